"""Generated trees: as many tips as asked for, radii by the pipe model, and thickness in points per radius of length."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tiskel import ShapeParams, TiskelError, make_shape
from tiskel.gallery.trees import HABITS, PIPE, thickened, tree
from tiskel.geometry.round_cones import ConeGraph, union_distance


@pytest.fixture(scope="module", params=sorted(HABITS))
def grown(request: pytest.FixtureRequest) -> ConeGraph:
    return tree(request.param, tips=40, seed=2)


def test_a_tree_has_its_tips_and_no_loop(grown: ConeGraph) -> None:
    assert (grown.components, grown.loops) == (1, 0)
    tips = np.flatnonzero(grown.degrees == 1)
    assert len(tips) - (grown.degrees[0] == 1) == 40  # and the root, where it has one stem
    assert np.isfinite(grown.nodes).all()
    assert (grown.lengths > 0).all()


def test_radii_follow_the_pipe_model(grown: ConeGraph) -> None:
    """At every joint the power of the radius is the sum of those of the limbs that it carries."""
    parents, children = grown.edges.T  # a child has the larger number
    carried = np.bincount(parents, grown.radii[children] ** PIPE, minlength=len(grown.nodes))
    inner = np.bincount(parents, minlength=len(grown.nodes)) > 0
    np.testing.assert_allclose(carried[inner], grown.radii[inner] ** PIPE, rtol=1e-9)
    tips = grown.radii[~inner]
    assert np.ptp(tips) == 0
    np.testing.assert_allclose(grown.radii.max(), tips[0] * 40 ** (1 / PIPE))


def test_the_same_seed_gives_the_same_tree_and_another_another() -> None:
    for habit in HABITS:
        one, other = tree(habit, seed=4), tree(habit, seed=4)
        np.testing.assert_array_equal(one.nodes, other.nodes)
        assert not np.array_equal(one.nodes[:7], tree(habit, seed=5).nodes[:7])


@pytest.mark.parametrize("thickness", [0.3, 2.0])
def test_thickness_is_points_per_radius_of_length(thickness: float) -> None:
    """Counted on the cloud: the points nearest to an end branch, times its radius, over its length."""
    shape = thickened(tree("spreading", tips=30, seed=1), 6000, thickness)
    cloud = make_shape(shape, ShapeParams(count=6000))[0]
    assert np.abs(union_distance(cloud, shape)).max() < 1e-6
    samples, owner = [], []
    for number, branch in enumerate(shape.branches):
        ways = shape.nodes[branch]
        between = ways[:-1, None] + np.linspace(0, 1, 20, endpoint=False)[:, None] * np.diff(ways, axis=0)[:, None]
        samples.append(between.reshape(-1, 3))
        owner.append(np.full(len(samples[-1]), number))
    nearest = np.concatenate(owner)[cKDTree(np.concatenate(samples)).query(cloud)[1]]
    counted = []
    for number, branch in enumerate(shape.branches):
        if 1 in shape.degrees[branch[[0, -1]]] and 0 not in branch:
            length = np.linalg.norm(np.diff(shape.nodes[branch], axis=0), axis=1).sum()
            counted.append((nearest == number).sum() * shape.radii[branch].mean() / length)
    # Thick twigs lie within one another where they fork, so that fewer points are left for the rest to lie on.
    assert np.median(counted) == pytest.approx(thickness, rel=0.25)


def test_wrong_wishes_are_refused() -> None:
    with pytest.raises(TiskelError, match="no tree grows like 'palm'"):
        tree("palm")
    with pytest.raises(TiskelError, match="two tips or more, got 1"):
        tree(tips=1)
