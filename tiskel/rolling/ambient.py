"""Rolling without a chart: the contact is a place, the frame about it is carried along.

With z the unit normal from the material to the sphere, S the shape operator
towards it (positive where the object is convex), Omega the sphere's angular
velocity and v the slip of its material at the contact, in the axes of space,

    (I + R_s S) x' = v + R_s Omega x z        Q' = [Omega] Q        z' = S x'

so that normal and shape operator are all that is read of a surface, and joints
and ends are places like others. It is Montana's equation (see
:mod:`tiskel.rolling.equations`) without coordinates: there K_o + I/R_s acts on
the same velocity.

The contact frame [x y z], which twists of the object are in, is carried along
the way of the contact without turning about the normal (Levi-Civita's parallel
transport): x' = -(x.z') z. At the start y points along the heading. A chart's
frame is turned about z against it by an angle theta with
theta' = T u_o'. In this frame a constant twist without slip and spin takes the
centre along a geodesic of the surface that is R_s away.

The state is scaled: (x - start) / R_s, the quaternion of Q, and the frame's x;
a term towards the surface, as fast as the sphere turns, keeps rounding and the
solver's error from adding up (Baumgarte, Stabilization of constraints, 1972).
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from tiskel.arrays import TINY, Numbers, Points, Stack, Table
from tiskel.errors import TiskelError
from tiskel.rolling.inputs import Inputs
from tiskel.rolling.sphere import quaternion_rate, rotation_of
from tiskel.surfaces.implicit import ImplicitSurface

BACK = 3.0  # radians that the sphere turns while a distance from the surface falls to 1/e is 1 / BACK
UP, ELSE, UPRIGHT = (
    (0.0, 0.0, 1.0),
    (1.0, 0.0, 0.0),
    0.1,
)  # headings without one, and the least tangent part of the first
EYE = np.eye(3)


class Touch(NamedTuple):
    """A surface at a place.

    Attributes
    ----------
    off : float
        How far the place is off the surface, to first order, positive on the sphere's side.
    z : (3,) float64
        Unit normal to the sphere.
    shape : (3, 3) float64
        Shape operator towards the sphere, in 1 / length, positive where the object is convex.
    """

    off: float
    z: Numbers
    shape: Table


@dataclass(frozen=True)
class Ground:
    """A surface, the side of it, and the sphere on it.

    Attributes
    ----------
    surface : ImplicitSurface
        The object.
    sigma : float
        1 outside, -1 inside.
    radius : float
        Of the sphere.
    """

    surface: ImplicitSurface
    sigma: float
    radius: float
    _last: dict[bytes, Touch] = field(default_factory=dict, repr=False, compare=False)

    def touch(self, place: Numbers) -> Touch:
        """Return the surface at a place (3,); the last one is kept, as events ask again where a step ended."""
        key = place.tobytes()
        if key not in self._last:
            value, gradient, hessian = (part[0] for part in self.surface.level(place[None]))
            slope = max(float(np.sqrt(gradient @ gradient)), TINY)
            n = gradient / slope
            flat = EYE - np.outer(n, n)
            self._last.clear()
            self._last[key] = Touch(
                self.sigma * float(value) / slope, self.sigma * n, flat @ hessian @ flat * (self.sigma / slope)
            )
        return self._last[key]

    def touches(self, places: Points) -> tuple[Numbers, Points, Stack]:
        """Return how far places (n, 3) are off (n,), the normals (n, 3) and shape operators (n, 3, 3) there."""
        value, gradient, hessian = self.surface.level(places)
        slope = np.maximum(np.linalg.norm(gradient, axis=1), TINY)
        n = gradient / slope[:, None]
        flat = EYE - n[:, :, None] * n[:, None, :]
        bent = flat @ hessian @ flat * (self.sigma / slope)[:, None, None]
        return self.sigma * value / slope, self.sigma * n, bent

    def margin(self, places: Points) -> Numbers:
        """Return (n,) lambda_min(K_o) + 1/R_s at places (n, 3), in 1 / length; NaN where the surface knows nothing."""
        return least_curvature(self.touches(places)[2]) + 1 / self.radius


def least_curvature(shapes: Stack) -> Numbers:
    """Return (n,) the lesser principal curvature of shape operators (n, 3, 3): their third eigenvalue is 0."""
    trace = np.trace(shapes, axis1=1, axis2=2)
    second = (trace**2 - np.einsum("nij,nji->n", shapes, shapes)) / 2
    return np.asarray(trace / 2 - np.sqrt(np.maximum(trace**2 / 4 - second, 0.0)))


def frame_about(z: Numbers, heading: tuple[float, float, float] | None) -> Table:
    """Return the contact frame (3, 3) at the start, x, y and z as columns: y is the tangent part of the heading.

    Without a heading it is up, along the third axis; where the normal is within six degrees of that, the first.

    Raises
    ------
    TiskelError
        For a heading along the normal.
    """
    ahead = np.array(UP if heading is None else heading, float)
    y = ahead / np.linalg.norm(ahead) - z * (z @ ahead) / np.linalg.norm(ahead)
    if np.linalg.norm(y) < UPRIGHT:
        if heading is not None:
            raise TiskelError(f"the heading {heading} is along the normal {z.round(4).tolist()}; give another one")
        y = np.array(ELSE) - z * z[0]
    y = y / np.linalg.norm(y)
    return np.stack([np.cross(y, z), y, z], axis=1)


def frame_of(x: Numbers, z: Numbers) -> Table:
    """Return the contact frame (3, 3) from its x axis, made orthogonal to z and of unit length."""
    x = x - z * (x @ z)
    x = x / max(float(np.sqrt(x @ x)), TINY)
    return np.asarray(np.array([x, _cross(z, x), z]).T)


@dataclass(frozen=True, eq=False)
class AmbientRate:
    """The right-hand side: derivatives of the state (10,): place, quaternion, and the frame's x.

    Attributes
    ----------
    ground : Ground
        What the sphere rolls on.
    inputs : Inputs
        The twist over time.
    twist : str
        Whose it is, see :class:`tiskel.RollParams`.
    origin : (3,) float64
        Where the scaled place is 0.
    """

    ground: Ground
    inputs: Inputs
    twist: str
    origin: Numbers

    def place(self, y: Numbers) -> Numbers:
        """Return the place (3,) of a state."""
        return np.asarray(self.origin + self.ground.radius * y[:3])

    def turning(self, t: float, y: Numbers, z: Numbers) -> tuple[Numbers, Numbers]:
        """Return Omega and v (3,) in the axes of space, v along the surface."""
        omega, velocity = self.inputs.at(t)
        w, v = np.array(omega), np.array(velocity)
        if self.twist == "object":
            frame = frame_of(y[7:10], z)
            return -(frame @ w), -(frame @ v)
        if self.twist == "sphere":
            own = rotation_of(y[3:7])
            w, v = own @ w, own @ v
        return w, v - z * (z @ v)

    def __call__(self, t: float, y: Numbers) -> Numbers:
        """Return the derivatives (10,) at a time in seconds and a state."""
        radius = self.ground.radius
        off, z, shape = self.ground.touch(self.place(y))
        turning, slip = self.turning(t, y, z)
        moving = np.linalg.solve(EYE + radius * shape, slip + radius * _cross(turning, z))
        back = BACK * (np.sqrt(turning @ turning) + np.sqrt(slip @ slip) / radius) * off
        carried = -(y[7:10] @ (shape @ moving)) * z
        return np.array([*(moving - back * z) / radius, *quaternion_rate(turning.tolist(), y[3:7].tolist()), *carried])


def _cross(a: Numbers, b: Numbers) -> Numbers:
    """Return a x b (3,); that of NumPy takes ten times as long for one pair."""
    (ax, ay, az), (bx, by, bz) = a.tolist(), b.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
