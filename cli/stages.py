"""What the commands do with the library: read, run a stage, tell, write."""

import math
import os
import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tiskel import messages
from tiskel.cli import console
from tiskel.cli.words import misput
from tiskel.errors import TiskelError
from tiskel.extras import ADVICE, there
from tiskel.params import ConditioningParams, ContractionParams, PipelineParams, params_class, settings_of

if TYPE_CHECKING:
    from tiskel.arrays import Numbers
    from tiskel.contraction import Contraction
    from tiskel.io.clouds import Cloud
    from tiskel.progress import Report

LONGEST_STEM = 100  #: characters of the input's name that the output's begins with
STAGE_SUFFIXES = (".ply", ".json", ".csv")  #: of outputs that have one format each
PARTS_OF_PI = re.compile(r"([+-]?)(?:(\d+(?:\.\d+)?)\*)?pi(?:/(\d+(?:\.\d+)?))?")


def conditioning_params(given: Mapping[str, Any]) -> ConditioningParams:
    """Return what the input options say."""
    crop, sample = _numbers("--crop", given["crop"], 6), sample_of(given["sample"])
    columns, classes = columns_of(given["columns"]), classes_of(given["classification"])
    read = {"crop": crop, "sample": sample, "columns": columns, "classification": classes}
    return ConditioningParams(**{**given, **read})


def columns_of(value: str | None) -> tuple[str, ...] | None:
    """Return what --columns names."""
    return None if value is None else tuple(value.split(","))


def classes_of(value: str | None) -> tuple[int, ...] | None:
    """Return the numbers of --classification."""
    if value is None:
        return None
    words = [word.strip() for word in value.split(",")]
    if not all(word.isascii() and word.isdigit() and len(word) <= 3 for word in words):
        raise misput("--classification", "numbers of classes such as 4,5", value)
    return tuple(map(int, words))


def sample_of(value: str | int | None) -> int | None:
    """Return the number of points that --sample names, None for auto."""
    if value in {None, "auto"}:
        return None
    try:
        return int(str(value))
    except ValueError:
        raise misput("--sample", "auto or a number of points", value) from None


def read_cloud(source: Path, params: ConditioningParams) -> "Cloud":
    """Read a cloud and tell its warnings; a mesh is sampled to as many points as the cloud is to have."""
    from tiskel import load_cloud

    chosen: dict[str, Any] = {"columns": params.columns, "classification": params.classification}
    cloud = load_cloud(source, mesh_samples=params.sample, seed=params.seed, **chosen)
    tell_read(cloud)
    return cloud


def weights_of(cloud: "Cloud", name: str | None) -> "Numbers | None":
    """Return a property of the cloud, one number per point, or nothing where none is named."""
    if name is None:
        return None
    if name not in cloud.properties:
        known = ", ".join(cloud.properties) or "none"
        raise TiskelError(f"--weights: {cloud.name} has no property {name!r}; it has {known}")
    return cloud.properties[name]


def contraction_params(method: str, given: Mapping[str, Any]) -> ContractionParams:
    """Return the settings of a method, with the solver from the environment where it has one and none is named."""
    solver = os.environ.get("TISKEL_SOLVER")
    usual = {"solver": solver} if solver and "solver" in settings_of(params_class(method)) else {}
    return ContractionParams(method=method, **{**usual, **given})


def contracted(data: bytes, source: Path, progress: "Report | None") -> "tuple[Contraction, dict[str, str]]":
    """Return the contraction in the bytes of a file, or that of the cloud in them, and what it was made from."""
    from tiskel import condition, contract
    from tiskel.io.clouds import parse_cloud
    from tiskel.io.ply import source_of
    from tiskel.io.stages.contraction import parse_contraction
    from tiskel.io.stages.which import stage_of

    if stage_of(data) not in {None, "cloud"}:
        return parse_contraction(data, str(source)), source_of(data, "contraction", str(source))
    cloud, params = parse_cloud(data, source), contraction_params(PipelineParams().contraction.method, {})
    tell_read(cloud)
    console.say(
        f"{cloud.name} is a cloud: contracted first, by method {params.method}; tiskel contract has other settings"
    )
    points, report = condition(cloud.points, ConditioningParams())
    console.tell(messages.said(report))
    made = contract(points, params, None, cloud.surface, progress=progress)
    tell_contraction(made)
    return made, cloud.source


