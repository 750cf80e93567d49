"""Where a curve may be wrong, from the curve, its cloud and the solid alone, whatever regime made it.

=============== ======== ==========================================================================
code            severity what
=============== ======== ==========================================================================
``in-air``      warning  curve neither at the points nor between them, bridges aside
``outside``     warning  curve outside the body, as ``tiskel metrics`` counts it
``loops``       warning  the body has more or fewer handles than the curve has loops
``open-ends``   warning  ends without a cap that look at another part of the curve: a gap left open; a note if few do
``contacts``    note     ends that lie at another part of the curve; a warning where they are many and points noisy,
                         and of loops in a crown
``far``         warning  points far from the curve: a part without a branch
``flat``        warning  cones in a body whose normals hardly turn; a note where it is long, or told to be a sheet
``no-inside``   warning  smooth tubes whose normals tell no inside: limbs side by side may be taken for one
``short``       warning  the body is hardly longer than thick
``bridged``     note     gaps crossed by straight lines; a warning where they are much of the curve
``small-parts`` note     points left out in small parts; a warning where they are many
``one-sided``   note     seen from one side: the curve is on what was seen; a warning where all of it is a guess
``turns``       note     the cloud is taken for one wire whose turns lie side by side, not for a surface in rows
``thin``        note     radii are bounds, the body is thinner than its points tell
=============== ======== ==========================================================================

A warning says that the curve may be wrong, a note that it is worth less than it
seems. Levels stand in :mod:`tiskel.methods.robust.levels`.
"""

from collections.abc import Callable

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, diagonal
from tiskel.geometry.air import in_the_air
from tiskel.geometry.curve import curve_samples
from tiskel.geometry.doubt import CurveWarning
from tiskel.geometry.graph import component_labels
from tiskel.geometry.oriented import oriented_cloud, places_inside
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.geometry.ways import on_loops
from tiskel.methods.robust import levels
from tiskel.methods.robust.contacts import contacts, turns
from tiskel.methods.robust.judged import Judged, doubt, severity
from tiskel.methods.robust.openings import open_ends_in_sight
from tiskel.methods.robust.turning import ONE_SIDE, empty_turns, flat_points, roughness

AIR = "{share} of the curve is in the air: neither at the points nor between them"


def doubts_of(judged: Judged) -> tuple[CurveWarning, ...]:
    """Return the warnings and notes about a curve, what weighs most first.

    Parameters
    ----------
    judged : Judged

    Returns
    -------
    tuple of CurveWarning
        Places in the unit of the curve.
    """
    checks = CHECKS if len(judged.graph.edges) else (_short, _small)
    told = [found for check in checks if (found := check(judged)) is not None]
    return tuple(sorted(told, key=lambda found: found.severity != "warning"))


def _in_air(j: Judged) -> CurveWarning | None:
    measured = ~j.graph.bridged[j.samples.edges]
    air = in_the_air(j.graph, j.samples, j.points, j.spacings)
    counted = measured if j.bridged_share > levels.BRIDGED_SHARE else np.ones_like(measured)  # nobody is told twice
    if (much := air.share_of(counted)) > levels.AIR_MUCH:
        places = air.places & counted
        return doubt("in-air", AIR, much, j.samples.points[places], air.distance[places])
    share = air.share_of(measured)
    if share <= levels.AIR_SHARE:
        return None
    wide = in_the_air(j.graph, j.samples, j.points, j.spacings, half=levels.HOLE * j.sample_radii)
    serious = air.share_of(measured & wide.places) > levels.AIR_SERIOUS
    text = AIR if serious else AIR + ", over holes in the scan"
    places = air.places & (measured & wide.places if serious else measured)
    return doubt("in-air", text, share, j.samples.points[places], air.distance[places], severity(serious))


