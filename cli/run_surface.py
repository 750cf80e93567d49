"""What ``tiskel run`` does after the skeleton: slices, surfaces, and a sphere on the longest."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tiskel.cli import console
from tiskel.cli.roll import summary, tell_runs
from tiskel.cli.slice import slices_csv, tell_surfaces
from tiskel.cli.surface_options import roll_settings
from tiskel.errors import TiskelError
from tiskel.params import SurfaceParams

if TYPE_CHECKING:
    from tiskel.rolling.trajectory import Trajectory
    from tiskel.skeleton import Skeleton
    from tiskel.slicing.fitted import FittedSurface, Surfaces


@dataclass(frozen=True)
class Rolled:
    """Surfaces and runs, as far as there are any, and why there are no more."""

    params: SurfaceParams
    surfaces: "Surfaces | None" = None
    surface: "FittedSurface | None" = None
    runs: "tuple[Trajectory, ...]" = ()
    reason: str = ""

    def stage_files(self, source: dict[str, str]) -> dict[str, Callable[[], bytes]]:
        """Return the files of what was made, by name."""
        if self.surfaces is None or self.surface is None:
            return {}
        from tiskel.io.mesh_file import dump_mesh
        from tiskel.io.stages.roll import to_csv
        from tiskel.io.stages.surface import dump_surfaces
        from tiskel.slicing.mesh import joined_mesh, surface_mesh

        surfaces = self.surfaces
        files: dict[str, Callable[[], bytes]] = {
            "surface.json": lambda: dump_surfaces(surfaces, self.params, source),
            "surface.ply": lambda: dump_mesh(joined_mesh([surface_mesh(s) for s in surfaces]), source),
            "slices.csv": lambda: slices_csv(surfaces),
        }
        return files | ({"path.csv": lambda: to_csv(self.runs)} if self.runs else {})

    def documents(self) -> dict[str, dict[str, Any]]:
        """Return the documents of the runs, by name."""
        if self.surface is None or not self.runs:
            return {}
        return {"roll.json": summary(self.surface.name, list(self.runs))}

    def pictures(self, title: str) -> dict[str, bytes]:
        """Return the pictures of surfaces and runs, by name."""
        if self.surfaces is None or self.surface is None:
            return {}
        from tiskel.pictures.rolling import rolling_picture
        from tiskel.pictures.slices import slices_picture

        drawn = {"slices.png": slices_picture(self.surfaces, title)}
        return drawn | ({"roll.png": rolling_picture(self.surface, self.runs, title)} if self.runs else {})


def sliced_and_rolled(skeleton: "Skeleton", params: SurfaceParams, rolling: Mapping[str, Any]) -> Rolled:
    """Fit surfaces and roll over the longest; where that is impossible, keep the reason and what there is."""
    from tiskel import fit_surface, roll

    made = Rolled(params)
    try:
        surfaces = fit_surface(skeleton, params)
        tell_surfaces(surfaces)
        made = Rolled(params, surfaces, surfaces.named(None))
        runs = tuple(roll(surfaces.named(None), settings) for settings in settings_of(rolling))
    except TiskelError as error:
        console.say(f"no {'surface' if made.surfaces is None else 'rolling'}: {error}")
        return Rolled(params, made.surfaces, made.surface, (), str(error))
    tell_runs(list(runs))
    return Rolled(params, surfaces, made.surface, runs)


def settings_of(rolling: Mapping[str, Any]) -> "list[Any]":
    """Return the settings of the runs that the options of ``tiskel run`` ask for."""
    from tiskel.cli.surface_options import ROLL, VELOCITY

    return roll_settings(
        rolling["model"], rolling["side"], rolling["sphere"], rolling["omega"], VELOCITY, ROLL.twist,
        rolling["duration"], ROLL.rate, rolling["start"], None, ROLL.normals,
        rolling["rtol"], rolling["atol"],
    )  # fmt: skip
