"""Homotopic thinning against a reference that counts pieces, and against the Betti numbers of what it is given."""

import numpy as np
from scipy import ndimage

from reference import thinning as plain
from reference.thinning import is_simple
from tiskel.geometry.solid import betti_numbers
from tiskel.geometry.thinning import Grid, thinned


def test_a_cube_goes_where_it_is_simple() -> None:
    """Of random neighbourhoods, sparse and dense: only the middle may go, the others are kept."""
    generator = np.random.default_rng(3)
    simple = []
    for share in np.repeat([0.1, 0.3, 0.5, 0.7, 0.9], 40):
        cubes: Grid = generator.random((3, 3, 3)) < share
        cubes[1, 1, 1] = True
        kept = cubes.copy()
        kept[1, 1, 1] = False
        simple.append(is_simple(cubes))
        assert bool(thinned(cubes, np.zeros(cubes.shape), kept)[1, 1, 1]) != simple[-1]
    assert 40 < sum(simple) < 160


def test_what_is_left_is_what_counting_pieces_leaves() -> None:
    """Of a sponge, with ties in the order and cubes that are kept: the same cubes, one by one."""
    generator = np.random.default_rng(4)
    sponge: Grid = ndimage.gaussian_filter(generator.normal(size=(12, 11, 10)), 1) > 0
    order = generator.integers(0, 5, size=sponge.shape).astype(float)
    kept: Grid = generator.random(sponge.shape) < 0.03
    np.testing.assert_array_equal(thinned(sponge, order, kept), plain.thinned(sponge, order, kept))


def test_topology_stays_and_no_simple_cube_is_left() -> None:
    """A sponge with many handles: what is left has them all, and is thin."""
    noise = ndimage.gaussian_filter(np.random.default_rng(1).normal(size=(30, 26, 22)), 2)
    sponge: Grid = np.pad(noise > 0, 1)
    left = thinned(sponge, np.asarray(ndimage.distance_transform_edt(sponge)), np.zeros(sponge.shape, bool))
    assert betti_numbers(sponge)[1] > 5
    assert betti_numbers(left) == betti_numbers(sponge)
    assert not (left & ~sponge).any()
    around = np.pad(left, 1)
    for i, j, k in np.argwhere(left).tolist():
        assert not is_simple(around[i : i + 3, j : j + 3, k : k + 3])


def test_the_order_says_what_is_left() -> None:
    """A plate thinned towards a crooked line keeps that line, but for corners that are no part of its topology."""
    plate: Grid = np.ones((3, 20, 20), bool)
    line, columns = np.zeros(plate.shape), np.arange(20)
    line[1, np.round(10 + 5 * np.sin(columns / 4)).astype(int), columns] = 1.0
    ends: Grid = (line > 0) & np.isin(columns, [0, 19])
    near = np.asarray(ndimage.distance_transform_edt(line == 0))
    left = thinned(plate, -near, ends)
    assert betti_numbers(left) == (1, 0, 0)
    assert near[left].max() <= 1
    assert (left & (line > 0)).sum() >= 15


def test_nothing_comes_of_nothing() -> None:
    none: Grid = np.zeros((4, 4, 4), bool)
    assert not thinned(none, np.zeros(none.shape), none).any()
