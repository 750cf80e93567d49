"""What is done to a cloud before the first stage."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from tiskel import ConditioningParams, ShapeParams, TiskelError, condition, make_shape, shape_graph
from tiskel.preprocess.capping import cap_points
from tiskel.preprocess.conditioning import OUTLIER_NEIGHBOURS, voxel_means, with_noise

POINTS = np.random.default_rng(0).random((2000, 3))


def test_nothing_asked_for_changes_nothing() -> None:
    dirty = np.concatenate([POINTS, [[np.nan, 0, 0]]])
    same, report = condition(dirty, ConditioningParams())
    assert same is dirty
    assert report == ()


def test_cropping_keeps_the_box_and_says_how_much_went() -> None:
    box = (0.0, 0.0, 0.0, 0.5, 1.0, 1.0)
    kept, report = condition(POINTS, ConditioningParams(crop=box))
    np.testing.assert_array_equal(kept, POINTS[POINTS[:, 0] <= 0.5])
    assert report == (f"cropped away {2000 - len(kept)} points",)


def test_voxels_hold_one_mean_each() -> None:
    means = voxel_means(POINTS, 0.25)
    cells = np.floor((POINTS - POINTS.min(axis=0)) / 0.25)
    expected = {tuple(cell): POINTS[(cells == cell).all(axis=1)].mean(axis=0) for cell in np.unique(cells, axis=0)}
    np.testing.assert_allclose(means, list(expected.values()), atol=1e-12)


def test_sampling_is_a_seeded_subset() -> None:
    one, same, other = (condition(POINTS, ConditioningParams(sample=100, seed=s))[0] for s in (1, 1, 2))
    assert one.tobytes() == same.tobytes() != other.tobytes()
    assert {tuple(p) for p in one} <= {tuple(p) for p in POINTS}
    assert len(condition(POINTS, ConditioningParams(sample=9999))[0]) == len(POINTS)


def test_outliers_go_and_the_cloud_stays() -> None:
    body = make_shape(shape_graph("capsule"), ShapeParams(count=2000))[0]
    far = np.array([[5.0, 0, 0], [0, 7, 0], [0, 0, -9]])
    kept, report = condition(np.concatenate([body, far]), ConditioningParams(outliers=True))
    assert np.abs(kept).max() < 1
    assert len(kept) > 0.9 * len(body)
    assert report[0].startswith("removed")


def test_caps_close_the_ends_of_a_tunnel_and_nothing_else() -> None:
    shape = shape_graph("tunnel")
    points = make_shape(shape, ShapeParams(count=4096))[0]
    added = cap_points(points)
    ends, radius = shape.nodes[list(shape.open_ends)], 0.25
    nearest, which = cKDTree(ends).query(added)
    assert nearest.max() < 1.2 * radius
    for end in range(2):
        # The disc's area at the cloud's own spacing: within a factor of two of the density of the wall.
        density = (which == end).sum() / (np.pi * radius**2)
        wall = len(points) / (2 * np.pi * radius * 1.2 * 1.4)
        assert 0.5 < density / wall < 2
    assert len(cap_points(make_shape(shape_graph("capsule"), ShapeParams(count=4096))[0])) == 0


@pytest.mark.parametrize(
    "settings", [{"crop": (0, 0, 0, 0, 1, 1)}, {"crop": (0, 1)}, {"voxel": 0.0}, {"sample": 0}, {"voxel": np.inf}]
)
def test_wrong_settings_are_refused(settings: dict[str, object]) -> None:
    with pytest.raises(TiskelError):
        ConditioningParams(**settings)  # type: ignore[arg-type]


def test_a_crop_that_leaves_nothing_says_so() -> None:
    with pytest.raises(TiskelError, match="no point of 2000 is left"):
        condition(POINTS, ConditioningParams(crop=(5, 5, 5, 6, 6, 6)))


def test_noise_of_each_kind_has_its_size_and_seed() -> None:
    points = np.random.default_rng(0).random((20_000, 3)) * [4, 1, 1] + 7
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    by_coordinate = with_noise(points, 0.05) - points
    ratio = by_coordinate / (points - middle)
    assert ratio.std() == pytest.approx(0.05, rel=0.02)  # 60 000 values: half a per cent
    even = with_noise(points, 0.05, "diagonal") - points
    assert even.std(axis=0) == pytest.approx([0.05 * np.linalg.norm([4, 1, 1]) / 2] * 3, rel=0.03)
    np.testing.assert_array_equal(with_noise(points, 0.1, seed=3), with_noise(points, 0.1, seed=3))
    blurred, report = condition(points, ConditioningParams(noise=0.05))
    np.testing.assert_array_equal(blurred, points + by_coordinate)
    assert report == ("added noise of 0.05 of the coordinates",)
    for bad in ({"noise": -1.0}, {"noise": np.nan}, {"noise_kind": "salt"}):
        with pytest.raises(TiskelError, match="noise"):
            ConditioningParams(**bad)


def test_caps_are_added_and_counted() -> None:
    points = make_shape(shape_graph("tunnel"), ShapeParams(count=4096))[0]
    capped, report = condition(points, ConditioningParams(cap=True))
    np.testing.assert_array_equal(capped[:4096], points)
    np.testing.assert_array_equal(capped[4096:], cap_points(points))
    assert report == (f"capped open ends with {len(capped) - 4096} points",)
    assert len(capped) > 4096


def test_of_few_points_none_is_an_outlier_unless_many_lie_in_one_place() -> None:
    few = POINTS[:OUTLIER_NEIGHBOURS].copy()
    few[-1] = 3.0  # among more it would be one
    np.testing.assert_array_equal(condition(few, ConditioningParams(outliers=True))[0], few)
    kept, report = condition(np.concatenate([few, np.zeros((60, 3))]), ConditioningParams(outliers=True))
    np.testing.assert_array_equal(kept, few)
    assert report == ("removed 60 outliers",)
