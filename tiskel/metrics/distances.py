"""Distances of H0 barcodes, exact: every bar is born at zero, so a diagram is a list of deaths.

The ground metric is L-infinity: two bars are |a - b| apart, a bar is a / 2 from
the diagonal. On a line, matched bars need not cross, and that makes both exact
distances cheap.
"""

from heapq import heappop, heappush

import numpy as np

from tiskel.arrays import Numbers
from tiskel.errors import TiskelError


def bottleneck(a: Numbers, b: Numbers, *, diagonal: bool = True) -> float:
    """Return the bottleneck distance of two H0 barcodes.

    With a threshold t every bar longer than 2 t needs a partner within t. If a
    bar goes to the diagonal while a shorter one is matched, the two can change
    places; so the longest are matched in order and the rest go to the diagonal.

    Parameters
    ----------
    a : (n,) float64
        Deaths of the first barcode, in any order and unit.
    b : (m,) float64
        Deaths of the second, in the same unit.
    diagonal : bool
        Whether a bar may be matched to the diagonal.

    Returns
    -------
    float
        In the unit of the deaths.

    Raises
    ------
    TiskelError
        Where the diagonal is not allowed and the counts differ.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.metrics.distances import bottleneck
    >>> bottleneck(np.array([4.0, 1.0]), np.array([3.0]))
    1.0
    """
    a, b = _padded(a, b, diagonal)
    if len(a) == 0:
        return 0.0
    apart = np.abs(a - b)
    if not diagonal:
        return float(apart.max())
    matched = np.maximum.accumulate(np.append(0.0, apart))  # the first m bars of each
    left = np.append(np.maximum(a, b), 0.0) / 2  # the longest of the rest
    return float(np.maximum(matched, left).min())


def wasserstein(a: Numbers, b: Numbers, *, diagonal: bool = True) -> float:
    """Return the 1-Wasserstein distance of two H0 barcodes, the sum over the best matching.

    By its dual: of a function f whose slope is at most 1 and that is at most
    half of x at x, the largest sum over a less that over b. Along the sorted
    bars the best sum as a function of f is concave with integer slopes, so that
    two heaps of the places where these change are all there is to know.

    Parameters
    ----------
    a : (n,) float64
        Deaths of the first barcode, in any order and unit.
    b : (m,) float64
        Deaths of the second, in the same unit.
    diagonal : bool
        Whether a bar may be matched to the diagonal.

    Returns
    -------
    float
        In the unit of the deaths.

    Raises
    ------
    TiskelError
        Where the diagonal is not allowed and the counts differ.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.metrics.distances import wasserstein
    >>> wasserstein(np.array([4.0, 1.0]), np.array([3.0]))
    1.5
    """
    a, b = _padded(a, b, diagonal)
    if not diagonal:
        return float(np.abs(a - b).sum())
    places = np.concatenate([a, b])
    order = np.argsort(places, kind="stable")
    return _largest_sum(places[order].tolist(), (order < len(a)).tolist())


def _largest_sum(places: list[float], gains: list[bool]) -> float:
    """Return the largest sum of f at the places that are gains, less that at the others; places ascending.

    From place to place what rises moves down by their distance and what falls
    moves up by it, since f may change by so much; a gain makes the first fall
    a rise.
    """
    rises: list[float] = []  # where slopes above 0 end: negative, the place added
    falls: list[float] = []  # where slopes below 0 begin, less the place
    total = 0.0
    for x, gain in zip(places, gains, strict=True):
        if gain:
            f = min(heappop(falls) + x, x / 2) if falls else x / 2
            total += f
            heappush(rises, -(f + x))
        else:
            f = max(-heappop(rises) - x, -x / 2) if rises else -x / 2
            total -= f
            heappush(falls, f - x)
    return total


def _padded(a: Numbers, b: Numbers, diagonal: bool) -> tuple[Numbers, Numbers]:
    """Return both longest first and equally many; a bar of length zero lies on the diagonal already."""
    if len(a) != len(b) and not diagonal:
        raise TiskelError(f"{len(a)} bars cannot be matched to {len(b)} one by one; allow the diagonal")
    made = np.zeros((2, max(len(a), len(b))))
    made[0, : len(a)], made[1, : len(b)] = np.sort(a)[::-1], np.sort(b)[::-1]
    return made[0], made[1]
