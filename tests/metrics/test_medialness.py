"""Inside and medialness against bodies whose clearance is known in closed form."""

from functools import cache

import numpy as np
import pytest

from tiskel import CurveGraph, ShapeParams, TiskelError, make_shape
from tiskel.arrays import Points
from tiskel.geometry.clearance import Body, CloudBody, ConeBody, mesh_surface
from tiskel.geometry.oriented import OrientedCloud, oriented_cloud
from tiskel.geometry.round_cones import ConeGraph
from tiskel.metrics.medialness import DIRECTIONS, MOST_STEPS, _highest, medialness, medialness_at

RADIUS = 0.2
CAPSULE = ConeGraph(np.array([[0.0, 0, 0], [2, 0, 0]]), np.array([[0, 1]], np.int32), np.full(2, RADIUS))
FIRST = np.array([[1.0, 0, 0]])


def box(half: tuple[float, float, float]) -> CloudBody:
    """A block about the origin."""
    corners = np.stack(np.meshgrid([-1.0, 1], [-1.0, 1], [-1.0, 1], indexing="ij"), axis=-1).reshape(-1, 3) * half
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))], np.int32)
    return CloudBody(mesh_surface(corners, faces))


def cloud_body() -> CloudBody:
    cloud, true = make_shape(CAPSULE, ShapeParams(count=3000))
    surface = oriented_cloud(cloud, true.nodes[true.node_of_point] * [0, 1, 1] + cloud * [1, 0, 0])
    assert surface.trusted
    return CloudBody(surface)


BODIES = ("cones", "cloud")


@cache
def body(name: str) -> Body:
    """The capsule, in one way or the other."""
    return ConeBody(CAPSULE) if name == "cones" else cloud_body()


def deep(body: Body, places: Points) -> np.ndarray:
    """The clearance: the distance to the surface inside, 0 outside."""
    return medialness_at(places, np.repeat(FIRST, len(places), axis=0), body).clearance


def line(y: float) -> CurveGraph:
    """Along the capsule, off its axis, away from its ends."""
    return CurveGraph(np.array([[0.3, y, 0], [1.7, y, 0]]), CAPSULE.edges)


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize(("share", "value"), [(0, 1), (0.5, 0.5), (0.75, 0.25)])
def test_medialness_is_the_share_of_the_way_to_the_axis(name: str, share: float, value: float) -> None:
    found = medialness(line(share * RADIUS), body(name))
    assert found.inside == 1
    assert found.mean == pytest.approx(value, abs=0.03)  # a cloud's points are a tenth of the radius apart
    assert found.best == pytest.approx(RADIUS, rel=0.03)


@pytest.mark.parametrize("name", BODIES)
def test_outside_it_is_nothing(name: str) -> None:
    found = medialness(line(1.2 * RADIUS), body(name))
    assert (found.inside, found.mean) == (0, 0)


def test_half_of_it_outside_is_half() -> None:
    found = medialness(CurveGraph(np.array([[1.0, 0, 0], [3.4, 0, 0]]), CAPSULE.edges), ConeBody(CAPSULE))
    assert found.inside == pytest.approx(0.5, abs=0.01)
    assert found.mean == pytest.approx(0.5, abs=0.03)  # across the axis there is nothing better in the cap


def test_the_clearance_of_a_union_is_to_its_surface_and_not_to_that_of_its_parts() -> None:
    """In the middle of a cross of two tubes the surface is the crease, at the root of two radii."""
    nodes = np.array([[-1.0, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0]])
    cross = ConeBody(ConeGraph(nodes, np.array([[0, 1], [2, 3]], np.int32), np.full(4, RADIUS)))
    high, low = deep(cross, np.array([[0.0, 0, 0], [0.5, 0, 0]]))
    assert high == pytest.approx(RADIUS, rel=0.02)  # straight up
    assert low == pytest.approx(RADIUS, rel=0.02)
    near = deep(cross, np.array([[0.19, 0.19, 0.0], [0.21, 0.21, 0.0]]))
    assert near[0] == pytest.approx(0.01 * np.sqrt(2), abs=0.01)
    assert near[1] == 0
    three = ConeGraph(np.concatenate([nodes, [[0, 0, -1], [0, 0, 1]]]), np.array([[0, 1], [2, 3], [4, 5]], np.int32))
    star = ConeBody(ConeGraph(three.nodes, three.edges, np.full(6, RADIUS)))
    corner = deep(star, np.zeros((1, 3)))[0]  # all tubes end their creases at y = z = r / sqrt(2) of the third
    assert corner == pytest.approx(RADIUS * np.sqrt(1.5), rel=0.02)


