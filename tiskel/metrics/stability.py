"""Is a contraction stable: do normals and curvatures change from step to step as they do where a curve comes out?

On a curve the normal of a principal component analysis is any direction across it. Oriented by one rule, before and
after, the angle between the two is then uniform between 0 and a right angle: D = angle / pi has mean 1/4, spread 0.144
and skewness 0. On a surface that has hardly moved D is near 0; where points have drifted along the shape it exceeds
1/2. The distance from uniform is judged, and the change of curvature, which grows where a clump or thick tube is left.

Departure from print (Proposition 4.2, Fig 4.12): there D is first skewed, then symmetric about 1/2, and that is taken
as a sign of stability. It is so with normals oriented towards the origin, as the author's routine does: a contracted
cloud has its origin to one side here, to the other there. It is not so with normals oriented by one rule before and
after, and with random signs it is so at every step, on every cloud, good or bad. All three are reported; the verdict is
by the first rule, and the control by random signs fails the test. ``normals`` says whose angles the pictures show.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from tiskel.arrays import Mask, Numbers, Points
from tiskel.contraction import Contraction
from tiskel.errors import TiskelError
from tiskel.geometry.neighbours import nearest_neighbours, principal_axes
from tiskel.geometry.oriented import OrientedCloud, oriented_cloud
from tiskel.metrics.distributions import UNIFORM_UP_TO, Distribution, distance_from_uniform, distribution
from tiskel.metrics.hulls import outside_hull
from tiskel.params import StabilityParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import StabilitySettings
from tiskel.progress import Report, Span
from tiskel.shown import Brief

BEYOND = 0.12  # share of angles over a right one that is named as the reason


@dataclass(frozen=True, eq=False)
class StepStability:
    """One step held against the original.

    Attributes
    ----------
    angles : (m,) float64, D_theta = arccos(n_k . n_0) / pi of each point, under the rule that was asked for.
    curvatures : (m,) float64, kappa_k - kappa_0 of each point.
    angle : Distribution of the angles with normals away from the final points.
    curvature : Distribution of the curvatures.
    origin : Distribution of the angles with normals towards the origin, as the author's routine orients them.
    control : Distribution of the angles under random signs.
    distance : float, the largest difference of the angles' cumulative distribution from the uniform one on [0, 1/2].
    control_distance : float, the same of the control.
    median_curvature : float, the median of the curvatures.
    in_hull : float, share of points in the convex hull of the step before.
    in_cloud : float or None, share of points inside the original cloud; None where its normals cannot be oriented.
    control_passes : bool, whether random signs would be judged stable; if so, this step is no evidence.
    stable : bool, the verdict.
    reason : str, why.
    """

    angles: Numbers
    curvatures: Numbers
    angle: Distribution
    curvature: Distribution
    origin: Distribution
    control: Distribution
    distance: float
    control_distance: float
    median_curvature: float
    in_hull: float
    in_cloud: float | None
    control_passes: bool
    stable: bool
    reason: str


@dataclass(frozen=True, eq=False, repr=False)
class Stability(Brief):
    """The steps of a contraction; its verdict is that of the last.

    Attributes
    ----------
    steps : tuple of StepStability, one per accepted step.
    points : int, how many points survive all steps.
    params : StabilityParams, the settings.

    Examples
    --------
    >>> from tiskel import ShapeParams, assess_stability, contract, make_shape, shape_graph
    >>> stability = assess_stability(contract(make_shape(shape_graph("capsule"), ShapeParams(count=1000))[0]))
    >>> stability.stable, stability.points, len(stability.steps) == len(stability.as_dict()["steps"])
    (True, 1000, True)
    """

    _said = ("stable", "reason", "points", "steps")

    steps: tuple[StepStability, ...]
    points: int
    params: StabilityParams

    @property
    def stable(self) -> bool:
        """Whether the last step is stable."""
        return self.steps[-1].stable

    @property
    def reason(self) -> str:
        """Why it is, or why not, in one sentence."""
        return self.steps[-1].reason

    def as_dict(self) -> dict[str, Any]:
        """Return plain JSON values, without the arrays."""
        return {
            "stable": self.stable,
            "reason": self.reason,
            "points": self.points,
            "steps": [{"step": number, **_plain(step)} for number, step in enumerate(self.steps, 1)],
            "settings": asdict(self.params),
        }


def _plain(step: StepStability) -> dict[str, Any]:
    return {key: value for key, value in asdict(step).items() if key not in ("angles", "curvatures")}


def assess_stability(
    contraction: Contraction, params: StabilityParams | None = None, *, progress: Report | None = None,
    **settings: Unpack[StabilitySettings],
) -> Stability:  # fmt: skip
    """Judge the steps of a contraction by how normals and curvatures change.

    Only points that survive all steps count; both normals of a point are oriented away from its final position.

    Parameters
    ----------
    contraction : Contraction, with its history.
    params : StabilityParams, optional; the settings.
    progress : callable, optional; called with a :class:`tiskel.Progress` as parts begin.
    **settings : those of :class:`tiskel.StabilityParams` by name; over those of params.

    Raises
    ------
    TiskelError : where the contraction kept no step, or its file no history.

    Examples
    --------
    >>> from tiskel import ShapeParams, assess_stability, contract, make_shape, shape_graph
    >>> assess_stability(contract(make_shape(shape_graph("banana"), ShapeParams(count=1000))[0])).stable
    True
    """
    params = settled(StabilityParams, params, settings)
    c, span = contraction, Span(progress, "stability")
    span.at(0, "normals")
    if len(c.history) == 0 and len(c.steps):
        raise TiskelError("the contraction file holds no history; write it with: tiskel contract --history")
    if len(c.history) == 0 or len(c.points) == 0:
        raise TiskelError(f"the contraction kept {len(c.history)} steps; there is nothing to compare")
    surface, outward = oriented_cloud(*_surface_arguments(c)), c.origin - c.points
    normals, curvature = oriented_normals(c.origin, outward, params.neighbours)
    signs = np.random.default_rng(params.seed).integers(2, size=len(c.origin))
    centre = (c.cloud.min(axis=0) + c.cloud.max(axis=0)) / 2  # the origin of normalised coordinates
    facing = _faces(normals, centre - c.origin)
    before, steps = c.origin, []
    for number, positions in enumerate(c.history, 1):
        span.at(number / (len(c.history) + 1), f"step {number}")
        turned, bent = oriented_normals(positions, outward, params.neighbours)
        angles = np.arccos(np.clip(np.einsum("ij,ij->i", normals, turned), -1, 1)) / np.pi
        faces = _faces(turned, centre - positions)
        by_rule = {
            "outward": angles,
            "origin": np.where(facing == faces, angles, 1 - angles),
            "random": np.where(signs, angles, 1 - angles),
        }
        steps.append(_judged(by_rule, bent - curvature, _containment(positions, before, surface), params))
        before = positions
    span.at(1)
    return Stability(tuple(steps), len(c.origin), params)


def _surface_arguments(c: Contraction) -> tuple[Points, Points]:
    """Return the distinct points of the cloud and where each contracts to."""
    distinct = c.merged_step != 0
    return np.ascontiguousarray(c.cloud[distinct]), c.points[c.survivor_of()][distinct]


def oriented_normals(points: Points, outward: Points, neighbours: int) -> tuple[Points, Numbers]:
    """Return normals (m, 3) on the side of outward (m, 3), and curvatures (m,): smallest eigenvalue over their sum."""
    near = nearest_neighbours(points := np.ascontiguousarray(points), min(neighbours, len(points)))[0]
    values, axes = principal_axes(points, near)
    normals, total = axes[:, 2], values.sum(axis=1)
    sign = np.where(np.einsum("ij,ij->i", normals, outward) < 0, -1.0, 1.0)
    return normals * sign[:, None], np.divide(values[:, 2], total, out=np.zeros(len(points)), where=total > 0)


def _faces(normals: Points, towards: Points) -> Mask:
    """Return (m,) whether normals (m, 3) look towards a place, by their largest component alone [T]."""
    largest = np.abs(normals).argmax(axis=1)[:, None]
    return np.asarray(np.take_along_axis(normals * towards, largest, axis=1)[:, 0] > 0)


def _containment(points: Points, before: Points, surface: OrientedCloud) -> tuple[float, float | None]:
    """Return the shares of points in the convex hull of the step before, and inside the original cloud."""
    inside = float(surface.contains(points).mean()) if surface.trusted else None
    return float((~outside_hull(points, before)).mean()), inside


def _judged(
    by_rule: dict[str, Numbers], curvatures: Numbers, places: tuple[float, float | None], params: StabilityParams
) -> StepStability:
    """Judge a step by its angles under the three rules of orientation, changes of curvature, and shares inside."""
    angles, control = by_rule["outward"], by_rule["random"]
    distance, median = distance_from_uniform(angles), float(np.median(curvatures))
    stable, reason = verdict(distance, median, angles, params)
    control_distance = distance_from_uniform(control)
    return StepStability(
        angles=by_rule[params.normals],
        curvatures=curvatures,
        angle=distribution(angles, "angle", params),
        curvature=distribution(curvatures, "curvature", params),
        origin=distribution(by_rule["origin"], "angle", params),
        control=distribution(control, "angle", params),
        distance=distance,
        control_distance=control_distance,
        median_curvature=median,
        in_hull=places[0],
        in_cloud=places[1],
        control_passes=control_distance <= params.distance,
        stable=stable,
        reason=reason,
    )


def verdict(distance: float, median: float, angles: Numbers, params: StabilityParams) -> tuple[bool, str]:
    """Return whether a step is stable, and why: by distance, median change of curvature and angles (m,)."""
    if distance > params.distance:
        return False, f"{_why_not(angles)} (distance {distance:.3f}, at most {params.distance})"
    if median > params.curvature:
        return False, f"what is left is thick: curvature rose by {median:.3f} (median, at most {params.curvature})"
    reason = f"normals are spread evenly across a curve (distance {distance:.3f}), curvature changed by {median:.3f}"
    return True, reason


def _why_not(angles: Numbers) -> str:
    over = float((angles > UNIFORM_UP_TO).mean())
    if over > BEYOND:
        return f"points drifted: {over:.0%} of the normals turned by more than a right angle"
    if angles.mean() < UNIFORM_UP_TO / 2:
        return f"normals have hardly turned, by {angles.mean():.2f} pi on average: it is still a surface"
    return "normals are not spread evenly across a curve"
