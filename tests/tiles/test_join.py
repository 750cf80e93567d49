"""Curves of tiles become the curve of the whole: components, loops and ends, wherever the planes are."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference.scenes import forest, long_tube, network
from tiskel import CurveGraph, ShapeParams, SplitParams, contract, extract_skeleton, make_shape
from tiskel.arrays import Points
from tiskel.gallery.body import Shape
from tiskel.gallery.random_graphs import random_graph
from tiskel.tiles.cells import Counting
from tiskel.tiles.join import doubts_of, joined, trimmed
from tiskel.tiles.margin import overlap_of
from tiskel.tiles.tiling import Plane, Tiling, tiles_of
from tiskel.tiles.web import Web, divided, undivided, web_of


def counts(curve: CurveGraph) -> tuple[int, int, int]:
    return curve.components, curve.loops, curve.ends


def fine(curve: CurveGraph, step: float) -> CurveGraph:
    """Return a curve with nodes that are a step apart."""
    web = divided(web_of(curve, 0), step, np.ones(len(curve.edges), bool))
    return web.graph()


def seen_by_tiles(curve: CurveGraph, tiling: Tiling, jitter: float, seed: int) -> dict[int, Web]:
    """Return the curve as every tile has it, its nodes moved at random by shares of their radii, edges divided."""
    generator = np.random.default_rng(seed)
    webs = {}
    for tile, core in enumerate(tiling.cores()):
        moved = curve.nodes + generator.normal(size=curve.nodes.shape) * (jitter * curve.radii)[:, None]
        webs[tile] = trimmed(fine(replace(curve, nodes=moved), 1.0), tile, core, tiling.overlap)
    return webs


@settings(max_examples=30)
@given(st.integers(0, 60), st.sampled_from([0.0, 0.1, 0.25]))
def test_a_curve_that_every_tile_sees_a_little_differently_is_whole_again(seed: int, jitter: float) -> None:
    """Joints lie on one side of a plane in one tile and on the other in the next, limbs run along planes."""
    curve = random_graph(seed % 12).shape
    low, high = curve.nodes.min(axis=0), curve.nodes.max(axis=0)
    places = np.floor(np.random.default_rng(seed).uniform(low + 0.3 * (high - low), high - 0.3 * (high - low)))
    x, y, z = (int(place) for place in places)
    tiling = Tiling(1.0, 14.0, Plane(0, x, Plane(1, y, 0, 1), Plane(1, y, Plane(2, z, 2, 3), 4)))
    web = joined(seen_by_tiles(curve, tiling, jitter, seed), tiling)
    assert counts(web.graph()) == counts(curve)
    assert not web.torn.any()
    assert web.graph().length == pytest.approx(curve.length, rel=0.05 + jitter / 2)


def test_without_jitter_the_curve_is_what_it_was() -> None:
    curve = random_graph(2, loops=2).shape
    tiling = Tiling(1.0, 14.0, Plane(0, 3, 0, 1))
    made = joined(seen_by_tiles(curve, tiling, 0.0, 0), tiling).graph()
    assert made.length == pytest.approx(curve.length, rel=1e-9)
    assert len(made.nodes) <= len(fine(curve, 1.0).nodes) + 2 * 12


def test_a_limb_that_one_tile_does_not_know_is_told() -> None:
    x = np.arange(41.0) - 20
    line = np.stack([x, 0 * x, 0 * x], axis=1)
    edges = np.stack([np.arange(40), np.arange(1, 41)], axis=1).astype(np.int32)
    curve = CurveGraph(line, edges, np.ones(41))
    tiling = Tiling(1.0, 8.0, Plane(0, 0, 0, 1))
    other = replace(curve, nodes=line + [0, 30, 0])
    webs = {0: trimmed(curve, 0, tiling.cores()[0], 8.0), 1: trimmed(other, 1, tiling.cores()[1], 8.0)}
    web = joined(webs, tiling)
    assert [doubt.code for doubt in doubts_of(web, tiling)] == ["torn"]
    assert web.torn.sum() == 2
    whole = joined({**webs, 1: trimmed(curve, 1, tiling.cores()[1], 8.0)}, tiling)
    assert doubts_of(whole, tiling) == []
    thick = replace(whole, radii=0 * whole.radii + 5)
    assert [doubt.code for doubt in doubts_of(thick, tiling)] == ["overlap"]


def test_a_twig_that_ends_behind_the_plane_comes_from_the_tile_that_knows_it() -> None:
    x = np.arange(24.0) - 20
    line = np.stack([x, 0 * x, 0 * x], axis=1)
    curve = CurveGraph(line, np.stack([np.arange(23), np.arange(1, 24)], axis=1).astype(np.int32), np.ones(24))
    tiling = Tiling(1.0, 12.0, Plane(0, 0, 0, 1))
    far = replace(curve, nodes=line + [30, 0, 0])
    webs = {n: trimmed(c, n, tiling.cores()[n], 12.0) for n, c in ((0, curve), (1, far))}
    web = joined(webs, tiling)
    assert counts(web.graph()) == (2, 0, 4)
    assert web.nodes[web.tile == 0, 0].max() == 3.0


def test_dividing_and_undoing_it_gives_the_curve_back() -> None:
    curve = random_graph(1, loops=1).shape
    web = web_of(curve, 3)
    again = undivided(divided(web, 0.3, np.ones(len(curve.edges), bool)))
    assert divided(web, 0.3, np.ones(len(curve.edges), bool)).lengths.max() <= 0.3 * (1 + 1e-9)
    np.testing.assert_array_equal(again.graph().edges, web.graph().edges)
    np.testing.assert_array_equal(again.nodes, curve.nodes)


def whole_and_joined(points: Points, tiles: int) -> tuple[CurveGraph, Web, Tiling]:
    counting = Counting()
    counting.add(points)
    grid = counting.grid()
    tiling = tiles_of(grid, SplitParams(points=len(points) // tiles), overlap_of(grid, grid.spacing()))
    cores = tiling.cores()
    webs = {
        tile: trimmed(extract_skeleton(contract(points[rows])), tile, cores[tile], tiling.overlap)
        for tile, rows, _ in tiling.deal(points)
    }
    return extract_skeleton(contract(points)), joined(webs, tiling), tiling


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shape", "count", "tiles"),
    [(long_tube(), 12_000, 8), (network((3, 3, 3), 0.12), 30_000, 6), (forest(2, 6), 20_000, 6)],
    ids=["tube", "network", "forest"],
)
def test_skeletons_of_tiles_make_the_skeleton_of_the_whole(shape: Shape, count: int, tiles: int) -> None:
    points, true = make_shape(shape, ShapeParams(count=count))
    whole, web, tiling = whole_and_joined(points, tiles)
    assert len(tiling.cores()) > 1
    assert counts(web.graph()) == counts(whole) == counts(true)
    assert web.graph().length == pytest.approx(whole.length, rel=0.03)
    assert doubts_of(web, tiling) == []
