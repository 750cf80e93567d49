"""Contraction by fronts: neighbours along the surface, sections across the limbs, and their axes."""

import numpy as np
import pytest

from tiskel import ContractionParams, ShapeParams, TiskelError, contract, make_shape, shape_graph
from tiskel.arrays import Numbers, Points
from tiskel.methods.robust.axes import line_centres
from tiskel.methods.robust.fronts import cut
from tiskel.methods.robust.network import neighbour_network


def tube(turns: np.ndarray, heights: np.ndarray) -> tuple[Points, Points]:
    """Points and normals on a cylinder of radius one about the z axis."""
    turn, height = (a.ravel() for a in np.meshgrid(turns, heights))
    normals = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    return normals + height[:, None] * [0, 0, 1], normals


@pytest.mark.parametrize("extent", [2 * np.pi, np.pi, np.pi / 2])
def test_the_centre_of_a_ring_and_of_an_arc_lies_on_the_axis(extent: float) -> None:
    points, normals = tube(np.linspace(0, extent, 40, endpoint=False), np.linspace(-0.2, 0.2, 5))
    centre, size = line_centres(points, normals, np.zeros(len(points), np.int32), 1)
    assert size[0] == len(points)
    # Along its bisector an arc's lines hold the centre with the mean of their squared sines; the mean pulls with 0.05.
    held = 0.5 - np.sin(extent) / (2 * extent)
    mean = np.linalg.norm(points.mean(axis=0))
    assert np.linalg.norm(centre[0]) == pytest.approx(0.05 / (0.05 + held) * mean, rel=0.02, abs=1e-9)


