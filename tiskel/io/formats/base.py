"""What a file type must give to the registry, and what reading a file gives."""

import io
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Edges, Points

LONGEST_QUOTE = 160  #: characters of a file that a message repeats
NO_FACES: Edges = np.empty((0, 3), np.int32)
Properties = Mapping[str, npt.NDArray[Any]]


@dataclass(frozen=True, eq=False)
class Parsed:
    """What a file holds.

    Attributes
    ----------
    points : (n, 3) float64
        In the file's units; rows may be NaN or Inf. The corners, where there are faces.
    faces : (m, 3) int32
        The corners of triangles; no row for a cloud.
    properties : mapping of str to (n,) array
        Further columns of the file by name.
    warnings : tuple of str
        What had to be decided while reading.
    """

    points: Points
    faces: Edges = field(default_factory=lambda: NO_FACES)
    properties: Properties = field(default_factory=dict)
    warnings: tuple[str, ...] = ()


def short(text: str) -> str:
    """Return the first line of what a message repeats from a file, cut where it is long."""
    line = (text.splitlines() or [""])[0]
    return line if len(line) <= LONGEST_QUOTE else f"{line[:LONGEST_QUOTE]}..."


def rows_of(data: bytes) -> Iterator[str]:
    """Yield the rows of a text file one by one, without comments from #, blanks at both ends and empty rows.

    All of them at once take more than ten times as much memory as the file.
    """
    for line in io.TextIOWrapper(io.BytesIO(data), "latin-1"):
        if row := line.partition("#")[0].strip():
            yield row


def never(data: bytes) -> bool:
    """Return False: a file type without a mark of its own in its first bytes."""
    return False


@dataclass(frozen=True)
class Format:
    """One type of file.

    Attributes
    ----------
    name : str
        As messages call it.
    suffixes : tuple of str
        In lower case, with the dot.
    read : callable
        From the bytes and the file's name (for messages) to a Parsed; raises TiskelError.
    write : callable or None
        From points (n, 3) to bytes; None where the type is only read.
    sniff : callable
        From the bytes to whether they are of this type; asked where there is no suffix, of standard input.
    """

    name: str
    suffixes: tuple[str, ...]
    read: Callable[[bytes, str], Parsed]
    write: Callable[[Points], bytes] | None = None
    sniff: Callable[[bytes], bool] = never

    def parse(self, data: bytes, name: str) -> Parsed:
        """Return what a file holds; numbers that float64 cannot hold are not finite, which is no warning."""
        with np.errstate(all="ignore"):
            return self.read(data, name)
