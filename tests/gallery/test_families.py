"""Families: points lie on the exact surfaces, evenly; the true curves are inside and have the right topology."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tiskel import ShapeParams, TiskelError, make_shape, named_shape, shape_graph
from tiskel.gallery.body import Body, Part, joined, least_thickness, surface_distance
from tiskel.gallery.catalogue import SHAPES
from tiskel.gallery.families import BODIES, GROUPS
from tiskel.gallery.machined import block
from tiskel.gallery.patches import cell_areas, sample_patch
from tiskel.gallery.solids import around_holes, superellipsoid
from tiskel.gallery.sweep import Sweep, spline, steady
from tiskel.gallery.tubes import swept

# components, loops, ends of every true skeleton
TOPOLOGY = {
    "flat-tube": (1, 0, 2), "strap": (1, 0, 2), "square-bar": (1, 0, 2), "twisted-bar": (1, 0, 2), "horn": (1, 0, 2),
    "band": (1, 1, 0), "half-torus": (1, 0, 2), "bundle": (7, 0, 14), "twins": (2, 0, 4), "leaf": (1, 0, 2),
    "seedling": (1, 0, 5), "maize": (1, 0, 7), "block-1": (1, 1, 0), "block-2": (1, 2, 0), "block-3": (1, 3, 0),
    "washer-plate": (1, 1, 0), "strip": (1, 4, 0), "l-bracket": (1, 0, 2), "u-bracket": (1, 0, 2),
    "torso": (1, 0, 5), "knobs": (1, 0, 5), "coil": (1, 0, 2), "crossing": (2, 0, 4), "lattice": (1, 4, 12),
    "stent": (1, 13, 0),
}  # fmt: skip
FULL_TURNS = np.linspace(0, 2 * np.pi, 400)


@pytest.fixture(scope="module", params=sorted(BODIES))
def named(request: pytest.FixtureRequest) -> tuple[str, Body]:
    return request.param, BODIES[request.param]()


def test_points_lie_on_the_surface_and_the_skeleton_has_the_right_topology(named: tuple[str, Body]) -> None:
    name, body = named
    points, truth = make_shape(body, ShapeParams(count=600))
    assert len(points) == 600
    levels = np.abs([part.level(points) for part in body.parts]).min(axis=0)
    assert levels.max() <= 1e-9
    assert not body.inside(points).any()
    assert (truth.components, truth.loops, truth.ends) == TOPOLOGY[name]
    assert (body.radii > 0).all()


def test_what_a_patch_covers_is_the_surface_of_its_part(named: tuple[str, Body]) -> None:
    """Or parts that are cut away because their level is wrong would go unseen: only faces of plates are cut."""
    for part in named[1].parts:
        kept = []
        for patch, areas in zip(part.patches, part.areas, strict=True):
            points = sample_patch(patch, areas, 60, np.random.default_rng(1))
            kept.append(float((np.abs(part.level(points)) <= 1e-9).mean()))
        assert min(kept) > 0.3
        assert len(part.patches) > 4 or min(kept) == 1


def test_the_true_curve_is_inside_a_solid(named: tuple[str, Body]) -> None:
    body = named[1]
    if body.solid:
        middles = body.nodes[body.edges].mean(axis=1)
        outside = ~body.inside(np.concatenate([body.nodes, middles]))
        assert not outside.any()


def test_a_midrib_is_on_its_leaf() -> None:
    body = BODIES["leaf"]()
    assert np.abs(body.parts[0].level(body.nodes)).max() < 1e-9
    assert not body.inside(body.nodes).any()
    assert np.abs(body.distance(body.nodes)).max() < 0.01  # between the points of the dense sample


def test_points_of_a_sweep_are_shared_out_by_area() -> None:
    """A straight elliptic cylinder: quarters of its length have equal areas, and so has each lid its share."""
    sweep = Sweep(spline([(0, 0, z) for z in np.linspace(0, 2, 9)]), steady(0.3, 0.1), up=(1.0, 0, 0))
    points = make_shape(swept([sweep]), ShapeParams(count=20_000))[0]
    assert np.histogram(points[:, 2], 4, (1e-9, 2 - 1e-9))[0].std() < 40  # of 4600 each: one part in a hundred
    outline = np.stack([0.3 * np.cos(FULL_TURNS), 0.1 * np.sin(FULL_TURNS)], axis=1)
    side = 2 * np.linalg.norm(np.diff(outline, axis=0), axis=1).sum()
    lids = 2 * np.pi * 0.3 * 0.1
    ends = (points[:, 2] < 1e-9) | (points[:, 2] > 2 - 1e-9)
    assert ends.mean() == pytest.approx(lids / (side + lids), rel=0.03)


def test_points_about_a_round_section_are_even() -> None:
    points = BODIES["half-torus"]().sample(4000, np.random.default_rng(0))
    nearest = cKDTree(points).query(points, k=2)[0][:, 1]
    area = 2 * np.pi * 0.2 * np.pi * 0.8 + 2 * np.pi * 0.2**2
    assert nearest.mean() > 1.2 * 0.5 / np.sqrt(4000 / area)  # of a Poisson process: half over root of density


def test_distance_to_a_swept_circle_is_that_to_its_curve() -> None:
    """Away from the ends of half a torus the distance is known."""
    queries = np.random.default_rng(3).uniform(-1, 1, (400, 3)) * [1.2, 1.2, 0.4]
    queries = queries[queries[:, 0] > 0.3]
    exact = np.hypot(np.hypot(queries[:, 0], queries[:, 1]) - 0.8, queries[:, 2]) - 0.2
    # 200 000 points on 3.4 units of area lie 0.004 apart; one between four of them is 0.003 from each.
    body = BODIES["half-torus"]()
    np.testing.assert_allclose(surface_distance(queries, body), exact, atol=0.004)
    np.testing.assert_allclose(body.clearance(queries), np.maximum(-exact, 0), atol=0.004)


def test_a_superellipsoid_of_power_two_is_a_ball() -> None:
    ball = superellipsoid((1, 0, 0), (0.5, 0.5, 0.5))
    points = np.random.default_rng(0).uniform(-2, 2, (200, 3))
    np.testing.assert_allclose(ball.level(points), np.linalg.norm(points - [1, 0, 0], axis=1) - 0.5, atol=1e-12)
    assert sum(areas.sum() for areas in ball.areas) == pytest.approx(np.pi, rel=1e-3)


@pytest.mark.parametrize("holes", [1, 2, 3, 4])
def test_the_curve_about_holes_is_as_far_from_them_as_from_the_sides(holes: int) -> None:
    length, width, radius = 1.1 * holes, 1.0, 0.28
    middles = (np.arange(holes) - (holes - 1) / 2) * length / holes
    for places, room in around_holes(length, width, holes, radius, 17):
        to_holes = np.sort(np.hypot(places[:, :1] - middles, places[:, 1:2]) - radius, axis=1)
        to_sides = np.minimum(length / 2 - np.abs(places[:, 0]), width / 2 - np.abs(places[:, 1]))
        np.testing.assert_allclose(to_holes[:, 0], room, atol=1e-12)
        second = np.minimum(to_sides, to_holes[:, 1]) if holes > 1 else to_sides
        np.testing.assert_allclose(second, room, atol=1e-12)
    assert block(holes).loops == holes


def test_parts_that_overlap_lose_what_is_inside_each_other() -> None:
    balls = [superellipsoid((x, 0, 0), (0.5, 0.5, 0.5)) for x in (-0.3, 0.3)]
    body = joined([np.array([[-0.3, 0, 0], [0.3, 0, 0]])], [np.full(2, 0.5)], balls, 0.5)
    points = body.sample(4000, np.random.default_rng(0))
    assert np.abs(points[:, 0]).max() == pytest.approx(0.8, abs=0.01)
    off = np.linalg.norm(points - np.array([0.3, 0, 0]) * np.sign(points[:, :1]), axis=1)
    np.testing.assert_allclose(off, 0.5, atol=1e-9)
    assert np.abs(points[:, 0] < 0).mean() == pytest.approx(0.5, abs=0.03)


def test_a_sheet_swallows_nothing() -> None:
    wall = Part((lambda u, v: np.stack([u, v, 0 * u], axis=1),), lambda p: p[:, 2], solid=False)
    assert not wall.swallows(np.array([[0.5, 0.5, -1.0]])).any()
    assert cell_areas(wall.patches[0]).sum() == pytest.approx(1)


def test_noise_is_a_share_of_half_the_least_thickness() -> None:
    strap = BODIES["strap"]()
    assert least_thickness(strap) == pytest.approx(0.03)
    clean, noisy = (make_shape(strap, ShapeParams(count=4000, noise=noise))[0] for noise in (0.0, 0.5))
    assert (noisy - clean).std() == pytest.approx(0.015, rel=0.03)


def test_degraded_bodies_are_seeded() -> None:
    settings = {"count": 300, "noise": 0.1, "missing": 0.2, "uneven": 5.0}
    one, same, other = (make_shape(BODIES["maize"](), ShapeParams(**settings, seed=s))[0] for s in (1, 1, 2))  # type: ignore[arg-type]
    assert one.tobytes() == same.tobytes() != other.tobytes()


def test_names_are_of_one_shape_each() -> None:
    names = [name for group in GROUPS.values() for name in group]
    assert len(set(names)) == len(names)
    assert {*SHAPES, *BODIES} < set(names)
    grown = named_shape("leader-tree")
    assert (grown.components, grown.loops, grown.ends) == (1, 0, 101)
    assert named_shape("y").ends == shape_graph("y").ends == 3
    with pytest.raises(TiskelError, match=r"choose one of capsule.*stent"):
        named_shape("unicorn")