def test_the_centre_of_a_cap_is_the_middle_of_its_ball() -> None:
    normals = np.random.default_rng(0).normal(size=(400, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    normals = normals[normals[:, 2] > 0.3]
    centre, _ = line_centres(5 + 2 * normals, normals, np.zeros(len(normals), np.int32), 1)
    assert np.linalg.norm(centre[0] - 5) < 0.25  # an eighth of the radius: the pull to the mean, which is 1.3 away


def test_centres_are_the_least_squares_of_their_definition() -> None:
    generator = np.random.default_rng(1)
    points, normals = generator.normal(size=(2, 60, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    label = np.arange(60, dtype=np.int32) % 4
    centre, _ = line_centres(points, normals, label, 5)
    for number in range(4):
        p, n = points[label == number], normals[label == number]
        across = np.eye(3) - n[:, :, None] * n[:, None, :]
        rows = np.concatenate([across, np.broadcast_to(np.sqrt(0.05) * np.eye(3), across.shape)]).reshape(-1, 3)
        right = np.concatenate(
            [np.einsum("nij,nj->ni", across, p), np.sqrt(0.05) * np.broadcast_to(p.mean(0), p.shape)]
        )
        np.testing.assert_allclose(centre[number], np.linalg.lstsq(rows, right.ravel(), rcond=None)[0], atol=1e-10)
    np.testing.assert_array_equal(centre[4], 0)  # a set without points


def test_neighbours_do_not_cross_a_narrow_gap() -> None:
    grid = np.stack(np.meshgrid(np.arange(30.0), np.arange(30.0)), axis=-1).reshape(-1, 2)
    grid = grid + np.random.default_rng(0).normal(size=grid.shape) * 0.1
    sheets = np.concatenate([np.c_[grid, np.zeros(900)], np.c_[grid + 0.3, np.full(900, 2.0)]])
    network = neighbour_network(sheets, 14)
    assert (network.neighbours[:900] >= 900).any()  # some are among the nearest
    inner = np.asarray(
        ((sheets[:, :2] > 4) & (sheets[:, :2] < 25)).all(axis=1)
    )  # at a rim the plane of the neighbours tilts
    edges = network.edges[inner[network.edges].all(axis=1)]
    joined = ((edges < 900).sum(axis=1) == 1).sum()
    assert joined < 0.1 * (network.neighbours[:900][inner[:900]] >= 900).sum()
    near = neighbour_network(np.concatenate([np.c_[grid, np.zeros(900)], np.c_[grid + 0.3, np.full(900, 9.0)]]), 14)
    assert network.spacing == pytest.approx(near.spacing, rel=0.1) == pytest.approx(1, rel=0.1)
    # disc areas: of a flat even sheet one each, a little more at its rim
    assert float(np.median(near.areas)) == pytest.approx(1, rel=0.15)


def test_a_network_knows_each_edge_once_and_averages_over_neighbours(capsule: Points) -> None:
    network = neighbour_network(capsule, 14)
    assert (network.edges[:, 0] < network.edges[:, 1]).all()
    assert len(np.unique(network.edges, axis=0)) == len(network.edges)
    np.testing.assert_allclose(
        network.lengths, np.linalg.norm(capsule[network.edges[:, 0]] - capsule[network.edges[:, 1]], axis=1)
    )
    at = 17
    around = np.unique(network.edges[(network.edges == at).any(axis=1)])  # the point itself among them
    values = np.arange(len(capsule), dtype=float)
    assert (network.averaging @ values)[at] == pytest.approx(around.mean())


def test_sections_are_the_connected_pieces_of_each_stride(capsule: Points) -> None:
    network = neighbour_network(capsule, 14)
    height = (capsule[:, 2] - capsule[:, 2].min()) * 5
    height[:3] = np.nan
    sections = cut(network, height)
    assert (sections.section[:3] == -1).all()
    assert (sections.level[:3] == -1).all()
    np.testing.assert_array_equal(sections.level[3:], np.floor(height[3:]))
    first = [int(sections.level[sections.section == s][0]) for s in range(sections.count)]
    assert first == sorted(first)
    for s in range(sections.count):
        assert len(set(sections.level[sections.section == s])) == 1
    linked = sections.level[network.edges[:, 0]] == sections.level[network.edges[:, 1]]
    np.testing.assert_array_equal(*sections.section[network.edges[linked]].T)


@pytest.mark.parametrize(("name", "most"), [("torus", 0.1), ("helix", 0.1), ("capsule", 0.1), ("knot", 0.1)])
def test_points_contract_to_the_axis(name: str, most: float) -> None:
    """In local radii, in the middle: published contraction leaves 0.27 to 0.9 on bent tubes."""
    from scipy.spatial import cKDTree

    from tiskel.metrics.truth import true_places

    shape = shape_graph(name)
    c = contract(make_shape(shape)[0])
    places, radii = true_places(shape)
    distance, nearest = cKDTree(places).query(c.points)
    assert float(np.median(distance / radii[nearest])) < most
    ratios = [step.ring_ratio for step in c.steps]
    assert max(ratios) < 0.5
    assert len(ratios) == len(c.history) == 3
    np.testing.assert_array_equal(c.history[-1], c.points)


def test_fewer_steps_can_be_asked_for(capsule: Points) -> None:
    assert len(contract(capsule, ContractionParams(max_steps=1)).steps) == 1


def test_every_point_is_left_and_knows_its_section(capsule: Points) -> None:
    c = contract(np.concatenate([capsule, capsule[:5]]))
    assert c.sections is not None
    assert len(c.points) == len(c.sections.section) == len(c.sections.level) == len(capsule)
    assert (c.merged_step >= 0).sum() == 5
    assert c.sections.section.min() == 0


def test_debris_has_no_section(capsule: Points) -> None:
    stray = np.random.default_rng(0).normal(size=(6, 3)) * 0.01 + [3, 0, 0]
    c = contract(np.concatenate([capsule, stray]))
    assert c.sections is not None
    np.testing.assert_array_equal(np.flatnonzero(c.sections.section < 0), len(capsule) + np.arange(6))


def test_lbc_and_gls_have_no_sections_and_take_weights(capsule: Points) -> None:
    for params in (ContractionParams(method="lbc", max_steps=1), ContractionParams(method="gls", max_steps=1)):
        plain, same = contract(capsule, params), contract(capsule, params, np.ones(len(capsule)))
        assert plain.sections is None
        np.testing.assert_array_equal(plain.points, same.points)


def test_a_heavier_part_contracts_further(capsule: Points) -> None:
    """S-LBC: the upper half, with ten times the weight, comes closer to the axis; the lower hardly changes."""
    upper = capsule[:, 2] > 0
    params = ContractionParams(method="lbc", max_steps=1)
    away = [
        np.linalg.norm(contract(capsule, params, weights).points[:, :2], axis=1)
        for weights in (None, np.where(upper, 10.0, 1.0))
    ]
    inner, outer = capsule[:, 2] > 0.2, capsule[:, 2] < -0.2
    assert away[1][inner].mean() < 0.7 * away[0][inner].mean()
    assert away[1][outer].mean() == pytest.approx(away[0][outer].mean(), rel=0.05)


@pytest.mark.parametrize(
    ("method", "weights", "message"),
    [
        ("robust", np.ones(800), "method robust takes no weights"),
        ("lbc", np.ones(3), "one number for each of the 800 points"),
        ("lbc", np.zeros(800), "positive and finite"),
        ("gls", np.full(800, np.nan), "positive and finite"),
    ],
)
def test_weights_that_do_not_fit_are_refused(capsule: Points, method: str, weights: Numbers, message: str) -> None:
    with pytest.raises(TiskelError, match=message):
        contract(capsule, ContractionParams(method=method), weights)


def test_two_bodies_have_a_front_each() -> None:
    one = make_shape(shape_graph("capsule"), ShapeParams(count=700))[0]
    c = contract(np.concatenate([one, one + [1, 0, 0]]))
    assert c.sections is not None
    assert not set(c.sections.section[:700]) & set(c.sections.section[700:])
