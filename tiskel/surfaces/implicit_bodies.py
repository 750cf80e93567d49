"""Bodies whose function, gradient and Hessian have closed forms, for teaching and for tests; lengths in any unit.

Off its own surface the function is a distance, but of an ellipsoid, where no
closed form has one, and of a blend.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np

from tiskel.arrays import TINY, Numbers, Points, Stack
from tiskel.errors import TiskelError
from tiskel.surfaces.implicit import ImplicitSurface, LevelSet

Place = tuple[float, float, float]
ORIGIN, UP = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Plane:
    """A half space.

    Attributes
    ----------
    normal : (x, y, z)
        Out of the material; of any length.
    offset : float
        How far the plane is from the origin, along the normal.
    """

    normal: Place = UP
    offset: float = 0.0

    def level(self, points: Points) -> LevelSet:
        normal = _unit(self.normal)
        return LevelSet(points @ normal - self.offset, np.tile(normal, (len(points), 1)), np.zeros((len(points), 3, 3)))


@dataclass(frozen=True)
class Sphere:
    """A ball.

    Attributes
    ----------
    radius : float
        In the unit of the points.
    centre : (x, y, z)
        Where it is.
    """

    radius: float
    centre: Place = ORIGIN

    def level(self, points: Points) -> LevelSet:
        return _about(points - np.array(self.centre), np.eye(3), self.radius)


@dataclass(frozen=True)
class RoundCylinder:
    """A round cylinder without end.

    Attributes
    ----------
    radius : float
        In the unit of the points.
    axis : (x, y, z)
        Its direction; of any length.
    centre : (x, y, z)
        A place on the axis.
    """

    radius: float
    axis: Place = UP
    centre: Place = ORIGIN

    def level(self, points: Points) -> LevelSet:
        axis = _unit(self.axis)
        across = np.eye(3) - np.outer(axis, axis)
        return _about((points - np.array(self.centre)) @ across, across, self.radius)


@dataclass(frozen=True)
class Capsule:
    """What is nearer to a straight way than a radius; its curvature jumps where the half spheres begin.

    Attributes
    ----------
    start : (x, y, z)
        One end of the way.
    stop : (x, y, z)
        The other one.
    radius : float
        In the unit of the points.

    Examples
    --------
    >>> import numpy as np
    >>> Capsule((0, 0, 0), (4, 0, 0), 1.0).level(np.array([[2.0, 0, 3], [5, 0, 0]])).value.tolist()
    [2.0, 0.0]
    """

    start: Place
    stop: Place
    radius: float

    def level(self, points: Points) -> LevelSet:
        start, way = np.array(self.start, float), np.subtract(self.stop, self.start).astype(float)
        share = (points - start) @ way / max(float(way @ way), TINY)
        beside = (share > 0) & (share < 1)
        axis = way / max(float(np.linalg.norm(way)), TINY)
        flat = np.eye(3) - beside[:, None, None] * np.outer(axis, axis)
        return _about(points - start - np.clip(share, 0, 1)[:, None] * way, flat, self.radius)


@dataclass(frozen=True)
class Torus:
    """A tube about a circle.

    Attributes
    ----------
    bend : float
        Radius of the circle.
    tube : float
        Radius of the tube.
    axis : (x, y, z)
        Across the circle; of any length.
    centre : (x, y, z)
        The circle's.
    """

    bend: float
    tube: float
    axis: Place = UP
    centre: Place = ORIGIN

    def level(self, points: Points) -> LevelSet:
        axis = _unit(self.axis)
        across = np.eye(3) - np.outer(axis, axis)
        offset = points - np.array(self.centre)
        far, out, bent = _about(offset @ across, across, self.bend)  # from the cylinder through the circle
        high = offset @ axis
        away = np.maximum(np.hypot(far, high), TINY)
        gradient = (far[:, None] * out + high[:, None] * axis) / away[:, None]
        square = _outer(out, out) + far[:, None, None] * bent + np.outer(axis, axis)
        return LevelSet(away - self.tube, gradient, (square - _outer(gradient, gradient)) / away[:, None, None])


@dataclass(frozen=True)
class Ellipsoid:
    """x^2/a^2 + y^2/b^2 + z^2/c^2 = 1; its function is the least half-axis times (root of the left side - 1).

    Attributes
    ----------
    a : float
        First half-axis.
    b : float
        Second half-axis.
    c : float
        Third half-axis.
    """

    a: float
    b: float
    c: float

    def level(self, points: Points) -> LevelSet:
        squares, least = np.array([self.a, self.b, self.c], float) ** -2, min(self.a, self.b, self.c)
        root = np.maximum(np.sqrt(points**2 @ squares), TINY)
        slope = points * squares / root[:, None]
        bend = (np.diag(squares) - _outer(slope, slope)) / root[:, None, None]
        return LevelSet(least * (root - 1), least * slope, least * bend)


@dataclass(frozen=True)
class Union:
    """Bodies in one, their seams filled: three times continuously differentiable where the bodies are.

    Of two functions a and b the smaller one less blend h^4 (5 - 2 h) / 20 with
    h = 1 - |a - b| / blend, where that is positive: as Inigo Quilez's polynomials
    (Smooth minimum, 2013), with one derivative more. Of several, one after the
    other. Where no two functions are within the blend, nothing changes.

    Attributes
    ----------
    bodies : sequence of ImplicitSurface
        At least one.
    blend : float
        How far apart values are still blended, in the unit of the points; 0 for none, which leaves sharp seams.

    Examples
    --------
    >>> import numpy as np
    >>> two = Union((Sphere(1.0), Sphere(1.0, (1.5, 0, 0))), blend=0.2)
    >>> two.level(np.array([[-1.0, 0, 0], [0.75, 0, 0.6614378]])).value.round(6).tolist()
    [0.0, -0.03]
    """

    bodies: Sequence[ImplicitSurface]
    blend: float = 0.0

    def level(self, points: Points) -> LevelSet:
        return reduce(self._joined, (body.level(points) for body in self.bodies))

    def _joined(self, one: LevelSet, other: LevelSet) -> LevelSet:
        apart = one.value - other.value
        h = np.maximum(1 - np.abs(apart) / self.blend, 0.0) if self.blend > 0 else np.zeros(len(apart))
        less = (2 * h**3 - h**4) / 2  # the part of the larger value: a half where both are equal
        share = np.where(apart > 0, less, 1 - less)[:, None]
        bent = -(h**2) * (3 - 2 * h) / max(self.blend, TINY)
        value = np.minimum(one.value, other.value) - self.blend * h**4 * (5 - 2 * h) / 20
        across = one.gradient - other.gradient
        hessian = share[..., None] * one.hessian + (1 - share[..., None]) * other.hessian
        return LevelSet(
            value, share * one.gradient + (1 - share) * other.gradient,
            hessian + bent[:, None, None] * _outer(across, across),
        )  # fmt: skip


def y_of_capsules(length: float = 2.0, radius: float = 0.4, blend: float = 0.2) -> Union:
    """Return three capsules in a plane that meet at the origin, a third of a turn apart.

    Examples
    --------
    >>> import numpy as np
    >>> y_of_capsules().level(np.array([[1.5, 0, 0.4]])).value.tolist()
    [0.0]
    """
    ends = [(length * float(np.cos(a)), length * float(np.sin(a)), 0.0) for a in 2 * np.pi * np.arange(3) / 3]
    return Union(tuple(Capsule(ORIGIN, end, radius) for end in ends), blend)


def _about(offset: Points, flat: Stack | Points, radius: float) -> LevelSet:
    """Return the distance from a set less a radius: ``flat`` is the derivative of the offset from it."""
    away = np.maximum(np.linalg.norm(offset, axis=1), TINY)
    out = offset / away[:, None]
    return LevelSet(away - radius, out, (flat - _outer(out, out)) / away[:, None, None])


def _outer(a: Points, b: Points) -> Stack:
    return a[:, :, None] * b[:, None, :]


def _unit(direction: Place) -> Numbers:
    length = float(np.linalg.norm(direction))
    if not length > 0:
        raise TiskelError(f"a direction needs a length, got {direction}")
    return np.asarray(direction, float) / length
