"""Points and curves of the published code on five clouds, held against ours."""

from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from tiskel import GlsParams, LbcParams, SkeletonParams, contract, extract_skeleton, load_cloud
from tiskel.arrays import normalisation

Json = dict[str, Any]


def toolbox_gls(name: str, folder: Path, variant: str = "toolbox") -> Json:
    """Run GLSkeleton, as its code or by its paper, and hold the curve against the published one."""
    return against_published(name, folder, GlsParams(variant=variant), "gls")


def toolbox_lbc(name: str, folder: Path) -> Json:
    """Run lbc, and hold its raw curve against the published one."""
    return against_published(name, folder, LbcParams(), "lbc")


def against_published(name: str, folder: Path, params: Any, method: str) -> Json:
    points = load_cloud(folder / "clouds" / f"{name}.ply").points
    theirs = dict(np.load(folder / "toolbox" / f"{name}_{method}.npz"))
    c = contract(points, params)
    s = extract_skeleton(c, SkeletonParams(raw=True))
    away, match = cKDTree(normalisation(points).apply(s.nodes)).query(theirs["nodes"])
    ours = {tuple(sorted(e)) for e in s.edges.tolist()}
    same = len(s.nodes) == len(theirs["nodes"]) and ours == {tuple(sorted(match[e].tolist())) for e in theirs["edges"]}
    return {
        "left": len(c.points),
        "nodes": len(s.nodes),
        "edges": len(s.edges),
        "away": float(away.max()),
        "same": same,
    }
