"""What the stages tell a user: the lines of every result, worded here and nowhere else."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tiskel.contraction import Contraction
    from tiskel.metrics.stability import Stability
    from tiskel.rolling.trajectory import Trajectory
    from tiskel.skeleton import Skeleton
    from tiskel.slicing.fitted import FittedSurface, Surfaces
    from tiskel.surfaces.patches import BodySurface

NAMED = 5  #: branches, or reasons, that a summary names
OF_BRANCH = re.compile(r"branch (\S+): (.*)", re.DOTALL)  #: a line about one branch


@dataclass(frozen=True)
class Message:
    """One line for a user; a warning where the result may not be what they think it is.

    Attributes
    ----------
    text : str
        The line.
    warning : bool
        Whether it is a warning.
    detail : bool
        Whether another line sums it up, with others of its kind.
    """

    text: str
    warning: bool = False
    detail: bool = False


Messages = tuple[Message, ...]


def said(lines: Iterable[str]) -> Messages:
    """Return plain messages."""
    return tuple(map(Message, lines))


def warned(lines: Iterable[object]) -> Messages:
    """Return warnings, each line once."""
    return tuple(Message(line, warning=True) for line in dict.fromkeys(map(str, lines)))


def of_contraction(c: "Contraction") -> Messages:
    """Return the warnings, how many points are stray, then how many are left and why it stopped."""
    line = (
        f"contracted {len(c.cloud)} points in {len(c.steps)} steps, {len(c.points)} left "
        f"({len(c.points) / len(c.cloud):.1%}); {c.status.value}: {c.status.advice}"
    )
    return (*warned(c.warnings), *of_strays(int(c.strays.sum())), Message(line))


def of_strays(count: int) -> Messages:
    """Return how many points of a cloud are stray, nothing where none is."""
    points = "1 stray point is" if count == 1 else f"{count} stray points are"
    return (Message(f"{points} left out: alone, far from the others, or repeated at one place"),) if count else ()


def of_skeleton(s: "Skeleton") -> Messages:
    """Return the warnings, then the notes, then the counts of the graph."""
    line = (
        f"{len(s.nodes)} nodes, {len(s.edges)} edges: components {s.components}, loops {s.loops}, ends {s.ends}, "
        f"joints {s.junctions}, branches {len(s.branches)}, length {s.length:.6g}"
    )
    return (*warned(s.warnings), *said(f"note: {note}" for note in s.notes), Message(line))


def document_of_skeleton(name: str, s: "Skeleton") -> dict[str, Any]:
    """Return what a script wants to know of a skeleton as JSON values: what it was made of, counts, warnings, notes."""
    return {"file": name, "graph": {"nodes": len(s.nodes), "edges": len(s.edges), **s.counts()}, **s.doubts()}


def document_of_run(name: str, s: "Skeleton", parts: "Iterable[tuple[str, Messages]]") -> dict[str, Any]:
    """Return the same of a whole run: warnings of other parts (name, messages) have the part's name as their code."""
    from tiskel.geometry.doubt import CurveWarning

    document = document_of_skeleton(name, s)
    for part, lines in parts:
        if part != "skeleton":
            document["warnings"] += [CurveWarning(part, line.text).as_dict() for line in lines if line.warning]
    return document


def of_stability(stability: "Stability") -> Messages:
    """Return the verdict."""
    return (Message(f"{'stable' if stability.stable else 'not stable'}: {stability.reason}"),)


def of_surfaces(surfaces: "Surfaces") -> Messages:
    """Return the surfaces, in one line where there are several, why other branches have none, coverage, warnings."""
    body = () if surfaces.body is None else (surfaces.body,)
    warnings = (warning for surface in (*surfaces, *body) for warning in surface.warnings)
    told = (*_of_branches(surfaces), *_of_rejected(surfaces.rejected), *of_coverage(surfaces), *said(map(_body, body)))
    return (*told, *warned(grouped(warnings)))


