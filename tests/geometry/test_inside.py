"""Oriented surfaces, the solid inside them, and loops."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tiskel import MetricParams, ShapeParams, evaluate, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.geometry.curve import curve_samples
from tiskel.geometry.oriented import OrientedCloud, oriented_cloud, ring_areas
from tiskel.geometry.propagation import propagated_signs
from tiskel.geometry.solid import betti_numbers, solid_handles
from tiskel.metrics.barcode import barcode
from tiskel.metrics.loops import count_loops
from tiskel.metrics.subject import make_subject


def shape(name: str, count: int = 3000, **degraded: float) -> tuple[Points, Points]:
    """Return a cloud, and the nearest place on its true skeleton for each point."""
    made, skeleton = make_shape(shape_graph(name), ShapeParams(count=count, **degraded))  # type: ignore[arg-type]
    places = curve_samples(skeleton, 400).points
    return made, places[cKDTree(places).query(made)[1]]


def test_areas_add_up_to_the_surface() -> None:
    """A capsule of radius 0.2 and length 1.4 has 2 pi r l + 4 pi r^2."""
    surface = oriented_cloud(*shape("capsule"))
    exact = 2 * np.pi * 0.2 * 1.4 + 4 * np.pi * 0.2**2
    assert surface.areas.sum() == pytest.approx(exact, rel=0.02)  # flat triangles of 0.05 on a radius of 0.2


def test_normals_of_a_sphere_point_outward_from_any_target() -> None:
    generator = np.random.default_rng(6)
    directions = generator.normal(size=(800, 3))
    points = directions / np.linalg.norm(directions, axis=1)[:, None]
    for target in ([0.0, 0, 0], [0.0, 0, 3]):
        surface = oriented_cloud(points, np.broadcast_to(target, points.shape))
        assert (np.einsum("ij,ij->i", surface.normals, points) > 0.9).mean() > 0.99
        assert surface.trusted
    assert surface.oriented_by == "propagation"  # away from a place outside, half of them point inward


def test_signs_pass_along_a_chain() -> None:
    generator = np.random.default_rng(6)
    turn = np.linspace(0, 3, 40)
    normals = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    flipped = normals * np.where(generator.random(40) < 0.5, -1.0, 1.0)[:, None]
    neighbours = np.stack([np.arange(40), np.clip(np.arange(40) + 1, 0, 39)], axis=1).astype(np.int32)
    sign, part = propagated_signs(neighbours, flipped)
    agreed = flipped * sign[:, None]
    assert (np.einsum("ij,ij->i", agreed[1:], agreed[:-1]) > 0).all()
    assert set(part.tolist()) == {0}


def test_two_parts_get_their_signs_apart() -> None:
    one = shape("capsule", 600)
    cloud, targets = np.concatenate([one[0], one[0] + 9]), np.concatenate([one[1], one[1] + 9])
    assert oriented_cloud(cloud, targets).consistency > 0.95


def test_an_open_patch_has_no_inside() -> None:
    """A bent sheet: whatever its normals, there is nothing behind it."""
    generator = np.random.default_rng(6)
    flat = generator.random((1500, 2))
    sheet = np.stack([flat[:, 0], flat[:, 1], 0.2 * np.sin(3 * flat[:, 0])], axis=1)
    surface = oriented_cloud(sheet, np.broadcast_to(sheet.mean(axis=0), sheet.shape))
    assert not surface.trusted
    loops, reason = solid_handles(surface)
    assert loops is None
    assert "agree on an inside" in reason
    document = evaluate(sheet, sheet[:50]).as_dict()
    assert document["inside"]["points"] is None
    assert "normals agree" in document["inside"]["reasons"]["points"]


def grid(*cubes: tuple[int, int, int]) -> np.ndarray:
    made = np.zeros((5, 5, 5), bool)
    for cube in cubes:
        made[cube] = True
    return made


RING = [(x, y, 1) for x in (1, 2, 3) for y in (1, 2, 3) if (x, y) != (2, 2)]
SHELL = [(x, y, z) for x in (1, 2, 3) for y in (1, 2, 3) for z in (1, 2, 3) if (x, y, z) != (2, 2, 2)]


@pytest.mark.parametrize(
    ("cubes", "numbers"),
    [
        ([], (0, 0, 0)),
        ([(0, 0, 0)], (1, 0, 0)),
        ([(0, 0, 0), (4, 4, 4)], (2, 0, 0)),
        ([(1, 1, 1), (2, 2, 2)], (1, 0, 0)),  # closed cubes touch at a corner
        (RING, (1, 1, 0)),
        (SHELL, (1, 0, 1)),
        ([*RING, *((x, y, 3) for x, y, _ in RING)], (2, 2, 0)),
    ],
)
def test_betti_numbers_of_cubes(cubes: list[tuple[int, int, int]], numbers: tuple[int, int, int]) -> None:
    assert betti_numbers(grid(*cubes)) == numbers


@pytest.mark.parametrize(
    ("name", "surface", "solid", "curve"),
    [
        ("torus", 2, 1, 1),
        ("two-holed-torus", 4, 2, 2),
        ("mug", 2, 1, 1),
        ("tunnel", 1, 0, 0),
        ("capsule", 0, 0, 0),
        ("hand", 0, 0, 0),
        ("table", 0, 0, 0),
        ("helix", 0, 0, 0),
    ],
)
def test_loops_of_surface_solid_and_curve(name: str, surface: int, solid: int, curve: int) -> None:
    """A closed surface of genus g has 2 g, its solid g; an open tube has one, its solid none."""
    cloud, true = make_shape(shape_graph(name), ShapeParams(count=4096))
    loops = evaluate(cloud, nodes=true.nodes, edges=true.edges).loops
    assert (loops.surface, loops.solid, loops.graph) == (surface, solid, curve)
    assert loops.reasons == {}


@pytest.mark.parametrize("name", ["torus", "mug", "two-holed-torus", "y"])
def test_noise_and_uneven_density_keep_the_handles(name: str) -> None:
    true = shape_graph(name)
    handles = len(true.edges) - len(true.nodes) + 1
    for degraded in ({"noise": 0.2}, {"uneven": 10.0}):
        assert solid_handles(oriented_cloud(*shape(name, 4096, **degraded))) == (handles, "")


def test_undecided_handles_are_null_with_the_candidates() -> None:
    """A ring with a gap of about its own thickness: closed or open, depending on what counts as inside."""
    surface = oriented_cloud(*shape("torus", 2000))
    angle = np.arctan2(surface.points[:, 1], surface.points[:, 0])
    found = set()
    for gap in np.linspace(0.05, 0.6, 12):
        kept = np.abs(angle) > gap
        cut = OrientedCloud(surface.points[kept], surface.normals[kept], surface.areas[kept], consistency=1.0)
        found.add(solid_handles(cut))
    assert (1, "") in found
    assert (0, "") in found
    assert (None, "0 or 1 handles, depending on the level of the inside") in found


def test_more_handles_than_the_surface_has_loops_are_not_decided() -> None:
    """Each handle of a solid is a loop of its surface: where that does not show, the cloud is too sparse to say."""
    cloud, targets = shape("torus", 2000)
    subject = make_subject(cloud, None, None, None, None, "side")
    surface = oriented_cloud(cloud, targets)
    enough, none = (count_loops(np.array([[1.0, d]]), surface, subject, MetricParams()) for d in (9.0, 2.0))
    assert (enough.surface, enough.solid) == (1, 1)
    assert (none.surface, none.solid) == (0, None)
    assert "only 0 loops of the surface last" in none.reasons["solid"]


def test_large_clouds_are_thinned_by_seed_and_it_is_said() -> None:
    cloud, targets = shape("torus", 4000)
    first, again = (evaluate(cloud, targets, params=MetricParams(loop_points=1500)).loops for _ in range(2))
    assert first.points == 1500
    assert (first.surface, first.solid) == (2, 1)
    np.testing.assert_array_equal(first.bars, again.bars)


def test_ring_areas_of_a_square_grid() -> None:
    generator = np.random.default_rng(6)
    from tiskel.geometry.neighbours import cloud_rings

    x, y = np.meshgrid(np.arange(12.0), np.arange(12.0))
    points = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    points[:, :2] += generator.normal(size=(144, 2)) * 1e-3  # so that the triangulation is unique
    inner = ((points[:, :2] > 2) & (points[:, :2] < 9)).all(axis=1)
    # a vertex of a triangulated unit grid has 4 to 8 triangles of area 1/2, on average 6: a third of 3
    assert ring_areas(points, cloud_rings(points, 12))[inner].mean() == pytest.approx(1, rel=0.05)
    assert barcode(points).deaths.max() < 1.01
