"""Loops of tree-like bodies, and tubes that are kept among wires."""

from dataclasses import replace
from typing import NoReturn

import numpy as np
import pytest

from tiskel import RobustParams, ShapeParams, TiskelError, contract, extract_skeleton, make_shape, shape_graph
from tiskel.arrays import Points
from tiskel.gallery.trees import thickened, tree
from tiskel.geometry.solid import solid_of
from tiskel.methods.robust import extraction, treelike
from tiskel.methods.robust.checks import Candidate
from tiskel.methods.robust.network import prepared
from tiskel.methods.robust.pipeline import fitted_curve
from tiskel.methods.robust.regimes import on_sure_tubes, shorter, wires
from tiskel.methods.robust.treelike import CROWN, without_contacts


def tubes_of(points: Points) -> Candidate:
    """Return the first curve of tubes of a cloud."""
    trace = contract(points).as_trace()[0]
    assert trace.sections is not None
    network = trace.prepared or prepared(points, 14)
    oriented = network.oriented(np.ascontiguousarray(trace.points @ network.axes.T))
    return fitted_curve(network, solid_of(oriented), trace.sections, RobustParams())


@pytest.mark.parametrize(("topology", "loops", "ends"), [("auto", 1, 0), ("loops", 1, 0), ("tree", 0, 2)])
def test_a_torus_is_cut_open_only_where_it_is_said_to_be_a_tree(topology: str, loops: int, ends: int) -> None:
    cloud = make_shape(shape_graph("torus"), ShapeParams(count=2000))[0]
    s = extract_skeleton(contract(cloud, RobustParams(topology=topology)))  # type: ignore[arg-type]
    assert (s.components, s.loops, s.ends) == (1, loops, ends)


def test_a_crown_keeps_the_loops_that_handles_confirm_and_no_others(monkeypatch: pytest.MonkeyPatch) -> None:
    found = tubes_of(make_shape(shape_graph("mug"), ShapeParams(count=4096))[0])
    params = RobustParams()
    assert (found.solid.handles, found.curve.loops, found.curve.ends) == (1, 1, 2)
    unknown = replace(found, solid=replace(found.solid, handles=None))
    assert without_contacts(unknown, params) is unknown  # two ends: no crown
    monkeypatch.setattr(treelike, "CROWN", 0)
    assert without_contacts(found, params) is found
    cut = without_contacts(unknown, params)
    assert (cut.curve.loops, cut.curve.components) == (0, 1)
    ring = tubes_of(make_shape(shape_graph("torus"), ShapeParams(count=2000))[0])
    unknown = replace(ring, solid=replace(ring.solid, handles=None))
    assert without_contacts(unknown, params) is unknown  # more loops than ends: no tree


def test_points_of_tubes_lie_on_them_and_no_twig_of_a_crown_does() -> None:
    limbs = on_sure_tubes(tubes_of(make_shape(shape_graph("y"), ShapeParams(count=4096))[0]))
    assert (limbs >= 0).mean() > 0.9
    twigs = thickened(tree("leader", tips=100, seed=3), 4000, 0.3)
    crown = make_shape(twigs, ShapeParams(count=4000, noise=3.0))[0]
    assert (on_sure_tubes(tubes_of(crown)) == -1).all()


def test_a_crown_whose_noise_fills_it_is_no_limb_though_its_points_lie_about_an_axis() -> None:
    shrub = thickened(tree("shrub", tips=300, seed=2), 5000, 0.24)
    crown = tubes_of(make_shape(shrub, ShapeParams(count=5000, noise=3.5, seed=1))[0])
    assert np.median(crown.fit.radii) > 4 * crown.network.spacing
    assert (on_sure_tubes(crown) == -1).all()


def test_a_crown_gets_no_further_fronts(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []

    def further(*_: object) -> NoReturn:
        asked.append("another front")
        raise TiskelError("a front too many")

    monkeypatch.setattr(extraction, "DOUBTFUL", -1.0)  # every curve is in doubt
    monkeypatch.setattr(extraction, "further_front", further)
    crown = make_shape(shape_graph("tree"), ShapeParams())[0]
    assert extract_skeleton(contract(crown)).ends > CROWN
    assert not asked
    with pytest.raises(TiskelError, match="too many"):
        extract_skeleton(contract(make_shape(shape_graph("y"), ShapeParams(count=1000))[0]))


def test_wires_whose_ends_meet_are_a_net_and_no_crown() -> None:
    """Strands through a sheet or a thick strut meet each other; twigs of a crown seldom do."""
    cloud = make_shape(thickened(tree("spreading", tips=25, seed=3), 1200, 0.3), ShapeParams(count=1200, noise=0.1))[0]
    tubes = tubes_of(cloud)
    thin = wires(tubes.network, tubes.solid, RobustParams(), tubes)
    assert thin.meetings < 0.1 * thin.curve.ends
    assert shorter(thin, tubes)
    assert not shorter(replace(thin, meetings=thin.curve.ends - 1), tubes)
