"""Where a sphere can roll to from a place, and the shortest way there over places that are spread over the surface."""

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Mask, Numbers, Points, Stack
from tiskel.errors import TiskelError
from tiskel.params import PlanParams
from tiskel.rolling.ambient import Ground, least_curvature
from tiskel.rolling.second import Surroundings
from tiskel.surfaces.implicit import projected

SPACING = 0.7  # radii of the sphere between places
AROUND = 8  # directions that are tried from each place
LEAST, NEIGHBOURS = 0.75, 1.7  # spacings: between two places, and of an edge
LONGEST = 3.0  # spacings of an edge over the surface, which is longer than that of the centre in hollows
ALIKE = 0.3  # cosine between normals of neighbours at least
FITS = 0.06  # lambda_min(K_o) R_s + 1 at least: nearer to 0 the contact runs away
TIGHTER = 0.1  # of a way's length over what room there is, as if it were longer: in tight hollows errors grow
SHARES = (0.25, 0.5, 0.75)  # of an edge, where it is looked whether the sphere stands
NOT_CONNECTED = "where it fits is not connected"
CLOSED = 0.3  # radii about a place that is closed
MORE = 6  # rounds of the search after the goal was reached: for ways around that turn out shorter


@dataclass(frozen=True, eq=False)
class Standing:
    """What a sphere needs of a place to stand there.

    Attributes
    ----------
    ground : Ground
        Surface, side and sphere.
    around : Surroundings
        What else is there.
    balls : (k, 4) float64
        Balls x, y, z, radius that the sphere keeps out of.
    closed : (n, 3) float64
        Centres that the sphere's keeps away from.
    """

    ground: Ground
    around: Surroundings
    balls: Points
    closed: Points = field(default_factory=lambda: np.zeros((0, 3)))

    def without(self, centres: Points) -> "Standing":
        """Return the same, with places closed about which the sphere turned out not to fit."""
        return replace(self, closed=np.concatenate([self.closed, centres]))

    def stands(self, places: Points) -> Mask:
        """Return (n,) whether the sphere can stand at places (n, 3) of the surface."""
        _, z, shape = self.ground.touches(places)
        centres = places + self.ground.radius * z
        with np.errstate(invalid="ignore"):
            good = np.isfinite(centres).all(axis=1) & (least_curvature(shape) * self.ground.radius + 1 > FITS)
        good &= self.avoids(centres)
        if len(self.closed):
            good[good] = cKDTree(self.closed).query(centres[good])[0] > CLOSED * self.ground.radius
        good[good] = self.around.free(places[good], centres[good])
        return good

    def avoids(self, centres: Points) -> Mask:
        """Return (n,) whether spheres about centres (n, 3) keep out of the balls."""
        far = np.linalg.norm(centres[:, None] - self.balls[None, :, :3], axis=2)
        return np.asarray((far >= self.balls[None, :, 3] + self.ground.radius).all(axis=1))

    def why_not(self, place: Numbers) -> str:
        """Return why the sphere cannot stand at a place (3,), empty where it can."""
        if self.stands(place[None])[0]:
            return ""
        _, z, shape = self.ground.touches(place[None])
        least = float(least_curvature(shape)[0])
        if not least * self.ground.radius + 1 > FITS:
            return f"the surface bends as sharply as the sphere; one of less than {(FITS - 1) / least:.4g} would fit"
        if not self.avoids(place[None] + self.ground.radius * z)[0]:
            return "it would lie in a ball that is to be avoided"
        return "another part of the surface would lie in it"


def reachable(standing: Standing, start: Numbers, goal: Numbers, params: PlanParams) -> Points:
    """Return places (n, 3) that are spread over where the sphere can roll to, from the start first to the goal last.

    Raises
    ------
    TiskelError
        Where the goal cannot be reached, with how near the sphere comes.
    """
    places, reached = _spread(standing, start, goal, params)
    every = np.concatenate([places, goal[None]])
    if reached:
        return every
    centres = every + standing.ground.radius * standing.ground.touches(every)[1]
    near = float(np.linalg.norm(centres[:-1] - centres[-1], axis=1).min())
    limit = len(places) >= params.most_places
    why = f"after {len(places)} places, the limit (most_places)" if limit else NOT_CONNECTED
    raise TiskelError(
        f"no way for a sphere of radius {standing.ground.radius:.4g}: {why}; it comes within {near:.4g} of the goal"
        + ("" if limit else "; take a smaller one")
    )


def _spread(standing: Standing, start: Numbers, goal: Numbers, params: PlanParams) -> tuple[Points, bool]:
    """Return places (n, 3) that the sphere can come to, the start first, and whether the goal is among them."""
    ground = standing.ground
    spacing = SPACING * ground.radius
    goal_z = ground.touches(goal[None])[1][0]
    goal_centre = goal + ground.radius * goal_z
    places, front = start[None], start[None]
    centres = start[None] + ground.radius * ground.touches(start[None])[1]
    left: int | None = None
    while len(front) and len(places) < params.most_places and left != 0:
        found, normals = _candidates(ground, front, spacing)
        found_centres = found + ground.radius * normals
        keep = _apart(found_centres, centres, LEAST * spacing)
        found, found_centres, normals = found[keep], found_centres[keep], normals[keep]
        good = standing.stands(found)
        front = found[good]
        places, centres = np.concatenate([places, front]), np.concatenate([centres, found_centres[good]])
        near = (np.linalg.norm(found_centres[good] - goal_centre, axis=1) < spacing) & (normals[good] @ goal_z > ALIKE)
        if left is None and near.any():
            left = MORE
        elif left is not None:
            left -= 1
    at_start = bool(np.linalg.norm(centres[0] - goal_centre) < spacing)
    return places, left is not None or at_start


