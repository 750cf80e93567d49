"""Junctions: where branches meet, which the sections only tell to about a radius."""

from dataclasses import replace

import numpy as np

from tiskel.arrays import TINY, Indices, Numbers, Points
from tiskel.geometry.solid import Solid
from tiskel.methods.robust.curve import ConeCurve, contract_nodes, keeps_loops

# Found by trial on the shapes of the gallery. In brackets: how many of the 14 curves of benchmarks/sensitivity.md
# change with 0.7 and with 1.4 times the value.
CLEARED = 1.0  # radii about a junction in which nodes say nothing of their branches [10, 11]
HOLD = 0.2  # weight of where a junction is, against the lines of its branches [12, 12]
FARTHEST = 1.5  # radii that a junction moves at most [5, 3]
TRIES = 5  # places on the way back from where the lines meet, both ends included [2, 2]
INSIDE = 0.4  # winding number that a place for a junction has at least [1, 1]


def merged_junctions(curve: ConeCurve, nearest: float) -> ConeCurve:
    """Contract, the closest first, the branches between junctions that are closer than so many local radii."""
    while True:
        degree, found = curve.degrees, []
        for branch in curve.branches:
            first, last = int(branch[0]), int(branch[-1])
            if first != last and min(degree[first], degree[last]) > 2:
                apart = float(np.linalg.norm(curve.nodes[first] - curve.nodes[last]))
                ratio = apart / max(float(curve.radii[first]), float(curve.radii[last]), TINY)
                into = np.arange(len(curve.nodes), dtype=np.int32)
                into[branch] = branch.min()
                if ratio < nearest and keeps_loops(curve, into):
                    found.append((ratio, first, into))
        if not found:
            return curve
        curve = contract_nodes(curve, min(found, key=lambda one: one[:2])[2])


def placed_junctions(curve: ConeCurve, solid: Solid) -> ConeCurve:
    """Move junctions to where the lines of their branches come closest, and clear the nodes about them.

    The place closest to the lines, or the first on the way back to the middle
    of the branches that is inside, where there is an inside to speak of.
    """
    paths: dict[int, list[Indices]] = {}
    for path in curve.paths_from(ends=False):
        paths.setdefault(int(path[0]), []).append(path)
    if not paths:
        return curve
    joints = sorted(paths)
    into, lines = _cleared(curve, {joint: paths[joint] for joint in joints})
    tries = np.stack([_places(curve, joint, paths[joint], lines[joint]) for joint in joints])
    chosen = np.zeros(len(joints), int)
    if solid.trusted:
        inside = solid.oriented.winding_numbers(tries.reshape(-1, 3)).reshape(len(joints), -1)
        chosen = np.where((inside > INSIDE).any(axis=1), (inside > INSIDE).argmax(axis=1), inside.argmax(axis=1))
    nodes = curve.nodes.copy()
    nodes[joints] = tries[np.arange(len(joints)), chosen]
    return contract_nodes(replace(curve, nodes=nodes), into)


Line = tuple[Numbers, Numbers]  # a place and a direction, (3,) each


def _cleared(curve: ConeCurve, paths: dict[int, list[Indices]]) -> tuple[Indices, dict[int, list[Line]]]:
    """Return for each node the one that takes its place, and the lines of the branches of every junction."""
    into = np.arange(len(curve.nodes), dtype=np.int32)
    lines: dict[int, list[Line]] = {}
    for joint, branches in paths.items():
        lines[joint] = []
        for path in branches:
            clear = _clear(curve, path)
            trial = into.copy()
            trial[[node for node in path[1:clear] if into[node] == node]] = joint
            into = trial if keeps_loops(curve, trial) else into
            line = _line(curve, path, clear)
            lines[joint] += [line] if line is not None else []
    return into, lines


def _clear(curve: ConeCurve, path: Indices) -> int:
    """Return the place in a path of the first node outside the junction's ball; at the end of a branch, that end."""
    stop = len(path) - 1 if path[-1] != path[0] else len(path) // 2
    away = np.linalg.norm(curve.nodes[path[1:]] - curve.nodes[path[0]], axis=1) > CLEARED * curve.radii[path[0]]
    return min(1 + int(away.argmax()) if away.any() else stop, stop)


def _line(curve: ConeCurve, path: Indices, clear: int) -> Line | None:
    """Return a place and a direction of a branch behind its cleared nodes, None where too little is left."""
    last = len(path) - (2 if curve.degrees[path[-1]] > 2 else 1)  # the junction at the other end says nothing
    if clear + 1 > last:
        return None
    start, stop = curve.nodes[path[clear]], curve.nodes[path[min(clear + 2, last)]]
    length = float(np.linalg.norm(stop - start))
    return (start, (stop - start) / length) if length > 0 else None


def _places(curve: ConeCurve, joint: int, paths: list[Indices], lines: list[Line]) -> Points:
    """Return the places (t, 3) to try, from the one closest to the lines back to the middle of the branches."""
    here, matrix, right = curve.nodes[joint], HOLD * np.eye(3), np.zeros(3)
    for start, along in lines:
        across = np.eye(3) - np.outer(along, along)
        matrix, right = matrix + across, right + across @ (start - here)
    move = np.linalg.solve(matrix, right)
    limit = FARTHEST * float(curve.radii[joint])
    move *= limit / max(float(np.linalg.norm(move)), limit, TINY)
    middle = np.mean([curve.nodes[path[1]] for path in paths], axis=0)
    return np.concatenate([here + np.linspace(1, 0, TRIES)[:, None] * move, [(here + middle) / 2, middle]])
