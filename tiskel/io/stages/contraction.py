"""The stage file ``contraction.ply``, format 2.

Elements: ``vertex``, the contracted points, each with its original position (x0
y0 z0) and its row in ``cloud``; by lbc and gls also with the end of its ring in
``ring_member`` and whether it is closed (its last member connects to the first),
by robust with its section and level, and, of points on a mesh, with the normal
and the area of the mesh; ``surface_link``, points whose cells on that mesh touch;
``ring_member``, the members of all rings one after the other, by place in
``vertex``; ``cloud``, every finite input point with its row in the input, the row
of ``cloud`` it was merged into and the step of that (-1: it is left; step 0: a
duplicate, or a stray point); ``history``, where it was asked for, the positions of
the points that are left after each step, step by step.

Format 1, which is still read, has a list property ``ring`` in ``vertex``, the
history always, and the neighbours of robust as rings.
"""

from pathlib import Path
from typing import Any

import numpy as np

from tiskel.arrays import Stack
from tiskel.contraction import Contraction
from tiskel.errors import TiskelError
from tiskel.geometry.rings import Rings
from tiskel.io import ply
from tiskel.io.stages import door
from tiskel.io.stages.mesh import surface_columns, surface_elements, surface_facts, surface_from
from tiskel.io.streams import Bytes, mapped, write_bytes
from tiskel.methods.trace import Sections, Status, StepRecord
from tiskel.params import known_settings

STAGE = "contraction"
ORIGIN = ("x0", "y0", "z0")
MOST_LEVELS = 2**24  #: bins of a front; there are more points than bins, but for gaps


def write_contraction(
    target: str | Path, contraction: Contraction, source: dict[str, str] | None = None, *, history: bool = False
) -> None:
    """Write a stage file.

    Parameters
    ----------
    target : path, or "-" for standard output
        Where to.
    contraction : Contraction
        What is written.
    source : dict, optional
        Name and SHA-256 of the input.
    history : bool
        Whether the positions after every step are written too; :func:`tiskel.assess_stability` needs them.

    Raises
    ------
    TiskelError
        Where the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from tiskel import contract, make_shape, read_contraction, shape_graph, write_contraction
    >>> c = contract(make_shape(shape_graph("capsule"))[0])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_contraction(f"{folder}/c.ply", c)
    ...     bool((read_contraction(f"{folder}/c.ply").points == c.points).all())
    True
    """
    write_bytes(target, dump_contraction(contraction, source, history=history))


def dump_contraction(c: Contraction, source: dict[str, str] | None = None, *, history: bool = False) -> bytes:
    """Return the bytes of a stage file, the same for the same contraction; see :func:`write_contraction`."""
    vertex: dict[str, Any] = {**ply.xyz(c.points), **ply.xyz(c.origin, ORIGIN), "row": c.rows}
    if c.rings is not None:
        vertex |= {"ring_end": np.cumsum(c.rings.sizes, dtype=np.int32), "closed": c.rings.closed.astype(np.uint8)}
    if c.sections is not None:
        vertex |= {"section": c.sections.section, "level": c.sections.level}
    cloud: dict[str, Any] = {
        **ply.xyz(c.cloud),
        "row": c.input_rows,
        "merged_into": c.merged_into,
        "merged_step": c.merged_step,
    }
    vertex |= surface_columns(c.surface)
    elements = [ply.element("vertex", vertex), ply.element("cloud", cloud), *surface_elements(c.surface)]
    if c.rings is not None:
        elements.append(ply.element("ring_member", {"place": c.rings.members[c.rings.mask()]}))
    if history:
        elements.append(ply.element("history", ply.xyz(c.history.reshape(-1, 3))))
    facts = {
        "source": source or {},
        "params": ply.plain(c.params),
        "status": c.status.value,
        "warnings": list(c.warnings),
        "steps": [_step_facts(step) for step in c.steps],
        **surface_facts(c.surface),
    }
    return ply.dump(elements, STAGE, facts)


def read_contraction(source: str | Path) -> Contraction:
    """Read a stage file.

    Parameters
    ----------
    source : str or Path
        A path, or "-" for standard input.

    Returns
    -------
    Contraction

    Raises
    ------
    TiskelError
        Where the file is missing, damaged, or none of this stage.

    Examples
    --------
    >>> from tiskel import TiskelError, read_contraction
    >>> try:
    ...     read_contraction("missing.ply")
    ... except TiskelError as error:
    ...     print(error)
    no file missing.ply; check the path
    """
    return parse_contraction(mapped(source), str(source))


