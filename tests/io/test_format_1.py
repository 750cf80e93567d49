"""Stage files of format 1, as version 0.1.0 of 23 November 2026 wrote them, are still read."""

import io
import json
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from plyfile import PlyData, PlyElement

from tiskel import Contraction, ContractionParams, Skeleton, contract, extract_skeleton
from tiskel.arrays import Points
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.io.stages.contraction import parse_contraction
from tiskel.io.stages.skeleton import parse_skeleton

# All settings stood in one class then, whatever the method read.
OLD_PARAMS = {
    "neighbours": None, "max_steps": None, "normalise": "side", "solver": "scipy", "growth": 3.0,
    "max_contraction_weight": 2048.0, "max_attraction_weight": 10000.0, "cotangent_cap": 10000.0, "box_growth": 1.2,
    "stop_ratio": 0.01, "min_steps": 3, "epsilon": 1.2, "phi": 100000.0, "theta": 0.02, "guard": 0.0001,
}  # fmt: skip


def table(columns: dict[str, npt.NDArray[Any]], name: str, ring: list[list[int]] | None = None) -> PlyElement:
    kinds: list[tuple[str, Any]] = [(key, column.dtype) for key, column in columns.items()]
    rows = np.empty(len(next(iter(columns.values()))), kinds + ([] if ring is None else [("ring", object)]))
    for key, column in columns.items():
        rows[key] = column
    for i, members in enumerate(ring or ()):
        rows["ring"][i] = np.array(members, np.int32)
    return PlyElement.describe(rows, name, len_types={"ring": "u2"}, val_types={"ring": "i4"})


def xyz(points: Points, names: str = "x y z") -> dict[str, npt.NDArray[Any]]:
    return dict(zip(names.split(), points.T, strict=True))


def written(elements: list[PlyElement], stage: str, facts: dict[str, Any]) -> bytes:
    comments = [f"tiskel 0.1.0 {stage}", *(f"{key} {json.dumps(value)}" for key, value in facts.items())]
    out = io.BytesIO()
    PlyData(elements, text=False, byte_order="<", comments=comments).write(out)
    return out.getvalue()


def old_contraction(c: Contraction) -> bytes:
    count = len(c.points)
    near = [[(i + 1) % count, (i + 2) % count, (i + 5) % count] for i in range(count)]  # robust wrote its neighbours
    ring = near if c.rings is None else [c.rings.of(i).tolist() for i in range(count)]
    closed = np.zeros(count, np.uint8) if c.rings is None else c.rings.closed.astype(np.uint8)
    vertex = {**xyz(c.points), **xyz(c.origin, "x0 y0 z0"), "row": c.rows, "closed": closed}
    if c.sections is not None:
        vertex |= {"section": c.sections.section, "level": c.sections.level}
    cloud = {**xyz(c.cloud), "row": c.input_rows, "merged_into": c.merged_into, "merged_step": c.merged_step}
    steps = [{k: v for k, v in vars(step).items() if k != "seconds"} for step in c.steps]
    facts = {
        "source": {}, "params": {"method": c.params.method, **OLD_PARAMS}, "status": c.status.value,
        "warnings": list(c.warnings), "steps": steps,
    }  # fmt: skip
    elements = [table(vertex, "vertex", ring), table(cloud, "cloud"), table(xyz(c.history.reshape(-1, 3)), "history")]
    return written(elements, "contraction", facts)


def old_skeleton(s: Skeleton) -> bytes:
    vertex = {**xyz(s.nodes), "radius": s.radii, "branch": s.branch_of_node(), "degree": s.degrees}
    contracted = {**xyz(s.contracted), **xyz(s.origin, "x0 y0 z0"), "row": s.rows, "node": s.node_of_point[s.rows]}
    elements = [
        table(vertex, "vertex"),
        table({"vertex1": s.edges[:, 0], "vertex2": s.edges[:, 1]}, "edge"),
        table({"count": np.array([len(branch) for branch in s.branches], np.int32)}, "branch"),
        table({"node": np.concatenate(s.branches)}, "branch_node"),
        table(contracted, "contracted"),
        table({**xyz(s.cloud), "row": s.input_rows, "node": s.node_of_point}, "cloud"),
    ]
    return written(elements, "skeleton", {"source": {}, "warnings": [], "params": {"raw": False, "radius": 0.02}})


@pytest.mark.parametrize("method", ["robust", "gls", "lbc"])
def test_contractions_of_format_1_give_the_same_curve(method: str, capsule: Points) -> None:
    c = contract(capsule, ContractionParams(method=method))
    back = parse_contraction(old_contraction(c), "old.ply")
    assert back.params == c.params
    np.testing.assert_array_equal(back.history, c.history)
    assert (back.rings is None) == (method == "robust")  # neighbours were no rings
    np.testing.assert_array_equal(extract_skeleton(back).nodes, extract_skeleton(c).nodes)


def test_skeletons_of_format_1_do_not_know_what_was_bridged(capsule: Points) -> None:
    s = extract_skeleton(contract(capsule))
    back = parse_skeleton(old_skeleton(s), "old.ply")
    np.testing.assert_array_equal(back.edges, s.edges)
    assert [branch.tolist() for branch in back.branches] == [branch.tolist() for branch in s.branches]
    assert not back.bridged.any()
    assert (back.radius_sources == RadiusSource.UNKNOWN).all()
    assert (back.regimes == Regime.UNKNOWN).all()
    assert back.params is None
