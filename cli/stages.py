"""What the commands do with the library: read, run a stage, tell, write."""

import math
import os
import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tiskel.cli import console
from tiskel.errors import TiskelError
from tiskel.params import ContractionParams, params_class, settings_of

if TYPE_CHECKING:
    from tiskel.arrays import Numbers, Points
    from tiskel.contraction import Contraction
    from tiskel.io.clouds import Cloud
    from tiskel.skeleton import Skeleton

PARTS_OF_PI = re.compile(r"([+-]?)(?:(\d+(?:\.\d+)?)\*)?pi(?:/(\d+(?:\.\d+)?))?")


def cloud_points(
    source: Path,
    *,
    voxel: float | None,
    sample: int | None,
    crop: str | None,
    outliers: bool,
    cap: bool,
    noise: float,
    noise_kind: str,
    seed: int,
) -> tuple["Cloud", "Points"]:
    """Read a cloud and condition it as the input options say."""
    from tiskel import ConditioningParams, condition, load_cloud

    params = ConditioningParams(
        voxel=voxel,
        sample=sample,
        crop=_numbers("--crop", crop, 6),
        outliers=outliers,
        cap=cap,
        noise=noise,
        noise_kind=noise_kind,  # type: ignore[arg-type]
        seed=seed,
    )
    cloud = load_cloud(source, mesh_samples=sample, seed=seed)
    console.warn(cloud.warnings)
    points, report = condition(cloud.points, params)
    for line in report:
        console.say(line)
    return cloud, points


def weights_of(cloud: "Cloud", points: "Points", name: str | None) -> "Numbers | None":
    """Return a property of the cloud, one number per point, or nothing where none is named."""
    if name is None:
        return None
    if name not in cloud.properties:
        known = ", ".join(cloud.properties) or "none"
        raise TiskelError(f"--weights: {cloud.name} has no property {name!r}; it has {known}")
    if len(points) != len(cloud.points):
        raise TiskelError("--weights names a value for every point of the file; leave out what changes their number")
    return cloud.properties[name]


def contraction_params(method: str, given: Mapping[str, Any]) -> ContractionParams:
    """Return the settings of a method, with the solver from the environment where it has one and none is named."""
    solver = os.environ.get("TISKEL_SOLVER")
    usual = {"solver": solver} if solver and "solver" in settings_of(params_class(method)) else {}
    return ContractionParams(method=method, **{**usual, **given})


def tell_contraction(c: "Contraction") -> None:
    """Print warnings and one line of result; with --verbose the table of steps."""
    console.warn(c.warnings)
    console.say(
        f"contracted {len(c.cloud)} points in {len(c.steps)} steps, {len(c.points)} left "
        f"({len(c.points) / len(c.cloud):.1%}); {c.status.value}: {c.status.advice}"
    )
    if console.session.verbose:
        console.errors().print(_steps_table(c))
        console.say(f"neighbours and rings: {c.ring_seconds:.3f} s")


def _steps_table(c: "Contraction"):  # type: ignore[no-untyped-def]
    parts = list(c.steps[0].seconds)
    columns = ["step", "W_L", "ring ratio", "score", "change", "points", *(f"{part} s" for part in parts)]
    rows = [
        [
            str(number),
            f"{step.contraction_weight:.4g}",
            f"{step.ring_ratio:.4f}",
            "" if step.score is None else f"{step.score:.5f}",
            "" if step.score_change is None else f"{step.score_change:.5f}",
            str(step.points),
            *(f"{step.seconds[part]:.3f}" for part in parts),
        ]
        for number, step in enumerate(c.steps, 1)
    ]
    return console.table("steps", columns, rows)


def tell_skeleton(s: "Skeleton") -> None:
    """Print warnings and one line of result."""
    console.warn(s.warnings)
    console.say(
        f"{len(s.nodes)} nodes, {len(s.edges)} edges: components {s.components}, loops {s.loops}, ends {s.ends}, "
        f"joints {s.junctions}, branches {len(s.branches)}, length {s.length:.6g}"
    )


def output_path(output: Path | None, source: Path, ending: str) -> Path:
    """Return where to write: the option, standard output for a pipe or a file, a name here on a terminal."""
    if output is not None:
        return output
    if not sys.stdout.isatty():
        return Path("-")
    stem = "stdin" if str(source) == "-" else source.name.split(".")[0]
    path = Path(f"{stem}.{ending}")
    console.say(f"writing {path}")
    return path


def write(target: Path, make: Callable[[], bytes]) -> None:
    """Make all bytes first, then write them: a stage that fails leaves no file."""
    from tiskel.io.streams import write_bytes

    write_bytes(target, make())


def _numbers(option: str, value: str | None, count: int) -> tuple[float, ...] | None:
    """Return the numbers of a comma-separated option."""
    if value is None:
        return None
    return numbers_of(option, value, count)


def numbers_of(option: str, value: str, count: int) -> tuple[float, ...]:
    """Return so many numbers of a comma-separated option; pi, -pi/2 and 3*pi/4 are numbers too."""
    try:
        numbers = tuple(_number(word) for word in value.split(","))
    except ValueError:
        numbers = ()
    if len(numbers) != count:
        raise TiskelError(f"{option} needs {count} numbers separated by commas, got {value!r}")
    return numbers


def _number(word: str) -> float:
    """Return a number, or a multiple or a part of pi."""
    found = PARTS_OF_PI.fullmatch(word.strip())
    if found is None:
        return float(word)
    sign, factor, divisor = found.groups()
    return float(f"{sign}1") * float(factor or 1) * math.pi / float(divisor or 1)
