"""The demonstrations of benchmarks/demonstrations.py show what they should."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

SCRIPT = Path(__file__).parents[2] / "benchmarks" / "demonstrations.py"


@pytest.fixture(scope="module")
def demonstrations() -> ModuleType:
    spec = importlib.util.spec_from_file_location("demonstrations", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["demonstrations"] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", ["capsule", "torus", "y"])
def test_a_cut_makes_a_long_bar_and_a_bend_does_not(name: str, demonstrations: ModuleType) -> None:
    """The cut is 0.25 wide in a shape of 1.8 that is scaled to 1.6; every other bar is of the spacing."""
    *_, bars = demonstrations.bars(name)
    assert bars.cut[0] == pytest.approx(
        0.25 * 1.6 / 1.8, abs=0.03
    )  # within a spacing, the nearest points face each other
    assert bars.whole[0] < 0.1
    assert bars.bent[0] < 0.1
    cut, bent = bars.distances
    assert cut > 4 * bent
    assert bent < 0.02  # d*: similar topology
    assert cut > 0.02


def test_the_ellipse_keeps_the_centre_that_the_barycentre_loses(demonstrations: ModuleType) -> None:
    by_ellipse, by_mean = (np.nanmedian(values, axis=1) for values in demonstrations.centres())
    assert (by_ellipse < by_mean / 5).all()
    assert (np.diff(by_mean) > 0).all()
    assert by_mean[-1] > 0.8
    assert by_ellipse[-1] < 0.1


def test_smoothness_tells_a_bend_in_one_place_from_waves_all_along(demonstrations: ModuleType) -> None:
    straight, bent, wavy = (smooth for _, smooth in demonstrations.lines().values())
    assert straight.min() > 0.999
    assert bent.mean() > 0.95
    assert np.abs(np.flatnonzero(bent < 0.9) - 80).max() <= 8  # eight neighbours reach four to each side, theirs again
    assert wavy.mean() < 0.7


@pytest.mark.parametrize("name", ["bars.png", "centres.png", "lines.png"])
def test_the_pictures_are_drawn(name: str, demonstrations: ModuleType) -> None:
    assert demonstrations.PICTURES[name]().startswith(b"\x89PNG")
