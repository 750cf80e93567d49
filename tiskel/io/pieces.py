"""Clouds piece by piece: never the whole file in memory, where its format allows that.

Binary PLY, NPY and text are read by rows, packed by gzip too; other files are
read whole, and a note says so. A piece of text is read by the same reader as a
whole file, behind the first lines of the file, so that both have one reading of it.
"""

import gzip
import hashlib
import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from plyfile import PlyData, PlyListProperty

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io import ply
from tiskel.io.clouds import load_cloud
from tiskel.io.formats import format_of, text
from tiskel.io.limits import GZIP
from tiskel.io.ply_tables import HEADER_END
from tiskel.io.streams import STANDARD
from tiskel.io.text_pieces import text_pieces

ROWS = 1 << 18  #: of a piece
BLOCK = 1 << 22  # bytes that are hashed at once
HEADER = 1 << 20  # bytes that a header may take
TEXTS = (text.XYZ, text.PTS, text.CSV)
NUMPY = b"\x93NUMPY"


@dataclass(frozen=True)
class Pieces:
    """A cloud that is read as often as it is needed.

    Attributes
    ----------
    name : str
        The file's name without folders.
    read : callable
        Without arguments; returns an iterator over points (m, 3) float64, one piece after the other, as the file
        has them: rows may be NaN or Inf.
    notes : tuple of str
        What to know of how it is read.
    """

    name: str
    read: Callable[[], Iterator[Points]]
    notes: tuple[str, ...] = ()


def pieces_of(source: str | Path) -> Pieces:
    """Return a cloud piece by piece.

    Parameters
    ----------
    source : str or Path
        A file of any format that :func:`tiskel.load_cloud` reads.

    Returns
    -------
    Pieces

    Raises
    ------
    TiskelError
        Where the file is missing, damaged, or standard input, which cannot be read twice.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from tiskel.io.pieces import pieces_of
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "c.xyz").write_text("0 0 0.5\\n1 0 0.5\\n")
    ...     [len(piece) for piece in pieces_of(f"{folder}/c.xyz").read()]
    [2]
    """
    path = Path(source)
    if str(source) == STANDARD:
        raise TiskelError("a cloud that is split is read more than once, standard input is not; name a file")
    first = _first_bytes(path)
    packed = first.startswith(GZIP)
    start = _first_bytes(path, packed) if packed else first
    name = path.name.removesuffix(".gz").removesuffix(".GZ") if packed else path.name
    kind = format_of(name, start)
    table = _ply_rows(start) or _numpy_rows(start)
    if table is not None:
        return Pieces(path.name, lambda: _by_rows(path, packed, *table))
    if kind in TEXTS and not start.startswith((b"\xff\xfe", b"\xfe\xff")):  # UTF-16 has no byte for the end of a line
        return Pieces(path.name, lambda: text_pieces(lambda: _opened(path, packed), kind.read, path.name))
    cloud = load_cloud(path)
    note = f"{path.name} is read whole: only binary PLY, NPY and text are read piece by piece"
    return Pieces(path.name, lambda: iter([cloud.points]), (*cloud.notes, *cloud.warnings, note))


def hash_of(path: Path) -> str:
    """Return the SHA-256 of a file, read block by block."""
    digest = hashlib.sha256()
    with _opened(path, False) as file:
        while block := file.read(BLOCK):
            digest.update(block)
    return digest.hexdigest()


def _opened(path: Path, packed: bool) -> IO[bytes]:
    try:
        if path.is_dir():
            raise TiskelError(f"{path} is a directory; name a file in it")
        return gzip.open(path) if packed else path.open("rb")  # type: ignore[return-value]
    except FileNotFoundError:
        raise TiskelError(f"no file {path}; check the path") from None
    except (OSError, ValueError) as error:  # a null character
        raise TiskelError(
            f"cannot read {path}: {getattr(error, 'strerror', None) or error}; check the path and its permissions"
        ) from None


def _first_bytes(path: Path, packed: bool = False) -> bytes:
    with _opened(path, packed) as file:
        try:
            start = file.read(HEADER)
        except (OSError, EOFError) as error:
            raise TiskelError(f"{path.name} is no whole gzip file: {error}; pack it again") from None
    if not start:
        raise TiskelError(f"{path.name} is empty; check how it was made")
    return start


def _ply_rows(start: bytes) -> tuple[np.dtype[Any], int, int] | None:
    """Return type, number and beginning of the rows with x, y and z; None where it is no binary cloud."""
    if not start.startswith(ply.MAGIC) or HEADER_END not in start:
        return None
    stream = io.BytesIO(start)
    try:
        file = PlyData._parse_header(stream)
    except Exception:
        return None  # read whole, which says what is wrong
    faces = sum(element.count for element in file.elements if element.name == "face")
    stage = any(comment.startswith("tiskel ") for comment in file.comments)
    holder = "cloud" if stage and "cloud" in file else "vertex"
    begin = stream.tell()
    for element in () if file.text or faces else file.elements:
        if any(isinstance(kind, PlyListProperty) for kind in element.properties):
            return None
        dtype = element.dtype(file.byte_order)
        if element.name == holder:
            return (dtype, element.count, begin) if _axes(dtype) else None
        begin += element.count * dtype.itemsize
    return None


def _numpy_rows(start: bytes) -> tuple[np.dtype[Any], int, int] | None:
    """Return type, number and beginning of the rows of an array (n, 3) or of records; None for others."""
    if not start.startswith(NUMPY):
        return None
    stream = io.BytesIO(start)
    try:
        version = np.lib.format.read_magic(stream)
        read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, fortran, dtype = read(stream)
    except Exception:  # of the tokenizer, too
        return None  # read whole, which says what is wrong
    if fortran or dtype.hasobject or len(shape) != (1 if dtype.names else 2):
        return None
    if dtype.names is None:
        if dtype.kind not in "fiu" or not 3 <= shape[1] <= shape[0]:
            return None
        names = [*"xyz", *(f"c{i}" for i in range(3, shape[1]))]
        dtype = np.dtype([(column, dtype) for column in names])
    return (dtype, shape[0], stream.tell()) if _axes(dtype) else None


def _axes(dtype: np.dtype[Any]) -> list[str]:
    """Return the names of x, y and z; none where one is missing or no number."""
    names = {key.lower(): key for key in reversed(dtype.names or ()) if dtype[key].kind in "fiu"}
    return [names[axis] for axis in "xyz"] if {"x", "y", "z"} <= set(names) else []


def _by_rows(path: Path, packed: bool, dtype: np.dtype[Any], count: int, begin: int) -> Iterator[Points]:
    """Yield the rows of a file that begin at a byte."""
    axes = _axes(dtype)
    with _opened(path, packed) as file:
        file.seek(begin)
        for done in range(0, count, ROWS):
            wanted = min(ROWS, count - done)
            data = file.read(wanted * dtype.itemsize)
            if len(data) < wanted * dtype.itemsize:
                raise TiskelError(f"{path.name}: the header promises {count} rows, the file is shorter; copy it again")
            yield ply.points_of(np.frombuffer(data, dtype), axes)
