"""A curve against a true tree, as far as the cloud shows it: length, tips, joints and radii.

Two places agree within the tolerance, 1 % of the diagonal of the observable
truth. Length precision is the share of the found length that is within the
tolerance of the truth, recall the share of the observable length that is within
it of the found curve, F their harmonic mean. The area is the mean F over
tolerances from 0 to 1 local radius of the truth.

Tips and joints agree within the tolerance or the local radius of the truth,
whichever is larger, one to one, see :mod:`tiskel.metrics.matching`.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points, diagonal
from tiskel.geometry.feet import Feet, Parts, between, feet_on, parts_of
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.spacing import spacing_of
from tiskel.metrics.matching import Matched, matched_joints, matched_tips
from tiskel.metrics.observable import STEP, observable
from tiskel.metrics.radius_truth import RadiusError, radius_errors

TOLERANCE = 0.01  # of the diagonal: how near is near
PARTS = 0.1  # of the tolerance: how long the parts are that length is counted in
SHARES = (np.arange(50) + 0.5) / 50  # of the local radius: the tolerances that the area is the mean over


@dataclass(frozen=True)
class TreeAgreement:
    """How a found curve agrees with the observable part of a true tree.

    Attributes
    ----------
    precision : float or None
        Share of the found length within the tolerance of the truth; None where nothing was found.
    recall : float or None
        Share of the observable length within the tolerance of the found curve; None where nothing is observable.
    f : float or None
        Their harmonic mean; 0 where nothing was found, None where nothing is observable.
    area : float or None
        Mean F over tolerances from 0 to 1 local radius; None as F.
    to_truth : float or None
        Mean distance from the found curve to the truth, as a share of the diagonal; None where one has no length.
    from_truth : float or None
        Mean distance from the truth to the found curve, likewise.
    tips : Matched
        Ends.
    joints : Matched
        Joints, each as often as it has branches more than two.
    length : float
        Observable length, in the unit of the input.
    length_ratio : float or None
        Found length over observable length; None where nothing is observable.
    components : int
        Components found minus those of the observable truth.
    loops : int
        Loops found minus those of the observable truth.
    radii : tuple of RadiusError
        Errors of the radii by thickness and source.
    """

    precision: float | None
    recall: float | None
    f: float | None
    area: float | None
    to_truth: float | None
    from_truth: float | None
    tips: Matched
    joints: Matched
    length: float
    length_ratio: float | None
    components: int
    loops: int
    radii: tuple[RadiusError, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return plain JSON values under the names of the fields; tips and joints as four values each."""
        document = {key: value for key, value in asdict(self).items() if key not in ("tips", "joints", "radii")}
        for name, pairs in (("tips", self.tips), ("joints", self.joints)):
            document |= {f"{name}_true": pairs.true, f"{name}_found": pairs.found}
            document |= {f"{name}_recall": pairs.recall, f"{name}_precision": pairs.precision}
        return document | {"radii": [error.as_dict() for error in self.radii]}


@dataclass(frozen=True, eq=False)
class _Way:
    """From the parts of one curve to the nearest places of another."""

    parts: Parts
    feet: Feet
    radii: Numbers  # of the truth, be it the one or the other

    def within(self, reach: float | Numbers) -> float:
        """Return the share of the length that is within reach."""
        return float(self.parts.lengths[self.feet.distances <= reach].sum() / self.parts.lengths.sum())

    def mean(self) -> float:
        return float(np.average(self.feet.distances, weights=self.parts.lengths))


def tree_agreement(found: CurveGraph, truth: CurveGraph, cloud: Points) -> TreeAgreement:
    """Compare a found curve with the part of a true one that a cloud shows.

    Parameters
    ----------
    found : CurveGraph
        The found curve.
    truth : CurveGraph
        The true one, with radii; NaN counts as 0. Loops are allowed.
    cloud : (n, 3) float64
        The points that it was found in, in the unit of both.

    Returns
    -------
    TreeAgreement

    Examples
    --------
    >>> from tiskel import make_shape, shape_graph
    >>> from tiskel.metrics.tree_truth import tree_agreement
    >>> shape = shape_graph("y")
    >>> result = tree_agreement(shape, shape, make_shape(shape)[0])
    >>> round(result.f, 2), result.tips.recall, result.joints.precision
    (1.0, 1.0, 1.0)
    """
    seen = observable(truth, cloud)
    side = diagonal(seen.nodes) if len(seen.nodes) else 0.0
    tolerance, spacing = TOLERANCE * side, spacing_of(cloud)
    ways = _ways(found, seen, PARTS * tolerance)
    lengths = _length_measures(ways, tolerance) if ways else _of_nothing(seen)
    return TreeAgreement(
        **lengths,
        to_truth=ways[0].mean() / side if ways else None,
        from_truth=ways[1].mean() / side if ways else None,
        tips=matched_tips(found, seen, tolerance, STEP * spacing),
        joints=matched_joints(found, seen, tolerance, STEP * spacing),
        length=seen.length,
        length_ratio=found.length / seen.length if seen.length else None,
        components=found.components - seen.components,
        loops=found.loops - seen.loops,
        radii=_radii(found, ways[0], tolerance, spacing) if ways else (),
    )


def _ways(found: CurveGraph, seen: CurveGraph, step: float) -> tuple[_Way, _Way] | None:
    """Return the ways from the found curve to the truth and back, None where one of them has no length."""
    if found.length == 0 or seen.length == 0:
        return None
    parts, own = parts_of(found, step), parts_of(seen, step)
    feet = feet_on(seen, parts.points, step)
    back = feet_on(found, own.points, step)
    radii = [between(seen.radii, seen, place.edges, place.shares) for place in (feet, own)]
    return _Way(parts, feet, radii[0]), _Way(own, back, radii[1])


def _length_measures(ways: tuple[_Way, _Way], tolerance: float) -> dict[str, float | None]:
    precision, recall = (way.within(tolerance) for way in ways)
    area = np.mean([_f(*(way.within(share * way.radii) for way in ways)) for share in SHARES])
    return {"precision": precision, "recall": recall, "f": _f(precision, recall), "area": float(area)}


def _of_nothing(seen: CurveGraph) -> dict[str, float | None]:
    missed = 0.0 if seen.length else None
    return {"precision": None, "recall": missed, "f": missed, "area": missed}


def _f(precision: float, recall: float) -> float:
    return 2 * precision * recall / (precision + recall) if precision + recall else 0.0


def _radii(found: CurveGraph, way: _Way, tolerance: float, spacing: float) -> tuple[RadiusError, ...]:
    near = way.feet.distances <= np.maximum(tolerance, way.radii)
    return radius_errors(found, way.parts, way.radii, near, spacing)
