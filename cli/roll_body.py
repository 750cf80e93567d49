"""``tiskel roll --body``: another body than a sphere."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from tiskel.cli import console, stages
from tiskel.cli.progress import reading, shown
from tiskel.cli.stages import numbers_of
from tiskel.cli.words import misput
from tiskel.errors import TiskelError
from tiskel.params import RollParams

if TYPE_CHECKING:
    from tiskel.rolling.inputs import Inputs
    from tiskel.surfaces.jets import ParametricSurface


def rolled(
    source: Path, output: Path | None, branch: str | None, body: str, settings: Sequence[RollParams],
    given: "Inputs | None", as_json: bool, *, pictured: bool,
) -> None:  # fmt: skip
    """Roll a body over the surface of a branch, and write what came of it."""
    if len(settings) > 1 or settings[0].model != "global":
        raise TiskelError(f"--body rolls on the surface of a branch as it is; leave out --model {settings[0].model}")
    if pictured:
        raise TiskelError("--plot and --animate draw spheres only; leave them out with --body")
    from tiskel import roll_body
    from tiskel.io.stages.surface import read_surfaces
    from tiskel.io.stages.trajectories import body_csv

    with shown(reading(source)):
        surface = read_surfaces(source).named(branch)
        run = roll_body(surface, body_named(body), settings[0], given)
    console.say(f"body {body}: {run.status.value}, {run.reason}")
    console.warn(run.warnings)
    if as_json:
        said = {"branch": surface.name, "body": body, "status": run.status.value, "reason": run.reason,
                "time": float(run.t[-1]), "start": run.state[0].tolist(), "end": run.state[-1].tolist(),
                "path_object": run.path_object, "path_body": run.path_body,
                "least_margin": float(run.margin.min()), "warnings": list(run.warnings)}  # fmt: skip
        typer.echo(json.dumps(said, allow_nan=False))
    if output is not None or not as_json:
        stages.write(stages.output_path(output, source, "path.csv"), lambda: body_csv(run))


def body_named(word: str) -> "ParametricSurface":
    """Return the body that --body names: an ellipsoid, a cylinder, or the longest branch of a surface file.

    Raises
    ------
    TiskelError
        For other words, and for sizes that are not positive.
    """
    from tiskel.io.stages.surface import read_surfaces
    from tiskel.surfaces.analytic import Ellipsoid, Rod

    kind, _, sizes = word.partition(":")
    if kind in {"ellipsoid", "cylinder"}:
        a, b, *c = numbers_of("--body", sizes, 3 if kind == "ellipsoid" else 2)
        if not min(a, b, *c) > 0:
            raise misput("--body", f"positive sizes of {'an' if c else 'a'} {kind}", sizes)
        return Ellipsoid(a, b, c[0]) if c else Rod(a, b)
    return read_surfaces(Path(word)).named(None)
