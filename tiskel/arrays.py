"""Checks of arrays at the door of the library."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tiskel.errors import TiskelError
from tiskel.params import MIN_POINTS, SIDE, Normalisation

Points = npt.NDArray[np.float64]  #: shape (n, 3)
Indices = npt.NDArray[np.int32]
Numbers = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

FLATNESS = 1e-9  # thinner than this share of its length, a cloud is a plane or a line to rounding


def as_points(points: npt.ArrayLike) -> Points:
    """Return the points as a C-contiguous float64 array of shape (n, 3)."""
    try:
        array = np.ascontiguousarray(points, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise TiskelError(f"points must be numbers in an array of shape (n, 3): {error}") from None
    if array.ndim != 2 or array.shape[1] != 3:
        hint = "; transpose them" if array.ndim == 2 and array.shape[0] == 3 else ""
        raise TiskelError(f"points must have shape (n, 3), got {array.shape}{hint}")
    return array


def finite_rows(points: Points) -> Mask:
    """Return which rows hold three finite numbers."""
    return np.asarray(np.isfinite(points).all(axis=1))


def first_of_duplicates(points: Points) -> Indices:
    """Return for each row the first row at exactly the same place (itself where it is alone)."""
    _, first, inverse = np.unique(points, axis=0, return_index=True, return_inverse=True)
    return first[inverse.ravel()].astype(np.int32)


def resolved(into: Indices) -> Indices:
    """Return for each row the one at the end of its chain of replacements; a row that stays names itself."""
    while not np.array_equal(into, into[into]):
        into = into[into]
    return into


def check_solid(points: Points) -> None:
    """Raise where distinct points are too few, or lie on a line or a plane: there is no body to contract."""
    if len(points) < MIN_POINTS:
        raise TiskelError(f"a cloud needs at least {MIN_POINTS} distinct points, got {len(points)}; use a denser scan")
    singular = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if singular[2] <= FLATNESS * singular[0]:
        place = "a line" if singular[1] <= FLATNESS * singular[0] else "a plane"
        raise TiskelError(f"all {len(points)} points lie on {place}; a curve skeleton needs a cloud around a body")


@dataclass(frozen=True)
class Frame:
    """A shift and a scale to normalised coordinates: (points - centre) * scale."""

    centre: Numbers
    scale: float

    def apply(self, points: Points) -> Points:
        return np.ascontiguousarray((points - self.centre) * self.scale)

    def undo(self, points: Points) -> Points:
        return points / self.scale + self.centre


def normalisation(points: Points, kind: Normalisation = "side") -> Frame:
    """Return the map that centres the bounding box and scales its longest side (or diagonal) to 1.6.

    The GLSkeleton paper says the diagonal; its toolbox, which made the tables, takes the longest side.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    length = (high - low).max() if kind == "side" else np.linalg.norm(high - low)
    return Frame((low + high) / 2, float(SIDE / length))


def diagonal(points: Points) -> float:
    """Return the length of the bounding box's diagonal."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))
