"""The surface that a cloud samples: oriented normals, areas, and what lies inside (winding numbers).

The generalised winding number of a cloud (Barill et al., Fast winding numbers
for soups and clouds, SIGGRAPH 2018) is near one inside a closed surface and near
zero outside. It needs normals that agree on which side is out. Two ways are
tried: away from where each point contracts to, which holds for good skeletons;
and propagation along a spanning tree of similar normals (Hoppe et al. 1992),
which also holds where the skeleton is bad. The one that puts more points
between an inside and an outside is taken.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from tiskel.arrays import TINY, Lists, Mask, Numbers, Points
from tiskel.geometry.neighbours import morton_curve, principal_axes, surroundings
from tiskel.geometry.propagation import propagated_signs
from tiskel.geometry.rings import Rings
from tiskel.params import published_neighbours

NORMAL_NEIGHBOURS = 9  # the point included; as many as the published normals have
INSIDE = 0.5  # winding number above which a place is inside
SOFTENING = 0.25  # of a point's area: what is nearer than half a spacing sees a patch, not a point
TRUSTED = 0.75  # least share of points that must lie between an inside and an outside
PROBES = 500  # points that this is tried on


@dataclass(frozen=True, eq=False)
class OrientedCloud:
    """Oriented points.

    Attributes
    ----------
    points : (n, 3) float64
        Distinct points of a surface, in any unit.
    normals : (n, 3) float64
        Unit vectors out of the body.
    areas : (n,) float64
        The area that each point stands for, in the squared unit.
    oriented_by : str
        "skeleton" or "propagation"; empty where the caller oriented them.
    consistency : float
        The share of probed points with an inside behind them and an outside before them; 0 where nobody looked.
    """

    points: Points
    normals: Points
    areas: Numbers
    oriented_by: str = ""
    consistency: float = 0.0

    @property
    def spacing(self) -> float:
        """The root of the median area, in the unit of the points."""
        return float(np.sqrt(np.median(self.areas)))

    @property
    def trusted(self) -> bool:
        """Whether enough points lie between an inside and an outside for winding numbers to mean something."""
        return self.consistency >= TRUSTED

    @cached_property
    def _blocks(self) -> tuple[Points, Points, Numbers, Points, Points, Numbers]:
        """Return what the kernel sums over.

        Of the points along the Morton curve: place, dipole and softening; of
        blocks of them: centre, sum of dipoles and radius.
        """
        from tiskel.kernels.winding import BLOCK

        curve = morton_curve(self.points)
        areas = self.areas[curve.order]
        dipoles = self.normals[curve.order] * areas[:, None]
        starts = np.arange(0, len(areas), BLOCK)
        weight = np.maximum(areas, TINY)
        totals = np.add.reduceat(weight, starts)
        centres = np.add.reduceat(curve.points * weight[:, None], starts) / totals[:, None]
        away = np.linalg.norm(curve.points - np.repeat(centres, BLOCK, axis=0)[: len(areas)], axis=1)
        radii = np.maximum.reduceat(away, starts)
        return curve.points, dipoles, SOFTENING * areas, centres, np.add.reduceat(dipoles, starts), radii

    def winding_numbers(self, queries: Points) -> Numbers:
        """Return (m,) the winding number of the surface about queries (m, 3)."""
        from tiskel.kernels.winding import LANES, winding_numbers

        if len(queries) == 0:
            return np.zeros(0)
        curve = morton_curve(np.ascontiguousarray(queries))  # what lies side by side asks the same blocks
        lacking = -len(queries) % LANES
        whole = np.concatenate([curve.points, np.repeat(curve.points[-1:], lacking, axis=0)])
        found, out = np.empty(len(whole)), np.empty(len(queries))
        winding_numbers(whole, *self._blocks, found)
        out[curve.order] = found[: len(queries)]
        return out

    def contains(self, queries: Points) -> Mask:
        """Return (m,) which queries (m, 3) lie inside."""
        return np.asarray(self.winding_numbers(queries) > INSIDE)


def oriented_cloud(points: Points, targets: Points, seed: int = 0) -> OrientedCloud:
    """Return the surface of a cloud, oriented in the way that puts more points between an inside and an outside.

    Parameters
    ----------
    points : (n, 3) float64
        Distinct points, C-contiguous, in any unit.
    targets : (n, 3) float64
        Where each of them contracts to, in the same unit.
    seed : int
        Of the choice of points that the orientation is tried on.

    Returns
    -------
    OrientedCloud
    """
    neighbours, _, rings = surroundings(points, published_neighbours(len(points)))
    near = np.ascontiguousarray(neighbours[:, :NORMAL_NEIGHBOURS])
    normals = principal_axes(points, near)[1][:, 2]
    areas = ring_areas(points, rings)
    away = oriented_away(points, normals, areas, targets, seed)
    propagated = oriented_by_propagation(points, normals, areas, targets, near, seed)
    return max(away, propagated, key=lambda surface: surface.consistency)


def oriented_away(
    points: Points, normals: Points, areas: Numbers, targets: Points, seed: int = 0
) -> OrientedCloud:  # fmt: skip
    """Return a surface with normals away from the targets; its consistency is known.

    Parameters
    ----------
    points : (n, 3) float64
        Distinct points, C-contiguous, in any unit.
    normals : (n, 3) float64
        Unit vectors, either way round.
    areas : (n,) float64
        The area that each point stands for, in the squared unit.
    targets : (n, 3) float64
        Where each point contracts to, in the same unit.
    seed : int
        Of the choice of points that the orientation is tried on.

    Returns
    -------
    OrientedCloud
    """
    sign = np.where(np.einsum("ij,ij->i", points - targets, normals) < 0, -1.0, 1.0)
    return checked(OrientedCloud(points, normals * sign[:, None], areas, "skeleton"), seed)


def oriented_by_propagation(
    points: Points, normals: Points, areas: Numbers, targets: Points, near: Lists, seed: int = 0
) -> OrientedCloud:  # fmt: skip
    """Return a surface with normals that agree along it and point away from the targets in the mean.

    Parameters
    ----------
    points, normals, areas, targets, seed
        See :func:`oriented_away`.
    near : (n, k) int32
        The nearest of every point, itself first, along which normals are propagated.

    Returns
    -------
    OrientedCloud
    """
    sign, part = propagated_signs(near, normals)
    votes = np.bincount(part, areas * np.einsum("ij,ij->i", points - targets, normals) * sign)
    sign = sign * np.where(votes < 0, -1.0, 1.0)[part]
    return checked(OrientedCloud(points, normals * sign[:, None], areas, "propagation"), seed)


def places_inside(surface: OrientedCloud, places: Points) -> Mask | None:
    """Tell which places are inside a surface, for measures and warnings alike.

    Parameters
    ----------
    surface : OrientedCloud
        With its ``consistency`` checked.
    places : (m, 3) float64
        In the unit of its points.

    Returns
    -------
    (m,) bool or None
        None where the normals do not agree on an inside: nothing can be said then.
    """
    return surface.contains(places) if surface.trusted else None


def checked(surface: OrientedCloud, seed: int) -> OrientedCloud:
    """Return the surface with the share of probed points that have an inside behind them and an outside before them.

    One spacing away, or two where that is better: noise reaches further than
    one, thin tubes are hardly thicker than two.

    Parameters
    ----------
    surface : OrientedCloud
        Whose ``consistency`` is not known.
    seed : int
        Of the choice of points.

    Returns
    -------
    OrientedCloud
        The same with it.
    """
    probes = np.sort(np.random.default_rng(seed).permutation(len(surface.points))[:PROBES])
    step = surface.normals[probes] * np.sqrt(surface.areas[probes])[:, None]
    shares = []
    for spacings in (1, 2):
        behind, before = (surface.contains(surface.points[probes] + side * spacings * step) for side in (-1, 1))
        shares.append(float((behind & ~before).mean()))
    return replace(surface, consistency=max(shares))


def ring_areas(points: Points, rings: Rings) -> Numbers:
    """Return (n,) a third of the area of each ring's triangles.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    rings : Rings
        Of all points.

    Returns
    -------
    (n,) float64
        In the squared unit of the points; 0 where a ring has no triangle.
    """
    members, sizes = rings.members, rings.sizes
    areas = np.zeros(len(points))
    rows = np.arange(len(points))
    for slot in range(members.shape[1]):
        last = slot == sizes - 1
        there = (slot < sizes - 1) | (last & (rings.closed == 1))
        following = np.where(last, 0, min(slot + 1, members.shape[1] - 1))
        u, v = (points[np.where(there, m, rows)] - points for m in (members[:, slot], members[rows, following]))
        areas += np.linalg.norm(np.cross(u, v), axis=1) / 6
    return areas
