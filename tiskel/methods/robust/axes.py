"""Axes of sections: the line that the lines along the normals come closest to.

Its direction is the one that the normals have least of. These are the two facts
behind ROSA (Tagliasacchi, Zhang and Cohen-Or, Curve skeleton extraction from
incomplete point cloud, SIGGRAPH 2009), used there for planar cuts. Of a full ring
and of an arc alike the line lies on the axis, of a round cap in the middle of its
ball.
"""

import numpy as np

from tiskel.arrays import TINY, Indices, Numbers, Points, Table
from tiskel.methods.robust.network import Network
from tiskel.methods.trace import Sections

# Found by trial on the shapes of the gallery. In brackets: how many of the 14 curves of benchmarks/sensitivity.md
# change with 0.7 and with 1.4 times the value.
PULL = 0.05  # weight that pulls a centre to the mean of its section, against the lines of the normals [14, 14]
ROUND = 0.2  # spread of the distance to the axis, in its mean, up to which a section is contracted in full [14, 14]
RAGGED = 0.45  # the same spread, from which on a section stays as it is [14, 14]
FEWEST = 4  # points of a section that has an axis; fewer go to their centre [0, 1]


def line_centres(points: Points, normals: Points, label: Indices, count: int) -> tuple[Points, Numbers]:
    """Return the centre (count, 3) of each labelled set of points (n, 3), and how many points it has.

    The place that the lines along the normals come closest to, in least
    squares, pulled a little to the mean.
    """
    size = np.bincount(label, minlength=count).astype(float)
    mean = sums(points, label, count) / np.maximum(size, 1)[:, None]
    offset = points - mean[label]
    across = np.eye(3) * (1 + PULL) - normals[:, :, None] * normals[:, None, :]
    matrix = sums(across.reshape(-1, 9), label, count).reshape(-1, 3, 3)
    right = sums(np.einsum("nij,nj->ni", across, offset), label, count) - PULL * sums(offset, label, count)
    matrix[size == 0] = np.eye(3)
    return mean + np.linalg.solve(matrix, right[..., None])[..., 0], size


def on_axes(network: Network, sections: Sections) -> Points:
    """Return the points (n, 3) on the axes of their sections, as far as these are round."""
    rows = np.flatnonzero(sections.section >= 0)
    label, count = sections.section[rows], sections.count
    points, normals = network.points[rows], network.normals[rows]
    centre, size = line_centres(points, normals, label, count)
    scatter = sums((normals[:, :, None] * normals[:, None, :]).reshape(-1, 9), label, count).reshape(-1, 3, 3)
    values, vectors = np.linalg.eigh(scatter)
    # A tube has no normals along its axis, a ball as many as in any direction.
    tubular = np.clip(1 - 2 * values[:, 0] / np.maximum(values[:, 1], TINY), 0, 1)
    axis = vectors[:, :, 0] * np.where(size < FEWEST, 0, tubular)[:, None] ** 0.5
    offset = points - centre[label]
    moved = centre[label] + np.einsum("ij,ij->i", offset, axis[label])[:, None] * axis[label]
    share = _roundness(np.linalg.norm(points - moved, axis=1), label, size)[label][:, None]
    contracted = network.points.copy()
    contracted[rows] = share * moved + (1 - share) * points
    return np.asarray(contracted)


def _roundness(distance: Numbers, label: Indices, size: Numbers) -> Numbers:
    """Return 1 for sections whose points are equally far from the axis, 0 where they are not at all."""
    mean = np.bincount(label, distance, minlength=len(size)) / size
    square = np.bincount(label, distance**2, minlength=len(size)) / size
    spread = np.sqrt(np.maximum(square - mean**2, 0)) / np.maximum(mean, TINY)
    return np.asarray(np.clip((RAGGED - spread) / (RAGGED - ROUND), 0, 1))


def sums(values: Table, label: Indices, count: int) -> Table:
    """Return (count, d) the sums of values (n, d) by label."""
    return np.asarray(np.stack([np.bincount(label, column, minlength=count) for column in values.T], axis=1))
