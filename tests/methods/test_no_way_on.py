"""Where contraction and the joining of pieces cannot go on: what is returned then, and what is said."""

import sys
from typing import Any

import numpy as np
import pytest
from scipy import sparse

from tiskel import GlsParams, LbcParams, ShapeParams, TiskelError, contract, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.geometry.solve import SingularStep, contracted
from tiskel.methods.laplacian.gls import contract_gls
from tiskel.methods.laplacian.lbc import contract_lbc
from tiskel.methods.laplacian.toolbox_gls import contract_as_toolbox
from tiskel.methods.laplacian.toolbox_rings import merged_ring, walk
from tiskel.methods.robust.curve import ConeCurve
from tiskel.methods.robust.pieces import CROWN, joined_pieces
from tiskel.methods.robust.wire.links import WIDEST
from tiskel.methods.trace import Status

TOO_MUCH = 1e200  # its square is no number any more
ALONG = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]])
CHAIN = sparse.csr_array(np.array([[-1.0, 1, 0], [1, -2, 1], [0, 1, -1]]))


@pytest.fixture(scope="module")
def capsule() -> Points:
    return make_shape(shape_graph("capsule"), ShapeParams(count=300))[0]


def test_a_step_pulls_points_together_and_one_that_has_no_solution_is_singular() -> None:
    """With attraction 0 for all, any shift of the points is a solution."""
    near = contracted(CHAIN, 1.0, np.ones(3), ALONG, "scipy")
    np.testing.assert_allclose((CHAIN.T @ CHAIN + np.eye(3)) @ near, ALONG, atol=1e-12)
    with pytest.raises(SingularStep):
        contracted(CHAIN, TOO_MUCH, np.ones(3), ALONG, "scipy")
    with pytest.raises(SingularStep):
        contracted(CHAIN, 1.0, np.ones(3), ALONG * [np.nan, 1, 1], "scipy")
    with pytest.raises(SingularStep):
        contracted(CHAIN * 0, 1.0, np.zeros(3), ALONG, "scipy")


def test_without_cvxopt_the_solver_that_needs_it_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cvxopt", None)
    with pytest.raises(TiskelError, match=r"needs cvxopt; install it with: pip install 'tiskel\[cholmod\]'"):
        contracted(CHAIN, 1.0, np.ones(3), ALONG, "cholmod")


@pytest.mark.parametrize(
    ("steps", "params"),
    [
        (contract_lbc, LbcParams(contraction_weight=TOO_MUCH)),
        (contract_gls, GlsParams(contraction_weight=TOO_MUCH)),
        (contract_as_toolbox, GlsParams(variant="toolbox", contraction_weight=TOO_MUCH)),
    ],
    ids=["lbc", "gls", "toolbox"],
)
def test_a_first_step_that_is_singular_ends_it(steps: Any, params: Any, capsule: Points) -> None:
    """The weight ended in an OverflowError."""
    with pytest.raises(TiskelError, match="failed in its first step: a step had no finite solution and was discarded"):
        contract(capsule, params)
    trace = steps(capsule, params)
    assert trace.status is Status.SINGULAR
    assert len(trace.steps) == 0
    np.testing.assert_array_equal(trace.points, capsule)


def test_a_step_that_grows_the_box_is_discarded_unless_it_is_the_first(capsule: Points) -> None:
    """Of what is allowed to grow to a hundredth only, every step grows too much."""
    trace = contract_lbc(capsule, LbcParams(box_growth=0.01))
    assert trace.status is Status.BOX_GREW
    assert len(trace.steps) == 1
    np.testing.assert_array_equal(trace.points, trace.history[0][1])


def test_the_first_weight_is_the_one_that_is_given(capsule: Points) -> None:
    given, own = (contract(capsule, LbcParams(contraction_weight=w, max_steps=1)) for w in (3.5, None))
    assert given.steps[0].contraction_weight == 3.5
    assert own.steps[0].contraction_weight != 3.5


