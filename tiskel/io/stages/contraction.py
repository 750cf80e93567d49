"""The stage file ``contraction.ply``.

Elements: ``vertex``, the contracted points, each with its original position
(x0 y0 z0), its row in ``cloud`` and its ring (by place in ``vertex``; closed is
1 where the last member connects to the first), by robust also its section and
level; ``cloud``, every finite input point with its row in the input, the row of ``cloud`` it was merged into and the
step of that (-1: it is left; step 0: a duplicate); ``history``, the positions
of the points that are left after each step, step by step.
"""

from pathlib import Path
from typing import Any

import numpy as np

from tiskel.contraction import Contraction
from tiskel.errors import TiskelError
from tiskel.geometry.rings import Rings
from tiskel.io import ply
from tiskel.io.streams import read_bytes, write_bytes
from tiskel.methods.trace import Status, StepRecord
from tiskel.params import ContractionParams

STAGE = "contraction"
ORIGIN = ("x0", "y0", "z0")


def write_contraction(target: str | Path, contraction: Contraction, source: dict[str, str] | None = None) -> None:
    """Write a stage file; "-" is standard output. source names the input and its SHA-256."""
    write_bytes(target, dump_contraction(contraction, source))


def dump_contraction(c: Contraction, source: dict[str, str] | None = None) -> bytes:
    """Return the bytes of a stage file: the same bytes for the same contraction."""
    rings = ply.ragged([c.rings.of(i) for i in range(len(c.rings))])
    vertex = ply.element(
        "vertex",
        {
            **ply.xyz(c.points),
            **ply.xyz(c.origin, ORIGIN),
            "row": c.rows,
            "closed": c.rings.closed.astype(np.uint8),
            **({} if c.sections is None or c.levels is None else {"section": c.sections, "level": c.levels}),
            "ring": rings,
        },
        {"ring": ("u2", "i4")},
    )
    cloud = ply.element(
        "cloud", {**ply.xyz(c.cloud), "row": c.input_rows, "merged_into": c.merged_into, "merged_step": c.merged_step}
    )
    history = ply.element("history", ply.xyz(c.history.reshape(-1, 3)))
    facts = {
        "source": source or {},
        "params": ply.plain(c.params),
        "status": c.status.value,
        "warnings": list(c.warnings),
        "steps": [_step_facts(step) for step in c.steps],
    }
    return ply.dump([vertex, cloud, history], STAGE, facts)


def read_contraction(source: str | Path) -> Contraction:
    """Read a stage file; "-" is standard input."""
    return parse_contraction(read_bytes(source), str(source))


def parse_contraction(data: bytes, name: str) -> Contraction:
    """Return the contraction that a stage file holds."""
    file = ply.parse(data, name)
    facts = ply.facts(file, STAGE, name)
    try:
        vertex, cloud = file["vertex"].data, file["cloud"].data
        return Contraction(
            points=ply.points_of(vertex),
            origin=ply.points_of(vertex, ORIGIN),
            rows=np.array(vertex["row"], np.int32),
            rings=_rings(vertex),
            cloud=ply.points_of(cloud),
            input_rows=np.array(cloud["row"], np.int32),
            merged_into=np.array(cloud["merged_into"], np.int32),
            merged_step=np.array(cloud["merged_step"], np.int32),
            history=ply.points_of(file["history"].data).reshape(-1, len(vertex), 3),
            steps=tuple(StepRecord(**step, seconds={}) for step in facts["steps"]),
            status=Status(facts["status"]),
            warnings=tuple(facts["warnings"]),
            params=ContractionParams(**facts["params"]),
            **_sections(vertex),
        )
    except (KeyError, ValueError, TypeError) as error:
        raise TiskelError(f"{name} is a damaged contraction file: {error}; run tiskel contract again") from None


def _sections(vertex: Any) -> dict[str, Any]:
    """Return what only robust writes."""
    if "section" not in (vertex.dtype.names or ()):
        return {}
    return {"sections": np.array(vertex["section"], np.int32), "levels": np.array(vertex["level"], np.int32)}


def _step_facts(step: StepRecord) -> dict[str, Any]:
    """Return a record without its times, which would differ from run to run."""
    return {
        "contraction_weight": step.contraction_weight,
        "ring_ratio": step.ring_ratio,
        "score": step.score,
        "score_change": step.score_change,
        "points": step.points,
    }


def _rings(vertex: Any) -> Rings:
    sizes = np.array([len(ring) for ring in vertex["ring"]], np.int32)
    members = np.full((len(sizes), max(1, int(sizes.max(initial=1)))), -1, np.int32)
    if len(sizes):
        members[np.arange(members.shape[1]) < sizes[:, None]] = np.concatenate(list(vertex["ring"]))
    if members.max(initial=-1) >= len(sizes):
        raise ValueError("a ring names a point that is not there")
    return Rings(members, sizes, np.array(vertex["closed"], np.int32))
