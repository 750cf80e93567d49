"""Clouds as numbers in text: XYZ, PTS, CSV and their kin. What cannot be told for certain is refused, not guessed."""

import re
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed, short
from tiskel.io.formats.table_dialect import cells, is_number, is_value, separator_of, unquoted, with_points
from tiskel.io.formats.table_header import Columns, chosen, columns_of, named
from tiskel.io.formats.table_lines import Table, table_of

COUNTED_ROWS = 4  #: rows that a column must count before it is taken for their numbers, not for coordinates


def read(data: bytes, name: str, asked: Sequence[str] | None = None) -> Parsed:
    """Return the columns headed x, y, z, or the first three where there is no header, and the other named columns.

    Columns are separated by semicolons, tabs, commas or white space; the
    decimal sign is a point, or a comma where something else separates. A first
    row of one whole number counts the rows, as PTS has it, and must be right.
    A header may stand in the first row or in a comment (#, //) before it. An
    empty cell, NA and null are not a number.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.
    asked : sequence of three str, optional
        The columns of x, y and z, by name or counted from 1; otherwise the header says.

    Raises
    ------
    TiskelError
        Where numbers could be read in two ways: whole numbers in pairs between commas, more than three columns of other
        names, a first column without a name that counts the rows; and where a row has other columns than the first.
    """
    table, separator = _separated(table_of(data, name))
    names, table = _header(table, separator)
    width = _width(table, separator)
    columns = chosen(asked, names, width, name) if asked else _columns(names, table, separator, width)
    headed = columns != Columns()
    table = replace(table, rows=with_points(table.rows, separator, headed, name))
    numbers, columns = _numbers(table, separator, columns)
    if not headed and not asked and width > 3 and _counts(numbers[:, 0]):
        raise TiskelError(
            f"{name}: its first column counts the rows, so the coordinates may be columns 2 to 4; "
            "put a line that names the columns in front, such as: index x y z"
        )
    others = {key: numbers[:, 3 + i] for i, key in enumerate(columns.others)}
    return Parsed(np.ascontiguousarray(numbers[:, :3]), properties=others, warnings=columns.warnings)


def _separated(table: Table) -> tuple[Table, str | None]:
    """Return the rows without quotes and without a separator at their ends, and the separator (None: white space)."""
    rows = unquoted(table.rows, table.name) if '"' in table.rows[-1] else table.rows
    separator = separator_of(rows)
    if separator and all(row.endswith(separator) for row in rows):
        rows = [row[:-1] for row in rows]
    if separator == "\t" and all(row.startswith("\t") for row in rows):
        rows = [row[1:] for row in rows]
    return replace(table, rows=rows), separator


def _header(table: Table, separator: str | None) -> tuple[list[str] | None, Table]:
    """Return the names in the first row (None where it holds numbers) and the rows that follow."""
    first = cells(table.rows[0], separator) or [""]
    if first[0] and all(map(is_value, first[:3])) and any(map(is_number, first)):
        return None, table
    if first[0] and any(map(is_number, first)):
        raise table.error(0, "words and numbers", "put the coordinates first, or name the columns in a line in front")
    rest = table.without_first()
    others = re.split(r"[\s,;]+", table.rows[0])  # a header may be separated in another way than the rows
    if len(first) != len(others) == len(cells(rest.rows[0], separator)):
        first = others
    return [name.strip("\"',;") for name in first], rest


def _width(table: Table, separator: str | None) -> int:
    """Return the number of columns; raise where a row has another."""
    rows = table.rows
    widths = [row.count(separator) + 1 for row in rows] if separator else [*map(len, map(str.split, rows))]
    if len(set(widths)) > 1:
        wrong = next(i for i, width in enumerate(widths) if width != widths[0])
        found = f"{widths[wrong]} columns, the rows before it have {widths[0]}"
        raise table.error(wrong, found, "every row needs the same columns, three numbers or more")
    return widths[0]


