"""Rows of the table, raw results that are kept between runs, and figures: what the chapters share."""

import argparse
import ast
import hashlib
import inspect
import io
import json
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from scipy.stats import spearmanr

from tiskel import load_cloud
from tiskel.arrays import Numbers, Points
from tiskel.pictures.canvas import rendered
from tiskel.pictures.style import CLOUD

ROOT = Path(__file__).parents[2]
MET, KIND, AGAINST, UNTESTED = "met", "met in kind", "contradicted", "not testable"
COLOURS = 64  # of a figure
SUFFIXES = (".ply", ".xyz", ".txt", ".csv", ".npy", ".pcd", ".off", ".obj", ".stl")
SHOWN = 10_000  # points of a cloud in a picture
RESAMPLES = 1000  # of a bootstrap
Json = dict[str, Any]


@dataclass(frozen=True)
class Found:
    """What a row came to: our value, the verdict, the reason or what is missing, and the figures drawn."""

    ours: str
    verdict: str
    why: str = ""
    pictures: tuple[str, ...] = ()


@dataclass(frozen=True)
class Row:
    """Something the dissertation says that a number can settle, and the function that settles it."""

    number: str
    claim: str
    published: str
    find: Callable[["Bench"], Found]
    command: str = ""  #: of tiskel, where one alone does it; benchmarks/dissertation --only ROW always does


@dataclass(frozen=True)
class Sizes:
    """How much is run: clouds by their number of points, shapes, and what the studies go up to."""

    clouds: dict[int, int] = field(default_factory=lambda: {1024: 24, 4096: 24, 16384: 6})
    shapes: int = 25  #: with a true skeleton, for the measures
    points: int = 2048  #: of each of these
    noisy: int = 8  #: shapes of the study of noise
    density: tuple[int, ...] = (512, 2048, 8192, 32768, 262144)
    beta: int = 250  #: skeletal points of the apple tree


QUICK = Sizes(clouds={512: 2}, shapes=3, points=512, noisy=2, density=(512, 2048), beta=20)


@dataclass(frozen=True)
class Bench:
    """Where things lie, how much is run, and what is known already."""

    sizes: Sizes
    out: Path
    kept: Path
    reference: Path
    data: Path | None = None
    stale: bool = False  #: raw results of other versions of the library count, too

    @cached_property
    def version(self) -> str:
        """A hash of the library's sources."""
        return hashed(*(path.read_text() for path in sources()))

    def raw(self, work: Callable[..., Json], **settings: Any) -> Json:
        """Return what a function gives for these settings, from the folder of raw results where it is there."""
        key = hashed(json.dumps(settings, sort_keys=True, default=str))
        version = hashed(ast.dump(ast.parse(inspect.getsource(work))), self.version)
        places = sorted(self.kept.glob(f"{work.__name__}-{key}-{'*' if self.stale else version}.json"))
        if places:
            return dict(json.loads(places[-1].read_text()))
        said = ", ".join(str(value) for value in settings.values() if not isinstance(value, Path))
        print(f"    {work.__name__}: {said}", file=sys.stderr, flush=True)
        result = work(**settings)
        self.kept.mkdir(parents=True, exist_ok=True)
        written = self.kept / f"{work.__name__}-{key}-{version}.json"
        partial = written.with_suffix(f".{os.getpid()}")
        partial.write_text(json.dumps(result))
        partial.replace(written)
        return result

    def draw(self, name: str, figure: Any) -> str:
        """Write a figure, of few colours, and return its name."""
        self.out.mkdir(parents=True, exist_ok=True)
        small = io.BytesIO()
        picture = Image.open(io.BytesIO(rendered(figure))).convert("RGB")
        picture.quantize(COLOURS).save(small, format="PNG", optimize=True)
        (self.out / name).write_bytes(small.getvalue())
        return name

    def cloud(self, name: str) -> Points | None:
        """Return a reference cloud, None where it is not there."""
        path = self.reference / "clouds" / f"{name}.ply"
        return load_cloud(path).points if path.exists() else None

    def scans(self) -> Iterator[tuple[str, Path]]:
        """Yield the clouds of --data by name."""
        for path in sorted(self.data.iterdir()) if self.data else ():
            if path.suffix.lower() in SUFFIXES:
                yield path.stem, path


def broad_view(cloud: Points) -> Points:
    """Return the two directions (2, 3) in which a cloud is longest."""
    return np.asarray(np.linalg.svd(cloud - cloud.mean(axis=0), full_matrices=False)[2][:2])


