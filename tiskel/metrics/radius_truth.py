"""Radii of a found curve against true ones, by thickness and by what the found radius is said to be worth."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from tiskel.arrays import Mask, Numbers
from tiskel.geometry.feet import Parts, between
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.radius import RadiusSource

THICKNESS = (0.0, 0.5, 1.0, 2.0, 4.0, np.inf)  # spacings: bounds of the classes of the true radius


@dataclass(frozen=True)
class RadiusError:
    """Errors of the radii of one class of thickness and one source; shares are of length.

    Attributes
    ----------
    thickness : (float, float)
        True radii of the class in spacings, from and up to.
    source : RadiusSource
        What the found radii are said to be worth.
    share : float
        Share of the found length near the truth that is of this class and source.
    ratio : float
        Median of found over true radius.
    error : float
        Median of |found - true| / true.
    held : float
        Share where the found radius is at least the true one: of bounds, how often they hold.
    """

    thickness: tuple[float, float]
    source: RadiusSource
    share: float
    ratio: float
    error: float
    held: float

    def as_dict(self) -> dict[str, Any]:
        """Return plain JSON values; the last class has no upper bound, None."""
        low, high = self.thickness
        return asdict(self) | {"thickness": [low, high if np.isfinite(high) else None], "source": self.source.name}


def radius_errors(
    found: CurveGraph, parts: Parts, true: Numbers, near: Mask, spacing: float
) -> tuple[RadiusError, ...]:
    """Return the errors of the radii of a found curve, by thickness and source, thin ones first.

    Parameters
    ----------
    found : CurveGraph
        With radii; where one is NaN, and where the true one is 0, nothing is compared.
    parts : Parts
        Of that curve, (p,) of them.
    true : (p,) float64
        The true radius at the nearest place of the truth, in the unit of the curve.
    near : (p,) bool
        Which parts are near enough to the truth to be compared.
    spacing : float
        Of the cloud, in the same unit.

    Returns
    -------
    tuple of RadiusError
        None of a class and source that there is nothing of.
    """
    radii = between(found.radii, found, parts.edges, parts.shares)
    nearer = np.where(parts.shares < 0.5, *found.edges[parts.edges].T)
    source, ratio = found.radius_sources[nearer], radii / np.where(true > 0, true, np.nan)
    known = near & np.isfinite(ratio)
    kind = np.searchsorted(THICKNESS, true / spacing, side="right") - 1
    total, rows = float(parts.lengths[near].sum()), []
    for low, high, number in zip(THICKNESS, THICKNESS[1:], range(len(THICKNESS)), strict=False):
        for name in RadiusSource:
            these = known & (kind == number) & (source == name)
            if these.any():
                weights = parts.lengths[these]
                rows.append(
                    RadiusError(
                        thickness=(low, high),
                        source=name,
                        share=float(weights.sum()) / total,
                        ratio=_median(ratio[these], weights),
                        error=_median(np.abs(ratio[these] - 1), weights),
                        held=float(weights[ratio[these] >= 1].sum() / weights.sum()),
                    )
                )
    return tuple(rows)


def _median(values: Numbers, weights: Numbers) -> float:
    order = np.argsort(values, kind="stable")
    reached = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(reached, reached[-1] / 2)])