def _candidates(ground: Ground, front: Points, spacing: float) -> tuple[Points, Points]:
    """Return places around those of a front, and the normals there: the centre moves by the spacing."""
    _, z, shape = ground.touches(front)
    x = np.cross(z, np.where(np.abs(z[:, 2:]) < 0.8, [[0.0, 0, 1]], [[1.0, 0, 0]]))
    x = x / np.linalg.norm(x, axis=1)[:, None]
    y = np.cross(z, x)
    angles = 2 * np.pi * np.arange(AROUND) / AROUND
    ahead = np.cos(angles)[None, :, None] * x[:, None] + np.sin(angles)[None, :, None] * y[:, None]
    steps = spacing * np.einsum("nij,naj->nai", _inverse(ground, shape), ahead)
    lengths = np.linalg.norm(steps, axis=2, keepdims=True)
    steps = steps * np.minimum(1, LONGEST * spacing / np.maximum(lengths, TINY))
    aimed = (front[:, None] + steps).reshape(-1, 3)
    found = projected(ground.surface, aimed)
    _, normals, _ = ground.touches(found)
    with np.errstate(invalid="ignore"):
        good = (np.linalg.norm(found - aimed, axis=1) < spacing) & (
            (normals * np.repeat(z, AROUND, axis=0)).sum(axis=1) > ALIKE
        )
    return found[good], normals[good]


def _inverse(ground: Ground, shape: Stack) -> Stack:
    """Return (I + R_s S)^-1 (n, 3, 3): how the contact moves with the centre."""
    return np.asarray(np.linalg.inv(np.eye(3) + ground.radius * shape))


def _apart(found: Points, taken: Points, least: float) -> Mask:
    """Return (n,) which of places to keep so that none is nearer than that to one that is taken, or to one another."""
    keep = cKDTree(taken).query(found, distance_upper_bound=least)[0] >= least
    rows = np.flatnonzero(keep)
    lists = cKDTree(found[rows]).query_ball_point(found[rows], least)
    for row, near in zip(rows.tolist(), lists, strict=True):
        if keep[row]:
            keep[rows[near]] = False
            keep[row] = True
    return np.asarray(keep)


def shortest_way(standing: Standing, places: Points) -> Points:
    """Return the shortest way (k, 3) of the centre from the first to the last of places (n, 3) between which it rolls.

    Edges on which the sphere cannot stand are given up when they are met.

    Raises
    ------
    TiskelError
        Where there is none.
    """
    ground = standing.ground
    spacing = SPACING * ground.radius
    keep = standing.stands(places)
    keep[[0, -1]] = True
    places = places[keep]
    z = ground.touches(places)[1]
    centres = places + ground.radius * z
    pairs = cKDTree(centres).query_pairs(NEIGHBOURS * spacing, output_type="ndarray")
    over = np.linalg.norm(places[pairs[:, 0]] - places[pairs[:, 1]], axis=1)
    pairs = pairs[((z[pairs[:, 0]] * z[pairs[:, 1]]).sum(axis=1) > ALIKE) & (over < LONGEST * spacing)]
    lengths = np.linalg.norm(centres[pairs[:, 0]] - centres[pairs[:, 1]], axis=1)
    room = np.maximum(ground.margin(places) * ground.radius, FITS)
    lengths = lengths * (1 + TIGHTER / np.minimum(room[pairs[:, 0]], room[pairs[:, 1]]))
    good, size = np.ones(len(pairs), bool), len(places)
    number = {pair: row for row, pair in enumerate(map(tuple, np.sort(pairs, axis=1).tolist()))}
    while True:
        graph = csr_matrix((np.maximum(lengths[good], TINY), (pairs[good, 0], pairs[good, 1])), (size, size))
        far, before = dijkstra(graph, directed=False, indices=0, return_predecessors=True)
        if not np.isfinite(far[-1]):
            raise TiskelError(f"no way for a sphere of radius {ground.radius:.4g}: {NOT_CONNECTED}; take a smaller one")
        way = [size - 1]
        while way[-1] != 0:
            way.append(int(before[way[-1]]))
        edges = [number[min(a, b), max(a, b)] for a, b in zip(way[:-1], way[1:], strict=True)]
        between = [projected(ground.surface, share * places[pairs[edges, 0]] + (1 - share) * places[pairs[edges, 1]])
                   for share in SHARES]  # fmt: skip
        free = np.all([standing.stands(some) for some in between], axis=0)
        if free.all():
            return np.asarray(places[way[::-1]])
        good[np.array(edges)[~free]] = False
