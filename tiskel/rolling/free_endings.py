"""What ends a run without a chart: events for the solver, each with a status and a reason."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tiskel.arrays import Numbers
from tiskel.params import RollParams
from tiskel.rolling.ambient import AmbientRate, least_curvature
from tiskel.rolling.endings import DEEPEST, SUNK, TOUCHING
from tiskel.rolling.second import Surroundings
from tiskel.rolling.trajectory import RollStatus

WORTH = {"any": 0, "seen": 1, "measured": 2}  # as surfaces count: see tiskel.Trust


@dataclass(frozen=True)
class Watch:
    """What ends a run or a stretch of it, as an event of the solver.

    Attributes
    ----------
    status : RollStatus
        The word for it.
    what : str
        The sentence for it.
    value : callable
        A function of the state (10,) that is positive while the run can go on.
    follows : bool
        Whether the run goes on at the second place.
    """

    status: RollStatus
    what: str
    value: Callable[[Numbers], float]
    follows: bool = False
    terminal = True
    direction = -1.0

    def __call__(self, t: float, y: Numbers) -> float:
        """Return the value at a time and a state."""
        return self.value(y)


def watches(rate: AmbientRate, around: Surroundings, params: RollParams) -> list[Watch]:
    """Return everything that can end a run, what is told first in front."""
    ground = rate.ground

    def margin(y: Numbers) -> float:
        touch = ground.touch(rate.place(y))
        low = least_curvature(touch.shape[None])[0]
        return float(low * ground.radius + 1 - TOUCHING)

    def centre(y: Numbers) -> Numbers:
        place = rate.place(y)
        return place + ground.radius * ground.touch(place).z

    def second(y: Numbers) -> float:
        return around.second(rate.place(y), centre(y)).gap

    def clear(y: Numbers) -> float:
        return float(around.clear(centre(y)[None])[0] - (1 - DEEPEST))

    found = [
        Watch(RollStatus.TIGHT, "lambda_min(K_o) + 1/R_s is 0: the surface bends as sharply as the sphere", margin)
    ]
    trust: Any = getattr(ground.surface, "trust", None)
    if trust is not None and params.trusted != "any":
        least = WORTH[params.trusted] - 0.5
        found.append(
            Watch(
                RollStatus.DOUBTFUL, f"the surface is not {params.trusted} there",
                lambda y: float(trust(rate.place(y)[None])[0]) - least,
            )
        )  # fmt: skip
    if params.meet:
        if around.cloud is not None:
            found.append(Watch(RollStatus.MET, f"points of the cloud lie {DEEPEST:g} of its radius deep in it", clear))
        if params.on_meeting == "follow":
            found.append(Watch(RollStatus.MET, "it touches the surface a second time", second, follows=True))
        else:
            found.append(
                Watch(RollStatus.MET, "it meets another part of the surface", lambda y: second(y) + SUNK)
            )  # fmt: skip
    return found


def finite(y: Numbers) -> bool:
    """Tell whether a state has no NaN."""
    return bool(np.isfinite(y).all())
