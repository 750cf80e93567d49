"""Rings in the order of the toolbox: many at once as one by one, and the same rings."""

import numpy as np
import pytest

from reference import toolbox_order as plain
from tiskel import ShapeParams, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.geometry.neighbours import surroundings
from tiskel.methods.laplacian import toolbox_order
from tiskel.methods.laplacian.toolbox_order import in_published_order


def lattice() -> Points:
    """A bent lattice: four neighbours on every circle, and open rings along its border."""
    x, y = (axis.ravel() for axis in np.mgrid[:14.0, :14.0])
    return np.stack([x, y, np.sin(0.1 * x)], axis=1)


def holed() -> Points:
    return make_shape(shape_graph("quadruped"), ShapeParams(count=500, missing=0.3, noise=0.1))[0]


def with_a_line() -> Points:
    """Points on a line, whose neighbours Qhull refuses, beside a lattice."""
    return np.concatenate([lattice(), np.outer(np.arange(40.0), [1, 2, 3]) + 50])


CLOUDS = {"lattice": lattice, "holed": holed, "with a line": with_a_line}


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("batch", [100, 16384])
def test_many_rings_at_once_are_as_one_by_one(name: str, batch: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(toolbox_order, "BATCH", batch)
    points = CLOUDS[name]()
    neighbours, _, rings = surroundings(points, 14)
    ordered = in_published_order(points, neighbours, rings)
    assert np.array_equal(ordered.members, plain.in_published_order(points, neighbours, rings))
    assert (ordered.members != rings.members).any()
    assert np.array_equal(np.sort(ordered.members, axis=1), np.sort(rings.members, axis=1))
    assert not (ordered.closed.all() and name == "lattice")
