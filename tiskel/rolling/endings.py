"""What ends a run before its time: events for the solver, each with a status and a reason."""

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite, pi

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Numbers
from tiskel.geometry.strays import body_of
from tiskel.params import RollParams
from tiskel.rolling.equations import margin
from tiskel.rolling.models import RollingModel, tube_of
from tiskel.rolling.trajectory import RollStatus
from tiskel.slicing.fitted import FittedSurface
from tiskel.surfaces.analytic import Ellipsoid
from tiskel.surfaces.forms import forms_of
from tiskel.surfaces.jets import ParametricSurface

POLAR = 1e-3  # radians from the pole of a chart: v, of no meaning there, turns ever faster
TOUCHING = 1e-4  # of 1/R_s: with less left the contact runs away, and no solver follows it
SUNK, ROUGH, DEEPEST = 0.05, 4.0, 0.2  # of its radius that points may lie in the sphere; or RMS misfits there; at most


@dataclass(frozen=True)
class Ending:
    """What ends a run, as an event of the solver.

    Attributes
    ----------
    status : RollStatus
        The word for it.
    what : str
        The sentence for it.
    value : callable
        A function of the integrated state, u_o and v_o first, that is positive while the run can go on.
    """

    status: RollStatus
    what: str
    value: Callable[..., float]
    terminal = True
    direction = -1.0

    def __call__(self, t: float, y: Numbers) -> float:
        """Return the value at a time and a state (d,)."""
        return self.value(*y.tolist())


def endings(surface: ParametricSurface, model: RollingModel, params: RollParams, radius: float) -> list[Ending]:
    """Return everything that can end a run of a sphere over a surface, what is told first in front."""
    found = [
        Ending(
            RollStatus.TIGHT, "lambda_min(K_o) + 1/R_s is 0: the surface bends as sharply as the sphere",
            lambda u, v, *_: float(margin(model.forms(u, v), radius)) * radius - TOUCHING,
        )
    ]  # fmt: skip
    found += ends_of_branch(surface)
    tube = tube_of(surface)
    if tube is not None:
        found += [
            Ending(
                RollStatus.CROSSED, "the surface folds where slices cross", lambda u, v, *_: float(tube.spread(u, v))
            ),
            Ending(RollStatus.CLOSED, "the surface has no radius there", lambda u, v, *_: float(tube.at(u, v)[1].R)),
        ]
    if params.meet and isinstance(surface, FittedSurface):
        met = Meeting(surface, params, radius)
        found += [
            Ending(RollStatus.MET, "points away from the contact lie in it", met.away),
            Ending(RollStatus.OFF, "points about the contact lie deep in it, the surface is off them there", met.about),
        ]
    return found


def ends_of_branch(surface: ParametricSurface, first: int = 0) -> list[Ending]:
    """Return what ends a run where v leaves its range; nothing on surfaces without end.

    The state holds u and v of the surface from its entry ``first`` on.
    """
    low, high = surface.v_range
    if not (isfinite(low) or isfinite(high)):
        return []
    what = "v reached the end of the branch" if first == 0 else "the body came to the end of its own branch"
    return [Ending(RollStatus.LEFT, what, lambda *y: min(y[first + 1] - low, high - y[first + 1]))]


def poles(surface: ParametricSurface, name: str, first: int) -> list[Ending]:
    """Return what ends a run in coordinates at the poles of a chart, where u ends; nothing on charts without."""
    if not isinstance(surface, Ellipsoid):
        return []
    what = f"the contact came to a pole of the chart of the {name}, at u = +-pi/2, where the sphere of roll can pass"
    return [Ending(RollStatus.POLE, what, lambda *y: pi / 2 - POLAR - abs(y[first]))]


class Meeting:
    """How far the sphere is from meeting points of the cloud, those about its contact and those away from it.

    Points may lie in it by a twentieth of its radius, or as far as the cloud is rough about its surface there, but
    never by more than a fifth: where a surface is far off its points a sphere on it is no sphere on the body.
    """

    def __init__(self, surface: FittedSurface, params: RollParams, radius: float) -> None:
        self.surface, self.sigma, self.radius = surface, params.sigma, radius
        self.cloud = body_of(surface.cloud)
        self.tree = cKDTree(self.cloud)
        self.last: tuple[tuple[float, float], tuple[float, float]] | None = None

    def away(self, u: float, v: float, *_: float) -> float:
        """Return what is left, in radii of the sphere, of points farther from the contact than its radius."""
        return self.left(u, v)[1]

    def about(self, u: float, v: float, *_: float) -> float:
        """Return what is left of the others."""
        return self.left(u, v)[0]

    def left(self, u: float, v: float) -> tuple[float, float]:
        """Return how much deeper points may lie in the sphere, in its radii: about the contact, and away from it."""
        if self.last is None or self.last[0] != (u, v):
            self.last = (u, v), self._left(u, v)
        return self.last[1]

    def _left(self, u: float, v: float) -> tuple[float, float]:
        jet = self.surface.jet(u, v)
        contact = np.array(jet.f)
        centre = contact + self.radius * np.array(forms_of(jet, self.sigma).z)
        allowed = min(max(SUNK, ROUGH * self.surface.roughness(v) / self.radius), DEEPEST)
        near = self.cloud[self.tree.query_ball_point(centre, self.radius)]
        depth = 1 - np.linalg.norm(near - centre, axis=1) / self.radius
        away = np.linalg.norm(near - contact, axis=1) > self.radius
        return tuple(allowed - float(depth[part].max(initial=0)) for part in (~away, away))  # type: ignore[return-value]
