"""Digests of what the stages make: did a change that only moves code move a result?

    python benchmarks/digests.py             # compare with benchmarks/digests.csv, say what differs
    python benchmarks/digests.py --write     # write benchmarks/digests.csv anew

Five reference clouds and ten shapes, by all three methods. ``files`` hashes the
bytes of contraction.ply and skeleton.ply, ``arrays`` what they hold: a change of
the file format alters the first and not the second. lbc and gls amplify
rounding by ten orders of magnitude, so the digests hold for one build of NumPy,
SciPy and BLAS on one processor: compare before and after on the same machine.
"""

import argparse
import csv
import hashlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from tiskel import ContractionParams, ShapeParams, contract, extract_skeleton, load_cloud, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.contraction import Contraction
from tiskel.io.stages.contraction import dump_contraction
from tiskel.io.stages.skeleton import dump_skeleton
from tiskel.skeleton import Skeleton

HERE = Path(__file__).parent
TABLE = HERE / "digests.csv"
REFERENCE = Path(os.environ.get("TISKEL_REFERENCE", HERE / ".." / ".." / "shared" / "reference")) / "clouds"
SCANS = ("hammer", "horse", "joint", "fertility", "cave")
SHAPES = ("capsule", "y", "banana", "torus", "hand", "ladder", "mug", "tree", "quadruped", "knot")
METHODS = ("robust", "lbc", "gls")
COUNT = 2048  # points of a shape


def clouds() -> Iterator[tuple[str, Points]]:
    """Yield name and points of every cloud; scans only where the folder of reference clouds is there."""
    for name in SCANS:
        if (REFERENCE / f"{name}.ply").is_file():
            yield name, load_cloud(REFERENCE / f"{name}.ply").points
    for name in SHAPES:
        yield name, make_shape(shape_graph(name), ShapeParams(count=COUNT, noise=0.02))[0]


def digest(*parts: bytes) -> str:
    """Return the first sixteen hexadecimal digits of the SHA-256 of all parts."""
    return hashlib.sha256(b"".join(parts)).hexdigest()[:16]


def arrays_of(c: Contraction, s: Skeleton) -> Iterator[bytes]:
    """Yield the bytes of every array that later stages and users build on."""
    for array in (c.points, c.origin, c.rows, c.merged_into, c.merged_step, *(np.ravel(p) for p in c.history)):
        yield np.ascontiguousarray(array).tobytes()
    for array in (s.nodes, s.edges, s.radius, s.node_of_point, s.contracted, *s.branches):
        yield np.ascontiguousarray(array).tobytes()
    yield "\n".join((*c.warnings, *map(str, s.warnings), c.status.value)).encode()


def rows() -> Iterator[dict[str, str]]:
    """Yield one row for every cloud and method."""
    for name, points in clouds():
        for method in METHODS:
            c = contract(points, ContractionParams(method=method))
            s = extract_skeleton(c)
            files = digest(dump_contraction(c), dump_skeleton(s))
            yield {"cloud": name, "method": method, "files": files, "arrays": digest(*arrays_of(c, s))}


def compare(old: list[dict[str, str]], new: list[dict[str, str]]) -> int:
    """Print what differs, and return how many rows do."""
    known = {(row["cloud"], row["method"]): row for row in old}
    differing = 0
    for row in new:
        before = known.get((row["cloud"], row["method"]), {})
        changed = [key for key in ("files", "arrays") if before.get(key) != row[key]]
        differing += bool(changed)
        if changed:
            print(f"{row['cloud']} {row['method']}: {' and '.join(changed)} differ")
    print(f"{len(new) - differing} of {len(new)} rows equal")
    return differing


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--write", action="store_true", help="write the table instead of comparing with it")
    parser.add_argument("--table", type=Path, default=TABLE)
    options = parser.parse_args()
    found = list(rows())
    if not options.write:
        with options.table.open(newline="") as file:
            return int(compare(list(csv.DictReader(file)), found) > 0)
    with options.table.open("w", newline="") as file:
        table = csv.DictWriter(file, ["cloud", "method", "files", "arrays"], lineterminator="\n")
        table.writeheader()
        table.writerows(found)
    return 0


if __name__ == "__main__":
    sys.exit(main())
