"""``tiskel run``."""

import html
import json
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from tiskel.cli import console, stages
from tiskel.cli import options as o
from tiskel.cli.common import common, reads_cloud
from tiskel.errors import TiskelError
from tiskel.params import SkeletonParams

if TYPE_CHECKING:
    from tiskel.contraction import Contraction
    from tiskel.skeleton import Skeleton

T = TypeVar("T")
Folder = Annotated[
    Path, typer.Option("-o", "--output", metavar="DIR", help="A folder; made when absent.", show_default=False)
]


@common
@reads_cloud
def run(
    source: o.Source,
    output: Folder,
    method: o.Method = o.CONTRACTION.method,
    neighbours: o.Neighbours = o.CONTRACTION.neighbours,
    max_steps: o.MaxSteps = o.CONTRACTION.max_steps,
    normalise: o.Normalise = o.CONTRACTION.normalise,
    solver: o.SolverName = None,
    raw: o.Raw = o.SKELETON.raw,
    radius: o.Radius = o.SKELETON.radius,
    *,
    conditioning: Mapping[str, Any],
) -> None:
    """Do everything in one go: stage files, exports, a picture and a report in one folder.

    `tiskel run scan.ply -o out/`
    """
    params = stages.contraction_params(method, neighbours, max_steps, normalise, solver)
    skeleton_params = SkeletonParams(raw=raw, radius=radius)
    _make_folder(output)
    seconds: dict[str, float] = {}
    cloud, points = _timed(seconds, "read", lambda: stages.cloud_points(source, **conditioning))
    from tiskel import contract, extract_skeleton
    from tiskel.io.contraction_file import dump_contraction
    from tiskel.io.exports import to_json, to_obj, to_swc
    from tiskel.io.skeleton_file import dump_skeleton
    from tiskel.pictures.skeleton import skeleton_picture

    contraction = _timed(seconds, "contract", lambda: contract(points, params))
    stages.tell_contraction(contraction)
    skeleton = _timed(seconds, "skeleton", lambda: extract_skeleton(contraction, skeleton_params))
    stages.tell_skeleton(skeleton)
    picture = _timed(seconds, "picture", lambda: skeleton_picture(skeleton, f"{cloud.name}, {method}"))
    files: dict[str, Callable[[], bytes]] = {
        "contraction.ply": lambda: dump_contraction(contraction, cloud.source),
        "skeleton.ply": lambda: dump_skeleton(skeleton, skeleton_params, cloud.source),
        "skeleton.obj": lambda: to_obj(skeleton),
        "skeleton.swc": lambda: to_swc(skeleton),
        "skeleton.json": lambda: to_json(skeleton),
        "skeleton.png": lambda: picture,
        "report.html": lambda: report(cloud.name, contraction, skeleton).encode(),
    }
    for name, make in files.items():
        stages.write(output / name, make)
    seconds |= {
        f"contract.{part}": sum(s.seconds.get(part, 0) for s in contraction.steps)
        for part in contraction.steps[0].seconds
    }
    seconds["contract.rings"] = contraction.ring_seconds
    stages.write(output / "timings.json", (json.dumps(seconds, indent=1) + "\n").encode)
    console.say(f"wrote {', '.join([*files, 'timings.json'])} to {output}")


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


def report(name: str, c: "Contraction", s: "Skeleton") -> str:
    """Return one page: what went in, what came out, the steps, the picture."""
    facts = {
        "points": len(c.cloud),
        "method": c.params.method,
        "steps": len(c.steps),
        "status": f"{c.status.value}: {c.status.advice}",
        "points left": f"{len(c.points)} ({len(c.points) / len(c.cloud):.1%})",
        "nodes": len(s.nodes),
        "components": s.components,
        "loops": s.loops,
        "ends": s.ends,
        "joints": s.joints,
        "length": f"{s.length:.6g}",
    }
    head = ("step", "contraction weight", "ring ratio", "explained score", "points")
    steps = [
        (i, f"{t.contraction_weight:.4g}", f"{t.ring_ratio:.4f}", "" if t.score is None else f"{t.score:.5f}", t.points)
        for i, t in enumerate(c.steps, 1)
    ]
    warnings = "".join(f"<li>{html.escape(line)}</li>" for line in (*c.warnings, *s.warnings))
    table = "".join(_row(pair) for pair in facts.items())
    history = _row(head, "th") + "".join(_row(step) for step in steps)
    return PAGE.format(name=html.escape(name), table=table, warnings=warnings, history=history)


PAGE = """<!doctype html>
<meta charset="utf-8">
<title>tiskel</title>
<style>
body {{ font: 15px sans-serif; margin: 2em; max-width: 75em }}
td, th {{ padding: .2em .8em; text-align: right }}
img {{ max-width: 100% }}
</style>
<h1>{name}</h1>
<img src="skeleton.png" alt="the cloud and its curve skeleton">
<table>{table}</table>
<ul>{warnings}</ul>
<h2>Contraction</h2>
<table>{history}</table>
"""


def _row(cells: tuple[Any, ...], tag: str = "td") -> str:
    return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"
