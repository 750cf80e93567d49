"""PLY, through plyfile, with the checks that hostile headers need."""

import io
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import numpy.typing as npt
from plyfile import PlyData, PlyElement, PlyParseError

from tiskel.arrays import Numbers, Points
from tiskel.errors import TiskelError
from tiskel.io.ply_tables import HEADER_END, packed, read_tables, surplus
from tiskel.io.streams import Bytes
from tiskel.version import version

Columns = Mapping[str, npt.NDArray[Any]]
MAGIC = b"ply"
SCALAR, QUALITY = "scalar_", "quality"  #: names of columns that CloudCompare and MeshLab show as colours
HEADER_REST = 12  #: bytes of the last line of a header, with any line ending
FORMAT = 2  #: of the stage files; 1 is still read
SMALLEST_ROW = 1  # byte; no element of a binary file can hold more rows than the file has bytes


def parse(data: Bytes, name: str) -> PlyData:
    """Return the elements of a PLY file.

    Parameters
    ----------
    data : bytes or map
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where it is cut short, too long or no PLY.
    """
    stream = io.BytesIO(data if isinstance(data, bytes) else data[: max(data.find(HEADER_END), 0) + HEADER_REST])
    try:
        ply = PlyData._parse_header(stream)
        for element in ply.elements:
            if element.count * SMALLEST_ROW > len(data):
                raise TiskelError(
                    f"{name}: the header promises {element.count} rows of {element.name}, the file is smaller"
                )
        end = -1 if ply.text else read_tables(ply, data, stream.tell())
        if end < 0:
            stream = io.BytesIO(data)
            with np.errstate(over="ignore"):  # beyond float32 is not finite, as other rows may be
                ply = PlyData.read(stream)
        rest = b"" if ply.text else data[end if end >= 0 else stream.tell() :]
    except PlyParseError as error:
        raise TiskelError(f"{name} is not a valid PLY file: {error}; export it again") from None
    except (ValueError, MemoryError, UnicodeDecodeError, OverflowError, TypeError, KeyError, EOFError) as error:
        raise TiskelError(f"{name} is not a valid PLY file: {error}; export it again") from None
    more = surplus(ply, data, rest)
    if more:
        raise TiskelError(f"{name}: {more} follow the last row that the header promises; export it again")
    return ply


def element(name: str, columns: Columns, lists: Mapping[str, tuple[str, str]] | None = None) -> PlyElement:
    """Return an element of a PLY file.

    Parameters
    ----------
    name : str
        Its name.
    columns : mapping of str to (n,) array
        Its properties by name.
    lists : mapping of str to (str, str), optional
        Types of length and values, of those columns that hold lists.
    """
    lists = lists or {}
    count = len(next(iter(columns.values())))
    kinds = [(key, object if key in lists else np.asarray(column).dtype) for key, column in columns.items()]
    table = np.empty(count, dtype=kinds)
    for key, column in columns.items():
        table[key] = column
    lengths = {key: kind[0] for key, kind in lists.items()}
    values = {key: kind[1] for key, kind in lists.items()}
    return PlyElement.describe(table, name, len_types=lengths, val_types=values)


def ragged(rows: Sequence[npt.NDArray[np.int32]]) -> npt.NDArray[Any]:
    """Return int32 lists of different lengths as one column of objects."""
    column = np.empty(len(rows), dtype=object)
    for i, row in enumerate(rows):
        column[i] = np.asarray(row, np.int32)
    return column


def dump(elements: Sequence[PlyElement], stage: str, facts: Mapping[str, Any]) -> bytes:
    """Return a binary little-endian file.

    Parameters
    ----------
    elements : sequence of PlyElement
        What the file holds.
    stage : str
        The name of the stage, for the first comment.
    facts : mapping
        Further comments, each a name and JSON.
    """
    comments = [f"tiskel {version()} {stage}"]
    everything = {"format": FORMAT, **facts}
    comments += [f"{key} {json.dumps(value, allow_nan=False)}" for key, value in everything.items()]
    file = PlyData(elements, text=False, byte_order="<", comments=comments)
    rows = [row for element in elements if (row := packed(element, "<")) is not None]
    if len(rows) < len(elements):
        out = io.BytesIO()
        file.write(out)
        return out.getvalue()
    return b"".join([file.header.encode("ascii"), b"\n", *rows])