def parse_contraction(data: Bytes, name: str) -> Contraction:
    """Return the contraction in the bytes of a stage file.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where the file is damaged or none of this stage.
    """
    file = ply.parse(data, name)
    facts = ply.facts(file, STAGE, name)
    try:
        vertex, cloud = door.element(file, "vertex"), door.element(file, "cloud")
        rows = door.once(door.whole(vertex, "vertex", "row", len(cloud)), "vertex", "row")
        merged_into = door.whole(cloud, "cloud", "merged_into", len(cloud), none=True)
        door.check_chains(merged_into, rows)
        return Contraction(
            points=door.places(vertex, "vertex"),
            origin=door.places(vertex, "vertex", ORIGIN),
            rows=rows,
            cloud=door.places(cloud, "cloud"),
            input_rows=door.whole(cloud, "cloud", "row"),
            merged_into=merged_into,
            merged_step=door.whole(cloud, "cloud", "merged_step", none=True),
            history=_history(file, len(vertex)),
            steps=tuple(map(_step_from, facts["steps"])),
            status=Status(facts["status"]),
            warnings=tuple(map(str, facts["warnings"])),
            params=known_settings(facts["params"]),
            rings=_rings(file, len(data)),
            sections=_sections(vertex),
            surface=surface_from(file, facts),
        )
    except (KeyError, ValueError, TypeError, AttributeError, IndexError, OverflowError) as error:
        raise TiskelError(f"{name} is a damaged contraction file: {error}; run tiskel contract again") from None


def _history(file: Any, count: int) -> Stack:
    if "history" not in file:
        return np.zeros((0, count, 3))
    places = door.places(door.element(file, "history"), "history")
    if count == 0 or len(places) % count:
        raise ValueError(f"element 'history' has {len(places)} rows, {count} are left after each step")
    return places.reshape(-1, count, 3)


def _sections(vertex: Any) -> Sections | None:
    """Return what only robust writes."""
    if "section" not in (vertex.dtype.names or ()):
        return None
    section = door.whole(vertex, "vertex", "section", len(vertex), none=True)
    return Sections(section, door.whole(vertex, "vertex", "level", MOST_LEVELS, none=True))


def _step_from(said: Any) -> StepRecord:
    """Return the record that a file has of a step."""
    score, change = (None if said[key] is None else float(said[key]) for key in ("score", "score_change"))
    weight, ratio = float(said["contraction_weight"]), float(said["ring_ratio"])
    return StepRecord(weight, ratio, score, change, int(said["points"]), seconds={})


def _step_facts(step: StepRecord) -> dict[str, Any]:
    """Return a record without its times, which would differ from run to run."""
    return {
        "contraction_weight": step.contraction_weight,
        "ring_ratio": step.ring_ratio,
        "score": step.score,
        "score_change": step.score_change,
        "points": step.points,
    }


def _rings(file: Any, given: int) -> Rings | None:
    """Return the rings that lbc and gls write, in a file of so many bytes."""
    vertex = door.element(file, "vertex")
    names = vertex.dtype.names or ()
    if "section" in names or not {"ring_end", "ring"} & set(names):
        return None
    if "ring_end" in names:
        ends = door.whole(vertex, "vertex", "ring_end").astype(np.int64)
        flat = door.whole(door.element(file, "ring_member"), "ring_member", "place", len(vertex))
        sizes = np.diff(ends, prepend=0)
        if len(flat) != (ends[-1] if len(ends) else 0) or (sizes < 0).any():
            raise ValueError(f"rings end at {ends[-1] if len(ends) else 0}, {len(flat)} members are listed")
    else:
        sizes = np.array([len(ring) for ring in vertex["ring"]], np.int64)
        listed = np.concatenate([np.zeros(0, np.int32), *vertex["ring"]])
        flat = door.numbered(listed, "rings of element 'vertex'", "a member", len(vertex))
    door.check_room(4 * len(sizes) * int(sizes.max(initial=1)), given, "the rings")
    members = np.full((len(sizes), max(1, int(sizes.max(initial=1)))), -1, np.int32)
    members[np.arange(members.shape[1]) < sizes[:, None]] = flat
    return Rings(members, sizes.astype(np.int32), door.whole(vertex, "vertex", "closed", 2))
