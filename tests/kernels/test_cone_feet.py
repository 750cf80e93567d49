"""Feet on round cones against every point beside every edge."""

import numpy as np

from reference.cones import cone_residuals
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.fit import foot_points

GENERATOR = np.random.default_rng(12)
NODES = np.concatenate([GENERATOR.normal(size=(9, 3)), np.ones((2, 3))])  # the last edge has no length
EDGES = np.array([[0, 1], [1, 2], [2, 3], [3, 4], [1, 5], [5, 6], [6, 7], [7, 8], [9, 10]], np.int32)
POINTS = GENERATOR.normal(size=(300, 3)) * 2
NONE = np.zeros(0, np.int32)
CURVE = ConeCurve(
    NODES, EDGES, GENERATOR.uniform(0.1, 0.5, 11), levels=NONE, node_of_section=NONE, section_sizes=np.zeros(0)
)
ROWS = GENERATOR.permutation(300)[:200].astype(np.int32)
SHARE, RESIDUAL = cone_residuals(POINTS[ROWS], NODES, CURVE.radii, EDGES)
ROUNDING = 1e-14  # lengths of up to ten, some sums in another order
FLAT = 1e-6  # the distance is flat where it is least: its rounding hides the root of it in the share


def test_each_point_stands_on_the_nearest_surface_of_its_own_list() -> None:
    candidates = np.array([[0, 1, 4, 8], [2, 5, -1, -1], [-1, 7, 3, -1]], np.int32)
    lists = np.arange(200, dtype=np.int32) % 3
    at = foot_points(CURVE, POINTS, ROWS, lists, candidates)
    for i, row in enumerate(candidates[lists]):
        mine = row[row >= 0]
        assert at.edge[i] == mine[np.abs(RESIDUAL[i, mine]).argmin()]
    every = np.arange(200), at.edge
    np.testing.assert_allclose(at.share, SHARE[every], atol=FLAT)
    np.testing.assert_allclose(at.residual, RESIDUAL[every], atol=ROUNDING)


def test_a_point_inside_any_cone_is_inside_the_union() -> None:
    some = np.array([1, 3, 6], np.int32)
    found = foot_points(CURVE, POINTS, ROWS, np.zeros(200, np.int32), some[None], signed=True).residual
    np.testing.assert_allclose(found, RESIDUAL[:, some].min(axis=1), atol=ROUNDING)
    assert (found < 0).any()
    assert (found > 0).any()


def test_an_empty_list_leaves_a_point_without_an_edge() -> None:
    nothing = np.full((1, 2), -1, np.int32)
    assert (foot_points(CURVE, POINTS, ROWS, np.zeros(200, np.int32), nothing).edge == -1).all()
