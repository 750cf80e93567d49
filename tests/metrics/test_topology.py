"""Barcodes and their distances: exact, and what they say of simple shapes."""

from importlib import import_module

import gudhi.hera
import numpy as np
import persim
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from ripser import ripser
from scipy.optimize import linear_sum_assignment

from reference.fixtures import Load
from tiskel import MetricParams, ShapeParams, TiskelError, make_shape, shape_graph
from tiskel.arrays import Numbers, Points
from tiskel.geometry.graph import CurveGraph
from tiskel.metrics.barcode import barcode, delaunay_edges
from tiskel.metrics.distances import bottleneck, wasserstein
from tiskel.metrics.topology import bars_kept, compare_topology

GENERATOR = np.random.default_rng(2)
deaths = st.lists(st.floats(0, 10), max_size=12).map(lambda bars: np.array(bars, float))


def dense_deaths(points: Points) -> Numbers:
    bars = np.asarray(ripser(points, maxdim=0)["dgms"][0][:, 1], float)
    finite = np.sort(bars[np.isfinite(bars)])[::-1]
    return np.concatenate([finite, np.zeros(len(points) - 1 - len(finite))])


CLOUDS = {
    "ball": GENERATOR.normal(size=(300, 3)),
    "line": np.outer(np.sort(GENERATOR.random(60)), [1.0, 2, 3]),
    "plane": GENERATOR.random((80, 3)) * [1, 1, 0] + [0, 0, 5],
    "far away": GENERATOR.random((100, 3)) + 1e5,
    "grid": np.stack(np.meshgrid(*[np.arange(5.0)] * 3), axis=-1).reshape(-1, 3),
    "duplicates": np.repeat(GENERATOR.random((40, 3)), 3, axis=0),
    "one place": np.ones((7, 3)),
    "two": np.array([[0.0, 0, 0], [3, 4, 0]]),
}


@pytest.mark.parametrize("name", CLOUDS)
def test_bars_are_those_of_the_dense_matrix(name: str) -> None:
    points = CLOUDS[name]
    # ripser works in single precision, relative to the coordinates
    tolerance = 1e-6 * max(1.0, np.abs(points).max() if name == "far away" else np.ptp(points, axis=0).max())
    np.testing.assert_allclose(barcode(points).deaths, dense_deaths(points), atol=tolerance)


def without_core(name: str) -> object:
    """Import a module, of a release of ripser whose compiled part is another."""
    return object() if name == "pyRipser" else import_module(name)


