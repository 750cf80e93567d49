"""Joints: where limbs meet, which the sections only tell to about a radius."""

from dataclasses import replace

import numpy as np

from tiskel.arrays import Indices, Numbers, Points
from tiskel.geometry.oriented import Surface
from tiskel.methods.robust.curve import ConeCurve, contract_nodes, keeps_loops

NEAR = 0.8  # joints closer than so many radii are one
CLEARED = 1.0  # radii about a joint in which nodes say nothing of their limbs
HOLD = 0.2  # weight of where a joint is, against the lines of its limbs
FARTHEST = 1.5  # radii that a joint moves at most
INSIDE = 0.4  # winding number that a place for a joint has at least
TINY = np.finfo(float).tiny  # stands in for the radius of a node whose points lie on it


def merged_joints(curve: ConeCurve) -> ConeCurve:
    """Contract, the closest first, the branches between joints that are closer than the local radius."""
    while True:
        degree, found = curve.degrees, []
        for branch in curve.branches():
            first, last = int(branch[0]), int(branch[-1])
            if first != last and min(degree[first], degree[last]) > 2:
                apart = float(np.linalg.norm(curve.nodes[first] - curve.nodes[last]))
                ratio = apart / max(float(curve.radii[first]), float(curve.radii[last]), TINY)
                into = np.arange(len(curve.nodes), dtype=np.int32)
                into[branch] = branch.min()
                if ratio < NEAR and keeps_loops(curve, into):
                    found.append((ratio, first, into))
        if not found:
            return curve
        curve = contract_nodes(curve, min(found, key=lambda one: one[:2])[2])


def placed_joints(curve: ConeCurve, surface: Surface) -> ConeCurve:
    """Move joints to where the lines of their limbs come closest, and clear the nodes about them."""
    into, nodes = np.arange(len(curve.nodes), dtype=np.int32), curve.nodes.copy()
    limbs: dict[int, list[Indices]] = {}
    for path in curve.paths_from(ends=False):
        limbs.setdefault(int(path[0]), []).append(path)
    for joint, paths in sorted(limbs.items()):
        lines = []
        for path in paths:
            clear = _clear(curve, path)
            trial = into.copy()
            trial[[node for node in path[1:clear] if into[node] == node]] = joint
            into = trial if keeps_loops(curve, trial) else into
            lines.append(_line(curve, path, clear))
        nodes[joint] = _place(curve, joint, paths, [line for line in lines if line is not None], surface)
    return contract_nodes(replace(curve, nodes=nodes), into)


def _clear(curve: ConeCurve, path: Indices) -> int:
    """Return the place in a path of the first node outside the joint's ball; at the end of a limb, that end."""
    stop = len(path) - 1 if path[-1] != path[0] else len(path) // 2
    away = np.linalg.norm(curve.nodes[path[1:]] - curve.nodes[path[0]], axis=1) > CLEARED * curve.radii[path[0]]
    return min(1 + int(away.argmax()) if away.any() else stop, stop)


def _line(curve: ConeCurve, path: Indices, clear: int) -> tuple[Numbers, Numbers] | None:
    """Return a place and a direction of a limb behind its cleared nodes, None where too little is left."""
    last = len(path) - (2 if curve.degrees[path[-1]] > 2 else 1)  # the joint at the other end says nothing
    if clear + 1 > last:
        return None
    start, stop = curve.nodes[path[clear]], curve.nodes[path[min(clear + 2, last)]]
    length = float(np.linalg.norm(stop - start))
    return (start, (stop - start) / length) if length > 0 else None


def _place(
    curve: ConeCurve, joint: int, paths: list[Indices], lines: list[tuple[Numbers, Numbers]], surface: Surface
) -> Points:
    """Return the place closest to the lines, or the first on the way back to the middle of the limbs that is inside."""
    here, matrix, right = curve.nodes[joint], HOLD * np.eye(3), np.zeros(3)
    for start, along in lines:
        across = np.eye(3) - np.outer(along, along)
        matrix, right = matrix + across, right + across @ (start - here)
    move = np.linalg.solve(matrix, right)
    limit = FARTHEST * float(curve.radii[joint])
    move *= limit / max(float(np.linalg.norm(move)), limit)
    middle = np.mean([curve.nodes[path[1]] for path in paths], axis=0)
    tries = np.concatenate([here + np.linspace(1, 0, 5)[:, None] * move, [(here + middle) / 2, middle]])
    winding = surface.winding_numbers(tries)
    inside = np.flatnonzero(winding > INSIDE)
    return np.asarray(tries[inside[0] if len(inside) else winding.argmax()])
