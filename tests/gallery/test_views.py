"""Views: sensors see the side that faces them, no hidden part, and a table where there is one."""

from typing import Any

import numpy as np
import pytest

from tiskel import ShapeParams, TiskelError, make_shape, named_shape, shape_graph
from tiskel.gallery import views
from tiskel.gallery.body import surface_distance
from tiskel.gallery.views import TABLE_SHARE, seen_from

CAPSULE = shape_graph("capsule")  # along z, radius 0.2, centres at -0.7 and 0.7


def facing(points: np.ndarray, view: tuple[float, float, float], far: float) -> np.ndarray:
    """Return the cosines between the normals of the capsule and the rays to a sensor."""
    normals = (points - np.clip(points[:, 2:], -0.7, 0.7) * [0, 0, 1]) / 0.2
    rays = far * np.array(view) / np.linalg.norm(view) - points
    return np.asarray((normals * rays).sum(axis=1) / np.linalg.norm(rays, axis=1))


FAR = 10 * float(np.linalg.norm([0.4, 0.4, 1.8]))  # ten diagonals


@pytest.mark.parametrize("view", [(1.0, 0, 0), (1.0, -2.0, 0.7), (0, 0, 1.0)])
def test_of_a_convex_shape_all_of_the_front_is_seen_and_no_back(view: tuple[float, float, float]) -> None:
    points = make_shape(CAPSULE, ShapeParams(count=2000, views=(view,)))[0]
    assert len(points) == 2000
    np.testing.assert_allclose(surface_distance(points, CAPSULE), 0, atol=1e-8)
    turned = facing(points, view, FAR)
    assert turned.min() > -0.01  # the middle of the cloud is that of the shape to a hundredth of its radius
    whole = make_shape(CAPSULE, ShapeParams(count=20_000))[0]
    expected = facing(whole, view, FAR)
    for least in (0.2, 0.5):
        assert (turned > least).mean() == pytest.approx((expected[expected > 0] > least).mean(), abs=0.03)


def test_what_a_body_hides_is_not_seen() -> None:
    """A wall before another wall of the same size."""
    side = np.stack(np.meshgrid(np.linspace(-1, 1, 61), np.linspace(-1, 1, 61)), axis=2).reshape(-1, 2)
    walls = np.concatenate([np.insert(side, 2, z, axis=1) for z in (0.0, -0.5)])
    seen = seen_from(walls, np.array([0, 0, 30.0]))
    inner = np.abs(walls[:, :2]).max(axis=1) < 0.9
    assert seen[inner & (walls[:, 2] == 0)].all()
    assert not seen[inner & (walls[:, 2] < 0)].any()


def test_two_views_see_both_sides_and_share_the_points() -> None:
    views = ((1.0, 0, 0), (-1.0, 0, 0))
    points = make_shape(CAPSULE, ShapeParams(count=1001, views=views))[0]
    assert len(points) == 1001
    assert facing(points[:500], views[0], FAR).min() > -0.01
    assert facing(points[500:], views[1], FAR).min() > -0.01


def test_sensor_noise_is_along_the_ray() -> None:
    settings: dict[str, Any] = {"count": 3000, "views": ((1.0, 0, 0),)}
    clean, noisy = (make_shape(CAPSULE, ShapeParams(**settings, sensor_noise=noise))[0] for noise in (0.0, 0.1))
    moved = noisy - clean
    assert moved[:, 0].std() == pytest.approx(0.02, rel=0.05)  # a tenth of the radius
    # Rays from ten diagonals away differ from x by as much as the points lie beside it: 0.9 in 15.
    assert np.abs(moved[:, 1:]).max() <= 0.1 * np.abs(moved[:, 0]).max()


def test_a_sensor_that_is_near_sees_less_of_a_ball() -> None:
    """From d radii away all is seen whose normal is within arccos(1 / d) of the sensor."""
    egg = named_shape("egg")
    near, far = (
        make_shape(egg, ShapeParams(count=4000, views=((0, 0, 1.0),), sensor_distance=d))[0] for d in (1.0, 50.0)
    )
    assert near[:, 2].min() > far[:, 2].min() + 0.05


