"""Meshes: what is counted of them, how they are cut finer, how thick they are, and points on them."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from reference.meshes import Mesh, block, boxes, joined, soup, torus, tube, without
from tiskel.errors import TiskelError
from tiskel.geometry.mesh import TriangleMesh, half_edges, welded, winding_number
from tiskel.geometry.mesh_facts import facts_of
from tiskel.geometry.mesh_sample import CONTRAST, FEWEST, SampledMesh, sample_mesh
from tiskel.geometry.mesh_surface import MeshSurface, still_on
from tiskel.geometry.refine import refined
from tiskel.geometry.thickness import thicknesses

HOLLOW = np.ones((5, 5, 5), bool)
HOLLOW[2, 2, 2] = False
TOUCHING = np.zeros((2, 2, 1), bool)
TOUCHING[0, 0] = TOUCHING[1, 1] = True
KNOWN = {  # components, boundary loops, genus of all parts, watertight
    "torus": (torus(), (1, 0, 1, True)),
    "soup of a torus": (soup(torus()), (1, 0, 1, True)),
    "tube": (tube([0, 0, 0], [0, 0, 5], 0.3), (1, 0, 0, True)),
    "open tube": (tube([0, 0, 0], [0, 0, 5], 0.3, caps=False), (1, 2, 0, False)),
    "two tubes": (joined(tube([0, 0, 0], [0, 0, 5], 0.3), tube([1, 0, 0], [1, 0, 5], 0.3)), (2, 0, 0, True)),
    "block with three holes": (block(3), (1, 0, 3, True)),
    "hollow": (boxes(HOLLOW), (2, 0, 0, True)),
    "torus with a rim": (without(torus(), np.arange(3072) == 7), (1, 1, 1, False)),
    "two boxes that share an edge": (boxes(TOUCHING), (1, 2, 0, False)),
}


@pytest.mark.parametrize("name", KNOWN)
def test_parts_rims_and_handles_are_counted(name: str) -> None:
    mesh, (components, rims, handles, watertight) = KNOWN[name]
    facts = facts_of(welded(*mesh))
    assert (facts.components, facts.boundary_loops, facts.handles, facts.watertight) == (
        components,
        rims,
        handles,
        watertight,
    )
    assert ("watertight" in str(facts)) == watertight
    assert facts.as_dict()["handles"] == handles


def test_genus_is_given_part_by_part_the_largest_first() -> None:
    assert facts_of(welded(*joined(torus(0.4, 0.1), block(2), tube([9, 9, 9], [9, 9, 99], 8)))).genus == (0, 2, 1)


def test_faces_that_disagree_are_said() -> None:
    points, faces = torus()
    faces[::2] = faces[::2, ::-1]
    facts = facts_of(welded(points, faces))
    assert not facts.watertight
    assert "disagree" in str(facts)


def test_corners_of_single_precision_are_one_vertex() -> None:
    points, faces = soup(torus())
    shaken = points + np.random.default_rng(0).uniform(-1, 1, points.shape) * 1e-7
    assert facts_of(welded(shaken, faces)).vertices == 64 * 24
    assert facts_of(welded(points + 1e-4 * np.random.default_rng(0).random(points.shape), faces)).components > 1000


def test_parts_that_are_inside_out_are_turned_hollows_are_not() -> None:
    points, faces = joined(torus(), boxes(HOLLOW))
    flipped = np.concatenate([faces[:3072, ::-1], faces[3072:]])
    for mesh in (welded(points, flipped), welded(points, faces)):
        corner = [mesh.vertices[mesh.faces[:, i]] for i in range(3)]
        volume = np.einsum("ij,ij->i", corner[0], np.cross(corner[1], corner[2])).sum() / 6
        # The polyhedron of 64 x 24 sides has 0.987 of the torus' volume; the box lacks the hollow's cube.
        assert volume == pytest.approx(124 + 0.987 * 2 * np.pi**2 * 0.25**2, rel=1e-3)


def test_the_winding_number_counts_turns() -> None:
    points, faces = boxes(np.ones((2, 2, 2), bool))
    assert winding_number((points - 1.7)[faces]) == pytest.approx(1)
    assert winding_number((points - 3.7)[faces]) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("name", KNOWN)
def test_cutting_keeps_surface_and_topology_and_obeys_the_length(name: str) -> None:
    mesh = welded(*KNOWN[name][0])
    fine, source = refined(mesh, np.full(len(mesh.faces), 0.2), 10**6)
    ends = np.stack([fine.faces, np.roll(fine.faces, -1, axis=1)], axis=2).reshape(-1, 2)
    assert np.linalg.norm(np.diff(fine.vertices[ends], axis=1)[:, 0], axis=1).max() <= 0.2
    np.testing.assert_allclose(np.bincount(source, fine.areas), mesh.areas, rtol=1e-9)
    np.testing.assert_allclose(fine.normals, mesh.normals[source], atol=1e-6)
    one, other = facts_of(mesh), facts_of(fine)
    assert (one.components, one.boundary_loops, one.genus) == (other.components, other.boundary_loops, other.genus)


def test_cutting_ends_at_the_number_of_triangles() -> None:
    mesh = welded(*torus())
    assert len(refined(mesh, np.full(len(mesh.faces), 1e-9), 5000)[0].faces) < 4 * 5000


def test_sides_meet_in_pairs() -> None:
    halves = half_edges(welded(*torus()).faces)
    assert (len(halves.meeting), len(halves.free), halves.crowded) == (3 * 3072 // 2, 0, 0)
    assert halves.opposite.all()


@pytest.mark.parametrize("radius", [0.05, 0.3])
def test_thickness_of_a_tube_is_its_diameter(radius: float) -> None:
    """From two to twelve points in the diameter."""
    rng = np.random.default_rng(1)
    turn, along = rng.random(3000) * 2 * np.pi, rng.random(3000) * 4
    normals = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    points = radius * normals + along[:, None] * [0, 0, 1]
    spacing = np.full(3000, np.sqrt(2 * np.pi * radius * 4 / 3000))
    found = thicknesses(points, normals, spacing, 10.0)[(along > 0.3) & (along < 3.7)]
    # A way ends a spacing before the other side at the latest; the nearest hit is less deep than the opposite one.
    assert 2 * radius - 1.2 * spacing[0] < np.median(found) < 2.1 * radius
    assert np.quantile(found, 0.98) < 2.2 * radius


def test_what_has_no_other_side_is_as_thick_as_may_be() -> None:
    points = np.random.default_rng(2).random((500, 3)) * [1, 1, 0]
    assert (thicknesses(points, np.tile([0, 0, 1.0], (500, 1)), np.full(500, 0.05), 3.0) == 3).all()


def parts_of(surface: MeshSurface) -> tuple[int, np.ndarray]:
    count = len(surface.normals)
    links = sparse.coo_array((np.ones(len(surface.links)), tuple(surface.links.T)), shape=(count, count))
    found, label = connected_components(links, directed=False)
    return int(found), label


@pytest.fixture(scope="module")
def near() -> SampledMesh:
    """Two tubes a tenth of a spacing apart."""
    return sample_mesh(*joined(tube([0, 0, 0], [0, 0, 5], 0.3, 48), tube([0.605, 0, 0], [0.605, 0, 5], 0.3, 48)))


def known(found: SampledMesh) -> MeshSurface:
    assert found.surface is not None
    return found.surface


def test_points_lie_on_the_mesh_and_normals_point_out() -> None:
    found = sample_mesh(*torus(), 2000)
    ring = found.points * [1, 1, 0]
    axis = ring / np.linalg.norm(ring, axis=1, keepdims=True)
    out = found.points - axis
    # The polyhedron lies within (1 - cos(pi / 24)) of the small radius, plus the same of the large circle.
    assert np.abs(np.linalg.norm(out, axis=1) - 0.25).max() < 0.25 * 0.009 + 1.25 * 0.0013
    cosine = np.einsum("ij,ij->i", known(found).normals, out / np.linalg.norm(out, axis=1, keepdims=True))
    assert cosine.min() > 0.95
    assert known(found).areas.sum() == pytest.approx(4 * np.pi**2 * 0.25, rel=0.01)
    assert known(found).outward
    assert known(found).handles == 1


def test_parts_stay_apart_however_near(near: SampledMesh) -> None:
    surface = known(near)
    count, label = parts_of(surface)
    assert count == 2
    assert (label == label[(near.points[:, 0] > 0.3025).argmax()]).sum() == (near.points[:, 0] > 0.3025).sum()
    neighbours = cKDTree(near.points).query(near.points, 14)[1]
    linked = surface.linked(neighbours)
    assert not (linked & (label[neighbours] != label[:, None])).any()
    same = label[neighbours] == label[:, None]
    assert (linked & same).sum() > 0.97 * same.sum()
    assert linked[:, 0].all()


@pytest.mark.parametrize("count", [None, 1500])
def test_points_are_even_and_cells_have_six_neighbours(count: int | None) -> None:
    """Of a random sample the distance to the nearest varies by 0.52 of its mean; six is Euler's formula."""
    found = sample_mesh(*torus(), count)
    nearest = cKDTree(found.points).query(found.points, 2)[0][:, 1]
    assert len(found.points) == (count or FEWEST)
    assert nearest.std() < 0.42 * nearest.mean()
    assert 2 * len(known(found).links) / len(found.points) == pytest.approx(6, abs=0.1)
    assert parts_of(known(found))[0] == 1


