"""Stray points set no scale: not of the curve, nor of slices, pictures, measures and conditioning."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reference.fixtures import Runner
from tiskel import (
    ConditioningParams,
    ContractionParams,
    ShapeParams,
    SurfaceParams,
    condition,
    contract,
    evaluate,
    extract_skeleton,
    fit_surface,
    make_shape,
    read_contraction,
    shape_graph,
    write_contraction,
)
from tiskel.arrays import Points
from tiskel.geometry.strays import FEW, GAP, PILE, body_of, stray_points
from tiskel.messages import of_contraction
from tiskel.params import Method
from tiskel.pictures.quality import quality_picture
from tiskel.pictures.skeleton import skeleton_picture
from tiskel.pictures.slices import slices_picture
from tiskel.preprocess.conditioning import voxel_means, with_noise

CLOUD = make_shape(shape_graph("y"), ShapeParams(count=1500))[0]
PLANE = np.mgrid[:20, :20, :1].reshape(3, -1).T.astype(float)  # spacing 0.89
ADDED = {
    "one far above": np.array([[0, 0, 300.0]]),
    "rows at one place inside": np.repeat(CLOUD.mean(axis=0)[None] * [1, 1, 0.5], 200, axis=0),
    "two on both sides": np.array([[500.0, 0, 0], [-900.0, 3, 0]]),
}


def spiked(number: int) -> Points:
    """A line of so many points above a plane, at its own spacing."""
    line = np.stack([np.zeros(number), np.zeros(number), np.arange(number)], axis=1)
    return np.concatenate([PLANE, line + [9.5, 9.5, GAP * number]])


@pytest.mark.parametrize("number", [1, 3, FEW - 1])
def test_the_larger_a_group_the_farther_off_it_must_be(number: int) -> None:
    near, far = spiked(number), spiked(number)
    near[len(PLANE) :, 2] *= 0.5
    far[len(PLANE) :, 2] += 1
    assert not stray_points(near).any()
    assert np.flatnonzero(stray_points(far)).tolist() == list(range(len(PLANE), len(far)))


def test_ten_points_are_a_part() -> None:
    assert not stray_points(np.concatenate([PLANE, spiked(FEW)[len(PLANE) :] + [0, 0, 900]])).any()


def test_a_place_repeated_far_more_often_than_others_is_stray_with_all_its_rows() -> None:
    rows = np.repeat([[9.5, 9.5, 0.2]], PILE, axis=0)
    assert stray_points(np.concatenate([PLANE, rows])).sum() == PILE
    assert not stray_points(np.concatenate([PLANE, rows[1:]])).any()
    # Where every place is repeated so often, that is how the file was made.
    assert not stray_points(np.repeat(np.concatenate([PLANE, rows[:1]]), PILE, axis=0)).any()


def test_a_sparse_wire_at_a_dense_body_is_no_crowd_of_strays() -> None:
    wire = np.stack([9.5 + np.arange(40) * 30.0, np.full(40, 9.5), np.zeros(40)], axis=1)[1:]
    assert not stray_points(np.concatenate([PLANE, wire])).any()


@given(st.integers(20, 400), st.integers(0, 10**6))
def test_a_wire_sampled_at_random_has_no_strays(count: int, seed: int) -> None:
    """Gaps are exponential there: the hardest case for a rule that goes by gaps."""
    along = np.sort(np.random.default_rng(seed).random(count))
    assert not stray_points(np.stack([along, np.sin(3 * along), 0 * along], axis=1)).any()


@given(st.integers(0, 10**6), st.floats(1e-9, 1e9))
def test_strays_do_not_depend_on_order_place_or_scale(seed: int, scale: float) -> None:
    cloud = np.concatenate([CLOUD, *ADDED.values()])
    order = np.random.default_rng(seed).permutation(len(cloud))
    moved = np.ldexp(cloud, int(np.log2(scale)))[order]  # a power of two, so that no distance is rounded
    np.testing.assert_array_equal(stray_points(moved), stray_points(cloud)[order])
    assert stray_points(cloud).sum() == 203


def test_a_cloud_without_strays_is_its_own_body() -> None:
    assert body_of(CLOUD) is CLOUD


@pytest.mark.parametrize("name", ADDED)
@pytest.mark.parametrize("method", ["robust", "gls", "lbc"])
def test_the_curve_is_the_same_to_the_last_bit(name: str, method: Method) -> None:
    c = contract(np.concatenate([CLOUD, ADDED[name]]), ContractionParams(method=method))
    s, alone = extract_skeleton(c), extract_skeleton(contract(CLOUD, ContractionParams(method=method)))
    for array in ("nodes", "edges", "radii", "contracted", "rows"):
        assert getattr(s, array).tobytes() == getattr(alone, array).tobytes(), array
    assert len(s.cloud) == len(s.node_of_point) == len(CLOUD) + len(ADDED[name])
    assert s.node_of_point[: len(CLOUD)].tobytes() == alone.node_of_point.tobytes()
    assert s.node_of_point.min() >= 0
    assert s.warnings == alone.warnings
    assert any(f"{len(ADDED[name])} stray point" in m.text and not m.warning for m in of_contraction(c))
    assert not any("stray" in m.text for m in of_contraction(contract(CLOUD, ContractionParams(method=method))))


def test_a_stage_file_keeps_them_apart(tmp_path: Path) -> None:
    c = contract(np.concatenate([CLOUD, ADDED["one far above"]]))
    write_contraction(f"{tmp_path}/c.ply", c)
    again = read_contraction(f"{tmp_path}/c.ply")
    assert np.flatnonzero(again.strays).tolist() == [len(CLOUD)]
    assert extract_skeleton(again).nodes.tobytes() == extract_skeleton(c).nodes.tobytes()


@pytest.mark.parametrize("name", ADDED)
def test_slices_pictures_and_measures_are_the_same(name: str) -> None:
    made = [extract_skeleton(contract(cloud)) for cloud in (CLOUD, np.concatenate([CLOUD, ADDED[name]]))]
    fitted = [fit_surface(s) for s in made]
    for one, other in zip(*fitted, strict=True):
        assert one.tube.series.coefficients.tobytes() == other.tube.series.coefficients.tobytes()
        assert (one.order, one.error, one.distance) == (other.order, other.error, other.distance)
    assert skeleton_picture(made[0], "") == skeleton_picture(made[1], "")
    assert slices_picture(fitted[0], "") == slices_picture(fitted[1], "")
    quality = [evaluate(s) for s in made]
    documents = [q.as_dict() for q in quality]
    for document in documents:
        document.pop("seconds", None), document.pop("warnings")
    assert documents[0] == documents[1]
    assert quality_picture([("", made[0].cloud, quality[0])]) == quality_picture([("", made[1].cloud, quality[1])])


def test_a_curve_from_elsewhere_is_sliced_the_same() -> None:
    cloud, true = make_shape(shape_graph("banana"), ShapeParams(count=1000))
    params = SurfaceParams(interval=0.05)
    one, other = (fit_surface(true, params, np.concatenate([cloud, more])) for more in ([[0, 0, 300.0]], cloud[:0]))
    assert (one[0].error, one[0].length, one[0].order) == (other[0].error, other[0].length, other[0].order)


def test_measures_row_by_row_leave_strays_out() -> None:
    stray = ADDED["one far above"]
    c = contract(CLOUD)
    one = evaluate(CLOUD, c.points)
    other = evaluate(np.concatenate([CLOUD, stray]), np.concatenate([c.points, stray]))
    assert one.points is not None
    assert other.points is not None
    assert one.points.centredness.tobytes() == other.points.centredness.tobytes()
    assert any("stray" in warning for warning in other.warnings)


def test_conditioning_goes_by_the_body() -> None:
    more = np.concatenate([CLOUD, ADDED["two on both sides"]])
    together = condition(more, ConditioningParams(outliers=True))[0]
    assert together.tobytes() == condition(CLOUD, ConditioningParams(outliers=True))[0].tobytes()
    means = {tuple(p) for p in voxel_means(more, 0.1)}
    assert {tuple(p) for p in voxel_means(CLOUD, 0.1)} < means
    noisy = with_noise(more, 0.01, "diagonal", 3)[: len(CLOUD)]
    assert np.ptp(noisy - CLOUD) < 0.2


def test_the_files_of_the_report(cases_folder: Path) -> None:
    """The same tree alone, with one stray point, and moved, with two hundred rows at 0 0 0."""
    made = [
        extract_skeleton(contract(np.loadtxt(f"{cases_folder}/{name}.xyz")))
        for name in ("tree", "tree_stray", "tree_origin")
    ]
    assert made[0].nodes.tobytes() == made[1].nodes.tobytes()
    assert made[0].edges.tobytes() == made[2].edges.tobytes()
    np.testing.assert_allclose(made[2].nodes - [50, 60, 0], made[0].nodes, atol=1e-6)
    assert skeleton_picture(made[0], "") == skeleton_picture(made[1], "")


def test_info_gives_the_box_of_the_body_too(tiskel: Runner, tmp_path: Path) -> None:
    np.savetxt(tmp_path / "c.xyz", np.concatenate([PLANE, ADDED["one far above"]]))
    found = json.loads(tiskel("info", "c.xyz").stdout)["cloud"]
    assert (found["stray"], found["max"], found["body_max"]) == (1, [19, 19, 300], [19, 19, 0])
