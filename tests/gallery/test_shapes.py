"""Shapes: their points lie on their surface, evenly; their skeletons have the right topology."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tiskel import ShapeParams, TiskelError, make_shape, shape_graph
from tiskel.gallery.catalogue import SHAPES
from tiskel.geometry.round_cones import ConeGraph, sample_union, signed_distance, union_distance

# components, loops, ends of every analytic skeleton
TOPOLOGY = {
    "capsule": (1, 0, 2), "banana": (1, 0, 2), "carrot": (1, 0, 2), "egg": (1, 0, 2), "dumbbell": (1, 0, 2),
    "hammer": (1, 0, 3), "y": (1, 0, 3), "cross": (1, 0, 4), "hand": (1, 0, 6), "quadruped": (1, 0, 5),
    "table": (1, 0, 4), "torus": (1, 1, 0), "two-holed-torus": (1, 2, 0), "mug": (1, 1, 2), "helix": (1, 0, 2),
    "tunnel": (1, 0, 2), "duck": (1, 0, 2), "dog": (1, 0, 8), "starfish": (1, 0, 6), "tree": (1, 0, 32),
    "ladder": (1, 4, 4), "chair": (1, 2, 4), "knot": (1, 1, 0), "links": (2, 2, 0), "fork": (1, 0, 5),
}  # fmt: skip


def cone(a: list[float], b: list[float], ra: float, rb: float) -> ConeGraph:
    return ConeGraph(np.array([a, b], float), np.array([[0, 1]], np.int32), np.array([ra, rb]))


@pytest.mark.parametrize("name", sorted(SHAPES))
def test_points_lie_on_the_surface_and_the_skeleton_has_the_right_topology(name: str) -> None:
    shape = shape_graph(name)
    points, truth = make_shape(shape, ShapeParams(count=1000))
    assert len(points) == 1000
    # Strands of many parts meet at nodes of unequal radius; there a point of one part may lie a hair inside another.
    np.testing.assert_allclose(union_distance(points, shape), 0, atol=1e-8)
    assert (truth.components, truth.loops, truth.ends) == TOPOLOGY[name]


def test_distance_to_a_round_cone_is_that_to_a_dense_sample_of_its_surface() -> None:
    for shape in (
        cone([0, 0, 0], [0, 0, 1], 0.3, 0.3),
        cone([0, 0, 0], [1, 0, 1], 0.5, 0.1),
        cone([0, 0, 0], [0.1, 0, 0], 0.5, 0.2),
    ):
        queries = np.random.default_rng(1).uniform(-1.5, 1.5, size=(300, 3))
        sample = sample_union(shape, 60_000, np.random.default_rng(2))
        nearest = cKDTree(sample).query(queries)[0]
        # 60 000 points on about four units of area: 0.01 apart; a miss of h sideways costs at most h.
        np.testing.assert_allclose(np.abs(signed_distance(queries, shape, 0)), nearest, atol=0.02)


def test_points_are_shared_out_by_area() -> None:
    """A capsule: side 2 pi r L, caps 4 pi r^2 (r = 0.2, L = 1.4, so 7 : 2)."""
    points = make_shape(shape_graph("capsule"), ShapeParams(count=20_000))[0]
    share = (np.abs(points[:, 2]) < 0.7).mean()
    assert share == pytest.approx(7 / 9, abs=0.01)


def test_points_are_more_even_than_chance() -> None:
    points = make_shape(shape_graph("capsule"), ShapeParams(count=4000))[0]
    nearest = cKDTree(points).query(points, k=2)[0][:, 1]
    area = 2 * np.pi * 0.2 * 1.4 + 4 * np.pi * 0.2**2
    by_chance = 0.5 / np.sqrt(4000 / area)  # mean nearest-neighbour distance of a Poisson process
    assert nearest.mean() > 1.2 * by_chance


def test_the_tunnel_is_open_and_the_union_hollow() -> None:
    shape = shape_graph("tunnel")
    points = make_shape(shape, ShapeParams(count=3000))[0]
    for end in shape.open_ends:
        neighbour = shape.edges[(shape.edges == end).any(axis=1)][0]
        outward = shape.nodes[end] - shape.nodes[neighbour[neighbour != end][0]]
        beyond = (points - shape.nodes[end]) @ (outward / np.linalg.norm(outward))
        close = np.linalg.norm(points - shape.nodes[end], axis=1) < 0.3
        assert beyond[close].max() < 0.02


def test_the_same_seed_gives_the_same_bytes_and_another_does_not() -> None:
    settings = {"count": 500, "noise": 0.1, "missing": 0.2, "uneven": 5.0}
    one, same, other = (make_shape(shape_graph("y"), ShapeParams(**settings, seed=s))[0] for s in (1, 1, 2))  # type: ignore[arg-type]
    assert one.tobytes() == same.tobytes() != other.tobytes()


def test_noise_is_a_share_of_the_smallest_radius() -> None:
    shape = shape_graph("capsule")
    points = make_shape(shape, ShapeParams(count=20_000, noise=0.1))[0]
    # Only the normal part of isotropic noise leaves the surface: sigma = 0.1 * 0.2.
    assert union_distance(points, shape).std() == pytest.approx(0.02, rel=0.05)


def test_missing_patches_leave_holes_of_the_asked_size() -> None:
    shape = shape_graph("capsule")
    whole, cut = (make_shape(shape, ShapeParams(count=n, missing=m))[0] for n, m in ((10_000, 0.0), (8000, 0.2)))
    bare = (cKDTree(cut).query(whole)[0] > 0.03).mean()  # three spacings from any point that is left
    assert 0.08 < bare < 0.2


def test_uneven_density_falls_along_the_axis() -> None:
    points = make_shape(shape_graph("capsule"), ShapeParams(count=40_000, uneven=10.0))[0]
    top, bottom = (points[:, 2] > 0.6) & (points[:, 2] < 0.7), (points[:, 2] < -0.6) & (points[:, 2] > -0.7)
    ratio = max(top.sum(), bottom.sum()) / min(top.sum(), bottom.sum())
    # The bands lie at 1/28 and 27/28 of the axis: 10 to the power of 26/28.
    assert ratio == pytest.approx(10 ** (26 / 28), rel=0.15)


@pytest.mark.parametrize(
    "settings", [{"count": 0}, {"noise": -1.0}, {"missing": 1.0}, {"uneven": 0.5}, {"noise": np.nan}]
)
def test_wrong_settings_are_refused(settings: dict[str, float]) -> None:
    with pytest.raises(TiskelError):
        ShapeParams(**settings)  # type: ignore[arg-type]


def test_an_unknown_shape_names_the_known_ones() -> None:
    with pytest.raises(TiskelError, match="choose one of capsule"):
        shape_graph("unicorn")
