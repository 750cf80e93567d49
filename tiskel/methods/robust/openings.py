"""Ends that stop where the scan has a hole: no cap ahead of them, and another part of the curve in sight."""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Indices, Numbers
from tiskel.geometry.curve import CurveSamples
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.methods.robust.judged import Judged

# Found by trial on the shapes of the gallery: none of 162 right curves has such an end, seven of 13 wrong ones have.
AROUND = 1.6  # radii about an end in which its cap is looked for
AHEAD = 0.5  # radii ahead of the end, from where on points belong to the cap
OPEN = 0.5  # share of a ball's cap, by area: an end with less is open
IN_SIGHT = 0.7  # cosine between the direction of an end and the way to another part of the curve
WIDE = 6.0  # sums of the two radii, how far that part is at most; the method bridges up to four
NEAR = 1.5  # radii; what is nearer to an end is its own branch


def open_ends_in_sight(judged: Judged) -> Indices:
    """Return the ends, ascending, that have no cap and look at another part of the curve across a gap.

    Only ends whose radius is measured are asked, and none of wires and sheets,
    which have no caps. The mouth of a tube that looks at nothing is none.
    """
    graph = judged.graph
    asked = (graph.degrees == 1) & (graph.radius_sources != RadiusSource.BOUNDED)
    asked &= ~np.isin(graph.regimes, (Regime.WIRE, Regime.SHEET))
    cloud = cKDTree(judged.points)
    found = [
        end
        for end in np.flatnonzero(asked).tolist()
        if _is_open(judged, cloud, end, heading := _heading(graph, end)) and _sees(judged.samples, judged, end, heading)
    ]
    return np.array(found, np.int32)


def _heading(graph: CurveGraph, end: int) -> Numbers:
    """Return the unit direction that an end looks in, over two edges where there are two."""
    path = [end, graph.neighbours[end][0]]
    if graph.degrees[path[1]] == 2:
        path += [node for node in graph.neighbours[path[1]] if node != end]
    way = graph.nodes[end] - graph.nodes[path[-1]]
    return np.asarray(way / max(float(np.linalg.norm(way)), TINY))


def _is_open(j: Judged, cloud: cKDTree, end: int, heading: Numbers) -> bool:
    radius = max(float(j.graph.radii[end]), j.spacing)
    near = np.sort(np.array(cloud.query_ball_point(j.graph.nodes[end], AROUND * radius), int))
    cap = near[(j.points[near] - j.graph.nodes[end]) @ heading > AHEAD * radius]
    whole = 2 * np.pi * (1 - AHEAD) * radius**2
    return float((j.spacings[cap] ** 2).sum()) < OPEN * whole


def _sees(samples: CurveSamples, j: Judged, end: int, heading: Numbers) -> bool:
    radius = max(float(j.graph.radii[end]), j.spacing)
    way = samples.points - j.graph.nodes[end]
    distance = np.linalg.norm(way, axis=1)
    sight = (way @ heading > IN_SIGHT * distance) & (distance > NEAR * radius)
    return bool((sight & (distance < WIDE * (radius + j.sample_radii))).any())