def test_thin_parts_get_more_points_per_area() -> None:
    thick, thin = tube([0, 0, 0], [0, 0, 4], 1.0), tube([0, 0, 6], [0, 0, 10], 0.2)
    points = sample_mesh(*joined(thick, thin), 6000).points
    lateral = np.linalg.norm(points[:, :2], axis=1)
    densities = [
        ((points[:, 2] > low + 0.5) & (points[:, 2] < low + 3.5) & (lateral > 0.9 * r)).sum() / (r * 3)
        for low, r in ((0, 1.0), (6, 0.2))
    ]
    # Five times thinner, so five times closer.
    assert 15 < densities[1] / densities[0] < 35
    assert CONTRAST > 5


def test_the_thickness_says_how_many_points_are_wanted() -> None:
    """Six in the diameter, so 36 per square of it: 18 pi times length over radius, and the caps."""
    found = sample_mesh(*tube([0, 0, 0], [0, 0, 40], 0.25, 48))
    assert found.wanted == pytest.approx(18 * np.pi * 160, rel=0.35)
    assert len(found.points) == found.wanted


def test_the_same_seed_gives_the_same_points() -> None:
    one, same, other = (sample_mesh(*block(1), 800, seed) for seed in (3, 3, 4))
    assert one.points.tobytes() == same.points.tobytes() != other.points.tobytes()
    assert known(one).links.tobytes() == known(same).links.tobytes()


