"""Wires: limbs thinner than the points are apart, whose nodes can have radius zero."""

from pathlib import Path

import numpy as np
import pytest

from tiskel import contract, extract_skeleton, load_cloud
from tiskel.arrays import Points

STEP = 0.1  # between the points of a twig
SEEDS = (171, 0, 1, 2)  # of these the first divided by a radius of zero


def forking_twigs(seed: int) -> Points:
    """Return 20 to 150 points that lie exactly on straight, forking twigs."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(20, 150))
    points = [np.zeros(3)]
    tips = [(np.zeros(3), np.array([0.0, 0.0, 1.0]))]
    while len(points) <= count:
        forks = []
        for place, direction in tips:
            for _ in range(int(rng.integers(2, 6))):
                place = place + STEP * direction  # noqa: PLW2901
                points.append(place)
            for _ in range(int(rng.integers(1, 4))):
                bent = direction + rng.normal(0, 0.6, 3)
                forks.append((place, bent / np.linalg.norm(bent)))
        tips = forks[:30]
    return np.array(points[:count])


@pytest.mark.parametrize("seed", SEEDS)
def test_nodes_of_radius_zero_are_no_crash(seed: int) -> None:
    skeleton = extract_skeleton(contract(forking_twigs(seed)))
    assert np.isfinite(skeleton.nodes).all()
    assert np.isfinite(skeleton.radius).all()


@pytest.mark.parametrize("name", ["twigs", "crash_54points"])
def test_reported_twigs_are_no_crash(cases_folder: Path, name: str) -> None:
    skeleton = extract_skeleton(contract(load_cloud(cases_folder / f"{name}.xyz").points))
    assert skeleton.components == 1