@pytest.mark.parametrize("name", ["ball", "plane", "grid", "duplicates", "two"])
def test_loops_are_those_of_the_module_about_the_compiled_part(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    quick = barcode(CLOUDS[name], loops=True).cycles
    monkeypatch.setattr("tiskel.metrics.barcode.import_module", without_core)
    np.testing.assert_array_equal(barcode(CLOUDS[name], loops=True).cycles, quick)


@pytest.mark.parametrize("name", CLOUDS)
def test_delaunay_edges_connect_every_point(name: str) -> None:
    """Also those that the triangulation drops because they coincide with others."""
    points = CLOUDS[name]
    assert CurveGraph(points, delaunay_edges(points)).components == 1


def test_contracted_clouds_have_the_bars_of_the_dense_matrix(toolbox: Load) -> None:
    for name in ("hammer_gls", "horse_lbc"):
        points = toolbox(name)["contracted"]
        np.testing.assert_allclose(barcode(points).deaths, dense_deaths(points), atol=1e-6)


def test_no_point_and_one_point_have_no_bar() -> None:
    assert len(barcode(np.zeros((0, 3))).deaths) == len(barcode(np.zeros((1, 3)), loops=True).cycles) == 0
    assert delaunay_edges(np.zeros((1, 3))).shape == (0, 2)


def assigned(a: Numbers, b: Numbers) -> float:
    """The textbook's assignment: n bars and m places on the diagonal against m bars and n places on the diagonal."""
    if len(a) + len(b) == 0:
        return 0.0
    cost = np.zeros((len(a) + len(b), len(a) + len(b)))
    cost[: len(a), : len(b)] = np.abs(a[:, None] - b)
    cost[: len(a), len(b) :] = a[:, None] / 2
    cost[len(a) :, : len(b)] = b / 2
    return float(cost[linear_sum_assignment(cost)].sum())


@given(deaths, deaths)
@example(np.array([1.0, 3.0]), np.array([3.0, 3.0, 4.0, 3.0]))  # 1.5; gudhi.bottleneck_distance 3.13 says 2
@settings(max_examples=200, deadline=None)
@pytest.mark.filterwarnings("ignore:dgm. has points with non-finite:UserWarning")
def test_distances_equal_those_of_other_libraries(a: Numbers, b: Numbers) -> None:
    diagrams = [np.stack([np.zeros(len(d)), d], axis=1) for d in (a, b)]
    assert bottleneck(a, b) == pytest.approx(persim.bottleneck(*diagrams), abs=1e-9)
    assert wasserstein(a, b) == pytest.approx(assigned(a, b), abs=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_distances_of_long_barcodes_equal_those_of_hera(seed: int) -> None:
    generator = np.random.default_rng(seed)
    a, b = generator.gamma(2, size=150), generator.gamma(1.5, size=120)
    diagrams = [np.stack([np.zeros(len(d)), d], axis=1) for d in (a, b)]
    assert bottleneck(a, b) == pytest.approx(gudhi.hera.bottleneck_distance(*diagrams, delta=1e-3), rel=1.1e-3)
    near = gudhi.hera.wasserstein_distance(*diagrams, order=1, internal_p=np.inf, delta=1e-3)
    assert wasserstein(a, b) == pytest.approx(near, rel=1.1e-3)  # hera promises its delta, relative


@given(deaths, deaths)
@settings(max_examples=100, deadline=None)
def test_distances_are_symmetric_and_the_diagonal_only_helps(a: Numbers, b: Numbers) -> None:
    for distance in (bottleneck, wasserstein):
        assert distance(a, b) == pytest.approx(distance(b, a), abs=1e-12)
        assert distance(a, a) == pytest.approx(0, abs=1e-12)
        if len(a) == len(b):
            assert distance(a, b) <= distance(a, b, diagonal=False) + 1e-12


def test_a_bijection_of_unequal_counts_is_refused() -> None:
    with pytest.raises(TiskelError, match="2 bars cannot be matched to 1"):
        bottleneck(np.ones(2), np.ones(1), diagonal=False)


def test_two_far_components_are_one_long_bar() -> None:
    """The gap of 7 stands out; within a component the bars are of the spacing."""
    one = make_shape(shape_graph("capsule"), ShapeParams(count=500))[0]
    other = one + [7.4, 0, 0]  # two radii of 0.2 less: a gap of 7
    bars = barcode(np.concatenate([one, other])).deaths
    assert bars[0] == pytest.approx(7, abs=0.1)  # the nearest samples lie that far inside the extreme points
    assert bars[1] < 0.2


def test_a_torus_has_two_lasting_loops_on_its_surface() -> None:
    cycles = barcode(make_shape(shape_graph("torus"), ShapeParams(count=3000))[0], loops=True).cycles
    ratio = cycles[:, 1] / cycles[:, 0]
    assert (ratio[:2] > 5).all()
    assert ratio[2] < 4
    # The tube's loop dies when its section, of radius 0.2, is filled; that of the hole, of radius 0.5, likewise: at the
    # side of the largest triangle in the circle, which the sampling misses by its spacing of 0.04.
    assert sorted(cycles[:2, 1]) == pytest.approx([0.2 * 3**0.5, 0.5 * 3**0.5], abs=0.05)


def test_rules_for_the_bars_that_count() -> None:
    points = np.concatenate([np.outer(np.arange(100.0), [1, 0, 0]), np.outer(np.arange(100.0), [1, 0, 0]) + [0, 9, 0]])
    bars = barcode(points).deaths
    assert bars_kept(points, bars, "max") == 1
    assert bars_kept(points, bars, "toolbox") == 10  # one is longer than the spacing, 5 % of 199 are more


def test_the_printed_rule_is_null_with_its_reason_on_a_well_sampled_object() -> None:
    points = CLOUDS["grid"]
    bars = barcode(points).deaths
    compared = compare_topology(points, bars, bars, MetricParams(bars="max"))
    assert compared.bottleneck is compared.wasserstein is compared.similar is None
    assert "longer than the largest nearest-neighbour distance" in compared.reason
    assert compare_topology(points, bars, bars, MetricParams()).similar is True


def test_fewer_skeletal_bars_are_compared_unless_a_bijection_is_asked_for() -> None:
    generator = np.random.default_rng(2)
    points = generator.random((300, 3))
    bars = barcode(points).deaths
    assert compare_topology(points, bars, bars[:3], MetricParams()).bottleneck is not None
    assert "no bijection" in compare_topology(points, bars, bars[:3], MetricParams(diagonal=False)).reason
