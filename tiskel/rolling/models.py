"""The two models: on the surface as it is, and on one made straight along its skeleton (Wen et al. 2025)."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tiskel.arrays import Table
from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.rolling.equations import Pair, Triple, local_object_rates, object_rates
from tiskel.slicing.fitted import FittedSurface
from tiskel.surfaces.forms import Forms, forms_of, frame_at
from tiskel.surfaces.jets import Jet, ParametricSurface, Scalar
from tiskel.surfaces.tube import Tube


class RollingModel(Protocol):
    """How the contact of a sphere moves over an object, and how its frame turns."""

    def forms(self, u: Scalar, v: Scalar) -> Forms:
        """Return the forms that the equations are in."""

    def frame(self, u: float, v: float) -> Table:
        """Return the contact frame (3, 3) on the surface as it is, x, y and z as columns."""

    def rates(self, u: float, v: float, forms: Forms, omega: Triple, velocity: Triple) -> Pair:
        """Return u_o' and v_o'."""


@dataclass(frozen=True)
class GlobalModel:
    """The surface as it is.

    Attributes
    ----------
    surface : ParametricSurface
        The object.
    sigma : float
        1 outside, -1 inside.
    radius : float
        Of the sphere.
    """

    surface: ParametricSurface
    sigma: float
    radius: float

    def forms(self, u: Scalar, v: Scalar) -> Forms:
        return forms_of(self.surface.jet(u, v), self.sigma)

    def frame(self, u: float, v: float) -> Table:
        return frame_at(self.surface, self.sigma, u, v)

    def rates(self, u: float, v: float, forms: Forms, omega: Triple, velocity: Triple) -> Pair:
        return object_rates(forms, self.radius, omega, velocity)


@dataclass(frozen=True, eq=False)
class LocalModel:
    """A straight skeleton, and a radius that is as at the contact all along it.

    Attributes
    ----------
    tube : Tube
        The object.
    sigma : float
        1 outside, -1 inside.
    radius : float
        Of the sphere.
    """

    tube: Tube
    sigma: float
    radius: float

    def forms(self, u: Scalar, v: Scalar) -> Forms:
        return forms_of(straightened(self.tube, u, v), self.sigma)

    def frame(self, u: float, v: float) -> Table:
        return frame_at(self.tube, self.sigma, u, v)

    def rates(self, u: float, v: float, forms: Forms, omega: Triple, velocity: Triple) -> Pair:
        frame, r = self.tube.at(u, v)
        return local_object_rates(r, frame.l, self.sigma, self.radius, omega, velocity)


def straightened(tube: Tube, u: Scalar, v: Scalar) -> Jet:
    """Return the jet of f = (alpha v, R cos u, R sin u) with R(u) and alpha = |p'| as they are at (u, v)."""
    frame, r = tube.at(u, v)
    c, s, zero = np.cos(u), np.sin(u), 0 * r.R
    around, bent = (zero, r.u * c - r.R * s, r.u * s + r.R * c), r.uu - r.R
    none = (zero, zero, zero)
    return Jet(
        (frame.l * v, r.R * c, r.R * s), around, (frame.l + zero, zero, zero),
        (zero, bent * c - 2 * r.u * s, bent * s + 2 * r.u * c), none, none,
    )  # fmt: skip


def tube_of(surface: ParametricSurface) -> Tube | None:
    """Return the Fourier surface that a surface is, None for others."""
    return surface.tube if isinstance(surface, FittedSurface) else surface if isinstance(surface, Tube) else None


def model_of(surface: ParametricSurface, params: RollParams, radius: float) -> RollingModel:
    """Return the model that the settings name, for a sphere of some radius.

    Raises
    ------
    TiskelError
        Where the local model is asked for without a skeleton, or normals of neighbours without a cloud.
    """
    tube = tube_of(surface)
    if params.model == "local":
        if tube is None:
            raise TiskelError("the local model needs a Fourier surface around a skeleton; use the global one")
        return LocalModel(tube, params.sigma, radius)
    if params.normals == "pca":
        from tiskel.rolling.printed import PrintedModel

        if not isinstance(surface, FittedSurface):
            raise TiskelError(
                "normals of neighbours need a surface that was fitted to a cloud; use those of the surface"
            )
        return PrintedModel.of(surface, params, radius)
    return GlobalModel(surface if tube is None else tube, params.sigma, radius)
