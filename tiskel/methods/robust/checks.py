"""What a user should know about a curve: where it may be wrong, and why."""

import numpy as np

from tiskel.geometry import graph
from tiskel.methods.robust.pipeline import Built

OUTSIDE, OUTSIDE_SHARE = 0.25, 0.02  # winding number, share of the places
FLAT, FLAT_SHARE = 0.15, 0.2  # ratio of how much normals spread both ways across the curve; share of such points
SPARSE, SPARSE_SHARE = 1.5, 0.05  # spacings in a radius; share of such nodes
SHORT = 1.0  # largest radii that a curve is long at least, to be one


def doubts(built: Built) -> tuple[str, ...]:
    """Return the warnings of a curve, each what, how much, and what to do."""
    return tuple(
        warning
        for warning in (_debris(built), _sparse(built), _short(built), _flat(built), _gaps(built), *_body(built))
        if warning
    )


def _debris(built: Built) -> str:
    left_out = int((built.curve.owner < 0).sum())
    return f"{left_out} points in small separate parts were left out" if left_out else ""


def _sparse(built: Built) -> str:
    thin = float((built.curve.radii < SPARSE * built.network.spacing).mean())
    few = f"{thin:.0%} of the nodes are thinner than {SPARSE} spacings of the points: too few points for the thickness"
    return few if thin > SPARSE_SHARE else ""


def _short(built: Built) -> str:
    curve = built.curve
    length = float(graph.edge_lengths(curve.nodes, curve.edges).sum())
    if len(curve.edges) and length >= SHORT * curve.radii.max():
        return ""
    return "the body is hardly longer than it is thick: its curve skeleton says little about it"


def _flat(built: Built) -> str:
    """Find the nodes whose points' normals hardly turn about the curve, as those of a plate do not."""
    node, normals = built.feet.node(built.curve), built.network.normals[built.feet.rows]
    scatter = np.zeros((len(built.curve.nodes), 3, 3))
    np.add.at(scatter, node, normals[:, :, None] * normals[:, None, :])
    _, across, most = np.linalg.eigvalsh(scatter).T
    flat = (across < FLAT * most)[node]
    share = float(flat.mean()) if len(flat) else 0.0
    told = (
        f"{share:.0%} of the points lie where the body is flat: it has no curve skeleton there and did not become thin"
    )
    return told if share > FLAT_SHARE else ""


def _gaps(built: Built) -> str:
    return f"{built.gaps} gaps in the scan were bridged by straight lines" if built.gaps else ""


def _body(built: Built) -> tuple[str, ...]:
    """Compare the curve with the solid inside the cloud, where there is one."""
    if not built.body.trusted:
        return ()
    handles, loops = built.body.handles, built.loops
    outside = float((built.winding < OUTSIDE).mean())
    return (
        "" if handles is None or handles <= loops else f"the body has {handles} handles, the curve only {loops} loops",
        "" if handles is None or handles >= loops else f"the curve has {loops} loops, the body only {handles} handles",
        f"{outside:.0%} of the curve lies outside the body" if outside > OUTSIDE_SHARE else "",
    )