def cloud_panel(panel: Any, cloud: Points, view: Points) -> None:
    """Draw a cloud in grey, at one scale, without ticks."""
    panel.scatter(*(cloud[:: max(1, len(cloud) // SHOWN)] @ view.T).T, s=1.5, c=CLOUD, linewidths=0)
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_xticks([])
    panel.set_yticks([])


def sources() -> list[Path]:
    """Return the files of the library."""
    return sorted([*(ROOT / "tiskel").rglob("*.py"), *(ROOT / "kernels").glob("*.py")])


def hashed(*texts: str) -> str:
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()[:12]


def missing(what: str) -> Found:
    return Found("", UNTESTED, f"{what} is not there")


def near(ours: float, published: float, share: float = 0.1) -> bool:
    """Whether a value is within a share of the published one."""
    return abs(ours - published) <= share * abs(published)


def interval(values: Sequence[float] | Numbers) -> tuple[float, float]:
    """Return the 95 % interval of a mean, by bootstrap."""
    known, generator = np.asarray(values, float), np.random.default_rng(0)
    means = known[generator.integers(len(known), size=(RESAMPLES, len(known)))].mean(axis=1)
    return float(np.quantile(means, 0.025)), float(np.quantile(means, 0.975))


def ranked(a: Sequence[float], b: Sequence[float]) -> tuple[float, float]:
    """Return Spearman's rank correlation and its p-value; NaN where a column does not vary."""
    if len(a) < 3 or len(set(a)) == 1 or len(set(b)) == 1:
        return float("nan"), float("nan")
    rho, p = spearmanr(a, b)
    return float(rho), float(p)


def page(rows: Sequence[tuple[str, Row, Found]], words: str) -> str:
    """Return the table as a page, a part for each chapter."""
    count = {verdict: sum(found.verdict == verdict for *_, found in rows) for verdict in (MET, KIND, AGAINST, UNTESTED)}
    lines = ["# The dissertation, claim by claim", "", words, ""]
    lines += [f"{len(rows)} rows: {', '.join(f'{n} {verdict}' for verdict, n in count.items())}.", ""]
    for chapter in dict.fromkeys(chapter for chapter, *_ in rows):
        lines += [f"## {chapter}", "", "| what | claim | published | here | verdict |", "|---" * 5 + "|"]
        for _, row, found in (r for r in rows if r[0] == chapter):
            links = " ".join(f"[figure](dissertation/{name})" for name in found.pictures)
            command = f"`{row.command}`" if row.command else ""
            claim = "; ".join(filter(None, (row.claim, command)))
            here = " ".join(filter(None, (found.ours, links)))
            verdict = f"**{found.verdict}**" + (f": {found.why}" if found.why else "")
            cells = [row.number, claim, row.published, here, verdict]
            lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
        lines.append("")
    return "\n".join(lines)


def remembered(bench: Bench) -> dict[str, Found]:
    """Return the rows of earlier runs by number and claim."""
    place = bench.kept / "rows.json"
    known = json.loads(place.read_text()) if place.exists() else {}
    return {key: Found(**{**value, "pictures": tuple(value["pictures"])}) for key, value in known.items()}


def remember(bench: Bench, found: dict[str, Found]) -> None:
    bench.kept.mkdir(parents=True, exist_ok=True)
    (bench.kept / "rows.json").write_text(json.dumps({key: asdict(value) for key, value in found.items()}, indent=1))


def arguments(words: Sequence[str] | None = None) -> argparse.Namespace:
    reference = os.environ.get("TISKEL_REFERENCE", ROOT / ".." / "shared" / "reference")
    parser = argparse.ArgumentParser(
        prog="benchmarks/dissertation", description="See benchmarks/dissertation/__main__.py"
    )
    parser.add_argument("--chapter", type=int, choices=(3, 4, 5))
    parser.add_argument("--only", help="rows whose number or claim contains this")
    parser.add_argument(
        "--data", type=Path, help="folder of scans, in place of generated clouds, under published names"
    )
    parser.add_argument("--quick", action="store_true", help="few and small clouds: does it run?")
    parser.add_argument("--clouds", nargs="+", metavar="POINTS:COUNT", help="as 1024:216 4096:216 16384:216")
    parser.add_argument("--shapes", type=int, help="shapes with a true skeleton, for the measures")
    parser.add_argument("--density", type=int, nargs="+", metavar="POINTS", help="of the study of density")
    parser.add_argument("--stale", action="store_true", help="raw results of other versions of the library count, too")
    parser.add_argument("--out", type=Path, default=ROOT / "docs", help="folder of dissertation.md and its figures")
    parser.add_argument("--kept", type=Path, default=ROOT / "out" / "dissertation", help="folder of raw results")
    parser.add_argument("--reference", type=Path, default=Path(reference))
    return parser.parse_args(words)