def test_a_tapered_tube_is_measured_by_its_local_thickness() -> None:
    """From 0.4 to 0.02 along four."""
    cone = ConeGraph(np.array([[0.0, 0, 0], [4, 0, 0]]), CAPSULE.edges, np.array([0.4, 0.02]))
    places = np.array([[x, 0, 0] for x in (1.0, 2.0, 3.0, 3.9)])
    sine = 0.38 / 4  # of half the angle: both balls touch the side, so the balls between have the radii between
    assert deep(ConeBody(cone), places) == pytest.approx(0.4 - sine * places[:, 0], rel=0.03)


def test_in_a_block_the_middle_is_where_two_sides_are_equally_far() -> None:
    """Half as wide as high: along the ridge all is 1, though the middle is elsewhere."""
    block = box((1, 0.5, 0.25))
    places = np.array([[0, 0, 0], [0, 0.25, 0], [0, 0, 0.125], [0, 0.375, 0], [0, 0.6, 0]])
    found = medialness_at(places, np.repeat(FIRST, 5, axis=0), block)
    assert found.clearance == pytest.approx([0.25, 0.25, 0.125, 0.125, 0], rel=0.01)
    assert found.values == pytest.approx([1, 1, 0.5, 0.5, 0], abs=0.01)


def test_a_narrow_wedge_is_climbed_to_its_top() -> None:
    """The ridge rises by a tenth, and runs halfway between two of the directions that are looked in first."""
    half = np.pi / DIRECTIONS
    turn = np.array([[1, 0, 0], [0, np.cos(half), np.sin(half)], [0, -np.sin(half), np.cos(half)]])
    corners = np.array([[x, y, z] for x in (-0.4, 0.4) for y, z in ((0, 0), (2, 0.2), (2, -0.2))])
    sides = [(0, 1, 2), (3, 5, 4), (0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2), (2, 5, 3), (2, 3, 0)]
    wedge = CloudBody(mesh_surface(corners @ turn, np.array(sides, np.int32)))
    best = medialness_at(np.array([[0, 1.0, 0]]) @ turn, FIRST, wedge).best[0]
    slope = 0.2 / np.hypot(2, 0.2)
    assert best == pytest.approx(2 * slope / (1 + slope), rel=0.05)  # (2 - c) slope = c


def test_a_joint_has_no_direction_and_no_value() -> None:
    found = medialness_at(np.array([[1.0, 0.1, 0]] * 2), np.array([[0.0, 0, 0], [1, 0, 0]]), ConeBody(CAPSULE))
    assert np.isnan(found.values).tolist() == [True, False]
    assert (found.inside, found.mean) == (1, found.values[1])


def test_short_edges_have_no_more_say_than_long_ones() -> None:
    """Two thirds of the length is one edge on the axis, a third a hundred edges halfway to the wall."""
    nodes = np.array([[0.3, 0, 0], [1.3, 0, 0]])
    many = np.stack([np.linspace(0.3, 0.8, 101), np.full(101, 0.1), np.zeros(101)], axis=1)
    edges = [[0, 1], *([i, i + 1] for i in range(2, 102))]
    found = medialness(CurveGraph(np.concatenate([nodes, many]), np.array(edges, np.int32)), ConeBody(CAPSULE), 60)
    assert found.mean == pytest.approx((2 + 0.5) / 3, abs=0.02)


def test_a_curve_without_length_has_no_value() -> None:
    found = medialness(CurveGraph(np.zeros((1, 3)), np.zeros((0, 2), np.int32)), ConeBody(CAPSULE))
    assert found.inside is found.mean is None


