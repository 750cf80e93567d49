"""Ends that lie at another part of the curve, and loops in crowns."""

from dataclasses import replace

import numpy as np

from reference.judged import true
from tiskel import CurveGraph
from tiskel.geometry.graph import tidy_edges
from tiskel.methods.robust.contacts import contacts


def comb(loops: int) -> CurveGraph:
    """Return a trunk with twenty twigs that bend back to it, the last ones as far as that they join it."""
    nodes, edges = [[float(x), 0.0, 0.0] for x in range(21)], [(x, x + 1) for x in range(20)]
    for x in range(20):
        first = len(nodes)
        nodes += [[x, 0, 2], [x + 0.5, 0, 2], [x + 0.5, 0, 0.1]]
        edges += [(x, first), (first, first + 1), (first + 1, first + 2)]
        edges += [(x + 1, first + 2)] if x >= 20 - loops else []
    return CurveGraph(np.array(nodes, float), tidy_edges(np.array(edges, np.int32)), np.full(len(nodes), 0.1))


def test_ends_at_other_limbs_are_a_warning_where_points_are_noisy() -> None:
    y = true("y")
    crown = replace(y, graph=comb(0), spacings=np.full(len(y.points), 0.2))
    for beside, severity in ((0.2, "note"), (0.6, "warning")):
        found = contacts(replace(crown, beside=beside))
        assert found is not None
        assert (found.severity, found.share > 0.9) == (severity, True)


def test_a_loop_in_a_crown_is_told_and_many_are_a_net() -> None:
    y = true("y")
    found = contacts(replace(y, graph=comb(1), spacings=np.full(len(y.points), 0.01)))
    assert found is not None
    assert found.severity == "warning"
    assert found.text.startswith("1 loops in a crown of 19 ends")
    assert contacts(replace(y, graph=comb(4), spacings=np.full(len(y.points), 0.001))) is None
