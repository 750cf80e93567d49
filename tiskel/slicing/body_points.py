"""The points that the surface of a body is fitted to: distinct, oriented, with the thickness of the body about each."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Lists, Mask, Numbers, Points, Table, first_of_duplicates
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.neighbours import morton_curve, nearest_neighbours
from tiskel.geometry.oriented import OrientedCloud, oriented_cloud
from tiskel.geometry.quadrics import Quadrics, fit_quadrics
from tiskel.geometry.strays import body_rows
from tiskel.params import BodyParams
from tiskel.skeleton import Skeleton
from tiskel.slicing.body_gaps import lids_of
from tiskel.surfaces.patches import Trust

TOWARDS = 0.5  # cosine from which on points count fully for one another; none where they look apart
AGAINST = -0.3  # cosine below which a point is on an opposite wall
POOLED = 30  # nearest points whose median error is that of one of them; of 12, noisy curvatures are twice as far off
REACH = 1.05  # of the distance to the last neighbour: where weights end, so that the last one counts
ROUNDS = 2  # normals of the first quadrics make the second better, those of the second hardly the third
LIDS, ASIDE = 0.1, 0.35  # share of a neighbourhood that closes gaps, and widths that its middle is off, of little seen
BATCH = 8192  # points at a time, which bounds the memory


@dataclass(frozen=True, eq=False)
class BodyPoints:
    """Points of a surface and what is around each.

    Attributes
    ----------
    rows : (n,) int32
        Their rows in the cloud; -1 for places that close gaps of it.
    points : (n, 3) float64
        Distinct, in the cloud's unit.
    normals : (n, 3) float64
        Unit vectors out of the body.
    radii : (n,) float64
        How thick the body is about each.
    near : (n, k) int32
        The nearest of each, itself first.
    far : (n, k) float64
        How far these are.
    count : (n,) int32
        How many of these a quadric is fitted to.
    error : (n,) float64
        How far points about it are off that, root mean square.
    trusted : bool
        Whether the normals agree on which side is out.
    """

    rows: Indices
    points: Points
    normals: Points
    radii: Numbers
    near: Lists
    far: Table
    count: Indices
    error: Numbers
    trusted: bool

    @property
    def widths(self) -> Numbers:
        """(n,) how far the neighbourhoods reach that quadrics are fitted to."""
        return np.asarray(REACH * self.far[np.arange(len(self.far)), self.count - 1])

    @property
    def seen(self) -> Mask:
        """(n,) which are points of the cloud."""
        return np.asarray(self.rows >= 0)

    def trust(self, rows: Indices) -> npt.NDArray[np.uint8]:
        """Return (m,) what a quadric about some rows (m,) is worth, see :class:`tiskel.Trust`.

        Little is seen where points are missing on one side, or places that close a gap are among them.
        """
        out = np.empty(len(rows), np.uint8)
        for count in np.unique(self.count[rows]).tolist():
            some = np.flatnonzero(self.count[rows] == count)
            near, width = self.near[rows[some], :count], self.widths[rows[some]]
            lids = (~self.seen[near]).mean(axis=1)
            aside = np.linalg.norm(self.points[near].mean(axis=1) - self.points[rows[some]], axis=1)
            out[some] = np.where((lids > LIDS) | (aside > ASIDE * width), Trust.SEEN, Trust.MEASURED)
        out[~self.seen[rows]] = Trust.BRIDGED
        return out

    @property
    def opposite(self) -> Numbers:
        """(n,) how far the nearest point on an opposite wall is; infinite where none of the nearest is on one."""
        parts = []
        for first in range(0, len(self.points), BATCH):
            some = slice(first, first + BATCH)
            alike = np.einsum("mkj,mj->mk", self.normals[self.near[some]], self.normals[some])
            parts.append(np.where(alike < AGAINST, self.far[some], np.inf).min(axis=1))
        return np.concatenate(parts)

    def quadrics(self, rows: Indices, count: int) -> Quadrics:
        """Return the quadrics through the nearest so many points about some rows (m,)."""
        near, far = np.ascontiguousarray(self.near[rows, :count]), self.far[rows, :count]
        width = np.asarray(REACH * far[:, -1])
        alike = np.einsum("mkj,mj->mk", self.normals[near], self.normals[rows])
        weights = (1 - (far / width[:, None]) ** 2) ** 2 * np.clip(alike / TOWARDS, 0, 1)
        return fit_quadrics(self.points[rows], self.points, self.normals, near, weights, width)

    def chosen(self, rows: Indices) -> Quadrics:
        """Return the quadrics about some rows (m,), each through as many points as it takes."""
        order = np.argsort(self.count[rows], kind="stable")
        counts, first = np.unique(self.count[rows[order]], return_index=True)
        groups = np.split(rows[order], first[1:])
        parts = [self.quadrics(group, count) for group, count in zip(groups, counts.tolist(), strict=True)]
        joined = Quadrics(*(np.concatenate(column) for column in zip(*parts, strict=True)))
        return joined.at(np.argsort(order, kind="stable"))


def body_points(curve: CurveGraph, cloud: Points, params: BodyParams) -> BodyPoints:
    """Return the points of a cloud that is a body, with normals as smooth as its noise asks for.

    Parameters
    ----------
    curve : CurveGraph
        The skeleton; a tiskel skeleton of this cloud knows the node of every point, of another the nearest is taken.
    cloud : (n, 3) float64
        In the unit of the curve; stray points and repeated ones are left out.
    params : BodyParams
        The settings.

    Returns
    -------
    BodyPoints
    """
    rows = np.flatnonzero(body_rows(cloud)).astype(np.int32)
    rows = rows[first_of_duplicates(cloud[rows]) == np.arange(len(rows))]
    if len(rows) > params.most:  # evenly along a curve through all of space, so as dense as they were in proportion
        order = morton_curve(np.ascontiguousarray(cloud[rows])).order
        rows = np.sort(rows[order[np.linspace(0, len(order) - 1, params.most).astype(int)]])
    points = np.ascontiguousarray(cloud[rows])
    known = isinstance(curve, Skeleton) and len(curve.node_of_point) == len(cloud)
    node = curve.node_of_point[rows] if known else cKDTree(curve.nodes).query(points)[1]  # type: ignore[attr-defined]
    targets = np.ascontiguousarray(curve.nodes[node])
    away = np.linalg.norm(points - targets, axis=1)
    radii = np.where(curve.radii[node] > 0, curve.radii[node], away)
    oriented = oriented_cloud(points, targets)
    body = _with_lids(rows, oriented, radii, params)
    for _ in range(ROUNDS):
        body = _smoothed(body, params)
    return body


def _with_lids(rows: Indices, surface: OrientedCloud, radii: Numbers, params: BodyParams) -> BodyPoints:
    """Return the points and the places that close their gaps, where normals agree on which side is out."""
    points, normals = surface.points, surface.normals
    if surface.trusted:
        lids = lids_of(surface)
        nearest = cKDTree(points).query(lids.points)[1]
        points, normals = np.concatenate([points, lids.points]), np.concatenate([normals, lids.normals])
        radii = np.concatenate([radii, radii[nearest]])
        rows = np.concatenate([rows, np.full(len(lids.points), -1, np.int32)])
    near, squares = nearest_neighbours(points, min(params.neighbours[-1], len(points)))
    least = np.full(len(points), min(params.neighbours[0], len(points)), np.int32)
    return BodyPoints(
        rows, points, normals, radii, near, np.sqrt(squares), least, np.zeros(len(points)), surface.trusted
    )  # fmt: skip


def _smoothed(body: BodyPoints, params: BodyParams) -> BodyPoints:
    """Return the points with normals of quadrics through the most points that are off them no more than by noise.

    Noise alone leaves the error the same however many points there are; the form
    of the body makes it grow (Lepski's rule).
    """
    size = len(body.points)
    least, error, errors = np.full(size, np.inf), np.full(size, np.nan), np.zeros(size)
    count, normals, rows = body.count.copy(), body.normals.copy(), np.arange(size, dtype=np.int32)
    for tried in (some for some in params.neighbours if some <= body.near.shape[1]):
        found = body.quadrics(rows, tried)
        error[rows] = found.error
        pooled = np.median(error[body.near[rows, :POOLED]], axis=1)
        least[rows] = np.minimum(least[rows], pooled)
        enough = np.maximum(params.noise * least[rows], params.exact * body.radii[rows])
        fits = (pooled <= enough) & (REACH * body.far[rows, tried - 1] < params.widest * body.radii[rows])
        fits |= tried == params.neighbours[0]
        slope, rows = found.gradient[fits], rows[fits]
        count[rows], errors[rows] = tried, pooled[fits]
        normals[rows] = slope / np.linalg.norm(slope, axis=1)[:, None]
    return replace(body, normals=normals, count=count, error=errors)
