"""Clouds that are cut into tiles: split, a skeleton of every tile, join, with time and memory of each, and the whole.

    python benchmarks/scale.py --points 1000000           # print
    python benchmarks/scale.py --points 10000000 --write  # into benchmarks/scale, beside the rows that are there

Scenes are pipes along a crooked lattice of 4 x 4 x 4 (network) and 16 x 2 x 2 joints (mine), and nine trees side by
side (forest), the same for all numbers of points: pipes have a radius of ten spacings, about, at a million. Every step
has a process of its own: peak MB is the most that it held, of interpreter, libraries and kernels 150 to 180. Skeletons
of tiles are made one after the other; seconds are of the wall. The whole is tried up to --whole points (1 000 000).
"""

import argparse
import csv
import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from memory import peak
from tables import Row, shown, surroundings

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from reference.scenes import forest, network
from tiskel import (
    SplitParams,
    contract,
    extract_skeleton,
    join_skeletons,
    load_cloud,
    read_skeleton,
    split_cloud,
    write_skeleton,
)
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.round_cones import ConeGraph, sample_union
from tiskel.io.tile_index import CLOUDS, SKELETONS, read_index
from tiskel.skeleton import Skeleton

FOLDER = Path(__file__).parent / "scale"
SCENES = ("network", "mine", "forest")
CHUNK = 500_000  # points that are made at once
ROW = np.dtype([("x", "<f8"), ("y", "<f8"), ("z", "<f8")])


def scene(name: str) -> ConeGraph:
    if name == "forest":
        return forest(3, 25, apart=16.0)
    return network((4, 4, 4), 0.09) if name == "network" else network((16, 2, 2), 0.09)


def make(folder: Path, name: str, count: int, points: int) -> dict[str, object]:
    """Write the cloud chunk by chunk."""
    shape = scene(name)
    with (folder / "cloud.ply").open("wb") as file:
        lines = ["ply", "format binary_little_endian 1.0", f"element vertex {count}"]
        lines += [f"property double {axis}" for axis in "xyz"]
        file.write(("\n".join([*lines, "end_header"]) + "\n").encode())
        for start in range(0, count, CHUNK):
            generator = np.random.default_rng(start)
            file.write(sample_union(shape, min(CHUNK, count - start), generator).astype("<f8").tobytes())
    return counts(shape)


def split(folder: Path, name: str, count: int, points: int) -> dict[str, object]:
    index, _ = split_cloud(folder / "cloud.ply", folder / "parts", SplitParams(points=points))
    copies = sum(part.points for part in index.parts)
    assert sum(part.core for part in index.parts) == count
    assert index.tiling is not None
    return {"tiles": len(index.parts), "copies": f"{copies / count:.2f}", "overlap": f"{index.tiling.overlap:.4g}"}


def tiles(folder: Path, name: str, count: int, points: int) -> dict[str, object]:
    parts = folder / "parts"
    (parts / SKELETONS).mkdir()
    for part in read_index(parts).parts:
        cloud = load_cloud(parts / CLOUDS / f"{part.name}.ply")
        skeleton = extract_skeleton(contract(cloud.points))
        write_skeleton(parts / SKELETONS / f"{part.name}.skeleton.ply", skeleton, cloud.source)
    return {}


def join(folder: Path, name: str, count: int, points: int) -> dict[str, object]:
    made, index = join_skeletons(folder / "parts")
    write_skeleton(folder / "joined.ply", made, index.source)
    return counts(made) | {"said": "; ".join(sorted(doubt.code for doubt in made.warnings))}


def whole(folder: Path, name: str, count: int, points: int) -> dict[str, object]:
    cloud = load_cloud(folder / "cloud.ply")
    made = extract_skeleton(contract(cloud.points))
    write_skeleton(folder / "whole.ply", made, cloud.source)
    return counts(made) | {"said": "; ".join(sorted(doubt.code for doubt in made.warnings))}


def counts(curve: CurveGraph) -> dict[str, object]:
    said = {"components": curve.components, "loops": curve.loops, "ends": curve.ends}
    return said | {"length": f"{curve.length:.2f}"}