@pytest.mark.parametrize("views", [(), ((1.0, -1.0, 1.0),)])
def test_a_quarter_of_the_points_lie_on_the_table(views: tuple[tuple[float, float, float], ...]) -> None:
    points = make_shape(CAPSULE, ShapeParams(count=1000, table=True, views=views))[0]
    flat = np.isclose(points[:, 2], points[:, 2].min(), atol=1e-3)
    assert len(points) == 1000
    assert flat.mean() == pytest.approx(TABLE_SHARE, abs=0.01)
    assert points[:, 2].min() == pytest.approx(-0.9, abs=0.01)  # under the capsule


def test_the_shape_casts_a_shadow_on_the_table() -> None:
    points = make_shape(CAPSULE, ShapeParams(count=4000, table=True, views=((1.0, 0, 1.0),)))[0]
    flat = points[points[:, 2] < -0.895]
    shadow = (np.abs(flat[:, 1]) < 0.1) & (flat[:, 0] < -0.1)  # rays come down at 45 degrees
    beside = (np.abs(flat[:, 1]) < 0.1) & (flat[:, 0] > 0.1)
    assert shadow.sum() < 0.1 * beside.sum()


def test_the_truth_of_a_view_is_the_whole_skeleton() -> None:
    points, truth = make_shape(named_shape("maize"), ShapeParams(count=500, views=((1.0, 0, 0.2),), missing=0.1))
    assert truth.ends == 7
    assert len(points) == len(truth.node_of_point) == 500


def test_the_same_seed_gives_the_same_bytes() -> None:
    settings: dict[str, Any] = {
        "count": 400,
        "views": ((1.0, 1, 0),),
        "sensor_noise": 0.1,
        "table": True,
        "uneven": 3.0,
    }
    one, same, other = (make_shape(CAPSULE, ShapeParams(**settings, seed=s))[0] for s in (1, 1, 2))
    assert one.tobytes() == same.tobytes() != other.tobytes()


@pytest.mark.parametrize(
    "settings",
    [
        {"views": ((0.0, 0, 0),)},
        {"views": ((np.nan, 0, 0),)},
        {"views": ((1.0, 0),)},
        {"views": ((1.0, 0, 0),), "sensor_noise": -1.0},
        {"views": ((1.0, 0, 0),), "sensor_distance": 0.5},
        {"sensor_noise": 0.1},
    ],
)
def test_wrong_settings_are_refused(settings: dict[str, Any]) -> None:
    with pytest.raises(TiskelError):
        ShapeParams(**settings)


def test_more_points_are_sampled_until_a_sensor_sees_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of as many points as are wanted it sees less than half; a limit ends the search."""
    sampled: list[int] = []
    points = make_shape(CAPSULE, ShapeParams(count=8000))[0]

    def sample(count: int) -> Any:
        sampled.append(count)
        return points[:count]

    scene = views.Scene(sample=sample, inside=lambda places: np.zeros(len(places), bool), distance=10.0, noise=0.0,
                        table=False)  # fmt: skip
    monkeypatch.setattr(views, "LEAST", 1000)
    monkeypatch.setattr(views, "DENSE", 1)
    seen = views.scan(scene, 1500, ((1.0, 0, 0),), np.random.default_rng(0))
    assert sampled == [1500, 3000, 6000][: len(sampled)]
    assert len(sampled) > 1
    assert seen.shape == (1500, 3)
    assert seen[:, 0].mean() > 0.05  # the side that faces it
    monkeypatch.setattr(views, "MOST", 2000)
    with pytest.raises(TiskelError, match=r"a sensor towards \(1\.0, 0, 0\), 10\.0 diagonals away, sees too little; m"):
        views.scan(scene, 1500, ((1.0, 0, 0),), np.random.default_rng(0))
