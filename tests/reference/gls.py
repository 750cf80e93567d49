"""GLSkeleton, plainly, the paper's version.

The system of a step is solved by SuperLU with the settings of the library: these systems are so ill-conditioned that
another ordering moves points by 1e-6, enough to flip a mark that is nearly tied. Everything else is loops over points
and lists.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from scipy.spatial import QhullError

from reference.laplacian import cotangent_laplacian, mean_length, sizes
from reference.rings import Ring, one_ring

GROWTH, EPSILON, PHI, THETA, GUARD = 3.0, 1.2, 1e5, 0.02, 1e-4
CAP_CONTRACTION, CAP_ATTRACTION, BOX_GROWTH = 2048.0, 1e4, 1.2
MIN_STEPS, MAX_STEPS = 3, 10


@dataclass
class Run:
    """Points left after every step, the rows and rings at the end, and why the run stopped."""

    counts: list[int] = field(default_factory=list)
    rows: np.ndarray = field(default_factory=lambda: np.empty(0, int))
    points: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))
    rings: list[Ring] = field(default_factory=list)
    status: str = "step limit"


def solve(laplacian: sparse.csr_array, contraction: float, attraction: np.ndarray, points: np.ndarray) -> np.ndarray:
    normal = sparse.csc_array(contraction**2 * (laplacian.T @ laplacian) + sparse.diags_array(attraction**2))
    factor = splu(normal, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return np.asarray(factor.solve((attraction**2)[:, None] * points))


def explained_score(points: np.ndarray) -> float:
    l3, l2, l1 = np.linalg.eigvalsh(np.cov(points.T))
    return float((2 * l1 + l2 + l3) / (2 * (l1 + l2 + l3)))


def stage_function(
    origin: np.ndarray, there: np.ndarray, delta: np.ndarray, rings: list[Ring], first: np.ndarray, now: np.ndarray,
    shrinkage: float, weight: float,
) -> np.ndarray:  # fmt: skip
    """Return F of every point."""
    out = np.empty(len(there))
    for i, (ring, _) in enumerate(rings):
        remainder = now[i] - shrinkage * first[i]
        eta = (remainder if remainder > 0 else GUARD) / first[i]
        v1 = weight**2 * np.sum((eta * delta[i]) ** 2)
        v2 = 0.0
        if first[i] != now[i]:
            v2 = np.sum((shrinkage * first[i] / (first[i] - now[i]) * (there[i] - origin[i])) ** 2) / eta**2
        u = np.sum((delta[i] - np.mean([delta[j] for j in ring], axis=0)) ** 2) if ring else 0.0
        out[i] = v1 - v2 + 3 * u
    return out


def greedy_matching(there: np.ndarray, rings: list[Ring], marked: np.ndarray) -> dict[int, int]:
    """Return removed -> kept, in index order: each marked point takes its nearest ring member if both are free."""
    merged: dict[int, int] = {}
    taken: set[int] = set()
    for i in np.flatnonzero(marked).tolist():
        ring = rings[i][0]
        if not ring:
            continue
        nearest = ring[int(np.argmin([np.sum((there[j] - there[i]) ** 2) for j in ring]))]
        if i not in taken and nearest not in taken:
            merged[nearest] = i
            taken |= {i, nearest}
    return merged


def across(direction: np.ndarray) -> np.ndarray:
    """Return two orthonormal directions across one, (3, 2)."""
    unit = direction / np.linalg.norm(direction)
    first = np.cross(unit, np.eye(3)[np.argmin(np.abs(unit))])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(unit, first)], axis=1)


def rebuilt(origin: np.ndarray, i: int, members: list[int], direction: np.ndarray) -> Ring:
    """Return the one-ring of i among members, on the plane across a direction."""
    if len(members) < 2:
        return list(members), False
    try:
        ring, closed = one_ring((origin[members] - origin[i]) @ across(direction))
    except QhullError:
        return [], False
    return [members[j] for j in ring], closed


def renamed(ring: list[int], names: dict[int, int], owner: int) -> list[int]:
    """Return a ring under new names, repeats and the owner dropped, the first kept."""
    return [j for j in dict.fromkeys(names.get(j, j) for j in ring) if j != owner]


def merge(
    origin: np.ndarray, rings: list[Ring], merged: dict[int, int], directions: np.ndarray
) -> tuple[dict[int, int], list[Ring]]:
    """Merge all pairs at once (the paper's version); pairs whose ring would fall below three are given up."""
    merged = dict(merged)
    while True:
        fresh: list[Ring] = [(renamed(ring, merged, i), closed) for i, (ring, closed) in enumerate(rings)]
        new = {}
        for lost, kept in merged.items():
            union = [j for j in dict.fromkeys(fresh[kept][0] + fresh[lost][0]) if j != kept]
            new[kept] = rebuilt(origin, kept, union, directions[kept])
        failed = [lost for lost, kept in merged.items() if len(new[kept][0]) < 3]
        if not failed:
            return merged, [new.get(i, ring) for i, ring in enumerate(fresh)]
        for lost in failed:
            del merged[lost]


def contract_paper(points: np.ndarray, rings: list[Ring], normals: np.ndarray) -> Run:
    """Contract as the paper has it; rings and normals of the original cloud are given."""
    run, total = Run(rows=np.arange(len(points))), len(points)
    origin, here, first = points, points, sizes(points, rings)
    first_weight = weight = 1 / (5 * mean_length(points, rings))
    attraction, score, before_count = np.ones(total), explained_score(points), total
    for k in range(MAX_STEPS):
        matrix = cotangent_laplacian(here, rings)
        there = solve(matrix, weight, attraction, here)
        if (np.ptp(there, axis=0) > BOX_GROWTH * np.ptp(points, axis=0)).any():
            run.status = "bounding box grew"
            break
        new_score = explained_score(there)
        change = abs(new_score - score) / (1 - (before_count - len(there)) / total)
        if k >= MIN_STEPS and change < THETA:
            run.status = "converged"
            break
        delta, now = matrix @ here, sizes(there, rings)
        psi = (sizes(here, rings).sum() - now.sum()) / first.sum()
        stage = stage_function(origin, there, delta, rings, first, now, EPSILON * psi, GROWTH ** (k + 2) * first_weight)
        pairs = greedy_matching(there, rings, stage < PHI * now**2)
        directions = np.where(np.linalg.norm(delta, axis=1)[:, None] == 0, normals, delta)
        merged, rings = merge(origin, rings, pairs, directions)
        score, before_count = new_score, len(there)
        kept = [i for i in range(len(there)) if i not in merged]
        origin, here, first, normals, run.rows = origin[kept], there[kept], first[kept], normals[kept], run.rows[kept]
        rings = compacted(rings, kept)
        run.counts.append(len(kept))
        weight, attraction = min(weight * GROWTH, CAP_CONTRACTION), attractions(first, sizes(here, rings))
        attraction[[len(ring) < 2 for ring, _ in rings]] = CAP_ATTRACTION
    run.points, run.rings = here, rings
    return run


def compacted(rings: list[Ring], kept: list[int]) -> list[Ring]:
    place = {old: new for new, old in enumerate(kept)}
    return [([place[j] for j in rings[i][0]], rings[i][1]) for i in kept]


def attractions(first: np.ndarray, now: np.ndarray) -> np.ndarray:
    with np.errstate(divide="ignore"):
        return np.asarray(np.minimum(first / now, CAP_ATTRACTION))
