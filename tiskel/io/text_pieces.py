"""Tables of numbers in text, a piece of their lines at a time."""

from collections.abc import Callable, Iterator
from typing import IO

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io.formats.base import Parsed

BYTES = 1 << 23  # of a piece, about: a quarter of a million rows
SHOWN = 64  # rows of the file that stand before every piece: they tell separator, decimal sign and columns
COMMENTS = (b"#", b"//")
LONGEST_COUNT = 18  # digits of a row that counts the others


def text_pieces(
    opened: Callable[[], IO[bytes]], read: Callable[[bytes, str], Parsed], name: str, size: int = BYTES
) -> Iterator[Points]:
    """Yield the points of a table, one piece after the other.

    Parameters
    ----------
    opened : callable
        Returns the open file.
    read : callable
        What reads a whole file of this kind, from its bytes and its name.
    name : str
        The file's name, for messages.
    size : int
        Bytes of a piece.

    Raises
    ------
    TiskelError
        Where a piece cannot be read as the first rows are, or a first row that counts the others is wrong.
    """
    with opened() as file:
        head, promised, line = _head(file)
        shown = len(read(head, name).points) if head.strip() else 0
        if not shown:
            raise TiskelError(f"{name} holds no points; check how it was made")
        before, total, lines = head.count(b"\n"), 0, line
        first = True
        while piece := _whole_lines(file, size):
            if any(map(_is_row, piece.splitlines())):
                points = _read(read, head + piece, name, lines - before)
                total += len(points) - (0 if first else shown)
                yield points if first else points[shown:]
                first = False
            lines += piece.count(b"\n")
        if first:
            total = shown
            yield read(head, name).points
    if promised is not None and promised != total:
        raise TiskelError(
            f"{name}: the first line promises {promised} points, {total} follow; export it again, one cloud per file"
        )


def _head(file: IO[bytes]) -> tuple[bytes, int | None, int]:
    """Return the first lines without a row that counts the others, that number, and how many lines were read."""
    head: list[bytes] = []
    promised, rows, lines = None, 0, 0
    while rows < SHOWN and (line := file.readline()):
        lines += 1
        bare = line.strip().removeprefix(b"\xef\xbb\xbf")
        if _is_row(bare):
            rows += 1
            if rows == 1 and promised is None and bare.isdigit() and len(bare) <= LONGEST_COUNT:
                promised, rows = int(bare), 0
                continue
        head.append(line if line.endswith(b"\n") else line + b"\n")
    return b"".join(head), promised, lines


def _is_row(line: bytes) -> bool:
    bare = line.strip()
    return bool(bare) and not bare.startswith(COMMENTS)


def _whole_lines(file: IO[bytes], size: int) -> bytes:
    piece = file.read(size)
    return piece if piece.endswith(b"\n") else piece + file.readline()


def _read(read: Callable[[bytes, str], Parsed], data: bytes, name: str, shift: int) -> Points:
    try:
        return read(data, name).points
    except TiskelError as error:
        if shift <= 0:
            raise
        raise TiskelError(f"{error} (add {shift} to the number of the line: it is counted in a piece)") from None
