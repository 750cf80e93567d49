"""The global model as printed: curvature from normals of neighbours, for comparison only.

Wen et al. 2025 take the shape operator from normals by principal components of
k neighbours. At 0.5 % noise its curvatures are off by a quarter where those of
the fitted surface are off by less than a hundredth.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Floats, Points, Stack, Table
from tiskel.params import RollParams
from tiskel.rolling.equations import Pair, Triple, object_rates
from tiskel.slicing.fitted import FittedSurface
from tiskel.surfaces.forms import Forms, forms_of, frame_at
from tiskel.surfaces.jets import Scalar
from tiskel.surfaces.tube import V_STOP, Tube

AROUND, PER_SLICE = 48, 1  # places where the shape operator is taken; it is straight between them


@dataclass(frozen=True, eq=False)
class PrintedModel:
    """A surface whose curvature comes from elsewhere.

    Attributes
    ----------
    tube : Tube
        The surface.
    sigma : float
        1 outside, -1 inside.
    radius : float
        Of the sphere.
    operators : (rows, around, 3, 3) array
        Shape operators in the axes of the cloud on an even grid of v and u, in 1 / length.
    """

    tube: Tube
    sigma: float
    radius: float
    operators: Floats

    @staticmethod
    def of(surface: FittedSurface, params: RollParams, radius: float) -> "PrintedModel":
        """Return the model of a surface, its normals those of neighbours among places on it."""
        rows = max(PER_SLICE * len(surface.sections), 2)
        v, u = np.meshgrid(np.linspace(0, V_STOP, rows), np.arange(AROUND) / AROUND * 2 * pi, indexing="ij")
        forms = forms_of(surface.jet(u, v), params.sigma)
        frames = np.moveaxis(np.array(forms[:3]), (0, 1), (-1, -2)).reshape(-1, 3, 3)
        places = np.stack(surface.jet(u, v).f, axis=-1).reshape(-1, 3)
        cloud = surface.cloud[surface.rows]
        operators = shape_operators(cloud, places, frames, min(params.neighbours, len(cloud)))
        return PrintedModel(surface.tube, params.sigma, radius, operators.reshape(rows, AROUND, 3, 3))

    def forms(self, u: Scalar, v: Scalar) -> Forms:
        """Return frame, metric and torsion of the surface, and the curvature form of the neighbours' normals."""
        forms = forms_of(self.tube.jet(u, v), self.sigma)
        operator = self._operator(np.asarray(u, float), np.asarray(v, float))
        sides = np.moveaxis(np.array([np.stack(np.broadcast_arrays(*side), axis=-1) for side in forms[:2]]), 0, -1)
        flat = np.moveaxis(np.swapaxes(sides, -1, -2) @ operator @ sides, (-2, -1), (0, 1))
        (m11, m12), (_, m22) = forms.M
        a, b, c = (value if value.ndim else float(value) for value in (flat[0, 0], flat[0, 1], flat[1, 1]))
        return forms._replace(K=((a * m11, a * m12 + b * m22), (b * m11, b * m12 + c * m22)))

    def frame(self, u: float, v: float) -> Table:
        return frame_at(self.tube, self.sigma, u, v)

    def rates(self, u: float, v: float, forms: Forms, omega: Triple, velocity: Triple) -> Pair:
        return object_rates(forms, self.radius, omega, velocity)

    def _operator(self, u: Floats, v: Floats) -> Floats:
        rows, around = self.operators.shape[:2]
        across, along = np.mod(u, 2 * pi) / (2 * pi) * around, np.clip(v / V_STOP, 0, 1) * (rows - 1)
        i, j = np.minimum(along.astype(int), rows - 2), across.astype(int) % around
        s, t = (along - i)[..., None, None], (across - np.floor(across))[..., None, None]
        grid, after = self.operators, (j + 1) % around
        low = (1 - t) * grid[i, j] + t * grid[i, after]
        high = (1 - t) * grid[i + 1, j] + t * grid[i + 1, after]
        return np.asarray((1 - s) * low + s * high)


def shape_operators(cloud: Points, places: Points, frames: Stack, k: int) -> Stack:
    """Return (p, 3, 3) how the normals of the k points nearest to each place turn along its tangent plane.

    ``frames`` (p, 3, 3) hold x, y and the normal z as columns. Symmetric; least squares.
    """
    tree = cKDTree(cloud)
    own = cloud[tree.query(cloud, k)[1]]
    own = own - own.mean(axis=1, keepdims=True)
    normals = np.linalg.eigh(np.einsum("nki,nkj->nij", own, own))[1][:, :, 0]
    near = tree.query(places, k)[1]
    sides, up = frames[:, :, :2], frames[:, :, 2]
    turned = normals[near]
    turned = turned * np.where(np.einsum("pki,pi->pk", turned, up) < 0, -1.0, 1.0)[..., None]
    a, b = ((m - m.mean(axis=1, keepdims=True)) @ sides for m in (cloud[near], turned))
    square = np.einsum("pki,pkj->pij", a, a)
    flat = np.linalg.solve(square + 1e-12 * np.trace(square, axis1=1, axis2=2)[:, None, None] * np.eye(2),
                           np.einsum("pki,pkj->pij", a, b))  # fmt: skip
    flat = (flat + np.swapaxes(flat, 1, 2)) / 2
    return np.asarray(sides @ flat @ np.swapaxes(sides, 1, 2))
