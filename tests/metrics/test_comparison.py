"""Two curves held against each other, in cases that are known."""

import json
from dataclasses import replace

import numpy as np
import pytest

from tiskel import CurveGraph, compare, shape_graph
from tiskel.metrics.repeatability import repeatability

Y = shape_graph("y")


def test_a_shift_is_the_distance_both_ways() -> None:
    found = compare(Y, replace(Y, nodes=Y.nodes + [0, 0.07, 0]))
    assert found.there is not None
    assert found.back is not None
    for way in (found.there, found.back):
        assert (way.mean, way.median, way.p95, way.largest) == pytest.approx((0.07,) * 4)
    assert found.lengths == pytest.approx((Y.length, Y.length))
    assert found.same_graph


def test_what_only_one_has_is_far_from_the_other_alone() -> None:
    line = CurveGraph(np.array([[0.0, 0, 0], [10, 0, 0]]), np.array([[0, 1]], np.int32))
    half = CurveGraph(np.array([[0.0, 0, 0], [5, 0, 0]]), np.array([[0, 1]], np.int32))
    found = compare(line, half)
    assert found.back is not None
    assert found.there is not None
    assert found.back.largest == pytest.approx(0, abs=1e-9)
    assert found.there.mean == pytest.approx(1.25, rel=1e-3)  # half of it is 0 to 5 away
    assert found.there.median == pytest.approx(0, abs=0.02)
    assert found.there.largest == pytest.approx(5, rel=1e-2)
    assert (found.lengths, found.ends, found.loops) == ((10, 5), 0, 0)


def test_it_says_what_repeatability_says_and_is_json() -> None:
    torus = shape_graph("torus")
    found = compare(Y, torus)
    told = json.loads(json.dumps(found.as_dict(), allow_nan=False))
    assert told.items() >= repeatability(Y, torus).as_dict().items()
    assert set(told) - set(repeatability(Y, torus).as_dict()) == {"lengths", "there", "back"}
    assert (found.loops, found.ends) == (1, -3)


def test_without_length_there_is_no_distance() -> None:
    nothing = CurveGraph(np.zeros((0, 3)), np.zeros((0, 2), np.int32))
    found = compare(Y, nothing)
    assert found.there is found.back is None
    assert repr(found) == "<Comparison same_graph=False lengths=(2.738, 0) there=None back=None tips=0>"
