"""From sections to one series along the curve: its order, and coefficients that are smooth in v."""

from dataclasses import replace

import numpy as np

from tiskel.geometry.bspline import BSplineCurve, fit_bspline
from tiskel.params import SurfaceParams
from tiskel.slicing.rings import Ring
from tiskel.slicing.sections import Case, Section, fit_section, left_out_error, rim_of
from tiskel.surfaces.tube import V_STOP

SIMPLER = 1.005  # factor on the error of points left out that one order more must save: noise alone saves nothing;
# of 1.02 the horse's neck had order 4 instead of 6, and a tube within 5 % of R of 58 % of all points instead of 59.4
UNLIKE, LEAST_UNLIKE = 3.0, 0.08  # median errors, and mean radii, that a section is off its points at most
BRIDGED = 0.1  # weight of what stands in for a rejected slice
JUDGED, SHOWN = 30, 1000  # sections that choose the order, and points of each: more say the same, and take longer
ENDS = (0, 1, 0.0), (-1, -2, V_STOP)  # the sections that say where the surface ends, and its end


def chosen_order(pairs: list[tuple[float, Ring]], params: SurfaceParams) -> int:
    """Return the order of the series by which points that are left out are met best, a simpler one where it is as good.

    All orders are tried: a section with symmetry has no odd harmonics, and the next order alone would say nothing.

    Parameters
    ----------
    pairs : list of (float, Ring)
        v of every slice, and its points.
    params : SurfaceParams
        ``least_order`` and ``most_order`` count.
    """
    orders = range(params.least_order, params.most_order + 1)
    judged = _judges(pairs, params)
    errors = [_judged(judged, order) * SIMPLER ** (order - params.least_order) for order in orders]
    return orders[int(np.argmin(errors))]


def _judges(pairs: list[tuple[float, Ring]], params: SurfaceParams) -> list[tuple[float, Ring]]:
    """Return the slices that choose the order: those that the lowest or the highest order fits."""
    ends = params.least_order, params.most_order
    few = [(v, _thinned(ring)) for v, ring in pairs]
    good = [pair for pair in few if any(fit_section(*pair, order, params).case is Case.FITTED for order in ends)]
    return good[:: -(-len(good) // JUDGED) or 1]


def _thinned(ring: Ring) -> Ring:
    """Return every k-th point of a ring, in the order of the cloud."""
    return ring.part(np.arange(len(ring.u)) % -(-len(ring.u) // SHOWN) == 0) if len(ring.u) > SHOWN else ring


def fit_sections(
    pairs: list[tuple[float, Ring]], order: int, params: SurfaceParams, closed: bool = False
) -> tuple[Section, ...]:
    """Return the sections, all of one order, or each of its own, as published.

    Slices at the ends that lie in a face are fitted to its rim.

    Parameters
    ----------
    pairs : list of (float, Ring)
        v of every slice, and its points.
    order : int
        The order of the series, unless the rule is "published".
    params : SurfaceParams
        The settings.
    closed : bool
        Whether the skeleton curve is a loop, without ends.

    Returns
    -------
    tuple of Section
    """
    if params.order_rule == "published":
        return without_unlike(tuple(_published(v, ring, params) for v, ring in pairs))
    found = list(without_unlike(tuple(fit_section(v, ring, order, params) for v, ring in pairs)))
    for way in () if closed else (range(len(found)), range(len(found) - 1, -1, -1)):
        for i in way:
            if found[i].case is Case.FITTED or (rim := rim_of(pairs[i][1])) is None:
                break
            faced = fit_section(pairs[i][0], rim, order, params)
            if faced.case is Case.FITTED and faced.error < LEAST_UNLIKE:
                found[i] = faced
    return tuple(found)


def without_unlike(sections: tuple[Section, ...]) -> tuple[Section, ...]:
    """Reject sections that are off their points far more than most, as those through junctions are."""
    errors = np.array([section.error for section in sections if section.case is Case.FITTED])
    most = max(UNLIKE * float(np.median(errors)), LEAST_UNLIKE) if len(errors) else np.inf
    return tuple(
        replace(section, case=Case.ROUGH, series=np.zeros(0), error=np.nan) if section.error > most else section
        for section in sections
    )


def _judged(pairs: list[tuple[float, Ring]], order: int) -> float:
    enough = [pair for pair in pairs if len(pair[1].u) > 2 * order + 5]
    return float(np.mean([left_out_error(v, ring, order) for v, ring in enough])) if enough else np.inf


def _published(v: float, ring: Ring, params: SurfaceParams) -> Section:
    """Return the section of the lowest order whose RMS error is small enough, or of the highest."""
    for order in range(params.least_order, params.most_order + 1):
        section = fit_section(v, ring, order, params)
        if section.case is not Case.FITTED or section.error * section.series[0] < params.fit_error:
            break
    return section


def joined_series(sections: tuple[Section, ...], intervals: int, closed: bool) -> BSplineCurve:
    """Return the coefficients of the series as functions of v.

    Straight, though lightly held, over rejected slices, and straight on to the
    ends, half a slice away: a spline alone would run off where nothing holds it.

    Parameters
    ----------
    sections : tuple of Section
        Every slice, fitted or rejected; some are fitted.
    intervals : int
        Of the spline.
    closed : bool
        Whether the skeleton curve is a loop.

    Returns
    -------
    BSplineCurve
        Columns a0, a1, b1, a2, b2, ..., in the input's unit; v from 0 to pi.
    """
    good = [section for section in sections if section.case is Case.FITTED]
    series = np.zeros((len(good), max(len(section.series) for section in good)))
    for row, section in zip(series, good, strict=True):
        row[: len(section.series)] = section.series
    v, weights = np.array([section.v for section in good]), np.array([float(section.points) for section in good])
    weights /= weights.mean()
    bridged = np.array([section.v for section in sections if section.case is not Case.FITTED])
    period = V_STOP if closed else None
    over = [np.interp(bridged, v, column, period=period) for column in series.T]
    places, values, held = [v, bridged], [series, np.stack(over, axis=1)], [weights]
    held.append(np.full(len(bridged), BRIDGED))
    if not closed:
        places.append(np.array([to for _, _, to in ENDS]))
        values.append(
            np.array([series[i] + (to - v[i]) / (v[i] - v[j]) * (series[i] - series[j]) for i, j, to in ENDS])
        )
        held.append(weights[[i for i, _, _ in ENDS]])
    v, series, weights = (np.concatenate(parts) for parts in (places, values, held))
    return fit_bspline(v, series, weights, intervals, V_STOP, periodic=closed)
