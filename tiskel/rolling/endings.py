"""What ends a run before its time: events for the solver, each with a status and a reason."""

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Numbers
from tiskel.geometry.strays import body_of
from tiskel.params import RollParams
from tiskel.rolling.equations import margin
from tiskel.rolling.models import RollingModel, tube_of
from tiskel.rolling.trajectory import RollStatus
from tiskel.slicing.fitted import FittedSurface
from tiskel.surfaces.forms import forms_of
from tiskel.surfaces.jets import ParametricSurface

TOUCHING = 1e-4  # of 1/R_s: with less left the contact runs away, and no solver follows it
SUNK, ROUGH = 0.05, 4.0  # points deeper in the sphere than so many of its radii, or RMS misfits, are met


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
        found.append(Ending(RollStatus.MET, "points away from the contact lie in it", Meeting(surface, params, radius)))
    return found


def ends_of_branch(surface: ParametricSurface) -> list[Ending]:
    """Return what ends a run where v leaves its range; nothing on surfaces without end."""
    low, high = surface.v_range
    if not (isfinite(low) or isfinite(high)):
        return []
    return [Ending(RollStatus.LEFT, "v reached the end of the branch", lambda u, v, *_: min(v - low, high - v))]


class Meeting:
    """Whether the sphere meets a part of the cloud that is not about its contact."""

    def __init__(self, surface: FittedSurface, params: RollParams, radius: float) -> None:
        self.surface, self.sigma, self.radius = surface, params.sigma, radius
        self.reach = max(radius - max(SUNK * radius, ROUGH * surface.error * surface.radius), 0.0)
        self.cloud = body_of(surface.cloud)
        self.tree = cKDTree(self.cloud)

    def __call__(self, u: float, v: float, *_: float) -> float:
        """Return -1 where points farther from the contact than the radius lie deep in the sphere, else 1."""
        jet = self.surface.jet(u, v)
        contact = np.array(jet.f)
        near = self.tree.query_ball_point(contact + self.radius * np.array(forms_of(jet, self.sigma).z), self.reach)
        away = np.linalg.norm(self.cloud[near] - contact, axis=1) > self.radius
        return -1.0 if away.any() else 1.0
