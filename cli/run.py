"""``tiskel run``."""

import json
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli import surface_options as so
from tiskel.cli.common import common, contracts, curves, reads_cloud, rolls
from tiskel.cli.report import report
from tiskel.cli.run_surface import Rolled, settings_of, sliced_and_rolled
from tiskel.errors import TiskelError
from tiskel.params import SkeletonParams, SurfaceParams

if TYPE_CHECKING:
    from tiskel.contraction import Contraction
    from tiskel.io.clouds import Cloud
    from tiskel.metrics.result import Quality
    from tiskel.metrics.stability import Stability
    from tiskel.skeleton import Skeleton

T = TypeVar("T")
Folder = Annotated[
    Path, typer.Option("-o", "--output", metavar="DIR", help="A folder; made when absent.", show_default=False)
]


@common
@reads_cloud
@contracts
@curves
@rolls
def run(
    source: o.Source,
    output: Folder,
    method: o.MethodName = o.METHOD,
    weights: o.Weights = None,
    history: o.History = False,
    branch: so.Branch = so.SURFACE.branch,
    *,
    conditioning: Mapping[str, Any],
    contracting: Mapping[str, Any],
    curving: Mapping[str, Any],
    rolling: Mapping[str, Any],
) -> None:
    """Do everything in one go: stage files, exports, measures, surfaces, a roll, pictures and a report in one folder.

    `tiskel run scan.ply -o out/`
    """
    params = stages.contraction_params(method, contracting)
    skeleton_params = SkeletonParams(**curving)
    skeleton_params.over(params)  # wrong settings are told before the work begins
    surface_params = SurfaceParams(branch=branch)
    settings_of(rolling)  # wrong options are told before the work begins
    _make_folder(output)
    seconds: dict[str, float] = {}
    cloud, points = _timed(seconds, "read", lambda: stages.cloud_points(source, **conditioning))
    from tiskel import assess_stability, contract, evaluate, extract_skeleton

    c = _timed(seconds, "contract", lambda: contract(points, params, stages.weights_of(cloud, points, weights)))
    stages.tell_contraction(c)
    s = _timed(seconds, "skeleton", lambda: extract_skeleton(c, skeleton_params))
    stages.tell_skeleton(s)
    quality = _timed(seconds, "metrics", lambda: evaluate(s))
    stability = _timed(seconds, "stability", lambda: assess_stability(c))
    console.say(f"{'stable' if stability.stable else 'not stable'}: {stability.reason}")
    rolled = _timed(seconds, "surface", lambda: sliced_and_rolled(s, surface_params, rolling))
    made = Made(cloud, c, s, quality, stability, rolled, history)
    drawn = _timed(seconds, "pictures", made.pictures)
    files: dict[str, Callable[[], bytes]] = {}
    files |= {**made.stage_files(), **made.documents(), **{name: partial(bytes, data) for name, data in drawn.items()}}
    for name, make in files.items():
        stages.write(output / name, make)
    seconds |= {f"contract.{part}": sum(t.seconds.get(part, 0) for t in c.steps) for part in c.steps[0].seconds}
    seconds |= {"contract.rings": c.ring_seconds} | {f"metrics.{part}": t for part, t in quality.seconds.items()}
    stages.write(output / "timings.json", (json.dumps(seconds, indent=1) + "\n").encode)
    console.say(f"wrote {', '.join([*files, 'timings.json'])} to {output}")


@dataclass(frozen=True)
class Made:
    """All results, and the files they become."""

    cloud: "Cloud"
    contraction: "Contraction"
    skeleton: "Skeleton"
    quality: "Quality"
    stability: "Stability"
    rolled: Rolled
    history: bool

    def stage_files(self) -> dict[str, Callable[[], bytes]]:
        """Return what makes each stage file and export, by name."""
        from tiskel.io.exports import to_json, to_obj, to_swc
        from tiskel.io.stages.contraction import dump_contraction
        from tiskel.io.stages.heat import dump_heat
        from tiskel.io.stages.skeleton import dump_skeleton

        source = self.cloud.source
        return {
            "contraction.ply": lambda: dump_contraction(self.contraction, source, history=self.history),
            "skeleton.ply": lambda: dump_skeleton(self.skeleton, source),
            "skeleton.obj": lambda: to_obj(self.skeleton),
            "skeleton.swc": lambda: to_swc(self.skeleton),
            "skeleton.json": lambda: to_json(self.skeleton),
            "metrics.ply": lambda: dump_heat(self.quality),
            **self.rolled.stage_files(source),
        }

    def documents(self) -> dict[str, Callable[[], bytes]]:
        """Return what makes each document, by name."""
        page = partial(
            report, self.cloud.name, self.contraction, self.skeleton, self.quality, self.stability, self.rolled
        )
        rolls = {name: partial(_document, document) for name, document in self.rolled.documents().items()}
        return {
            "metrics.json": lambda: _document(self.quality.as_dict()),
            "stability.json": lambda: _document(self.stability.as_dict()),
            **rolls,
            "report.html": lambda: page().encode(),
        }

    def pictures(self) -> dict[str, bytes]:
        """Return the pictures, by name."""
        from tiskel.pictures.quality import quality_picture
        from tiskel.pictures.skeleton import skeleton_picture
        from tiskel.pictures.stability import stability_picture

        title = f"{self.cloud.name}, {self.contraction.params.method}"
        return {
            "skeleton.png": skeleton_picture(self.skeleton, title),
            "metrics.png": quality_picture([(title, self.skeleton.cloud, self.quality)]),
            "stability.png": stability_picture(self.contraction, self.stability, title),
            **self.rolled.pictures(title),
        }


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise TiskelError(f"cannot make the folder {folder}: {error.strerror}; choose another with -o") from None


def _timed(seconds: dict[str, float], part: str, work: Callable[[], T]) -> T:
    start = time.perf_counter()
    result = work()
    seconds[part] = time.perf_counter() - start
    return result


def _document(values: dict[str, Any]) -> bytes:
    return (json.dumps(values, allow_nan=False, indent=1) + "\n").encode()
