"""What stage files must keep to, checked once, where they are read: indices, counts, numbers, chains.

Every check raises ValueError with the element, the row from 0, the property and
the value; the readers say which file it was, and what to do.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Indices, Numbers, Points
from tiskel.io import ply

WHOLE = 2**31  #: whole numbers of stage files lie below it
ROOM, PER_BYTE = 200 << 20, 10  #: bytes that what is read may take: so many, and so many for each byte of the file


def element(file: Any, name: str) -> npt.NDArray[Any]:
    """Return the rows of an element of a PLY file."""
    if name not in file:
        raise ValueError(f"there is no element {name!r}")
    return np.asarray(file[name].data)


def column(table: npt.NDArray[Any], where: str, name: str, kinds: str = "iuf") -> npt.NDArray[Any]:
    """Return one property of an element, single numbers of the kinds named."""
    if name not in (table.dtype.names or ()):
        raise ValueError(f"element {where!r} has no property {name}")
    values = np.asarray(table[name])
    if values.dtype.kind not in kinds or values.ndim != 1:
        wanted = "numbers" if "f" in kinds else "whole numbers"
        raise ValueError(f"property {name} of element {where!r} must be single {wanted}")
    return values


def whole(table: npt.NDArray[Any], where: str, name: str, count: int = WHOLE, *, none: bool = False) -> Indices:
    """Return whole numbers below a count, at least 0, or -1 where there may be none."""
    return numbered(column(table, where, name, "iu"), f"element {where!r}", name, count, none=none)


def numbered(values: npt.NDArray[Any], where: str, name: str, count: int = WHOLE, *, none: bool = False) -> Indices:
    """Return whole numbers as int32, each below the count and at least 0, or -1 where there may be none."""
    low = -1 if none else 0
    bad = np.flatnonzero((values < low) | (values >= count))
    if len(bad):
        limits = f"from {low} to {count - 1}" if count > 0 else "none at all"
        raise ValueError(f"{where}, row {bad[0]}: {name} is {values[bad[0]]}, it must be {limits}")
    return np.array(values, np.int32)


def listed(values: Any, what: str) -> npt.NDArray[np.int64]:
    """Return a list of whole numbers."""
    array = np.array(values)
    if len(array) and (array.ndim != 1 or array.dtype.kind not in "iu"):
        raise ValueError(f"{what} must be a list of whole numbers")
    return array.astype(np.int64)


def places(table: npt.NDArray[Any], where: str, names: Sequence[str] = ("x", "y", "z")) -> Points:
    """Return three properties as (n, 3) float64, all of them finite."""
    for name in names:
        column(table, where, name)
    return finite(ply.points_of(table, names), f"element {where!r}", ", ".join(names))


def finite(values: Points, where: str, name: str) -> Points:
    """Return numbers (n, d), all of them finite."""
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if len(bad):
        raise ValueError(f"{where}, row {bad[0]}: {name} is {values[bad[0]].tolist()}, it must be finite")
    return values


@np.errstate(invalid="ignore")
def sizes(table: npt.NDArray[Any], where: str, name: str) -> Numbers:
    """Return lengths or areas: 0 or more, or NaN where they are not known."""
    values = np.array(column(table, where, name), np.float64)
    bad = np.flatnonzero((values < 0) | np.isinf(values))
    if len(bad):
        raise ValueError(f"element {where!r}, row {bad[0]}: {name} is {values[bad[0]]}, it must be 0 or more")
    return values


def once(rows: Indices, where: str, name: str) -> Indices:
    """Return row numbers of which none is there twice."""
    order = np.argsort(rows, kind="stable")
    again = np.flatnonzero(np.diff(rows[order]) == 0)
    if len(again):
        raise ValueError(f"element {where!r}, row {order[again[0] + 1]}: {name} is {rows[order[again[0]]]} once more")
    return rows


def check_chains(merged_into: Indices, rows: Indices) -> None:
    """Raise where a chain of merged points goes round in a circle, or ends at a point that is not left."""
    ends = np.where(merged_into < 0, np.arange(len(merged_into)), merged_into)
    for _ in range(len(merged_into).bit_length()):  # each time twice as far along the chains
        ends = ends[ends]
    left = np.zeros(len(merged_into), np.bool_)
    left[rows] = True
    bad = np.flatnonzero(~left[ends])
    if len(bad):
        said = f"element 'cloud', row {bad[0]}: merged_into is {merged_into[bad[0]]}"
        raise ValueError(f"{said}, which leads to no point of element 'vertex'")
    merged = np.flatnonzero(merged_into[rows] >= 0)
    if len(merged):
        raise ValueError(
            f"element 'vertex', row {merged[0]}: row is {rows[merged[0]]}, which was merged into another point"
        )


def check_room(needed: int, given: int, what: str) -> None:
    """Raise where so many bytes are needed for what a file of so many bytes says."""
    if needed > ROOM + PER_BYTE * given:
        raise ValueError(f"{what} would take {needed >> 20} MB, the file has {given >> 10} kB")
