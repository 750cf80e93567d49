"""Which ways along a curve are fitted: the longest, all, one of a number; and ends that lie in a face."""

import numpy as np
import pytest

from tiskel import TiskelError
from tiskel.arrays import Edges, Points
from tiskel.geometry.graph import CurveGraph
from tiskel.params import SurfaceParams
from tiskel.slicing.paths import longest_path, paths_of
from tiskel.slicing.rings import Ring
from tiskel.slicing.sections import Case, fit_section
from tiskel.slicing.series import fit_sections


def round_about(sizes: list[tuple[float, int]]) -> CurveGraph:
    """Circles of so many nodes, apart from one another."""
    nodes: list[Points] = []
    edges: list[Edges] = []
    start = 0
    for number, (radius, count) in enumerate(sizes):
        turn = np.arange(count) * 2 * np.pi / count
        nodes.append(np.stack([radius * np.cos(turn) + 10 * number, radius * np.sin(turn), 0 * turn], axis=1))
        ring = start + np.arange(count)
        edges.append(np.sort(np.stack([ring, np.roll(ring, -1)], axis=1), axis=1).astype(np.int32))
        start += count
    return CurveGraph(np.concatenate(nodes), np.concatenate(edges))


def test_of_loops_alone_the_longest_is_taken() -> None:
    """The second is longer, though it has fewer nodes and comes after the first."""
    path = longest_path(round_about([(1.0, 12), (2.0, 8), (0.5, 20)]))
    assert path[0] == path[-1]
    assert sorted(path[:-1].tolist()) == list(range(12, 20))


def test_a_curve_without_nodes_is_refused_and_one_without_edges_is_a_line() -> None:
    none = np.zeros((0, 2), np.int32)
    with pytest.raises(TiskelError, match="the skeleton has no nodes; run tiskel skeleton again"):
        paths_of(CurveGraph(np.zeros((0, 3)), none), "all")
    (line,) = paths_of(CurveGraph(np.eye(3), none), "longest")
    assert line.nodes.tolist() in ([0, 1, 2], [2, 1, 0])
    with pytest.raises(TiskelError, match="there is no branch 3; the skeleton has 3, from 0 to 2"):
        paths_of(round_about([(1.0, 5)] * 3), "3")


def face(v: float, rim: float, count: int = 400) -> tuple[float, Ring]:
    """A slice in the flat end of a bar: a filled disc whose rim is uneven by a share of its radius."""
    rng = np.random.default_rng(0)
    u, r = rng.uniform(0, 2 * np.pi, count), np.sqrt(rng.uniform(0, 1, count))
    edge = 1 + rim * np.sign(np.sin(9 * u))
    return v, Ring(np.arange(count, dtype=np.int32), u, np.full(count, v), r * edge)


def test_slices_in_faces_are_fitted_to_their_rims_where_these_are_smooth() -> None:
    """Without a slice that is fitted in between, both ways along the curve come to its other end."""
    params = SurfaceParams()
    smooth = [face(v, 0.0) for v in (0.0, 1.0, 2.0)]
    assert {fit_section(v, ring, 3, params).case for v, ring in smooth}.isdisjoint({Case.FITTED})
    fitted = fit_sections(smooth, 3, params)
    assert [section.case for section in fitted] == [Case.FITTED] * 3
    assert [section.series[0] for section in fitted] == pytest.approx(
        [0.9] * 3, abs=0.02
    )  # the middle of what counts as rim
    rough = fit_sections([face(v, 0.45) for v in (0.0, 1.0)], 1, params)
    assert not any(section.case is Case.FITTED for section in rough)
    assert [section.points for section in rough] == [400, 400]  # those of the whole slices, not of their rims
    assert not any(section.case is Case.FITTED for section in fit_sections(smooth, 3, params, closed=True))