def grouped(lines: Iterable[str]) -> list[str]:
    """Return lines, those that say the same of several branches as one.

    Examples
    --------
    >>> from tiskel.messages import grouped
    >>> grouped(["branch 0: it folds", "whole body: it leaks", "branch 4: it folds"])
    ['branches 0, 4: it folds', 'whole body: it leaks']
    """
    names: dict[str, list[str]] = {}
    for line in lines:
        found = OF_BRANCH.fullmatch(line)
        name, text = found.groups() if found else ("", line)
        names.setdefault(text, []).append(name)
    return [_of_names(which) + text for text, which in names.items()]


def _of_names(names: list[str]) -> str:
    named = [name for name in names if name]
    more = f" and {len(named) - NAMED} more" if len(named) > NAMED else ""
    return f"branch{'es' * (len(named) > 1)} {', '.join(named[:NAMED])}{more}: " if named else ""


def _of_branches(surfaces: "Surfaces") -> Messages:
    lines = [_surface(surface) for surface in surfaces]
    if len(lines) < 2:
        return said(lines)
    fitted = list(surfaces)
    ranges = ", ".join(
        f"{name} {min(values):.3g} to {max(values):.3g}"
        for name, values in (
            ("lengths", [s.length for s in fitted]),
            ("radii", [s.radius for s in fitted]),
            ("mean distances to their points", [s.distance["mean"] for s in fitted]),
        )
    )
    return (Message(f"{len(lines)} branches have surfaces: {ranges}"), *(Message(line, detail=True) for line in lines))


def _of_rejected(rejected: "Mapping[str, str]") -> Messages:
    lines = [f"branch {name} has no surface: {reason}" for name, reason in rejected.items()]
    if len(lines) < 2:
        return said(lines)
    counts = Counter(rejected.values()).most_common()
    reasons = "; ".join(f"{reason} ({count})" for reason, count in counts[:NAMED])
    more = f"; {len(counts) - NAMED} other reasons" if len(counts) > NAMED else ""
    summary = Message(f"{len(lines)} branches have no surface: {reasons}{more}")
    return (summary, *(Message(line, detail=True) for line in lines))


def of_coverage(surfaces: "Surfaces") -> Messages:
    """Return how much the surfaces cover, nothing where a file of an older version does not say."""
    c = surfaces.coverage
    if c is None:
        return ()
    off = ", ".join(f"{name} {c.radii[key]:.2g}" for name, key in (("mean", "mean"), ("95 %", "p95"), ("most", "max")))
    line = (
        f"{c.points:.0%} of the points lie within 5 % of the local radius of a surface, {c.length:.0%} of the curve "
        f"has one; all points are off by local radii of {off}"
    )
    return said([line])


def _body(b: "BodySurface") -> str:
    off = b.summary
    return (
        f"whole body: {len(b.patches)} patches, {b.of_tubes:.0%} of them of tubes; {off['coverage']:.1%} of the points "
        f"within 5 % of the local radius; distance in local radii: mean {off['mean']:.2%}, 95 % {off['p95']:.2%}; "
        f"{b.share(1):.1%} of it little seen, {b.share(0):.1%} bridged"
    )


def _surface(s: "FittedSurface") -> str:
    off, cases = s.distance, ", ".join(f"{count} {case}" for case, count in s.cases().items())
    frame = f"frame {s.frame}" + (f" ({s.note})" if s.note else "")
    frame += f"; {s.unseen:.0%} of it unseen and rounded off" if s.unseen > 0 else ""
    return (
        f"branch {s.name}: length {s.length:.6g}, radius {s.radius:.4g}, order {s.order}, slices: {cases}; {frame}; "
        f"distance to {len(s.rows)} points: mean {off['mean']:.3g}, 95 % {off['p95']:.3g}, most {off['max']:.3g}"
    )


def of_runs(runs: "Sequence[Trajectory]") -> Messages:
    """Return a line for every run of a sphere, then the warnings."""
    return (*said(map(_run, runs)), *warned(warning for run in runs for warning in run.warnings))


def _run(r: "Trajectory") -> str:
    return (
        f"{r.params.model} model, sphere of radius {r.radius:.4g} {r.params.side}: {r.status.value}, {r.reason}; "
        f"way over the object {r.path_object:.6g}, over the sphere {r.path_sphere:.6g}"
    )
