"""The small demonstrations of the chapter on skeleton quality: what each measure sees, on shapes anyone can draw.

    python benchmarks/demonstrations.py [folder]

1. H0 bars of simple shapes, before and after a cut, and after a deformation that keeps the topology.
2. The centre of a fitted ellipse against the barycentre, on rings that are sampled more and more unevenly.
3. Smoothness of a bent line and of a wavy one.

Writes a picture of each; tests/metrics/test_demonstrations.py holds the numbers to what they should show.
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tiskel import MetricParams, ShapeParams, make_shape, shape_graph
from tiskel.arrays import Numbers, Points, normalisation
from tiskel.geometry.ellipse import fit_ellipse
from tiskel.metrics.barcode import barcode
from tiskel.metrics.distances import bottleneck
from tiskel.metrics.smoothness import point_smoothness
from tiskel.pictures.canvas import Sight, cloud_panel, new_figure, rendered, sight_of
from tiskel.pictures.style import CURVE, INK, POINTS

OUT = Path(__file__).parent / "demonstrations"
SHAPES = ("capsule", "torus", "y")
GAP = 0.25  # width of the cut, in units of the shapes
BARS = 40
CONCENTRATIONS = (0.0, 0.5, 1.0, 1.5, 2.0, 2.5)  # of the von Mises distribution of the points around a ring
RINGS = 30  # of each


@dataclass(frozen=True)
class Bars:
    """Longest bars of H0 of a shape, of its halves after a cut, and of the shape bent; in normalised units."""

    whole: Numbers
    cut: Numbers
    bent: Numbers

    @property
    def distances(self) -> tuple[float, float]:
        """Bottleneck distances of the cut and of the bent shape from the whole."""
        return bottleneck(self.whole, self.cut), bottleneck(self.whole, self.bent)


def bars(name: str) -> tuple[Points, Points, Points, Bars]:
    """Return a shape, cut, and bent, and their bars."""
    whole = make_shape(shape_graph(name), ShapeParams(count=2000))[0]
    along = whole[:, np.ptp(whole, axis=0).argmax()]
    cut = whole[np.abs(along - along.mean() - 0.1) > GAP / 2]
    bent = whole + 0.25 * np.stack([whole[:, 2] ** 2, whole[:, 0] ** 2, 0 * along], axis=1)
    longest = [barcode(normalisation(p).apply(p)).deaths[:BARS] for p in (whole, cut, bent)]
    return whole, cut, bent, Bars(*longest)


def centres() -> tuple[Numbers, Numbers]:
    """Return (c, r) distances of ellipse centres and of barycentres from the true centre, in mean radii."""
    generator = np.random.default_rng(0)
    by_ellipse, by_mean = [], []
    for concentration in CONCENTRATIONS:
        rings = [ring(concentration, generator) for _ in range(RINGS)]
        fits = [fit_ellipse(points) for points in rings]
        by_ellipse.append([np.linalg.norm(fit.centre) / 1.5 if fit else np.nan for fit in fits])
        by_mean.append([np.linalg.norm(points.mean(axis=0)) / 1.5 for points in rings])
    return np.array(by_ellipse), np.array(by_mean)


def ring(concentration: float, generator: np.random.Generator) -> Numbers:
    """Return 60 points about an ellipse of semi-axes 2 and 1, crowded on one side, with noise of 2 %."""
    turn = generator.vonmises(0, concentration, 60)
    return np.stack([2 * np.cos(turn), np.sin(turn)], axis=1) + generator.normal(size=(60, 2)) * 0.02


def lines() -> dict[str, tuple[Points, Numbers]]:
    """Return a straight, a bent and a wavy row of points, and the smoothness of each point."""
    x = np.linspace(0, 4, 161)
    corner = np.clip(x - 2, 0, None)
    rows = {
        "straight": np.stack([x, 0 * x, 0 * x], axis=1),
        "bent": np.stack([x - corner, corner, 0 * x], axis=1),
        "wavy": np.stack([x, 0.15 * np.sin(12 * x), 0 * x], axis=1),
    }
    return {name: (points, point_smoothness(points, MetricParams())) for name, points in rows.items()}


def bars_picture() -> bytes:
    figure = new_figure(11, 3 * len(SHAPES))
    panels = figure.subplots(len(SHAPES), 4)
    for row, name in zip(panels, SHAPES, strict=True):
        *clouds, found = bars(name)
        view = sight_of(clouds[0]).view
        for panel, points, title in zip(row, clouds, ("whole", "cut", "bent"), strict=False):
            cloud_panel(panel, Sight(points, view))
            panel.set_title(f"{name}, {title}", fontsize=9)
        drawn = ((found.whole, INK, "whole"), (found.cut, CURVE, "cut"), (found.bent, POINTS, "bent"))
        for values, colour, title in drawn:
            row[3].plot(values, np.arange(len(values)), ".", color=colour, markersize=4, label=title)
        row[3].set_title("d_B to the whole: cut {:.3f}, bent {:.3f}".format(*found.distances), fontsize=8)
        row[3].set_xlabel("death", fontsize=8)
        row[3].tick_params(labelsize=7)
        row[3].legend(fontsize=7)
    return rendered(figure)


def centres_picture() -> bytes:
    figure = new_figure(10, 4)
    left, right = figure.subplots(1, 2)
    by_ellipse, by_mean = centres()
    for values, colour, title in ((by_mean, POINTS, "barycentre"), (by_ellipse, CURVE, "ellipse")):
        middle, low, high = (np.nanpercentile(values, share, axis=1) for share in (50, 5, 95))
        left.fill_between(CONCENTRATIONS, low, high, color=colour, alpha=0.25)
        left.plot(CONCENTRATIONS, middle, color=colour, label=title)
    left.set_xlabel("concentration of the points on one side (von Mises)", fontsize=8)
    left.set_ylabel("distance from the true centre, in mean radii", fontsize=8)
    left.legend(fontsize=8)
    points = ring(CONCENTRATIONS[-1], np.random.default_rng(3))
    fit = fit_ellipse(points)
    right.scatter(*points.T, s=10, c=INK)
    right.plot(*points.mean(axis=0), "o", color=POINTS, label="barycentre")
    right.plot(*fit.centre if fit else (), "o", color=CURVE, label="ellipse")
    right.plot(0, 0, "+", color=INK, markersize=14, label="true centre")
    right.set_aspect("equal")
    right.legend(fontsize=8)
    return rendered(figure)


def lines_picture() -> bytes:
    figure = new_figure(12, 3.6)
    for panel, (name, (points, smooth)) in zip(figure.subplots(1, 3), lines().items(), strict=True):
        drawn = panel.scatter(points[:, 0], points[:, 1], c=smooth, cmap="viridis", vmin=0, vmax=1, s=14)
        panel.set_aspect("equal", adjustable="datalim")
        panel.set_title(f"{name}: smoothness {smooth.mean():.3f}, least {smooth.min():.3f}", fontsize=9)
    figure.colorbar(drawn, ax=figure.axes)
    return rendered(figure)


PICTURES = {"bars.png": bars_picture, "centres.png": centres_picture, "lines.png": lines_picture}


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else OUT
    folder.mkdir(exist_ok=True)
    for name, draw in PICTURES.items():
        (folder / name).write_bytes(draw())
        print(folder / name)


if __name__ == "__main__":
    main()