def _outside(j: Judged) -> CurveWarning | None:
    if j.thick.mean() <= levels.OUTSIDE_SHARE or _surely_inside(j):
        return None
    step = -(-len(j.points) // levels.SURFACE_POINTS)
    points, contracted = (np.ascontiguousarray(rows[::step]) for rows in (j.points, j.contracted))
    surface = oriented_cloud(points, contracted)
    inside = places_inside(surface, j.samples.points)
    if inside is None or (~inside).mean() <= levels.OUTSIDE_SHARE:
        return None
    clearly = (surface.winding_numbers(j.samples.points) < levels.CLEARLY_OUTSIDE) & j.thick
    if clearly.mean() <= levels.OUTSIDE_SHARE:
        return None
    text = "{share} of the curve lies outside the body"
    return doubt("outside", text, float((~inside).mean()), j.samples.points[clearly])


def _surely_inside(j: Judged) -> bool:
    """Tell whether so little of the curve is outside the solid that normals oriented anew would not say otherwise."""
    if not j.solid.trusted:
        return False
    outside = ~j.solid.oriented.contains(j.samples.points @ j.axes.T) & j.thick
    return bool(outside.mean() <= levels.OUTSIDE_SURELY_NOT)


def _loops(j: Judged) -> CurveWarning | None:
    handles, loops = j.solid.handles, j.graph.loops
    if not j.solid.trusted or handles is None or handles == loops:
        return None
    if handles > loops:
        text = f"the body has {handles} handles, the curve only {loops} loops"
        return CurveWarning("loops", text, share=(handles - loops) / handles)
    text = f"the curve has {loops} loops, the body only {handles} handles"
    return doubt("loops", text, (loops - handles) / loops, j.graph.nodes[on_loops(j.graph)])


def _open_ends(j: Judged) -> CurveWarning | None:
    ends = open_ends_in_sight(j)
    if j.solid.closed or len(ends) == 0:
        return None
    text = f"{len(ends)} ends stop at a hole in the scan and face another part of the curve: they may belong together"
    share = len(ends) / j.graph.ends
    return doubt("open-ends", text, share, j.graph.nodes[ends], None, severity(share > levels.OPEN_SHARE))


def _far(j: Judged) -> CurveWarning | None:
    """Find points beyond what the curve can stand for, about the nearest place on it and about their own node."""
    graph, kept = j.graph, ~j.left_out
    count = int(np.clip(graph.length / max(j.spacing, TINY), levels.PLACES, levels.MOST_PLACES))
    along = curve_samples(graph, count)
    radii = graph.radii[graph.edges[along.edges]].max(axis=1)
    distance, nearest = cKDTree(along.points).query(j.points)
    own = np.linalg.norm(j.points - graph.nodes[j.node_of_point], axis=1)
    reach = levels.FAR_SPACINGS * j.spacing
    beyond = (
        np.minimum(distance - levels.FAR_RADII * radii[nearest], own - levels.FAR_RADII * graph.radii[j.node_of_point])
        - reach
    )
    far = kept & (beyond > 0)
    share = float(far.mean())
    if share <= levels.FAR_SHARE:
        return None
    text = "{share} of the points are far from the curve: a part of the body may have no branch"
    return doubt("far", text, share, j.points[far], beyond[far])


def _flat(j: Judged) -> CurveWarning | None:
    flat = flat_points(j.graph, j.normals, j.node_of_point, levels.FLAT) & ~j.left_out
    share = float(flat.mean())
    if share <= levels.FLAT_SHARE:
        return None
    node = j.node_of_point[flat]
    sheet = bool((j.graph.regimes[node] == Regime.SHEET).mean() > levels.MOSTLY)
    half = float(np.quantile(np.linalg.norm(j.points[flat] - j.graph.nodes[node], axis=1), levels.MOST))
    extent = diagonal(j.points)
    rings = 0 if j.graph.ends else j.graph.loops  # it is longer about each; where ends stick out of them, it strays
    straight = j.graph.length < levels.TO_AND_FRO * extent * (1 + rings)
    middle = j.solid.trusted and levels.LONG * 2 * half < extent and straight
    text = "{share} of the points lie where the body is flat: " + (
        "the curve is the middle of a sheet there" if sheet else "a curve says little about it there"
    )
    return doubt("flat", text, share, j.graph.nodes[np.unique(node)], None, severity(not (sheet or middle)))


def _no_inside(j: Judged) -> CurveWarning | None:
    tubes = (j.graph.regimes == Regime.TUBE) & (j.graph.radii > levels.THICK * j.spacing)
    share = 1 - j.solid.oriented.consistency
    inside = j.solid.trusted and (j.meshed or 1 - share > levels.INSIDE)
    if inside or tubes.mean() < levels.TUBES or roughness(j.points, j.normals, j.spacings) > levels.ROUGH:
        return None
    text = f"{share:.0%} of the points have no inside behind them: limbs side by side may be taken for one"
    return CurveWarning("no-inside", text + ", or one side was not seen", share=share)


def _short(j: Judged) -> CurveWarning | None:
    graph = j.graph
    if len(graph.edges) and graph.length >= levels.SHORT * graph.radii.max():
        return None
    text = "the body is hardly longer than it is thick: its curve skeleton says little about it"
    return CurveWarning("short", text, share=1.0)


def _bridged(j: Judged) -> CurveWarning | None:
    graph = j.graph
    if not graph.bridged.any():
        return None
    share = j.bridged_share
    over = graph.edges[graph.bridged]
    gaps = len(np.unique(component_labels(len(graph.nodes), over)[over[:, 0]]))
    text = f"{gaps} gaps in the scan were bridged by straight lines, {{share}} of the curve"
    serious = severity(share > levels.BRIDGED_SHARE)
    return doubt("bridged", text, share, graph.nodes[over].mean(axis=1), graph.lengths[graph.bridged], serious)


def _small(j: Judged) -> CurveWarning | None:
    count = int(j.left_out.sum())
    if not count:
        return None
    share = count / len(j.points)
    text = f"{count} points in small separate parts were left out"
    return doubt("small-parts", text, share, j.points[j.left_out], None, severity(share > levels.LEFT_OUT_SHARE))


def _one_sided(j: Judged) -> CurveWarning | None:
    sheet, empty = j.graph.regimes == Regime.SHEET, empty_turns(j.graph, j.points, j.node_of_point)
    tubes = (j.graph.regimes == Regime.TUBE) & (j.graph.radii > levels.THICK * j.spacing) & (empty > levels.EMPTY)
    share = j.share_at(tubes)
    if share > levels.EMPTY_SHARE:
        text = "{share} of the curve has no points about a third of its turn: its middle is a guess from what was seen"
        return doubt("one-sided", text, share, j.graph.nodes[tubes])
    nodes = (empty >= ONE_SIDE) | sheet
    share = float(nodes.mean())
    if share <= levels.ONE_SIDED_SHARE:
        return None
    text = "{share} of the nodes have points on one side only: what was not seen may be elsewhere"
    return doubt("one-sided", text, share, j.graph.nodes[nodes], None, "note")


def _thin(j: Judged) -> CurveWarning | None:
    thin = j.graph.radius_sources == RadiusSource.BOUNDED
    share = float(thin.mean())
    if share <= levels.THIN_SHARE:
        return None
    text = "{share} of the nodes are thinner than their points tell: their radii are bounds"
    return doubt("thin", text, share, j.graph.nodes[thin], None, "note")


CHECKS: tuple[Callable[[Judged], CurveWarning | None], ...] = (
    _in_air, _outside, _loops, _open_ends, contacts, _far, _flat, _no_inside, _short, _bridged, _small, _one_sided,
    turns, _thin,
)  # fmt: skip
