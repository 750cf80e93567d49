"""Gaps between the angles of a section: where they are, and what holds a Fourier series in them."""

import numpy as np

from tiskel.arrays import Numbers, Table

WIDE, PROBES = 0.35, 12  # radians of a gap in which points say nothing; places in it
AWAY = 1.5  # the longest of its points that a series may be in a gap, and one over the shortest


def largest_gap(u: Numbers) -> tuple[float, float]:
    """Return the largest angle between neighbours among angles u (k,), and its middle; 2 pi for fewer than two."""
    if len(u) < 2:
        return 2 * np.pi, float(np.mod(u[0] + np.pi, 2 * np.pi)) if len(u) else 0.0
    ordered, widths = gaps_of(u)
    widest = int(widths.argmax())
    return float(widths[widest]), float(np.mod(ordered[widest] + widths[widest] / 2, 2 * np.pi))


def gaps_of(u: Numbers) -> tuple[Numbers, Numbers]:
    """Return the angles u (k,) in order, and how far it is from each to the next around the circle, in radians."""
    ordered = np.sort(np.mod(u, 2 * np.pi))
    return ordered, np.diff(np.append(ordered, ordered[0] + 2 * np.pi))


def waves_of(u: Numbers, order: int) -> Table:
    """Return (k, 2 N) for angles u (k,): sin u, cos u, sin 2u, cos 2u ... up to order N."""
    i = np.arange(1, order + 1)
    return np.stack([np.sin(u[:, None] * i), np.cos(u[:, None] * i)], axis=2).reshape(len(u), -1)


def places_in_gaps(u: Numbers) -> Numbers:
    """Return angles (m,) spread over the wide gaps of angles u (k,), nothing where it has none."""
    ordered, widths = gaps_of(u)
    share = np.linspace(0, 1, PROBES + 2)[1:-1]
    places = [ordered[i] + widths[i] * share for i in np.flatnonzero(widths > WIDE)]
    return np.concatenate(places) if places else np.zeros(0)


def roughness_in_gaps(u: Numbers, order: int) -> Table:
    """Return (2 N + 1, 2 N + 1) the roughness of a series in gaps of angles u (k,): the mean square of R_uu + R - a0.

    Points say nothing of waves that fit into a gap between them; this does. To first order it
    is 0 of circles, about the skeleton or not: what is not seen is rounded off.
    """
    at = places_in_gaps(u)
    if len(at) == 0:
        return np.zeros((2 * order + 1, 2 * order + 1))
    turns = (1 - np.repeat(np.arange(1, order + 1) ** 2, 2)) * waves_of(at, order)
    bend = np.concatenate([np.zeros((len(at), 1)), turns], axis=1)
    return np.asarray(bend.T @ bend / len(at))


def runs_away(solution: Numbers, u: Numbers, r: Numbers, order: int) -> bool:
    """Tell whether a series is somewhere in the gaps of angles u (k,) far from all distances r (m,) met elsewhere."""
    at = places_in_gaps(u)
    if len(at) == 0:
        return False
    fitted = solution[0] + waves_of(at, order) @ solution[1 : 2 * order + 1]
    return bool(fitted.max() > AWAY * r.max() or fitted.min() < r.min() / AWAY)