def test_a_mesh_has_an_inside_whichever_way_it_turns() -> None:
    for corners in ((0, 1, 2), (0, 2, 1)):
        faces = np.array([(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)], np.int32)[:, corners]
        surface = mesh_surface(np.array([[0, 0, 0], [1e3, 0, 0], [0, 1e3, 0], [0, 0, 1e3]]), faces, 20000)
        assert surface.trusted
        assert surface.contains(np.array([[9.0, 9, 9], [200, 200, 200], [400, 400, 400]])).tolist() == [
            True,
            True,
            False,
        ]
        assert CloudBody(surface).clearance(np.array([[200.0, 200, 200]])) == pytest.approx([200], rel=0.02)


def test_a_mesh_without_area_is_refused() -> None:
    with pytest.raises(TiskelError, match="the mesh of 1 triangles has no area"):
        mesh_surface(np.zeros((3, 3)), np.array([[0, 1, 2]], np.int32))


def test_a_climb_does_not_go_through_a_thin_wall() -> None:
    """Two rooms, the far one higher: a place hard at the wall between stays in its own."""
    near, far = box((1, 0.2, 0.2)), box((1, 0.5, 0.5))
    points = np.concatenate([near.surface.points, far.surface.points + [0, 0.72, 0]])
    normals = np.concatenate([near.surface.normals, far.surface.normals])
    areas = np.concatenate([near.surface.areas, far.surface.areas])
    rooms = CloudBody(OrientedCloud(points, normals, areas))
    assert medialness_at(np.array([[0, 0.18, 0.0]]), FIRST, rooms).best[0] == pytest.approx(0.2, rel=0.02)


@pytest.mark.parametrize("name", BODIES)
def test_a_place_at_the_wall_climbs_inwards_though_outwards_is_as_far(name: str) -> None:
    found = medialness_at(np.array([[1.0, 0.98 * RADIUS, 0]]), FIRST, body(name))
    assert found.best[0] == pytest.approx(RADIUS, rel=0.03)


def test_quick_bodies_are_climbed_as_others_are() -> None:
    class Slow:
        def clearance(self, places: Points) -> np.ndarray:
            return body("cones").clearance(places)

    places = np.random.default_rng(0).uniform(-0.19, 0.19, (50, 3)) + [1, 0, 0]
    axes = np.repeat(FIRST, 50, axis=0)
    quick, slow = (medialness_at(places, axes, one) for one in (body("cones"), Slow()))
    np.testing.assert_array_equal(quick.values, slow.values)


class HalfSpace:
    """All that is beyond x = 0: a body without an end, that a climb never comes to the middle of."""

    def clearance(self, places: Points) -> np.ndarray:
        return np.maximum(places[:, 0], 0.0)


def test_a_climb_in_a_body_without_end_ends_all_the_same() -> None:
    """Each step is half of the clearance at most, and nearly in the best of twelve directions."""
    m = medialness_at(np.array([[1.0, 0, 0], [-1, 0, 0]]), np.array([[0, 0, 1.0]] * 2), HalfSpace())
    assert (0.5 * 1.4**MOST_STEPS) < m.best[0] < 1.5**MOST_STEPS
    assert m.clearance.tolist() == [1, 0]
    assert m.values[0] == pytest.approx(0, abs=1e-9)


class Beside(HalfSpace):
    """A body with nothing but its distances: no place looked at is inside."""

    asked = 0

    def distances(self, places: Points) -> np.ndarray:
        return np.asarray(np.linalg.norm(places, axis=1) + 1)

    def contains(self, places: Points) -> np.ndarray:
        self.asked += len(places)
        return np.zeros(len(places), bool)


def test_where_every_place_looked_at_is_outside_none_is_higher() -> None:
    """Each of the directions is asked for once, the farthest first."""
    beside = Beside()
    tried = np.random.default_rng(0).normal(size=(3, DIRECTIONS, 3))
    _, reached = _highest(tried, np.zeros(3), beside)
    assert reached.tolist() == [0, 0, 0]
    assert beside.asked == 3 * DIRECTIONS
