"""What small clouds are done with before Taichi runs: the same bits as kernels, and a command that never starts it."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tiskel.arrays import Points
from tiskel.geometry import numpy_kernels
from tiskel.geometry.neighbours import nearest_neighbours, principal_axes
from tiskel.geometry.rings import Rings, smallest_distances
from tiskel.kernels import running, runtime

RANDOM = np.random.default_rng(7)
LATTICE = np.stack(np.meshgrid(*[np.arange(9.0)] * 3), axis=-1).reshape(-1, 3)
CLOUDS: dict[str, Points] = {
    "random": RANDOM.normal(size=(3000, 3)),
    "far from the origin": RANDOM.normal(size=(500, 3)) + 1e6,
    "long": RANDOM.normal(size=(500, 3)) * [1e3, 1, 1e-3],
    "plane": RANDOM.normal(size=(500, 3)) * [1, 1, 0],
    "line": RANDOM.normal(size=(200, 3)) * [1, 0, 0],
    "lattice": LATTICE,
    "shell about a point": np.concatenate([[[0.0, 0, 0]], (LATTICE - 4)[(abs(LATTICE - 4)).max(axis=1) == 4]]),
    "copies": np.repeat(RANDOM.normal(size=(60, 3)), 9, axis=0),
    "one place": np.ones((50, 3)),
    "squares below the least number": RANDOM.normal(size=(300, 3)) * 1e-170,
    "few": RANDOM.normal(size=(14, 3)),
}


@pytest.fixture(scope="module", autouse=True)
def started() -> None:
    runtime.ensure()


@pytest.mark.parametrize("name", CLOUDS)
def test_neighbours_axes_and_distances_have_the_bits_of_the_kernels(name: str) -> None:
    points = np.ascontiguousarray(CLOUDS[name])
    k = min(14, len(points))
    found = numpy_kernels.nearest(points, k)
    assert found is not None
    rows, squares = nearest_neighbours(points, k)
    sizes = np.random.default_rng(0).integers(0, k, len(points)).astype(np.int32)
    members = np.where(np.arange(k) < sizes[:, None], rows, -1).astype(np.int32)
    by_numpy: tuple[np.ndarray, ...] = (
        *found, *numpy_kernels.principal_axes(points, rows), numpy_kernels.smallest_distances(points, members, sizes)
    )  # fmt: skip
    rings = Rings(members, sizes, np.zeros_like(sizes))
    by_kernels: tuple[np.ndarray, ...] = (
        rows,
        squares,
        *principal_axes(points, rows),
        smallest_distances(points, rings),
    )
    for one, other in zip(by_numpy, by_kernels, strict=True):
        assert (one.dtype, one.shape, one.flags.c_contiguous) == (other.dtype, other.shape, True)
        assert one.tobytes() == other.tobytes()


def test_what_cannot_be_told_or_held_is_left_to_the_kernel(monkeypatch: pytest.MonkeyPatch) -> None:
    too_far = RANDOM.normal(size=(100, 3)) * 1e160  # squares overflow
    assert numpy_kernels.nearest(too_far, 14) is None
    monkeypatch.setattr(numpy_kernels, "SCRATCH", 2000)
    assert numpy_kernels.nearest(CLOUDS["copies"], 4) is None
    monkeypatch.setattr(running, "started_in", [])
    assert nearest_neighbours(CLOUDS["copies"], 4)[0].shape == (540, 4)


def test_only_small_clouds_are_done_so_and_only_before_kernels_run(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not numpy_kernels.instead(10)
    monkeypatch.setattr(running, "started_in", [])
    assert numpy_kernels.instead(numpy_kernels.MOST)
    assert not numpy_kernels.instead(numpy_kernels.MOST + 1)


def test_a_small_cloud_is_contracted_without_taichi_and_to_the_same_bytes(tmp_path: Path) -> None:
    from tiskel import make_shape, shape_graph

    np.savetxt(tmp_path / "y.xyz", make_shape(shape_graph("y"))[0])
    code = (
        "import sys; sys.argv = ['tiskel', 'contract', 'y.xyz', '-q', '-o', sys.argv[1]]; "
        "{first}; from tiskel.cli.app import main\n"
        "try: main()\n"
        "finally: print('taichi' in sys.modules)"
    )
    for first, name, taichi in (
        ("pass", "one.ply", False),
        ("from tiskel.kernels import runtime as r; r.ensure()", "two.ply", True),
    ):
        words = [sys.executable, "-c", code.format(first=first), name]
        said = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=True).stdout
        assert said.split() == [str(taichi)]
    assert (tmp_path / "one.ply").read_bytes() == (tmp_path / "two.ply").read_bytes()
