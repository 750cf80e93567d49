"""How far a fitted surface is off its points, and what a user should know of it."""

from collections.abc import Sequence

import numpy as np

from tiskel.arrays import Indices
from tiskel.slicing.fitted import FittedSurface
from tiskel.slicing.rings import Ring
from tiskel.slicing.sections import Case, Section
from tiskel.surfaces.tube import V_STOP, Tube

MISSING, OFF = 0.3, 0.1  # share of bridged slices, and misfit over the mean radius, that are worth a warning


def misfit(tube: Tube, rings: list[Ring], sections: tuple[Section, ...]) -> tuple[Indices, float]:
    """Return the points of all fitted rings, and how far they are off the surface.

    Points beyond its ends, which the outermost slabs see, are none of it: there the series would run on without them.

    Parameters
    ----------
    tube : Tube
        The surface.
    rings : list of Ring
        What every slice sees.
    sections : tuple of Section
        What became of every slice.

    Returns
    -------
    rows : (p,) int32
        Their rows, ascending.
    error : float
        RMS of what they are off along the radius, over the mean radius.
    """
    good = [ring for ring, section in zip(rings, sections, strict=True) if section.case is Case.FITTED]
    every, u, v, r = (np.concatenate([getattr(ring, name) for ring in good]) for name in ("rows", "u", "v", "r"))
    on = np.flatnonzero((v >= 0) & (v <= V_STOP)) if not tube.closed else np.arange(len(v))
    rows, first = np.unique(every[on], return_index=True)
    fitted = tube.at(u[on[first]], v[on[first]])[1].R
    return rows.astype(np.int32), float(np.sqrt(np.mean((r[on[first]] - fitted) ** 2)) / fitted.mean())


def doubts(surface: FittedSurface) -> tuple[str, ...]:
    """Return warnings about a fitted surface."""
    sections = surface.sections
    lost = [section.case for section in sections if section.case is not Case.FITTED]
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 36), np.linspace(0, V_STOP, 2 * len(sections)))
    crossing, thin = surface.tube.spread(u, v), surface.tube.at(u, v)[1].R
    told = {
        f"{len(lost)} of {len(sections)} slices between its ends were bridged: {counted(lost)}": len(lost)
        > MISSING * len(sections),
        f"the surface is off its points by {surface.error:.0%} of its radius": surface.error > OFF,
        "slices cross where the curve bends sharper than the body is thick; the surface folds there": crossing.min()
        <= 0,
        "the radius is not positive everywhere; the surface folds there": thin.min() <= 0,
    }
    return tuple(f"branch {surface.name}: {line}" for line, holds in told.items() if holds)


def counted(cases: Sequence[Case]) -> str:
    """Return how many slices there are of each case, in words."""
    return ", ".join(f"{cases.count(case)} {case.value}" for case in dict.fromkeys(cases))
