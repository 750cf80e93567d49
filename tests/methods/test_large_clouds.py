"""Large clouds are thinned to what their surface needs: noise goes, thin parts and narrow gaps keep their points."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from reference.fixtures import Runner
from tiskel import (
    RobustParams,
    ShapeParams,
    contract,
    extract_skeleton,
    make_shape,
    read_contraction,
    shape_graph,
    write_contraction,
)
from tiskel.arrays import Numbers, Points
from tiskel.errors import TiskelError
from tiskel.gallery.trees import thickened, tree
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.round_cones import ConeGraph
from tiskel.methods.robust.cell_sizes import ENOUGH, cells_of
from tiskel.methods.robust.thinning import thinned
from tiskel.metrics.truth import agreement
from tiskel.params import MaxPoints

RADIUS = 0.1


def tube(count: int, length: float, noise: float = 0.0, radius: float = RADIUS, seed: int = 0) -> Points:
    """Return points on an open tube along z, noise in radii."""
    generator = np.random.default_rng(seed)
    angle, height = generator.uniform(0, 2 * np.pi, count), generator.uniform(0, length, count)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    return points + noise * radius * generator.normal(size=points.shape)


def half_torus(count: int, noise: float) -> Points:
    """Return points on half a torus of radii 1 and 0.3, noise in diagonals."""
    generator = np.random.default_rng(0)
    along, around = generator.uniform(0, np.pi, 3 * count), generator.uniform(0, 2 * np.pi, 3 * count)
    kept = np.flatnonzero(generator.uniform(0, 1.3, 3 * count) < 1 + 0.3 * np.cos(around))[:count]
    along, around = along[kept], around[kept]
    out = 1 + 0.3 * np.cos(around)
    points = np.stack([out * np.cos(along), out * np.sin(along), 0.3 * np.sin(around)], axis=1)
    return np.asarray(points + noise * np.linalg.norm(np.ptp(points, axis=0)) * generator.normal(size=points.shape))


@pytest.mark.parametrize("count", [4096, 30_000, 120_000])
def test_more_points_make_no_worse_curve(count: int) -> None:
    """Taken as they are, 120 000 points of a half torus with noise of 0.5 % have had four ends."""
    s = extract_skeleton(contract(half_torus(count, 0.005)))
    assert (s.components, s.loops, s.ends) == (1, 0, 2)
    np.testing.assert_allclose(np.median(s.radii), 0.3, rtol=0.05)
    assert len(s.node_of_point) == count


@pytest.mark.parametrize("noise", [0.1, 0.25], ids=str)
def test_a_noisy_trunk_is_one_strand(noise: float) -> None:
    """With noise of a quarter of the radius it has had eight ends; the curve now stays within a third of the axis."""
    s = extract_skeleton(contract(tube(60_000, 3.0, noise)))
    assert (s.components, s.loops, s.ends) == (1, 0, 2)
    assert np.linalg.norm(s.nodes[:, :2], axis=1).max() < RADIUS / 3


def test_wires_that_cross_are_two_however_many_points_they_have() -> None:
    """Taken as they are, 65 536 points have had three loops, and 262 144 points 9524 ends."""
    s = extract_skeleton(contract(make_shape("crossing", 65_536)[0]))
    assert (s.components, s.loops, s.ends) == (2, 0, 4)


def test_a_thin_tree_has_its_tips_and_its_bounds() -> None:
    """Taken as they are, 40 000 points have had 85 ends; bounds come of all points, not of the means."""
    shape = thickened(tree(tips=40, seed=3), 40_000, 1.0)
    s = extract_skeleton(contract(make_shape(shape, ShapeParams(count=40_000, seed=3))[0]))
    assert (s.components, s.loops) == (1, 0)
    assert abs(s.ends - shape.ends) <= 2
    assert [note.code for note in s.notes] == ["thin", "thinned"]
    share = s.radii / feet(shape, s.nodes)
    assert 0.8 < np.median(share[s.radius_sources == RadiusSource.BOUNDED]) < 1.3
    assert 0.8 < np.median(share[s.radius_sources == RadiusSource.MEASURED]) < 1.2


def feet(shape: ConeGraph, places: Points) -> Numbers:
    """Return the radii of a shape at the places on its curve that are nearest."""
    share = np.linspace(0, 1, 60)[:, None]
    (one, other), (thick, thin) = shape.nodes[shape.edges].transpose(1, 0, 2), shape.radii[shape.edges].T
    line = (one + share[..., None] * (other - one)).reshape(-1, 3)
    radii: Numbers = (thick + share * (thin - thick)).ravel()
    return np.asarray(radii[cKDTree(line).query(places)[1]])


def test_lines_across_each_other_are_no_surface() -> None:
    """They lie in a plane, and have been cut out of the wires about them, a hundred spacings of each as one mean."""
    x = np.linspace(-1, 1, 15_001)
    cross = np.concatenate([np.stack([x, 0 * x, 0 * x], axis=1), np.stack([0 * x, x, 0 * x], axis=1)])
    number = cells_of(cross)
    x = number.max() + 1
    assert 5000 < x <= ENOUGH
    low, high = np.full((x, 3), np.inf), np.full((x, 3), -np.inf)
    np.minimum.at(low, number, cross)
    np.maximum.at(high, number, cross)
    assert np.linalg.norm(high - low, axis=1).max() < 10 * 2 / 15_000


def test_the_smallest_cells_grow_until_there_are_few_enough() -> None:
    """The trunk keeps the cells that its surface has, the wire beside it gets larger ones; one size, and no more."""
    trunk, wire = tube(40_000, 3.0, radius=0.5), tube(40_000, 3.0, radius=1e-5) + [2.0, 0, 0]
    number = cells_of(np.concatenate([trunk, wire]))
    of_trunk, of_wire = np.unique(number[:40_000]), np.unique(number[40_000:])
    assert not np.intersect1d(of_trunk, of_wire).size
    assert 0.5 < of_trunk.size / np.unique(cells_of(trunk)).size < 2  # sides double from the smallest, which differ
    assert 500 < of_wire.size < ENOUGH


def test_of_a_body_less_than_half_the_points_are_left_and_more_of_thin_limbs() -> None:
    body = make_shape("quadruped", 30_000)[0]
    thin = make_shape(thickened(tree(tips=100, seed=1), 30_000, 0.5), 30_000)[0]
    assert 5000 < len(thinned(body, "auto").rows) < 0.45 * 30_000
    assert len(thinned(thin, "auto").rows) > 0.5 * 30_000


@pytest.mark.parametrize("count", [16_384, 65_536])
def test_cells_of_a_plane_are_smaller_than_its_limbs(count: int) -> None:
    """A ladder from one side is flat at any size; its bars were as wide as two cells, and the curve had 105 ends."""
    width, generator = 0.2, np.random.default_rng(0)
    places = generator.uniform([0, 0], [3.2, 0.7], (3 * count, 2))
    x, y = places.T
    hole = (x % 0.75 > width) & (y > width) & (y < 0.7 - width)
    ladder = np.column_stack([places, 0.005 * generator.normal(size=len(places))])[~hole][:count]
    number = cells_of(ladder)
    low, high = np.full((number.max() + 1, 3), np.inf), np.full((number.max() + 1, 3), -np.inf)
    np.minimum.at(low, number, ladder)
    np.maximum.at(high, number, ladder)
    assert (high - low)[:, :2].max() < width / 2


def test_no_fewer_than_there_are_clusters() -> None:
    """Fifty of them, far apart, are as many cells at every size."""
    generator = np.random.default_rng(0)
    points = np.repeat(np.arange(50), 500)[:, None] * [1e3, 0, 0] + generator.uniform(0, 1e-3, (25_000, 3))
    assert thinned(points, 10).points.shape == (50, 3)


def test_small_clouds_stay_as_they_are_and_all_can_be_asked_for() -> None:
    points = tube(ENOUGH, 1.0)
    choices: list[tuple[Points, MaxPoints]] = [(points, "auto"), (np.concatenate([points, points + 9]), "all")]
    for cloud, most in choices:
        same = thinned(cloud, most)
        assert same.points is cloud
        np.testing.assert_array_equal(same.rows, np.arange(len(cloud)))


def test_every_point_goes_into_one_mean_and_a_mean_goes_by_the_nearest() -> None:
    points = tube(30_000, 1.0, 0.05)
    few = thinned(points, "auto")
    assert 200 < len(few.rows) < 10_000
    np.testing.assert_array_equal(few.place[few.rows], np.arange(len(few.rows)))
    away = np.linalg.norm(points - few.points[few.place], axis=1)
    for place in (0, len(few.rows) // 2):
        members = np.flatnonzero(few.place == place)
        np.testing.assert_allclose(few.points[place], points[members].mean(axis=0))
        assert away[few.rows[place]] == away[members].min()
    out = np.linalg.norm(few.points[:, :2], axis=1)
    assert out.std() < 0.6 * np.linalg.norm(points[:, :2], axis=1).std()  # noise is averaged


def test_a_twig_beside_a_thick_trunk_keeps_its_points() -> None:
    """The twig is as thick as the points are apart, the trunk a hundred times; a grid for both would lose one."""
    trunk, twig = tube(40_000, 3.0, radius=0.5), tube(60, 1.0, radius=0.008) + [2.0, 0, 1.0]
    few = thinned(np.concatenate([trunk, twig]), "auto")
    assert (few.rows < 40_000).sum() < 20_000
    assert (few.rows >= 40_000).sum() > 55


def test_two_sheets_stay_apart() -> None:
    """No mean lies between two coaxial tubes, five spacings apart."""
    inner, outer = tube(30_000, 1.0), tube(30_000, 1.0, radius=RADIUS * 1.25, seed=1)
    out = np.linalg.norm(thinned(np.concatenate([inner, outer]), "auto").points[:, :2], axis=1)
    assert (np.abs(out / RADIUS - 1.125) > 0.05).all()


def test_turning_and_scaling_change_no_choice_and_files_say_the_same(tmp_path: Path) -> None:
    points = tube(25_000, 1.0, 0.05)
    few = thinned(points, "auto")
    turned = thinned(3 * points @ Rotation.from_rotvec([1, 2, 3]).as_matrix().T + 5, "auto")
    np.testing.assert_array_equal(few.rows, turned.rows)
    c = contract(np.concatenate([points, points[:50]]))  # with duplicates
    write_contraction(tmp_path / "c.ply", c)
    one, other = extract_skeleton(c), extract_skeleton(read_contraction(tmp_path / "c.ply"))
    np.testing.assert_array_equal(one.node_of_point, other.node_of_point)
    np.testing.assert_allclose(one.nodes, other.nodes, atol=1e-9)


def test_so_many_points_at_most() -> None:
    shape = shape_graph("hand")
    cloud = make_shape(shape, ShapeParams(count=30_000))[0]
    assert len(thinned(cloud, 5000).rows) <= 5000 < len(thinned(cloud, "auto").rows)
    c = contract(cloud, RobustParams(max_points=5000))
    assert len(c.points) <= 5000
    assert agreement(extract_skeleton(c), shape).topology_right


def test_who_thins_says_so() -> None:
    cloud = tube(30_000, 1.0)
    s = extract_skeleton(contract(cloud))
    assert [note.code for note in s.notes] == ["thinned"]
    assert f"of the {len(cloud)} points" in str(s.notes[0])
    assert not extract_skeleton(contract(tube(3000, 1.0))).notes


@pytest.mark.parametrize("value", ["some", -1, 0, 3, 2.5, True, None], ids=str)
def test_max_points_is_a_number_of_points_or_a_word(value: object) -> None:
    with pytest.raises(TiskelError, match="max_points must be auto, all or a whole number of at least 10"):
        RobustParams(max_points=value)  # type: ignore[arg-type]


def test_the_command_takes_words_and_numbers(tiskel: Runner, cloud: Path, tmp_path: Path) -> None:
    for value, expected in (("auto", "auto"), ("all", "all"), ("5000", 5000)):
        assert tiskel("contract", cloud, "-o", "c.ply", "--max-points", value).returncode == 0
        params = read_contraction(tmp_path / "c.ply").params
        assert isinstance(params, RobustParams)
        assert params.max_points == expected
    failed = tiskel("contract", cloud, "-o", "c.ply", "--max-points", "few")
    assert failed.returncode == 2
    assert "auto, all or a whole number" in failed.stderr.decode()