def tell_read(cloud: "Cloud") -> None:
    """Tell what there is to say of a cloud that was read."""
    console.warn(cloud.warnings)
    console.tell(messages.said(cloud.notes))


def tell_contraction(c: "Contraction") -> None:
    """Tell what there is to say; with --verbose the table of steps, too."""
    console.tell(messages.of_contraction(c))
    tell_steps(c)


def tell_steps(c: "Contraction") -> None:
    """Print the table of steps with --verbose."""
    if console.session.verbose:
        console.errors().print(_steps_table(c))
        console.say(f"neighbours and rings: {c.ring_seconds:.3f} s")


def _steps_table(c: "Contraction"):  # type: ignore[no-untyped-def]
    columns = {
        "step": [str(number) for number in range(1, len(c.steps) + 1)],
        "W_L": [f"{step.contraction_weight:.4g}" if step.contraction_weight else "" for step in c.steps],
        "ring ratio": [f"{step.ring_ratio:.4f}" for step in c.steps],
        "score": ["" if step.score is None else f"{step.score:.5f}" for step in c.steps],
        "change": ["" if step.score_change is None else f"{step.score_change:.5f}" for step in c.steps],
        "points": [str(step.points) for step in c.steps],
    } | {f"{part} s": [f"{step.seconds[part]:.3f}" for step in c.steps] for part in c.steps[0].seconds}
    columns = {name: cells for name, cells in columns.items() if any(cells)}  # robust has no weights and no score
    return console.table("steps", list(columns), [list(row) for row in zip(*columns.values(), strict=True)])


def output_path(output: Path | None, source: Path, ending: str, also: tuple[str, ...] = ()) -> Path:
    """Return where to write: the option, standard output for a pipe or a file, a name here on a terminal."""
    if output is not None:
        _check_output(output, ending, also)
        return output
    if not sys.stdout.isatty():
        return Path("-")
    stem = "stdin" if str(source) == "-" else source.name.split(".")[0]
    path = Path(f"{stem[:LONGEST_STEM]}.{ending}")
    _check_output(path, ending)
    console.say(f"writing {path}")
    return path


def _check_output(output: Path, ending: str, also: tuple[str, ...] = ()) -> None:
    """Raise, before the work begins, where a file cannot be written, or its suffix says another format."""
    from tiskel.io.streams import check_target

    wanted = Path(ending).suffix
    regular = str(output) != "-" and (not output.exists() or output.is_file())
    if regular and wanted in STAGE_SUFFIXES and output.suffix and output.suffix.lower() not in (wanted, *also):
        raise TiskelError(f"this is written as {wanted}, not as {output.suffix!r}; name the file so, or leave -o out")
    check_target(output)


def check_targets(*paths: Path | None) -> None:
    """Raise, before the work begins, where one of the files that are asked for cannot be written."""
    from tiskel.io.streams import check_target

    for path in paths:
        if path is not None:
            check_target(path)


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
        raise misput(option, f"{count} numbers separated by commas", value)
    return numbers


def _number(word: str) -> float:
    """Return a number, or a multiple or a part of pi."""
    found = PARTS_OF_PI.fullmatch(word.strip())
    if found is None:
        return float(word)
    sign, factor, divisor = found.groups()
    return float(f"{sign}1") * float(factor or 1) * math.pi / float(divisor or 1)


def can_draw() -> bool:
    """Tell whether pictures can be drawn; say what is missing where they cannot."""
    if there("matplotlib"):
        return True
    console.say(f"no pictures: they need matplotlib; {ADVICE}")
    return False
