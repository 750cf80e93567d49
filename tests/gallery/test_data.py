"""The sample clouds are what data/README.md says they are."""

import json
from pathlib import Path

import numpy as np
import pytest

from tiskel import load_cloud, shape_graph
from tiskel.geometry.round_cones import union_distance

DATA = Path(__file__).parents[2] / "data"


@pytest.mark.parametrize("name", ["banana", "hand", "torus", "quadruped-scan"])
def test_sample_clouds_lie_on_their_shapes(name: str) -> None:
    points = load_cloud(DATA / f"{name}.ply").points
    shape = shape_graph(name.removesuffix("-scan"))
    assert len(points) == 4096
    noise = 0.05 * shape.radii.min() if name.endswith("-scan") else 0.0
    # Isotropic noise leaves the surface with its own deviation; five of them hold for 4096 points.
    assert np.abs(union_distance(points, shape)).max() <= 5 * noise + 1e-8
    truth = json.loads((DATA / f"{name}.skeleton.json").read_text())
    np.testing.assert_array_equal(truth["nodes"], shape.nodes)
    np.testing.assert_array_equal(truth["edges"], shape.edges)
