"""Polygons of mesh files as triangles."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Edges, within_runs
from tiskel.errors import TiskelError
from tiskel.io.formats.base import NO_FACES

BATCH = 5_000  #: polygons at a time: as lists of whole numbers they take many times what they do in a file


@dataclass(frozen=True, eq=False)
class Lists:
    """Polygons one behind the other.

    Attributes
    ----------
    corners : (k,) array of int
        Of all polygons.
    lengths : (m,) int64
        How many corners each has.
    """

    corners: npt.NDArray[Any]
    lengths: npt.NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.lengths)


def joined(batches: Iterable[Edges]) -> Edges:
    """Return the triangles (m, 3) of batches of polygons as one array."""
    return np.concatenate([NO_FACES, *batches])


def fans(polygons: Sequence[Sequence[int]] | npt.NDArray[Any] | Lists, count: int, name: str) -> Edges:
    """Return polygons as triangles that fan out from their first corners, in the order of the polygons.

    Parameters
    ----------
    polygons : sequence of sequences of int, or Lists
        The corners of each, counted from 0; fewer than three make no triangle.
    count : int
        Corners that the file has.
    name : str
        The file's name, for messages.

    Returns
    -------
    (m, 3) int32

    Raises
    ------
    TiskelError
        Where a polygon names a corner that is not there.

    Examples
    --------
    >>> from tiskel.io.formats.faces import fans
    >>> fans([[0, 1, 2, 3]], 4, "square.off").tolist()
    [[0, 1, 2], [0, 2, 3]]
    """
    if len(polygons) == 0:
        return NO_FACES
    try:
        named, lengths = _flat(polygons)
        if named.dtype.kind == "f" and (np.abs(named) > count).any():  # what int64 does not hold came as float64
            raise OverflowError
        corners = named.astype(np.int64, copy=False)
    except OverflowError:
        raise TiskelError(f"{name}: a face names a vertex beyond all numbers; export it again") from None
    if len(corners) and (corners.min() < 0 or corners.max() >= count):
        wrong = corners.min() if corners.min() < 0 else corners.max()
        raise TiskelError(f"{name}: a face names vertex {wrong}, there are {count}; export it again")
    triangles = np.maximum(lengths - 2, 0)
    first = np.repeat(np.cumsum(lengths) - lengths, triangles)
    step = within_runs(triangles)
    return np.stack([corners[first], corners[first + step + 1], corners[first + step + 2]], axis=1).astype(np.int32)


def _flat(
    polygons: Sequence[Sequence[int]] | npt.NDArray[Any] | Lists,
) -> tuple[npt.NDArray[Any], npt.NDArray[np.int64]]:
    """Return the corners of all polygons, and how many each has."""
    if isinstance(polygons, Lists):
        return polygons.corners, polygons.lengths
    if isinstance(polygons, np.ndarray) and polygons.ndim == 2:
        return polygons.ravel(), np.full(len(polygons), polygons.shape[1], np.int64)
    return np.concatenate([*polygons]), np.fromiter(map(len, polygons), np.int64, len(polygons))
