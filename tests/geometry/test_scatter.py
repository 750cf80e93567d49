"""Clouds that are no scans of bodies are told in words; scans and generated bodies are not."""

from pathlib import Path

import numpy as np
import pytest

from tiskel import ShapeParams, TiskelError, contract, load_cloud, make_shape, shape_graph
from tiskel.geometry.scatter import doubts_about

BODY = make_shape(shape_graph("hand"), ShapeParams(count=2000))[0]
RANDOM = np.random.default_rng(5)
SWARMS = {
    "swarm": (RANDOM.normal(size=(1500, 3)), "like a swarm"),
    "outliers": (
        np.concatenate([BODY, RANDOM.uniform(-20, 20, (600, 3))]),
        "23% of the points are far from all others",
    ),
    "copies": (np.concatenate([BODY, BODY + 1e-5 * RANDOM.normal(size=BODY.shape)]), "two copies"),
}


@pytest.mark.parametrize("name", SWARMS)
def test_what_is_no_scan_is_told(name: str) -> None:
    points, said = SWARMS[name]
    assert said in " ".join(contract(points).warnings)


@pytest.mark.parametrize("name", ["dumbbell", "tree", "egg"])
@pytest.mark.parametrize("settings", [{}, {"noise": 0.05}, {"uneven": 10.0}])
def test_bodies_are_not(name: str, settings: dict[str, float]) -> None:
    assert doubts_about(make_shape(shape_graph(name), ShapeParams(count=1500, **settings))[0]) == ()  # type: ignore[arg-type]


def test_filled_bodies_are_not() -> None:
    assert doubts_about(RANDOM.random((3000, 3))) == ()


def test_real_clouds_are_not(reference_folder: Path, cases_folder: Path) -> None:
    files = [*(reference_folder / "clouds").glob("*.ply"), *cases_folder.glob("*.xyz")]
    for path in files:
        points = load_cloud(path).points
        assert doubts_about(np.unique(points[np.isfinite(points).all(axis=1)], axis=0)) == (), path.name


def test_a_quarter_of_outliers_and_a_gaussian_cloud_of_reported_trouble(cases_folder: Path) -> None:
    for name, said in (("outliers_many", "25% of the points are far"), ("gauss", "like a swarm"), ("pairs", "a twin")):
        assert said in " ".join(doubts_about(np.load(cases_folder / "broken" / f"{name}.npy"))), name


@pytest.mark.parametrize("scale", [1e160, 1e300])
def test_numbers_whose_squares_overflow_are_refused(scale: float) -> None:
    with pytest.raises(TiskelError, match="coordinates reach"):
        contract(BODY / np.abs(BODY).max() * scale)


@pytest.mark.parametrize("scale", [1e140, 1e-140])
def test_large_and_small_numbers_give_the_same_curve(scale: float) -> None:
    from tiskel import extract_skeleton

    small = BODY[::4]
    assert extract_skeleton(contract(small * scale)).ends == extract_skeleton(contract(small)).ends