def _columns(names: list[str] | None, table: Table, separator: str | None, width: int) -> Columns:
    """Return which columns are read: by the header, by a comment that is one, or the first three."""
    if names is None:
        return _commented(table, separator, width)
    if len(names) == width - 1 and named(names) and _counts(_column(table, separator)):
        names = ["", *names]  # as R writes the numbers of rows
    if separator == "," and width == 2 * len(names):
        raise TiskelError(f"{table.name}: its commas both separate and are decimal signs; export it again with points")
    if len(names) != width:
        raise TiskelError(
            f"{table.name}: the header names {len(names)} columns ({short(', '.join(names))}), the rows have {width}; "
            "name every column, or put # before a line that is a title"
        )
    return columns_of(names, table.name)


def _commented(table: Table, separator: str | None, width: int) -> Columns:
    """Return the columns that a comment before the rows names, as CloudCompare writes it; the first three otherwise."""
    for comment in reversed(table.comments):
        bare = comment.lstrip("#/ \t")
        for names in (cells(bare, separator), re.split(r"[\s,;]+", bare)):
            if len(names) == width and named(names):
                return columns_of(names, table.name)
    return Columns()


def _numbers(table: Table, separator: str | None, columns: Columns) -> tuple[Points, Columns]:
    """Return x, y, z and the other columns that are numbers."""
    load = partial(np.loadtxt, table.rows, delimiter=separator, comments=None, ndmin=2)
    first = cells(table.rows[0], separator)
    others = {key: i for key, i in columns.others.items() if i < len(first) and is_number(first[i])}
    if others:
        try:
            return load(usecols=(*columns.axes, *others.values())), replace(columns, others=others)
        except ValueError:  # words further down
            others = {}
    try:
        return load(usecols=columns.axes), replace(columns, others=others)
    except (ValueError, IndexError):
        raise _wrong(table, separator, columns) from None


def _wrong(table: Table, separator: str | None, columns: Columns) -> TiskelError:
    """Return what to say of the first row without three numbers."""
    for i, row in enumerate(table.rows):
        words = cells(row, separator)
        if len(words) <= max(columns.axes):
            return table.error(i, f"{len(words)} columns", "every row needs three numbers")
        wrong = next((words[axis] for axis in columns.axes if not _is_float(words[axis])), None)
        if wrong is not None:
            return table.error(i, f"{short(wrong)!r} for a number", "every row needs three numbers")
    return TiskelError(f"{table.name}: a row is no numbers; every row needs three numbers")


def _is_float(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _column(table: Table, separator: str | None) -> Numbers:
    """Return the first column; nothing where it holds words."""
    try:
        return np.loadtxt(table.rows, delimiter=separator, comments=None, ndmin=1, usecols=0)
    except ValueError:
        return np.empty(0)


def _counts(column: Numbers) -> bool:
    """Return whether the numbers are those of the rows, from 0 or from 1."""
    return len(column) >= COUNTED_ROWS and column[0] in (0, 1) and bool((np.diff(column) == 1).all())


def write(points: Points, separator: str = " ") -> bytes:
    """Return points (n, 3), one per line, with as many digits as it takes to read the same numbers back.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud.
    separator : str
        What stands between the coordinates.
    """
    return "".join(separator.join(map(repr, row)) + "\n" for row in points.tolist()).encode()


def _write_pts(points: Points) -> bytes:
    return f"{len(points)}\n".encode() + write(points)


def _write_csv(points: Points) -> bytes:
    return b"x,y,z\n" + write(points, ",")


XYZ = Format("XYZ", (".xyz", ".txt", ".asc", ".xyzn", ".xyzrgb"), read, write)
PTS = Format("PTS", (".pts",), read, _write_pts)


def _write_tsv(points: Points) -> bytes:
    return b"x\ty\tz\n" + write(points, "\t")


CSV = Format("CSV", (".csv",), read, _write_csv)
TSV = Format("TSV", (".tsv",), read, _write_tsv)
