"""The surface of a whole body: quadrics of compact support, blended.

f = sum w_i q_i / sum w_i, where q_i is a quadric about the centre of patch i and
w_i = (1 - |x - c_i|^2 / r_i^2)^4 within its support r_i: three times continuously
differentiable wherever a patch reaches (a partition of unity, Ohtake et al.,
Multi-level partition of unity implicits, SIGGRAPH 2003, without its levels).
"""

from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Indices, Numbers, Points, Table
from tiskel.geometry.neighbours import morton_curve
from tiskel.geometry.quadrics import matrices
from tiskel.shown import Brief
from tiskel.surfaces.implicit import LevelSet

NEAR = 0.05  # local radii: what a surface covers is nearer than that


class Trust(IntEnum):
    """What a place of a surface is worth; the numbers stand in files.

    Examples
    --------
    >>> Trust.BRIDGED < Trust.MEASURED
    True
    """

    BRIDGED = 0  #: no points: laid over a gap
    SEEN = 1  #: little seen: few points, or only from one side
    MEASURED = 2  #: points all about determine it


@dataclass(frozen=True, eq=False)
class Patches:
    """Quadrics and where they count, neighbours in space next to each other.

    Attributes
    ----------
    centres : (p, 3) float64
        In the unit of the cloud.
    supports : (p,) float64
        How far they reach.
    values : (p,) float64
        Of the quadrics at the centres, lengths.
    gradients : (p, 3) float64
        There, without unit.
    hessians : (p, 6) float64
        xx, yy, zz, xy, xz, yz, in 1 / length.
    radii : (p,) float64
        How thick the body is there.
    trust : (p,) uint8
        See :class:`Trust`.
    of_tube : (p,) bool
        Whether the quadric is that of a fitted tube.
    """

    centres: Points
    supports: Numbers
    values: Numbers
    gradients: Points
    hessians: Table
    radii: Numbers
    trust: npt.NDArray[np.uint8]
    of_tube: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.centres)

    def at(self, rows: Any) -> "Patches":
        """Return some of them."""
        return Patches(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))

    def sorted(self) -> "Patches":
        """Return them along a curve on which neighbours in space are next to each other."""
        return self.at(morton_curve(np.ascontiguousarray(self.centres)).order)

    @cached_property
    def _tables(self) -> tuple[Table, Table, Table]:
        """Return what the kernel reads: patches, boxes about blocks of supports, and boxes about these."""
        from tiskel.kernels.patches import BLOCK, LARGE

        table = np.column_stack(
            [self.centres, self.supports**2, self.values, self.gradients, self.hessians]
        )  # fmt: skip
        reach = self.supports[:, None]
        boxes = _boxes(self.centres - reach, self.centres + reach, BLOCK)
        return np.ascontiguousarray(table), boxes, _boxes(boxes[:, :3], boxes[:, 3:], LARGE)

    def blended(self, points: Points) -> Table:
        """Return (n, 11) value, gradient, Hessian (xx, yy, zz, xy, xz, yz) and number of the heaviest patch."""
        from tiskel.kernels.patches import FOUND, blend

        found = np.empty((len(points), FOUND))
        if len(points):
            blend(np.ascontiguousarray(points, dtype=np.float64), *self._tables, found)
        return found


def _boxes(low: Points, high: Points, size: int) -> Table:
    """Return (b, 6) the boxes about blocks of boxes."""
    starts = np.arange(0, len(low), size)
    return np.concatenate([np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)], axis=1)


@dataclass(frozen=True, eq=False, repr=False)
class BodySurface(Brief):
    """The closed surface of a whole body; lengths in the input's unit.

    Attributes
    ----------
    patches : Patches
        What it is blended from.
    cloud : (n, 3) float64
        The cloud.
    distances : (n,) float64
        Of every point of the cloud from the surface, NaN where the point is stray or the surface knows nothing.
    radius : float
        Median of the local radii at the points.
    warnings : tuple of str
        Where the surface may be wrong, and why.

    Examples
    --------
    >>> from tiskel import ShapeParams, fit_body, make_shape, shape_graph
    >>> body = fit_body(make_shape(shape_graph("capsule"), ShapeParams(count=1000))[1])
    >>> body.trust(body.cloud[:2]).tolist(), bool((abs(body.level(body.cloud).value) < 0.01 * body.radius).all())
    ([2, 2], True)
    """

    _said = ("patches.centres", "cloud", "radius", "warnings")

    patches: Patches
    cloud: Points
    distances: Numbers
    radius: float
    warnings: tuple[str, ...] = ()

    def level(self, points: Points) -> LevelSet:
        """Return function, gradient and Hessian at points (n, 3); NaN where no patch reaches."""
        found = self.patches.blended(points)
        return LevelSet(found[:, 0], found[:, 1:4], matrices(found[:, 4:10]))

    def heaviest(self, points: Points) -> Indices:
        """Return (n,) the patch that counts most at points (n, 3), -1 where none reaches."""
        return self.patches.blended(points)[:, 10].astype(np.int32)

    def trust(self, points: Points) -> npt.NDArray[np.uint8]:
        """Return (n,) what the surface is worth at points (n, 3), see :class:`Trust`; BRIDGED beyond all patches."""
        patch = self.heaviest(points)
        return np.where(patch < 0, np.uint8(Trust.BRIDGED), self.patches.trust[patch])

    def local_radius(self, points: Points) -> Numbers:
        """Return (n,) how thick the body is about points (n, 3), in the cloud's unit; NaN where no patch reaches."""
        patch = self.heaviest(points)
        return np.where(patch < 0, np.nan, self.patches.radii[patch])

    @cached_property
    def summary(self) -> dict[str, float]:
        """Distances of all points in local radii, "mean" and "p95", and "coverage", the share nearer than a 20th."""
        known = np.isfinite(self.distances)
        far = self.distances[known] / self.local_radius(self.cloud[known])
        if len(far) == 0:
            return {"mean": np.nan, "p95": np.nan, "coverage": 0.0}
        coverage = float((far < NEAR).sum() / len(self.cloud))
        return {"mean": float(far.mean()), "p95": float(np.quantile(far, 0.95)), "coverage": coverage}

    @property
    def of_tubes(self) -> float:
        """The share of the patches that are of tubes."""
        return float(self.patches.of_tube.mean())

    def share(self, trust: int) -> float:
        """Return the share of the surface that is worth so much, see :class:`Trust`."""
        area = self.patches.supports**2
        return float(area[self.patches.trust == trust].sum() / area.sum())
