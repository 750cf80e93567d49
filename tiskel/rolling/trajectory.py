"""What a run returns: the state over time, what follows from it, and why the run ended."""

from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.params import RollParams


class RollStatus(str, Enum):
    """Why a run ended."""

    FINISHED = "finished"
    LEFT = "left the branch"
    TIGHT = "the sphere no longer fits"
    CROSSED = "slices cross"
    CLOSED = "the radius of the surface is zero"
    MET = "the sphere meets another part of the cloud"
    STUCK = "the solver gave up"


@dataclass(frozen=True)
class Trajectory:
    """A sphere's way over a surface; lengths in the surface's unit, angles in radians, times in seconds.

    Attributes
    ----------
    t : (n,). state : (n, 5), u_o, v_o, u_s, v_s, psi, without jumps of a turn.
    contact, centre : (n, 3). orientation : (n, 4), unit quaternions w, x, y, z of the sphere.
    object_radius : (n,), R at the contact, NaN for surfaces without a skeleton.
    margin : (n,), lambda_min(K_o) + 1/R_s; determinant : (n,), det Q of the controllability with spin.
    path_object, path_sphere : lengths of the contact's ways, measured from places along them, not from rates.
    status, reason : why it ended. evaluations : of the right-hand side. radius : of the sphere.
    warnings : what a user should know.
    """

    t: Numbers
    state: Numbers
    contact: Points
    centre: Points
    orientation: Numbers
    object_radius: Numbers
    margin: Numbers
    determinant: Numbers
    path_object: float
    path_sphere: float
    status: RollStatus
    reason: str
    evaluations: int
    radius: float
    params: RollParams
    warnings: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """Return the summary as plain values."""
        p = self.params
        return {
            "status": self.status.value,
            "reason": self.reason,
            "model": p.model,
            "normals": p.normals,
            "side": p.side,
            "twist": p.twist,
            "radius": self.radius,
            "rtol": p.rtol,
            "atol": p.atol,
            "start": self.state[0].tolist(),
            "end": self.state[-1].tolist(),
            "time": float(self.t[-1]),
            "rows": len(self.t),
            "path_object": self.path_object,
            "path_sphere": self.path_sphere,
            "path_difference": self.path_object - self.path_sphere,
            "least_margin": float(self.margin.min()),
            "least_determinant": float(np.abs(self.determinant).min()),
            "evaluations": self.evaluations,
            "warnings": list(self.warnings),
        }
