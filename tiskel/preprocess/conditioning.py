"""What can be done to a cloud before the first stage; each off by default, each reported."""

from dataclasses import replace

import numpy as np

from tiskel.arrays import Mask, Points, PointsLike, diagonal, finite_rows
from tiskel.errors import TiskelError
from tiskel.geometry.given import given_cloud
from tiskel.geometry.neighbours import nearest_neighbours
from tiskel.geometry.strays import body_of, stray_points
from tiskel.params import ConditioningParams, NoiseKind
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import ConditioningSettings
from tiskel.preprocess.capping import cap_points

OUTLIER_NEIGHBOURS = 17  # the point included; sixteen others, a common choice of statistical removal
OUTLIER_DEVIATIONS = 2.0


def condition(
    points: PointsLike, params: ConditioningParams | None = None, **settings: Unpack[ConditioningSettings]
) -> tuple[Points, tuple[str, ...]]:
    """Crop, remove outliers, thin, cap and blur a cloud, in this order.

    Rows that are not finite are left for the next stage to count, unless
    something is asked for, which drops them here.

    Parameters
    ----------
    points : (n, 3) array, Cloud, or object of Open3D or trimesh
        The cloud, in any unit.
    params : ConditioningParams, optional
        What is done; by default nothing.
    **settings
        Those of :class:`tiskel.ConditioningParams` by name; over those of params.

    Returns
    -------
    points : (m, 3) float64
        The cloud that is left.
    report : tuple of str
        One line for each thing done.

    Raises
    ------
    TiskelError
        Where no point is left.

    Examples
    --------
    >>> from tiskel import condition, make_shape, shape_graph
    >>> cloud, _ = make_shape(shape_graph("capsule"))
    >>> thinned, report = condition(cloud, sample=1000)
    >>> thinned.shape, report
    ((1000, 3), ('sampling took away 3096 points',))
    """
    report: list[str] = []
    params, every = settled(ConditioningParams, params, settings), given_cloud(points)[0]
    if replace(params, columns=None, classification=None) == ConditioningParams(seed=params.seed):
        return every, ()
    points = every[finite_rows(every)]
    _say(report, every, points, "dropped {} rows with NaN or Inf")
    if params.crop is not None:
        before, points = points, points[_inside(points, params.crop)]
        _say(report, before, points, "cropped away {} points")
    if params.outliers:
        before, points = points, points[_inliers(points)]
        _say(report, before, points, "removed {} outliers")
    if params.voxel is not None:
        before, points = points, voxel_means(points, params.voxel)
        _say(report, before, points, "voxels took away {} points")
    if params.sample is not None and params.sample < len(points):
        generator = np.random.default_rng(params.seed)
        before, points = points, points[np.sort(generator.choice(len(points), params.sample, replace=False))]
        _say(report, before, points, "sampling took away {} points")
    if params.cap and len(points):
        added = cap_points(points)
        points = np.concatenate([points, added])
        report.append(f"capped open ends with {len(added)} points")
    if params.noise > 0 and len(points):
        points = with_noise(points, params.noise, params.noise_kind, params.seed)
        report.append(f"added noise of {params.noise:.3g} of the {params.noise_kind}")
    if len(points) == 0:
        raise TiskelError(f"no point of {len(every)} is left after {'; '.join(report)}; loosen the options")
    return np.ascontiguousarray(points), tuple(report)


def _say(report: list[str], before: Points, after: Points, line: str) -> None:
    if len(after) < len(before):
        report.append(line.format(len(before) - len(after)))


def _inside(points: Points, box: tuple[float, ...]) -> Mask:
    return np.asarray(((points >= box[:3]) & (points <= box[3:])).all(axis=1))


def _inliers(points: Points) -> Mask:
    """Statistical outlier removal (Rusu et al. 2008); stray points go first, and have no part in the statistics."""
    body = ~stray_points(points)
    within = np.ascontiguousarray(points[body])
    if len(within) <= OUTLIER_NEIGHBOURS:
        return np.asarray(body)
    mean = np.sqrt(nearest_neighbours(within, OUTLIER_NEIGHBOURS)[1]).sum(axis=1) / (OUTLIER_NEIGHBOURS - 1)
    body[body] = mean <= mean.mean() + OUTLIER_DEVIATIONS * mean.std()
    return np.asarray(body)


def with_noise(points: Points, share: float, kind: NoiseKind = "coordinates", seed: int = 0) -> Points:
    """Return a cloud with Gaussian noise, as the published experiments have it.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    share : float
        The standard deviation, as a share of what ``kind`` says.
    kind : "coordinates" or "diagonal"
        "coordinates": of each coordinate, taken from the middle of the bounding box (the evaluation toolbox multiplies
        raw coordinates, which depends on the origin). "diagonal": of half the diagonal, the same everywhere, as in the
        chapter on contraction.
    seed : int
        Of the noise.

    Returns
    -------
    (n, 3) float64
    """
    body = body_of(points)
    middle = (body.min(axis=0) + body.max(axis=0)) / 2
    scale = points - middle if kind == "coordinates" else diagonal(body) / 2
    return np.asarray(points + np.random.default_rng(seed).normal(size=points.shape) * share * scale)


def voxel_means(points: Points, side: float) -> Points:
    """Return the mean of the points in every occupied cube of a grid, in the order of the cubes.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud, in any unit.
    side : float
        Side of the cubes, in the same unit.

    Returns
    -------
    (m, 3) float64

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.preprocess.conditioning import voxel_means
    >>> voxel_means(np.array([[0, 0, 0], [0.5, 0, 0], [3.0, 0, 0]]), 1.0).tolist()
    [[0.25, 0.0, 0.0], [3.0, 0.0, 0.0]]
    """
    cells = np.floor((points - body_of(points).min(axis=0)) / side)
    _, inverse, counts = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    sums = [np.bincount(inverse.ravel(), points[:, axis], minlength=len(counts)) for axis in range(3)]
    return np.stack(sums, axis=1) / counts[:, None]
