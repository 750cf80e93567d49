"""The curves of all tiles made one: planes are undone in the opposite order in which they were drawn."""

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from tiskel.arrays import Mask, Points
from tiskel.geometry.doubt import CurveWarning, as_places
from tiskel.geometry.graph import CurveGraph, component_labels
from tiskel.tiles.cells import Flags, Integers
from tiskel.tiles.margin import RADII
from tiskel.tiles.stitch import stitched
from tiskel.tiles.tiling import Plane, Tiling
from tiskel.tiles.web import Web, divided, together, undivided, web_of

TRUSTED = 0.55  # of the overlap: beyond, a limb's curve may suffer from the limb's being cut open
SLAB = 0.5  # of the overlap, to either side of a plane: where two curves may be cut to fit
STEPS = 32  # that the overlap is long, of the pieces that edges are divided into
SCRAP = 2.0  # reaches that a cut end is long at most, or what hangs at nothing, to be taken off
SHOWN = 5  # places that a warning shows


def trimmed(curve: CurveGraph, tile: int, core: Points, overlap: float) -> Web:
    """Return what is to be trusted of the curve of a tile.

    Parameters
    ----------
    curve : CurveGraph
        Of all points of the tile.
    tile : int
        Its number.
    core : (2, 3) float64
        The lowest and the highest corner of its core, infinite where there is no border.
    overlap : float
        How far the tile reaches beyond it, in the unit of the curve.
    """
    web = web_of(curve, tile)
    web = _without_bridges(web, ~_within(web, core, TRUSTED * overlap))
    near = np.asarray((~_within(web, core, -SLAB * overlap))[web.edges].any(axis=1), np.bool_)
    web = divided(web, overlap / STEPS, near)
    return web.kept(_within(web, core, TRUSTED * overlap))


def _within(web: Web, core: Points, by: float) -> Flags:
    """Return (v,) which nodes are inside a core, or no farther outside."""
    return np.asarray(((web.nodes > core[0] - by) & (web.nodes < core[1] + by)).all(axis=1))


def _without_bridges(web: Web, outside: Flags) -> Web:
    """Return the web without bridges that reach nodes (v,) near the border of the tile: they join limbs cut open there.

    What they led to is no torn end: the limb ends there, or goes on by itself.
    """
    label = component_labels(len(web.nodes), web.edges[web.bridged])
    ends = np.unique(web.edges[web.bridged])
    wrong = np.isin(label, label[ends[outside[ends]]])
    keep = ~(web.bridged & wrong[web.edges[:, 0]])
    return replace(web, edges=web.edges[keep], bridged=web.bridged[keep])


def joined(webs: Mapping[int, Web], tiling: Tiling) -> Web:
    """Return the curves of tiles as one.

    Parameters
    ----------
    webs : mapping of int to Web
        What is trusted of the tiles that there are, by number.
    tiling : Tiling

    Returns
    -------
    Web
        The nodes that are torn are ends that nothing continues.
    """

    def under(node: Plane | int) -> Web | None:
        if isinstance(node, int):
            return webs.get(node)
        low, high = under(node.low), under(node.high)
        if low is None or high is None:
            return low or high
        half, step = SLAB * tiling.overlap, tiling.overlap / STEPS
        return stitched(low, high, node.axis, tiling.place(node), half, step)

    web = under(tiling.root)
    return together([]) if web is None else _without_scraps(undivided(web))


def side_by_side(webs: Iterable[Web]) -> Web:
    """Return the curves of objects as one."""
    return together(list(webs))


def _without_scraps(web: Web) -> Web:
    """Return the web without short ends that were cut off, and without short pieces with such ends."""
    while True:
        degree = np.bincount(web.edges.ravel(), minlength=len(web.nodes))
        ends = np.flatnonzero(web.torn & (degree <= 1))
        drop = _scraps(web, ends)
        if not drop.any():
            return web
        joints = web.edges[drop[web.edges].any(axis=1)].ravel()
        keep = ~drop
        web = web.kept(keep)
        restored = web.torn.copy()
        restored[(np.cumsum(keep) - 1)[joints[keep[joints]]]] = False  # what was taken off was not needed there
        web = replace(web, torn=restored)


def _scraps(web: Web, ends: Integers) -> Mask:
    """Return which nodes lie on ways from torn ends to joints, or in pieces, that are shorter than they reach."""
    drop = np.zeros(len(web.nodes), bool)
    if len(ends) == 0:
        return drop
    graph = web.graph()
    label = component_labels(len(web.nodes), web.edges)
    total = np.bincount(label[web.edges[:, 0]], web.lengths, minlength=int(label.max()) + 1)
    for end in ends.tolist():
        if total[label[end]] <= SCRAP * web.reach[end]:
            drop[label == label[end]] = True
    for branch in graph.branches:
        for way in (branch, branch[::-1]):
            stops_at_joint = graph.degrees[way[-1]] > 2
            length = float(np.linalg.norm(np.diff(web.nodes[way], axis=0), axis=1).sum())
            if web.torn[way[0]] and graph.degrees[way[0]] == 1 and stops_at_joint and length <= web.reach[way[-1]]:
                drop[way[:-1]] = True
    return drop


def doubts_of(web: Web, tiling: Tiling) -> list[CurveWarning]:
    """Return what may be wrong with the curve where tiles meet."""
    found = []
    torn = np.flatnonzero(web.torn)
    if len(torn):
        found.append(CurveWarning(
            "torn", f"{len(torn)} limbs end at the border of a tile, and no curve of the next tile goes on there; "
            "split again with a larger overlap", share=len(torn) / len(web.nodes),
            places=as_places(web.nodes[torn[:: -(-len(torn) // SHOWN)]]),
        ))  # fmt: skip
    thick = np.flatnonzero(_at_borders(web, tiling) & (web.radii > 1.5 * tiling.overlap / RADII))
    if len(thick):
        radius = float(web.radii[thick].max())
        found.append(CurveWarning(
            "overlap", f"bodies at the borders of tiles have radii of up to {radius:.4g}, too thick for an overlap of "
            f"{tiling.overlap:.4g}; split again with --overlap {RADII * radius:.4g}",
            share=len(thick) / len(web.nodes), places=as_places(web.nodes[thick[:: -(-len(thick) // SHOWN)]]),
        ))  # fmt: skip
    return found


def _at_borders(web: Web, tiling: Tiling) -> Mask:
    """Return which nodes are so near to the border of a core that they may have been joined there."""
    away = np.abs(web.nodes[:, None] - tiling.cores()[web.tile]).min(axis=(1, 2))
    return np.asarray(away < tiling.overlap / 2)