def facts(ply: PlyData, stage: str, name: str) -> dict[str, Any]:
    """Return the facts in the comments of a stage file.

    Parameters
    ----------
    ply : PlyData
        The file.
    stage : str
        The stage that is needed.
    name : str
        The file's name, for messages.

    Raises
    ------
    TiskelError
        Where the file is none of this stage, or of a newer format.
    """
    head = next((c.split() for c in ply.comments if c.startswith("tiskel ")), None)
    if head is None or len(head) != 3 or head[2] != stage:
        found = f"a {head[2]} file" if head and len(head) == 3 else "no tiskel stage file"
        raise TiskelError(f"{name} is {found}, a {stage} file is needed here; make one with: tiskel {VERB[stage]}")
    found_facts = {}
    for comment in ply.comments:
        key, _, value = comment.partition(" ")
        if key != "tiskel":
            try:
                found_facts[key] = json.loads(value)
            except (ValueError, RecursionError):
                continue
    number = found_facts.get("format", 1)
    if not isinstance(number, int) or number > FORMAT:
        raise TiskelError(f"{name} has format {number} of a newer tiskel, this one reads up to {FORMAT}; update tiskel")
    return found_facts


def source_of(data: bytes, stage: str, name: str) -> dict[str, str]:
    """Return name and SHA-256 of the cloud that the bytes of a stage file were made from; see :func:`facts`."""
    return dict(facts(parse(data, name), stage, name).get("source", {}))


VERB = {"contraction": "contract", "skeleton": "skeleton"}


@np.errstate(invalid="ignore")  # a signalling NaN is one like others
def points_of(table: npt.NDArray[Any], names: Sequence[str] = ("x", "y", "z")) -> Points:
    """Return three named columns of a table of n rows as (n, 3) float64."""
    fields: Mapping[str, Any] = table.dtype.fields or {}
    kinds = [(fields[name][0], fields[name][1]) for name in names]
    side_by_side = [(np.dtype("<f8"), kinds[0][1] + 8 * i) for i in range(3)]
    plain = table.ndim == 1 and table.flags.c_contiguous and not table.dtype.hasobject
    if kinds == side_by_side and plain and len(table):  # one pass, not three
        start = table.view(np.uint8).reshape(len(table), -1)[:, kinds[0][1] : kinds[0][1] + 24]
        return np.ascontiguousarray(start).view(np.float64)
    return np.stack([np.asarray(table[name], np.float64) for name in names], axis=1).reshape(-1, 3)


def scalars(columns: Columns, quality: str = "") -> dict[str, npt.NDArray[np.float32]]:
    """Return columns by the names that others know: ``scalar_NAME`` for CloudCompare, ``quality`` for MeshLab.

    Parameters
    ----------
    columns : mapping of str to (n,) array
        By their own names.
    quality : str, optional
        Which of them is the quality, if it is there.
    """
    known = {f"{SCALAR}{name}": np.asarray(column, np.float32) for name, column in columns.items()}
    return known | ({QUALITY: np.asarray(columns[quality], np.float32)} if quality in columns else {})


def own(names: Iterable[str]) -> list[str]:
    """Return the names of columns without those that :func:`scalars` adds."""
    return [name for name in names if name != QUALITY and not name.startswith(SCALAR)]


def xyz(points: Points, names: Sequence[str] = ("x", "y", "z")) -> dict[str, Numbers]:
    """Return points (n, 3) as three columns by name."""
    return {name: points[:, axis] for axis, name in enumerate(names)}


def plain(params: Any) -> dict[str, Any]:
    """Return a params dataclass as a JSON object."""
    return asdict(params)
