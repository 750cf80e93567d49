"""The types of arrays, and checks of arrays at the door of the library."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from tiskel.errors import TiskelError
from tiskel.params import MIN_POINTS, SIDE, Normalisation

# mypy tells them apart by dtype and number of axes, not by how long an axis is: Points and Table are one type to it.
Numbers = np.ndarray[tuple[int], np.dtype[np.float64]]  #: shape (n,); a vector (3,) too
Points = np.ndarray[tuple[int, int], np.dtype[np.float64]]  #: shape (n, 3)
Table = np.ndarray[tuple[int, int], np.dtype[np.float64]]  #: shape (n, k): columns, matrices, places in a plane
Stack = np.ndarray[tuple[int, int, int], np.dtype[np.float64]]  #: shape (n, k, m): a table for each of n
Floats = npt.NDArray[np.float64]  #: any number of axes, as the docstring says
Indices = np.ndarray[tuple[int], np.dtype[np.int32]]  #: shape (n,): rows of something
Edges = np.ndarray[tuple[int, int], np.dtype[np.int32]]  #: shape (e, 2), or (e, 3) for triangles
Labels = npt.NDArray[np.uint8]  #: small codes, any number of axes, as the docstring says
Lists = np.ndarray[tuple[int, int], np.dtype[np.int32]]  #: shape (n, k): a row of rows for each of n
Pairs = np.ndarray[tuple[int, int], np.dtype[np.integer[Any]]]  #: shape (l, 2) or (l, k), integers of any width
Mask = np.ndarray[tuple[int], np.dtype[np.bool_]]  #: shape (n,)
Masks = np.ndarray[tuple[int, int], np.dtype[np.bool_]]  #: shape (n, k)


class HasPoints(Protocol):
    """A cloud of this or of another program: ``points`` are rows of x, y and z, or can become such an array."""

    @property
    def points(self) -> Any:
        """(n, 3) coordinates."""


class HasVertices(Protocol):
    """A mesh or a cloud of another program: ``vertices`` are rows of x, y and z, or can become such an array."""

    @property
    def vertices(self) -> Any:
        """(n, 3) coordinates."""


PointsLike = npt.ArrayLike | HasPoints | HasVertices  #: whatever is taken for points

TINY = np.finfo(float).tiny  # the least normal number: keeps what may be zero from being divided by
LARGEST = 1e150  #: of a coordinate: the sum of three squares of differences is still a number
MAD = 1.4826  # of the median absolute deviation: the standard deviation of a normal distribution
SPREAD = np.uint64(0x9E3779B97F4A7C15)  # 2**64 over the golden ratio, odd: spreads bits (Knuth, volume 3, section 6.4)
FLATNESS = 1e-9  # thinner than this share of its length, a cloud is a plane or a line to rounding


def as_points(points: PointsLike) -> Points:
    """Return the points as an array that is laid out as the kernels need it.

    Parameters
    ----------
    points : array_like, or an object with ``points`` or ``vertices``
        Numbers in the shape (n, 3), in any unit; NaN and infinity pass. Clouds of this library, of Open3D and of
        trimesh are such objects.

    Returns
    -------
    (n, 3) float64
        C-contiguous; the argument itself where it is so already.

    Raises
    ------
    TiskelError
        Where they are no numbers or have another shape.
    """
    if isinstance(points, (str, Path)):
        raise TiskelError(f"points cannot be the path {str(points)!r}; read it with load_cloud")
    held = getattr(points, "points", getattr(points, "vertices", points))
    try:
        array = np.ascontiguousarray(held, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise TiskelError(f"points must be numbers in an array of shape (n, 3): {error}") from None
    if array.ndim != 2 or array.shape[1] != 3:
        hint = "; transpose them" if array.ndim == 2 and array.shape[0] == 3 else ""
        raise TiskelError(f"points must have shape (n, 3), got {array.shape}{hint}")
    largest = np.abs(array, where=np.isfinite(array), out=np.zeros_like(array)).max(initial=0.0)
    if largest > LARGEST:
        raise TiskelError(f"coordinates reach {largest:.3g}, squares beyond {LARGEST:g} overflow; scale the cloud")
    return array


def as_weights(weights: npt.ArrayLike, count: int) -> Numbers:
    """Return one positive number for each of so many points (count,); raise TiskelError for anything else."""
    values = np.asarray(weights, dtype=np.float64)
    if values.shape != (count,):
        raise TiskelError(
            f"weights must be one number for each of the {count} points, got shape {values.shape}; "
            "leave out what changes the number of points"
        )
    if not (np.isfinite(values) & (values > 0)).all():
        raise TiskelError("weights must be positive and finite; 1 leaves a point as it is")
    return values


def finite_rows(points: Points) -> Mask:
    """Return (n,) bool, which of points (n, 3) have three finite numbers."""
    return np.asarray(np.isfinite(points).all(axis=1))


def first_of_duplicates(points: Points) -> Indices:
    """Return for each point the first row at exactly the same place.

    Parameters
    ----------
    points : (n, 3) float64
        Finite, in any unit.

    Returns
    -------
    (n,) int32
        The row itself where it is alone or first.
    """
    everyone = np.arange(len(points), dtype=np.int32)
    marks = _marks(points)
    ordered = np.sort(marks)
    repeated = ordered[1:][ordered[1:] == ordered[:-1]]
    if len(repeated):
        rows = np.flatnonzero(np.isin(marks, repeated))
        _, first, inverse = np.unique(points[rows], axis=0, return_index=True, return_inverse=True)
        everyone[rows] = rows[first[inverse.ravel()]]
    return everyone


def _marks(points: Points) -> npt.NDArray[np.uint64]:
    """Return (n,) a number for each point, the same for the same place, seldom the same for others."""
    words = np.ascontiguousarray(points + 0.0).view(np.uint64)  # -0 is 0
    marks = np.zeros(len(points), np.uint64)
    for column in words.T:
        marks = (marks ^ column ^ (column >> np.uint64(32))) * SPREAD
        marks ^= marks >> np.uint64(29)
    return marks


def resolved(into: Indices) -> Indices:
    """Return for each row the one at the end of its chain of replacements.

    Parameters
    ----------
    into : (n,) int32
        The row that takes the place of each; a row that stays names itself. Chains must not go round in circles.

    Returns
    -------
    (n,) int32

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.arrays import resolved
    >>> resolved(np.array([0, 0, 1, 3], np.int32)).tolist()
    [0, 0, 0, 3]
    """
    while not np.array_equal(into, into[into]):
        into = into[into]
    return into


def check_solid(points: Points) -> None:
    """Check that points surround a body.

    Parameters
    ----------
    points : (n, 3) float64
        Distinct and finite, in any unit.

    Raises
    ------
    TiskelError
        Where they are fewer than ten, or lie on a line or a plane: there is no body to contract.
    """
    if len(points) < MIN_POINTS:
        raise TiskelError(f"a cloud needs at least {MIN_POINTS} distinct points, got {len(points)}; use a denser scan")
    singular = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if singular[2] <= FLATNESS * singular[0]:
        place = "a line" if singular[1] <= FLATNESS * singular[0] else "a plane"
        raise TiskelError(f"all {len(points)} points lie on {place}; a curve skeleton needs a cloud around a body")


@dataclass(frozen=True, eq=False)
class Frame:
    """A shift and a scale to normalised coordinates: (points - centre) * scale.

    Attributes
    ----------
    centre : (3,) float64
        The middle of the bounding box, in the input's unit.
    scale : float
        Normalised lengths per unit of the input.
    """

    centre: Numbers
    scale: float

    def apply(self, points: Points) -> Points:
        """Return points (n, 3) of the input in normalised coordinates."""
        return np.ascontiguousarray((points - self.centre) * self.scale)

    def place(self, place: tuple[float, float, float]) -> tuple[float, float, float]:
        """Return one place of the input in normalised coordinates."""
        x, y, z = self.apply(np.array([place]))[0].tolist()
        return x, y, z

    def undo(self, points: Points) -> Points:
        """Return normalised points (n, 3) in the units of the input."""
        return points / self.scale + self.centre


def normalisation(points: Points, kind: Normalisation = "side") -> Frame:
    """Return the map that centres the bounding box and scales it to a length of 1.6.

    The GLSkeleton paper says the diagonal; its toolbox, which made the tables, takes the longest side.

    Parameters
    ----------
    points : (n, 3) float64
        Points of a cloud, in any unit.
    kind : "side" or "diagonal"
        What is scaled to 1.6: the longest side of the bounding box, or its diagonal.

    Returns
    -------
    Frame

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.arrays import normalisation
    >>> frame = normalisation(np.array([[0, 0, 0], [4.0, 2, 2]]))
    >>> frame.centre.tolist(), frame.scale
    ([2.0, 1.0, 1.0], 0.4)
    """
    low, high = points.min(axis=0), points.max(axis=0)
    length = (high - low).max() if kind == "side" else np.linalg.norm(high - low)
    return Frame((low + high) / 2, float(SIDE / length))


def diagonal(points: Points) -> float:
    """Return the length of the bounding box's diagonal of points (n, 3), in their unit."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def within_runs(counts: npt.NDArray[np.integer[Any]]) -> npt.NDArray[np.int64]:
    """Return 0, 1, 2, ... within each run of so many, all runs one behind the other: 0, 1, 0, 1, 2 of 2 and 3."""
    return np.asarray(np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts))
