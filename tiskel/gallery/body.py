"""Bodies that are no unions of round cones: parts with exact surfaces, and a true curve skeleton."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Mask, Numbers, Points, Table
from tiskel.gallery.patches import Patch, cell_areas, sample_patch
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.round_cones import ConeGraph, union_distance

ON_SURFACE = 1e-9  # units of the shape, which are of the order of one: levels below this are zero to rounding
CONES_MEET = 1e-8  # the same for round cones, whose surfaces meet a little unevenly where radii differ
DENSE = 200_000  # points of a surface that distances to it are measured from
BATCH = 100_000  # candidates per round: bounds the memory, not the result
ROOM = 0.05  # share of its size that the box about a part is widened by, since it is that of the corners of cells


@dataclass(frozen=True, eq=False)
class Part:
    """A piece of a body: a solid, or a sheet without thickness.

    Attributes
    ----------
    patches : tuple of Patch
        What covers its surface; what lies off the surface is cut away.
    level : callable
        From places (n, 3) to numbers (n,) that are zero on the surface and negative inside a solid.
    solid : bool
        Whether it has an inside, which swallows the surface of other parts.
    """

    patches: tuple[Patch, ...]
    level: Callable[[Points], Numbers]
    solid: bool = True

    @cached_property
    def areas(self) -> tuple[Table, ...]:
        """The areas of the cells of each patch."""
        return tuple(cell_areas(patch) for patch in self.patches)

    @cached_property
    def box(self) -> tuple[Numbers, Numbers]:
        """Two corners (3,) of a box that holds the part."""
        side = np.linspace(0, 1, 65)
        u, v = np.repeat(side, len(side)), np.tile(side, len(side))
        places = np.concatenate([patch(u, v) for patch in self.patches])
        room = ROOM * np.linalg.norm(np.ptp(places, axis=0))
        return places.min(axis=0) - room, places.max(axis=0) + room

    def swallows(self, points: Points) -> Mask:
        """Return (n,) bool, which of places (n, 3) are inside, by more than rounding."""
        found = np.zeros(len(points), np.bool_)
        if self.solid:
            low, high = self.box
            near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
            found[near] = self.level(points[near]) < -ON_SURFACE
        return found


@dataclass(frozen=True, eq=False, repr=False)
class Body(CurveGraph):
    """A union of parts, and the graph that is its curve skeleton.

    The radius of a node is that of the circle with the area of the section there; of a
    sheet it is half the width. Distances are to the nearest of 200 000 points on the
    surface, and too large by less than their spacing; whether a place is inside is exact.

    Attributes
    ----------
    parts : tuple of Part
        What the body is made of.
    unit : float
        Half its least thickness, which noise is a share of; of a sheet a quarter of half the width.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import named_shape
    >>> block = named_shape("block-3")
    >>> block.loops, bool(block.inside(block.nodes).all()), block.inside(np.zeros((1, 3))).tolist()
    (3, True, [False])
    """

    parts: tuple[Part, ...] = field(default=(), kw_only=True)
    unit: float = field(default=1.0, kw_only=True)

    @property
    def solid(self) -> bool:
        """Whether all parts have an inside."""
        return all(part.solid for part in self.parts)

    def inside(self, points: Points) -> Mask:
        """Return (n,) bool, which of places (n, 3) are inside a solid part, by more than rounding."""
        return np.asarray(np.any([part.swallows(points) for part in self.parts], axis=0))

    def distance(self, points: Points) -> Numbers:
        """Return (n,) the distances of places (n, 3) to the surface, negative inside, in the unit of the shape."""
        return np.asarray(np.where(self.inside(points), -1.0, 1.0) * self._surface.query(points)[0])

    def clearance(self, places: Points) -> Numbers:
        """Return (q,) the distances from places (q, 3) inside to the surface, 0 outside, in the unit of the shape."""
        return np.maximum(-self.distance(places), 0.0)

    @cached_property
    def _surface(self) -> cKDTree:
        return cKDTree(self.sample(DENSE, np.random.default_rng(0)))

    def sample(self, count: int, generator: np.random.Generator) -> Points:
        """Return points on the surface, even by area; points inside another part are not on it.

        Parameters
        ----------
        count : int
            How many points.
        generator : numpy.random.Generator
            Drawn from; the same state gives the same points.

        Returns
        -------
        (count, 3) float64
            In the unit of the shape.
        """
        share = np.array([areas.sum() for part in self.parts for areas in part.areas])
        found: list[Points] = []
        have = 0
        while have < count:
            wanted = iter(generator.multinomial(min(BATCH, 2 * (count - have) + 1000), share / share.sum()))
            pieces = [
                self._visible(part, sample_patch(patch, areas, int(next(wanted)), generator))
                for part in self.parts
                for patch, areas in zip(part.patches, part.areas, strict=True)
            ]
            found.append(generator.permutation(np.concatenate(pieces)))
            have += len(found[-1])
        return np.concatenate(found)[:count]

    def _visible(self, own: Part, points: Points) -> Points:
        """Return those points of a patch of one part that lie on its surface and inside no other."""
        points = points[np.abs(own.level(points)) <= ON_SURFACE]
        for part in self.parts:
            if part is not own:
                points = points[~part.swallows(points)]
        return points


Shape = ConeGraph | Body  #: what has a surface to sample and is its own true skeleton


def surface_distance(points: Points, shape: Shape) -> Numbers:
    """Return signed distances of places to the surface of a shape, negative inside.

    Parameters
    ----------
    points : (n, 3) float64
        Places in the unit of the shape.
    shape : ConeGraph or Body
        Of round cones the depth inside is a lower bound where parts overlap; of a body see :class:`Body`.

    Returns
    -------
    (n,) float64
        In the same unit.
    """
    return union_distance(points, shape) if isinstance(shape, ConeGraph) else shape.distance(points)


def is_inside(points: Points, shape: Shape) -> Mask:
    """Return (n,) bool, which of places (n, 3) are inside a shape, by more than rounding."""
    return shape.inside(points) if isinstance(shape, Body) else union_distance(points, shape) < -CONES_MEET


def least_thickness(shape: Shape) -> float:
    """Return what noise is a share of: the smallest radius, of a body half its least thickness."""
    return float(shape.radii.min()) if isinstance(shape, ConeGraph) else shape.unit


def joined(lines: Sequence[Points], radii: Sequence[Numbers], parts: Sequence[Part], unit: float) -> Body:
    """Return a body whose graph is made of polylines; nodes at the same place become one.

    Parameters
    ----------
    lines : sequence of (m, 3) float64
        Places along each polyline.
    radii : sequence of (m,) float64
        The radii there; where lines meet the largest holds.
    parts : sequence of Part
    unit : float
        Half the least thickness.

    Returns
    -------
    Body
    """
    nodes, thick = np.concatenate(list(lines)), np.concatenate(list(radii))
    starts = np.cumsum([0, *(len(line) for line in lines)])
    edges = np.concatenate([np.stack([np.arange(a, b - 1), np.arange(a + 1, b)], axis=1) for a, b in _pairs(starts)])
    pairs = cKDTree(nodes).query_pairs(ON_SURFACE, output_type="ndarray")
    first = np.arange(len(nodes))
    np.minimum.at(first, pairs[:, 1], pairs[:, 0])
    kept, name = np.unique(first, return_inverse=True)
    largest = np.zeros(len(kept))
    np.maximum.at(largest, name, thick)
    ordered = np.unique(np.sort(name[edges], axis=1), axis=0).astype(np.int32)
    return Body(nodes[kept], ordered, largest, parts=tuple(parts), unit=unit)


def _pairs(starts: np.ndarray[tuple[int], np.dtype[np.int64]]) -> list[tuple[int, int]]:
    return [(int(a), int(b)) for a, b in zip(starts[:-1], starts[1:], strict=True)]
