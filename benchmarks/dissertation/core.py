"""Rows of the table and what they have at hand: clouds, raw results, a place for figures, and rules of judgement."""

import io
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from kept import Json, Store, Work
from PIL import Image
from scipy.stats import spearmanr

from tiskel import load_cloud
from tiskel.arrays import Numbers, Points
from tiskel.pictures.canvas import rendered
from tiskel.pictures.style import CLOUD

MET, KIND, AGAINST, UNTESTED = "met", "met in kind", "contradicted", "not testable"
COLOURS = 64  # of a figure
SUFFIXES = (".ply", ".xyz", ".txt", ".csv", ".npy", ".pcd", ".off", ".obj", ".stl")
SHOWN = 10_000  # points of a cloud in a picture
RESAMPLES = 1000  # of a bootstrap


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

    @property
    def key(self) -> str:
        return f"{self.number}: {self.claim}"


@dataclass(frozen=True)
class Sizes:
    """How much is run: clouds by their number of points, shapes, and what the studies go up to."""

    clouds: dict[int, int] = field(default_factory=lambda: {1024: 216, 4096: 216, 16384: 216})
    shapes: int = 25  #: with a true skeleton, for the measures
    points: int = 2048  #: of each of these
    noisy: int = 8  #: shapes of the study of noise
    stopped: int = 25  #: shapes of the study of the stopping rule
    density: tuple[int, ...] = (512, 2048, 8192, 32768, 262144)
    beta: int = 250  #: skeletal points of the apple tree in a draw


QUICK = Sizes(clouds={512: 2}, shapes=3, points=512, noisy=2, stopped=2, density=(512, 2048), beta=20)


@dataclass(frozen=True)
class Bench:
    """Where things lie, how much is run, and what is known already."""

    sizes: Sizes
    out: Path
    store: Store
    reference: Path
    data: Path | None = None

    def raw(self, work: Work, **settings: Any) -> Json:
        """Return what a work gives for these settings; raise Wanted where it is not there yet."""
        return self.store.many(work, [settings])[0]

    def many(self, work: Work, settings: Sequence[Json]) -> list[Json]:
        """Return what a work gives for each of several settings; raise Wanted where some are not there yet."""
        return self.store.many(work, settings)

    def draw(self, name: str, figure: Any) -> str:
        """Write a figure and return its name."""
        return self.keep(name, rendered(figure))

    def keep(self, name: str, picture: bytes) -> str:
        """Write a picture, of few colours, and return its name."""
        self.out.mkdir(parents=True, exist_ok=True)
        small = io.BytesIO()
        Image.open(io.BytesIO(picture)).convert("RGB").quantize(COLOURS).save(small, format="PNG", optimize=True)
        (self.out / name).write_bytes(small.getvalue())
        return name

    def file(self, name: str) -> Path:
        """Return where a reference cloud lies."""
        return self.reference / "clouds" / f"{name}.ply"

    def cloud(self, name: str) -> Points | None:
        """Return a reference cloud, None where it is not there."""
        return load_cloud(self.file(name)).points if self.file(name).exists() else None

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


def missing(what: str = "the folder of reference clouds") -> Found:
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