def test_splinters_know_nothing_and_nothing_has_no_area() -> None:
    corners = np.random.default_rng(0).random((500, 1, 3)) + 0.02 * np.random.default_rng(1).random((500, 3, 3))
    splinters = corners.reshape(-1, 3), np.arange(1500, dtype=np.int32).reshape(-1, 3)
    assert sample_mesh(*splinters, 500).surface is None
    with pytest.raises(TiskelError, match="has no area"):
        sample_mesh(np.zeros((3, 3)), np.array([[0, 1, 2]], np.int32))


def test_corners_that_are_not_finite_take_their_triangles_with_them() -> None:
    points, faces = torus()
    points[5] = np.nan
    mesh: Mesh = points, faces
    assert facts_of(welded(*mesh)).boundary_loops == 1
    assert np.isfinite(sample_mesh(*mesh, 500).points).all()
    empty = welded(np.full((3, 3), np.nan), np.array([[0, 1, 2]], np.int32))
    assert isinstance(empty, TriangleMesh)
    assert facts_of(empty).faces == 0


def test_what_is_known_follows_the_rows(near: SampledMesh) -> None:
    surface = known(near)
    rows = np.arange(0, len(near.points), 3, dtype=np.int32)
    part = surface.at(rows)
    np.testing.assert_array_equal(part.normals, surface.normals[rows])
    np.testing.assert_array_equal(part.scaled(3.0).areas, 9 * surface.areas[rows])
    assert {tuple(pair) for pair in rows[part.links].tolist()} <= {tuple(pair) for pair in surface.links.tolist()}
    assert still_on(surface, near.points.copy(), near.points) is surface
    assert still_on(surface, near.points[1:], near.points) is None
    assert still_on(None, near.points, near.points) is None
    with pytest.raises(TiskelError, match="sample it again"):
        surface.checked(3)


def test_what_lies_inside_another_part_is_no_surface() -> None:
    """A tube that enters another: of it a tenth, and of the other a disc, are hidden."""
    mesh = joined(tube([0, 0, 0], [0, 0, 5], 0.3, 48), tube([0, 0, 2.5], [3, 0, 2.5], 0.2, 48))
    found = sample_mesh(*mesh, 4000)
    # Within a spacing of a wall, 0.05, it is open on which side of it a point lies.
    inside_one = (np.hypot(*found.points[:, :2].T) < 0.25) & (found.points[:, 2] > 0.1) & (found.points[:, 2] < 4.9)
    inside_other = (np.hypot(found.points[:, 1], found.points[:, 2] - 2.5) < 0.15) & (found.points[:, 0] > 0.1)
    inside_other &= found.points[:, 0] < 2.9
    assert inside_one.sum() == 0
    assert inside_other.sum() == 0
    assert found.hidden == 4000 - len(found.points) > 200
    assert parts_of(known(found))[0] == 1
    assert known(found).handles is None


def test_parts_that_only_touch_hide_nothing(near: SampledMesh) -> None:
    assert near.hidden == 0
    beside = joined(boxes(np.ones((3, 3, 3), bool)), (boxes(np.ones((3, 3, 3), bool))[0] + [3, 0.5, 0.5], boxes(
        np.ones((3, 3, 3), bool))[1]))  # fmt: skip
    assert sample_mesh(*beside, 3000).hidden == 0
    hollow = sample_mesh(*boxes(HOLLOW), 3000)
    assert hollow.hidden == 0
    assert known(hollow).handles == 0


def test_turning_a_mesh_and_the_order_of_its_file_change_nothing() -> None:
    points, faces = joined(tube([0, 0, 0], [0, 0, 3], 0.3), tube([0.1, 0.2, 4], [2, 0.5, 5], 0.2))
    rng = np.random.default_rng(5)
    order = rng.permutation(len(points))
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    shuffled = np.roll(place[faces][rng.permutation(len(faces))], 1, axis=1).astype(np.int32)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)  # no mirror
    one, other = sample_mesh(points, faces, 1000), sample_mesh(points[order] @ turn.T * 7 + 3, shuffled, 1000)
    back = (other.points - 3) / 7 @ turn
    # Rounding decides on the border of two triangles which of them a point falls to, and moves those after it.
    assert np.quantile(cKDTree(one.points).query(back)[0], 0.9) < 0.01
    same = sample_mesh(points[order], shuffled, 1000)
    np.testing.assert_allclose(same.points, one.points, atol=1e-9)