STEPS: dict[str, Callable[[Path, str, int, int], dict[str, object]]] = {
    "make": make, "split": split, "tiles": tiles, "join": join, "whole": whole,
}  # fmt: skip
COLUMNS = ("tiles", "copies", "overlap", "components", "loops", "ends", "length", "said")


def apart(folder: Path) -> str:
    """Return how far nodes of the joined curve are from the whole one, the 95 % quantile, in radii there."""
    from scipy.spatial import cKDTree

    joined, one = read_skeleton(folder / "joined.ply"), read_skeleton(folder / "whole.ply")
    distance = cKDTree(dense(one)).query(joined.nodes)[0]
    radius = np.median(one.radii)
    return f"{np.quantile(distance, 0.95) / radius:.2f} of the median radius off the whole at 95 % of nodes"


def dense(curve: Skeleton) -> np.ndarray:
    share = np.linspace(0, 1, 9)[:, None, None]
    ends = curve.nodes[curve.edges]
    return (ends[:, 0] * (1 - share) + ends[:, 1] * share).reshape(-1, 3)


def measured(step: str, folder: Path, name: str, count: int, points: int) -> Row:
    """Return a row: what a step gave in a process of its own."""
    command = [sys.executable, __file__, "--child", step, str(folder), name, str(count), str(points)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(done.stderr)
    found = json.loads(done.stdout.splitlines()[-1])
    cells = {column: str(found.get(column, "")) for column in COLUMNS}
    return {
        "scene": name, "points": str(count), "a tile": str(points), "step": step,
        "seconds": f"{found['seconds']:.1f}", "peak MB": f"{found['peak']:.0f}", **cells,
    }  # fmt: skip


def rows_of(name: str, count: int, points: int, most: int, scratch: str | None) -> Iterator[Row]:
    folder = Path(tempfile.mkdtemp(dir=scratch))
    try:
        for step in STEPS:
            if step == "whole" and count > most:
                continue
            row = measured(step, folder, name, count, points)
            if step == "whole":
                row["said"] = "; ".join(filter(None, (row["said"], f"joined: {apart(folder)}")))
            yield row
    finally:
        shutil.rmtree(folder)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, nargs="+", default=[1_000_000])
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--tile", type=int, default=SplitParams().points)
    parser.add_argument("--whole", type=int, default=1_000_000)
    parser.add_argument("--scratch", help="a folder for temporary files, 80 bytes a point")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--child", nargs=5, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.child:
        step, folder, name, count, points = given.child
        start = time.perf_counter()
        found = STEPS[step](Path(folder), name, int(count), int(points))
        print(json.dumps({**found, "seconds": time.perf_counter() - start, "peak": peak()}))
        return
    table = FOLDER / "scale.csv"
    rows: list[Row] = list(csv.DictReader(table.open(newline=""))) if given.write and table.exists() else []
    for name in given.scenes:
        for count in given.points:
            for row in rows_of(name, count, given.tile, given.whole, given.scratch):
                print(", ".join(f"{key} {cell}" for key, cell in row.items() if cell), flush=True)
                key = [row[column] for column in ("scene", "points", "a tile", "step")]
                rows = [r for r in rows if [r[c] for c in ("scene", "points", "a tile", "step")] != key] + [row]
                if given.write:
                    write(rows)
    print(shown(rows))


def write(rows: list[Row]) -> None:
    FOLDER.mkdir(exist_ok=True)
    rows.sort(key=lambda row: (row["scene"], int(row["points"]), int(row["a tile"]), list(STEPS).index(row["step"])))
    with (FOLDER / "scale.csv").open("w", newline="") as file:
        out = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        out.writeheader()
        out.writerows(rows)
    words = (
        "Split, skeletons of tiles one after the other, join, and the whole where it is tried: `benchmarks/scale.py`."
    )
    (FOLDER / "scale.md").write_text(f"{words}\n\n{surroundings()}\n\n{shown(rows)}\n")


if __name__ == "__main__":
    main()
