"""How long a contraction takes to write and to read, and what a pipe of commands costs over the work in it.

    python benchmarks/files.py [POINTS]                # 262144 without
    python benchmarks/files.py 1000000 --pipe robust   # contract | skeleton by command, over the same in process
    python benchmarks/files.py --write                 # into benchmarks/speed/files.csv and .md, or pipe.csv and .md

plyfile writes and reads files with the same columns, as plain tables, and copies
every column once, as whoever uses them does. Least times of alternating runs, in
one process; files lie in a temporary folder. The pipe reads a PLY and writes one;
in process the cloud is in memory and the curve stays there. Held at 2 times.
"""

import argparse
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from plyfile import PlyData, PlyElement
from startup import program
from tables import Row, shown, written

from tiskel import (
    Contraction,
    ContractionParams,
    ShapeParams,
    contract,
    extract_skeleton,
    make_shape,
    read_contraction,
    shape_graph,
    write_contraction,
)
from tiskel.geometry.rings import Rings
from tiskel.io.clouds import dump_cloud

COUNT, RUNS, RING, PIPES = (
    262144,
    7,
    7,
    3,
)  # points; of each; members of a ring, as many as lbc's have in the mean; runs of a pipe


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


def files(count: int) -> list[Row]:
    """Return what writing and reading take, in seconds and in times of plyfile."""
    made, rows = contract(make_shape(shape_graph("quadruped"), ShapeParams(count=count))[0]), []
    with tempfile.TemporaryDirectory() as folder:
        ours, theirs = Path(folder, "ours.ply"), Path(folder, "theirs.ply")
        for name, c, history in (
            ("robust", made, False), ("robust, history", made, True), ("rings", with_rings(made), False),
        ):  # fmt: skip
            columns = tables(c, history)
            wrote = least([
                lambda c=c, history=history: write_contraction(ours, c, history=history),  # type: ignore[misc]
                lambda columns=columns: write_plain(theirs, columns),  # type: ignore[misc]
            ])  # fmt: skip
            read = least([lambda: read_contraction(ours), lambda: read_plain(theirs)])
            rows.append({
                "points": str(count), "file": name, "written s": f"{wrote[0]:.3f}",
                "over plyfile": f"{wrote[0] / wrote[1]:.2f}", "read s": f"{read[0]:.3f}",
                "over plyfile, read": f"{read[0] / read[1]:.2f}",
            })  # fmt: skip
    return rows


def pipe(count: int, method: str) -> list[Row]:
    """Return what contract | skeleton takes by command, and the same in process; the first of both warms up."""
    cloud = make_shape(shape_graph("quadruped"), ShapeParams(count=count))[0]
    params = ContractionParams(method=method)
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder, "in.ply")
        source.write_bytes(dump_cloud(cloud, source))
        one = program("contract", str(source), "-q", "--method", method)
        commands = f"{one} | {program('skeleton', '-', '-q', '-o', f'{folder}/out.ply')}"
        works = {
            "in process": lambda: extract_skeleton(contract(cloud, params)),
            "by command": lambda: subprocess.run(commands, shell=True, check=True),
        }
        times: dict[str, list[float]] = {name: [] for name in works}
        for number in range(PIPES + 1):
            for name, work in works.items():
                start = time.perf_counter()
                work()
                if number or count > COUNT:  # what takes minutes is warm from its start
                    times[name].append(time.perf_counter() - start)
            if count > COUNT:
                break
    ratios = [a / b for a, b in zip(times["by command"], times["in process"], strict=True)]
    seconds = {f"{name} s": f"{statistics.median(found):.2f}" for name, found in times.items()}
    return [{"points": str(count), "method": method, **seconds, "ratio": f"{statistics.median(ratios):.2f}"}]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("points", type=int, nargs="*", default=[COUNT])
    parser.add_argument("--pipe", metavar="METHOD")
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    rows = [row for count in given.points for row in (pipe(count, given.pipe) if given.pipe else files(count))]
    print(shown(rows))
    if given.write and given.pipe:
        written("pipe", rows, "contract | skeleton by command, files included, over the same work in process.")
    elif given.write:
        written("files", rows, "Stage files of a contraction, least times of alternating runs, over plyfile's.")


if __name__ == "__main__":
    main()
