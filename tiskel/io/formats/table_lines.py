"""The rows of a text file that hold something, and where they stand in it."""

import codecs
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from tiskel.errors import TiskelError

COMMENTS = ("#", "//")
BLANKS = " \r\f\v"  #: taken off the ends of rows; tabs may separate empty cells there
LONGEST_COUNT = 18  #: digits that a count of rows may have
MARKS = {codecs.BOM_UTF8: "utf-8", codecs.BOM_UTF16_LE: "utf-16-le", codecs.BOM_UTF16_BE: "utf-16-be"}


@dataclass(frozen=True)
class Table:
    """Rows of a text file.

    Attributes
    ----------
    name : str
        The file's name.
    text : str
        All of the file.
    rows : sequence of str
        Rows that are neither blank nor comments, without white space around them; at least one.
    comments : tuple of str
        Lines before the first row.
    skipped : int
        Rows of the file before the first of these.
    """

    name: str
    text: str = field(repr=False)
    rows: Sequence[str] = field(repr=False)
    comments: tuple[str, ...] = ()
    skipped: int = 0

    def without_first(self) -> "Table":
        """Return the table that follows the first row.

        Raises
        ------
        TiskelError
            Where nothing follows.
        """
        if len(self.rows) == 1:
            raise TiskelError(f"{self.name} holds no points; check how it was made")
        return replace(self, rows=self.rows[1:], skipped=self.skipped + 1)

    def error(self, row: int, found: str, needed: str) -> TiskelError:
        """Return an error about a row.

        Parameters
        ----------
        row : int
            The row, counted from 0; the message names its line in the file.
        found : str
            What is in it.
        needed : str
            What to do.
        """
        lines = [i for i, line in enumerate(self.text.splitlines(), 1) if _is_row(line.strip())]
        return TiskelError(f"{self.name}: line {lines[self.skipped + row]} has {found}; {needed}")


def table_of(data: bytes, name: str) -> Table:
    """Return the rows of a text file, after a first row that only counts them.

    Parameters
    ----------
    data : bytes
        Text in UTF-8, or in UTF-16 with its mark.
    name : str
        The file's name, for messages.

    Raises
    ------
    TiskelError
        Where it is not text, holds no row, or the count is wrong.
    """
    text = _decoded(data, name)
    lines = [line.strip(BLANKS) for line in text.splitlines()]
    start = next((i for i, line in enumerate(lines) if _is_row(line)), len(lines))
    rows = [line for line in lines if line.strip() and not line.startswith(COMMENTS)]
    if not rows:
        raise TiskelError(f"{name} holds no points; check how it was made")
    table = Table(name, text, rows, tuple(line for line in lines[:start] if line.strip()))
    if not (rows[0].isascii() and rows[0].isdigit() and len(rows[0]) <= LONGEST_COUNT):
        return table
    promised = int(rows[0])
    if promised != len(rows) - 1:
        raise TiskelError(
            f"{name}: the first line promises {promised} points, {len(rows) - 1} follow; export it again, "
            "one cloud per file"
        )
    return table.without_first()


def _is_row(line: str) -> bool:
    return bool(line.strip()) and not line.startswith(COMMENTS)


def _decoded(data: bytes, name: str) -> str:
    mark = next((mark for mark in MARKS if data.startswith(mark)), b"")
    try:
        text = data[len(mark) :].decode(MARKS.get(mark, "utf-8"))
    except UnicodeDecodeError:
        raise TiskelError(f"{name} is not text; is its suffix right?") from None
    if "\0" in text:
        raise TiskelError(f"{name} is not text in UTF-8, or in UTF-16 with its mark; save it as UTF-8")
    return text
