"""What a mesh knows about points on it: which way is out, what hangs together, how many handles there are."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy import sparse

from tiskel.arrays import Edges, Indices, Lists, Masks, Numbers, Pairs, Points
from tiskel.errors import TiskelError
from tiskel.geometry.distinct import distinct
from tiskel.geometry.mesh import pair_keys

HOPS = 3  # cells of other points, at most, between two that are neighbours; as far as thirty nearest reach


@dataclass(frozen=True, eq=False)
class MeshSurface:
    """Points on a mesh, a row each.

    Attributes
    ----------
    normals : (n, 3) float64
        Of unit length.
    areas : (n,) float64
        Of the mesh that each stands for, in the squared unit of the points.
    links : (l, 2) int32
        Points whose cells touch: every place of the mesh belongs to the point that is nearest along the mesh.
    outward : bool
        Whether the normals point out of the body; else only their lines are known.
    handles : int or None
        Of the solid inside, None where the mesh encloses none.
    """

    normals: Points
    areas: Numbers
    links: Edges
    outward: bool
    handles: int | None

    def checked(self, count: int) -> "MeshSurface":
        """Return the same where it has a row for each of so many points; raise TiskelError where it has not."""
        if len(self.normals) != count:
            raise TiskelError(f"the mesh knows {len(self.normals)} points, there are {count}; sample it again")
        return self

    def at(self, rows: Indices) -> "MeshSurface":
        """Return what is known about some rows (m,) of the points."""
        place = np.full(len(self.normals), -1, np.int32)
        place[rows] = np.arange(len(rows), dtype=np.int32)
        links = place[self.links]
        kept = links[(links >= 0).all(axis=1)]
        return replace(self, normals=self.normals[rows], areas=self.areas[rows], links=kept)

    def scaled(self, factor: float) -> "MeshSurface":
        """Return the same of points whose lengths are multiplied by a factor."""
        return replace(self, areas=self.areas * factor**2)

    def linked(self, neighbours: Lists) -> Masks:
        """Return (n, k) which neighbours (n, k) are a few cells away along the mesh, the points themselves among them.

        What is as near in space on another part, or across a narrow gap, is not.
        """
        count = len(self.normals)
        ones = np.ones(len(self.links), bool)
        step = sparse.coo_array((ones, (self.links[:, 0], self.links[:, 1])), shape=(count, count)).tocsr()
        step = step + step.T + sparse.eye_array(count, dtype=bool, format="csr")
        reach = step
        for _ in range(HOPS - 1):
            reach = reach @ step
        near = reach.tocoo()
        there = near.row * np.int64(count) + near.col
        return np.asarray(np.isin(np.arange(count)[:, None] * np.int64(count) + neighbours, there))


def unique_pairs(pairs: Pairs) -> Edges:
    """Return pairs (n, 2) once each, the lower number first."""
    count = int(pairs.max(initial=0)) + 1
    keys = distinct(pair_keys(pairs, count))
    return np.stack([keys // count, keys % count], axis=1).astype(np.int32)


def still_on(surface: MeshSurface | None, points: npt.ArrayLike, before: npt.ArrayLike) -> MeshSurface | None:
    """Return what a mesh knows about points (n, 3), None where these are no longer what they were before (m, 3)."""
    return surface if surface is not None and np.array_equal(points, before) else None
