"""Scans in PTX, the text format of Leica: one or several, each with the way from the scanner to the world."""

import numpy as np

from tiskel.arrays import Table
from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed, short

HEAD = 10  #: lines before the points of a scan: columns, rows, four of the scanner's place, four of the matrix
WIDTHS = (3, 4, 6, 7)  #: numbers in a row: a place, perhaps an intensity, perhaps a colour
LONGEST = 12  #: digits that a count may have and still be one


def read(data: bytes, name: str) -> Parsed:
    """Return the points of all scans in the world's coordinates, with intensity and colour.

    A row of a place 0 0 0 is a pulse that did not come back; it becomes NaN, as other rows without a place.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where a header is damaged or a scan has fewer rows than it promises.
    """
    lines = data.decode("latin-1").split("\n")
    scans: list[Table] = []
    at = 0
    while at < len(lines) and (not scans or any(line.strip() for line in lines[at : at + HEAD])):
        count, way = _header(lines[at : at + HEAD], at, name)
        at += HEAD
        scans.append(_scan(lines[at : at + count], count, at, way, name))
        at += count
    if len({scan.shape[1] for scan in scans}) > 1:
        raise TiskelError(f"{name}: its scans have rows of different lengths; export them one by one")
    rows = np.concatenate(scans)
    return Parsed(np.ascontiguousarray(rows[:, :3]), properties=_properties(rows))


def _header(lines: list[str], at: int, name: str) -> tuple[int, Table]:
    """Return the number of points of a scan, and the matrix (4, 4) that a row of a place is multiplied by."""
    words = [line.split() for line in lines]
    counts = [word[0] for word in words[:2] if len(word) == 1 and word[0].isascii() and word[0].isdigit()]
    try:
        if len(counts) < 2 or max(map(len, counts)) > LONGEST or [len(word) for word in words[2:]] != [3] * 4 + [4] * 4:
            raise ValueError
        return int(counts[0]) * int(counts[1]), np.array(words[6:], np.float64)
    except ValueError:
        raise TiskelError(
            f"{name}: the ten lines from line {at + 1} on are no header of a scan; export it again"
        ) from None


def _scan(lines: list[str], count: int, at: int, way: Table, name: str) -> Table:
    """Return the rows of a scan, moved."""
    if len(lines) < count or count == 0:
        raise TiskelError(f"{name}: the header promises {count} points, {len(lines)} rows follow; export it again")
    try:
        rows = np.loadtxt(lines, comments=None, ndmin=2)
    except ValueError as error:
        raise TiskelError(f"{name}: {short(str(error))}, after line {at}; every row needs the same numbers") from None
    if len(rows) != count or rows.shape[1] not in WIDTHS:
        raise TiskelError(f"{name}: {len(rows)} rows of {rows.shape[1]} numbers after line {at}, {count} are promised")
    missed = (rows[:, :3] == 0).all(axis=1)
    rows[:, :3] = rows[:, :3] @ way[:3, :3] + way[3, :3]
    rows[missed, :3] = np.nan
    return np.asarray(rows)


def _properties(rows: Table) -> dict[str, Table]:
    more = rows[:, 3:].T
    return dict(
        zip(("intensity", "red", "green", "blue") if len(more) != 3 else ("red", "green", "blue"), more, strict=False)
    )


def _sniff(data: bytes) -> bool:
    lengths = [len(line.split()) for line in data[:4096].splitlines()[:HEAD]]
    return lengths == [1, 1, 3, 3, 3, 3, 4, 4, 4, 4]


PTX = Format("PTX", (".ptx",), read, None, _sniff)