def test_the_toolbox_stops_at_its_last_step_and_reduces_no_more_once_nothing_merged(capsule: Points) -> None:
    """With a low threshold the fourth reduction merges nothing, so there is no fifth."""
    short = contract(capsule, GlsParams(variant="toolbox", max_steps=2))
    assert short.status is Status.MAX_STEPS
    assert [step.points < 300 for step in short.steps] == [True, True]
    steps = contract(capsule, GlsParams(variant="toolbox", phi=1e-300, theta=1e-12)).steps
    lost = -np.diff([300, *(step.points for step in steps)])
    first = lost.tolist().index(0)
    assert 0 < first < len(steps) - 1
    assert not lost[first:].any()
    assert ["reduce" in step.seconds for step in steps] == [number <= first for number in range(len(steps))]


def test_a_pair_with_no_other_neighbours_has_no_ring() -> None:
    assert merged_ring(np.eye(3), 0, 1, [[1], [0], []], np.zeros(3)) == []


def test_without_a_direction_points_are_projected_along_their_thinnest_axis() -> None:
    """A ring of six about a point, in a plane that is not square to any axis."""
    turn = np.arange(6) * np.pi / 3
    flat = np.concatenate([[[0.05, 0.02], [0.1, 0]], np.stack([np.cos(turn), np.sin(turn)], axis=1)])
    across = np.array([[2.0, 1, 0], [0, 1, 3]]) / [[np.sqrt(5)], [np.sqrt(10)]]
    ring = merged_ring(flat @ across, 0, 1, [list(range(2, 8)), list(range(2, 8)), *([[]] * 6)], np.zeros(3))
    assert sorted(ring[:-1]) == list(range(2, 8))
    assert {(b - a) % 6 for a, b in zip(ring, ring[1:], strict=False)} in ({1}, {5})


def test_a_point_that_qhull_leaves_out_of_all_triangles_has_no_ring() -> None:
    """Between its neighbours to within what Qhull joggles by; its triangles are (1, 3, 4) and (1, 2, 4)."""
    assert walk(np.array([[0, 3], [0, 3 + 1e-7], [-1e-7, 3], [1e-7, 3], [-2, -2]])) == []


def crown(*pieces: Points, loop: bool = False) -> ConeCurve:
    """A star of as many ends as a crown has, of extent 2, and pieces of two nodes, or one that closes."""
    turn = np.arange(CROWN) * 2 * np.pi / CROWN
    nodes = np.concatenate([np.zeros((1, 3)), np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1), *pieces])
    edges = [(0, k) for k in range(1, CROWN + 1)]
    at = CROWN + 1
    for piece in pieces:
        edges += [(at + k, at + k + 1) for k in range(len(piece) - 1)] + ([(at, at + len(piece) - 1)] if loop else [])
        at += len(piece)
    count = len(nodes)
    return ConeCurve(nodes, np.array(edges, np.int32), np.full(count, 0.05), levels=np.zeros(count, np.int32),
                     node_of_section=np.array([-1], np.int32), section_sizes=np.zeros(0))  # fmt: skip


def test_pieces_are_joined_by_the_shortest_way_from_one_of_their_ends() -> None:
    """Two pieces: the nearer one is joined to the crown, the other one to that one, which is nearer by then."""
    far = WIDEST * np.hypot(2, 2)  # between surfaces, at most
    one = np.array([[1.2, 0, 0], [1.4, 0, 0]])
    joined = joined_pieces(crown(one, one + [0.4, 0, 0]))
    assert joined.components == 1
    bridges = {tuple(edge) for edge in joined.edges[joined.bridged].tolist()}
    assert bridges == {(1, CROWN + 1), (CROWN + 2, CROWN + 3)}
    for away, pieces in ((0.99, 1), (1.01, 2)):
        x = 1 + 0.1 + away * far
        assert joined_pieces(crown(np.array([[x, 0, 0], [x + 1, 0, 0]]))).components == pieces


def test_a_piece_without_an_end_stays_by_itself() -> None:
    triangle = np.array([[1.2, 0, 0], [1.4, 0, 0], [1.3, 0.1, 0]])
    curve = crown(triangle, loop=True)
    assert joined_pieces(curve) is curve
    assert joined_pieces(crown(triangle)).components == 1
