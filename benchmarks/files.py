"""How long a contraction takes to write and to read, in what plyfile needs for as many scalar values.

    python benchmarks/files.py [POINTS]     # 262144 without

plyfile writes and reads files with the same columns, as plain tables, and copies
every column once, as whoever uses them does. Least times of alternating runs, in
one process; files lie in a temporary folder.
"""

import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from plyfile import PlyData, PlyElement

from tiskel import (
    Contraction,
    ShapeParams,
    contract,
    make_shape,
    read_contraction,
    shape_graph,
    write_contraction,
)
from tiskel.geometry.rings import Rings

COUNT, RUNS, RING = 262144, 7, 7  # points; of each; members of a ring, as many as lbc's have in the mean


def with_rings(c: Contraction) -> Contraction:
    """Return the contraction with rings in place of its sections, as lbc would have them."""
    members = np.random.default_rng(0).integers(len(c.points), size=(len(c.points), RING), dtype=np.int32)
    sizes = np.full(len(c.points), RING, np.int32)
    return replace(c, sections=None, rings=Rings(members, sizes, np.ones_like(sizes)))


def tables(c: Contraction, history: bool) -> list[list[np.ndarray]]:
    """Return the columns that a stage file holds, table by table."""
    vertex = [*c.points.T, *c.origin.T, c.rows]
    found = [vertex, [*c.cloud.T, c.input_rows, c.merged_into, c.merged_step]]
    if c.sections is not None:
        vertex += [c.sections.section, c.sections.level]
    if c.rings is not None:
        vertex += [np.cumsum(c.rings.sizes, dtype=np.int32), c.rings.closed.astype(np.uint8)]
        found.append([c.rings.members.ravel()])
    if history:
        found.append([*c.history.reshape(-1, 3).T])
    return found


def write_plain(path: Path, columns: list[list[np.ndarray]]) -> None:
    elements = []
    for number, table in enumerate(columns):
        rows = np.empty(len(table[0]), [(f"p{i}", column.dtype) for i, column in enumerate(table)])
        for i, column in enumerate(table):
            rows[f"p{i}"] = column
        elements.append(PlyElement.describe(rows, f"e{number}"))
    PlyData(elements, byte_order="<").write(str(path))


def read_plain(path: Path) -> list[np.ndarray]:
    file = PlyData.read(str(path))
    return [np.array(element.data[name]) for element in file.elements for name in element.data.dtype.names]


def least(works: list[Callable[[], object]]) -> list[float]:
    """Return the least time of each of some works that take turns."""
    times = [[] for _ in works]  # type: list[list[float]]
    for _ in range(RUNS):
        for work, found in zip(works, times, strict=True):
            start = time.perf_counter()
            work()
            found.append(time.perf_counter() - start)
    return [min(found) for found in times]


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else COUNT
    made = contract(make_shape(shape_graph("quadruped"), ShapeParams(count=count))[0])
    with tempfile.TemporaryDirectory() as folder:
        ours, theirs = Path(folder, "ours.ply"), Path(folder, "theirs.ply")
        for name, c, history in (
            ("robust", made, False), ("robust, history", made, True), ("rings", with_rings(made), False),
        ):  # fmt: skip
            columns = tables(c, history)
            written = least([
                lambda c=c, history=history: write_contraction(ours, c, history=history),  # type: ignore[misc]
                lambda columns=columns: write_plain(theirs, columns),  # type: ignore[misc]
            ])  # fmt: skip
            read = least([lambda: read_contraction(ours), lambda: read_plain(theirs)])
            print(
                f"{count} points, {name}: written in {written[0]:.3f} s, {written[0] / written[1]:.2f} times plyfile; "
                f"read in {read[0]:.3f} s, {read[0] / read[1]:.2f} times"
            )


if __name__ == "__main__":
    main()
