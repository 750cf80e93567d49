"""The pages of benchmarks/speed.py: the table, fitted growth, and a plot of time and memory over the points."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

import numpy as np
from tables import FOLDER, Row, written

from tiskel.kernels.threads import requested_threads
from tiskel.pictures.canvas import new_figure, rendered

FITTED = 16_384  # points from which on growth is fitted; below, what every call costs is a part of it
NOTICED = 10  # MB over the base that tell something about memory
TABLES = ("kernels", "laplacian-scipy", "laplacian-cholmod", "startup", "files", "pipe")
MARKERS = "osD^vPX"  # of works, in the order of the table

GROWTH = f"""# How time and memory grow

Exponents: slopes of logarithms over the sizes of [speed](speed.md) from {FITTED} points on. Memory: of what the peak is
over the base, where that is {NOTICED} MB or more; tree: of the yardstick's seconds in the same processes."""


def page(rows: Sequence[Row], skipped: Mapping[str, str]) -> None:
    """Write speed.csv, .md and .png, growth.csv and .md to benchmarks/speed."""
    others = ", ".join(f"[{name}]({name}.md)" for name in TABLES if (FOLDER / f"{name}.md").exists())
    left = "".join(f" {work} is left out: {why}." for work, why in skipped.items())
    words = f"""# Time and memory by the number of points

![time and memory](speed.png)

`python benchmarks/speed.py --write`, whose head says how; threads: {requested_threads()}. `over tree`: the median of
the ratios to cKDTree, build and query of k = 14 by two workers, of the same cloud in turn. Peak MB: the most that a
process held that did nothing else; base MB: what it held before.{left} Exponents: [growth](growth.md). Other tables:
{others}."""
    written("speed", rows, words)
    if grown := list(growth(rows)):
        written("growth", grown, GROWTH)
    (FOLDER / "speed.png").write_bytes(plot(rows))


def by_work(rows: Sequence[Row]) -> Iterator[tuple[tuple[str, str], list[Row]]]:
    """Yield shape and work, and their rows that have figures."""
    for key, group in groupby(rows, key=lambda row: (row["shape"], row["work"])):
        yield key, [row for row in group if row["seconds"]]


def growth(rows: Sequence[Row]) -> Iterator[Row]:
    """Yield the exponents of every shape and work with two sizes or more."""
    for (shape, work), found in by_work(rows):
        large = [row for row in found if int(row["points"]) >= FITTED]
        if len(large) < 2:
            continue
        sizes = np.array([float(row["points"]) for row in large])
        columns = {"time": "seconds", "processor": "processor s", "tree": "tree s"}
        fits = {name: slope(sizes, numbers(large, column)) for name, column in columns.items()}
        over = numbers(large, "peak MB") - numbers(large, "base MB")
        memory = slope(sizes[over >= NOTICED], over[over >= NOTICED])
        yield {"shape": shape, "work": work, "points": f"{sizes[0]:.0f} to {sizes[-1]:.0f}", **fits, "memory": memory}


def numbers(rows: Sequence[Row], column: str) -> np.ndarray:
    return np.array([float(row[column]) for row in rows])


def slope(sizes: np.ndarray, values: np.ndarray) -> str:
    """Return the exponent of the power that fits best, empty where there are fewer than two values."""
    return f"{np.polyfit(np.log(sizes), np.log(values), 1)[0]:.2f}" if len(sizes) > 1 else ""


def plot(rows: Sequence[Row]) -> bytes:
    """Return a picture: seconds above, peak memory below, a column for each shape; the yardstick is grey."""
    shapes, works = (list(dict.fromkeys(row[key] for row in rows)) for key in ("shape", "work"))
    figure = new_figure(3.2 * len(shapes) + 1.2, 6.5)
    panels = figure.subplots(2, len(shapes), squeeze=False, sharex=True, sharey="row")
    for (shape, work), found in by_work(rows):
        column, number = shapes.index(shape), works.index(work)
        sizes = numbers(found, "points")
        style = {"color": f"C{number}", "marker": MARKERS[number % len(MARKERS)], "ms": 4, "label": work}
        panels[0, column].plot(sizes, numbers(found, "seconds"), **style)
        panels[1, column].plot(sizes, numbers(found, "peak MB"), **style)
        if work == works[0]:
            panels[0, column].plot(sizes, numbers(found, "tree s"), "--", color="grey", label="cKDTree, k = 14")
    for panel in panels.flat:
        panel.set(xscale="log", yscale="log")
        panel.grid(alpha=0.3)
    for panel, shape in zip(panels[0], shapes, strict=True):
        panel.set_title(shape)
    for panel in panels[1]:
        panel.set_xlabel("points")
    panels[0, 0].set_ylabel("seconds")
    panels[1, 0].set_ylabel("peak memory, MB")
    named = {label: line for panel in panels[0] for line, label in zip(*panel.get_legend_handles_labels(), strict=True)}
    figure.legend(named.values(), named, loc="outside right upper")
    return rendered(figure)
