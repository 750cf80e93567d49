"""Scans in LAS and LAZ, by laspy and lazrs (extra ``las``), once the header agrees with the size of the file."""

import importlib.util
import io
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed, short
from tiskel.io.formats.isolated import read_apart
from tiskel.io.limits import check_unpacked

MARK = b"LASF"
SHORTEST, LONG = 227, 375  #: bytes of a header up to version 1.3, and of one of version 1.4
VLR, EVLR = 54, 60  #: least bytes of a record of variable length in front of the points, and behind them
LASZIP = b"laszip encoded"  #: user of the record that says how LAZ is packed
CHUNK, ANY_CHUNK = 12, 0xFFFFFFFF  #: where it says how many points a chunk holds, and that each chunk says it itself
AT_THE_END = (1 << 64) - 1  #: in place of where the table of chunks is: its place is in the last eight bytes
PACKED = 0x80  #: bit of the point format that says LAZ
KEPT = ("intensity", "classification", "return_number", "number_of_returns", "red", "green", "blue")


def read(data: bytes, name: str) -> Parsed:
    """Return the points, exact to the last digit of the file's scale, and what is known of each.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where the header promises what the file does not hold, where it is damaged, and without laspy.
    """
    _check(data, name)
    if importlib.util.find_spec("laspy") is None:
        raise TiskelError(f"{name}: LAS and LAZ need laspy; pip install 'tiskel[las]', or convert it to PLY")
    if data[104] & PACKED:
        arrays = dict(read_apart(arrays_of, data, name, "LAZ"))
    else:
        try:
            arrays = arrays_of(data)
        except Exception as error:  # laspy and struct each raise their own
            reason = short(str(error)) or type(error).__name__
            raise TiskelError(f"{name} is not a valid LAS file: {reason}; export it again") from None
    return Parsed(arrays.pop("points"), properties=arrays)


def arrays_of(data: bytes) -> dict[str, npt.NDArray[Any]]:
    """Return the points, and the other columns by name; raises what laspy and lazrs raise."""
    import laspy

    if data[104] & PACKED:
        _check_chunks(data)
    found = laspy.read(io.BytesIO(data))
    points = np.stack([np.asarray(found[axis], np.float64) for axis in "xyz"], axis=1)
    there = set(found.point_format.dimension_names)
    names = [key for key in (*KEPT, *found.point_format.extra_dimension_names) if key in there and key != "points"]
    columns = {key: np.array(found[key]) for key in dict.fromkeys(names)}
    return {"points": points} | {key: value for key, value in columns.items() if value.shape == (len(points),)}


def _check_chunks(data: bytes) -> None:
    """Raise ValueError where chunks of LAZ, for whose bytes the reader makes room at once, are larger than the file."""
    import lazrs

    record = _laszip(data)
    if record < 0:
        return
    source = io.BytesIO(data)
    source.seek(_number(data, 96, 4))
    said = lazrs.LazVlr(data[record + VLR : record + VLR + _number(data, record + 20, 2)])
    size = sum(size for _, size in lazrs.read_chunk_table(source, said))
    if size > len(data):
        raise ValueError(f"its table promises chunks of {size} bytes, the file has {len(data)}")


def _check(data: bytes, name: str) -> None:
    """Raise where counts and sizes of the header do not fit the file."""
    if not data.startswith(MARK) or len(data) < SHORTEST:
        raise TiskelError(f"{name} is no LAS file: it does not begin with a whole header; is its suffix right?")
    newest = data[25] >= 4 and len(data) >= LONG
    start, records = _number(data, 96, 4), _number(data, 100, 4)
    count, size = _number(data, 107, 4), _number(data, 105, 2)
    behind, more = (_number(data, 235, 8), _number(data, 243, 4)) if newest else (0, 0)
    count = (_number(data, 247, 8) or count) if newest else count
    if start > len(data) or records * VLR > len(data) or (more and behind + more * EVLR > len(data)):
        raise TiskelError(f"{name}: the header points beyond the end of the file; export it again")
    if count == 0:
        raise TiskelError(f"{name} holds no points; check how it was made")
    if data[104] & PACKED:
        check_unpacked(count * size, len(data), name)
        check_unpacked(_chunk(data) * size, len(data), name, "has chunks of")
        if (chunks := _chunks(data, start)) > count:
            raise TiskelError(f"{name}: its table promises {chunks} chunks for {count} points; export it again")
    elif start + count * size > len(data):
        raise TiskelError(
            f"{name}: the header promises {count} points of {size} bytes, {len(data) - start} follow; copy it again"
        )


def _laszip(data: bytes) -> int:
    """Return where the record in front of the points begins that says how LAZ is packed, below 0 without one."""
    return data.find(LASZIP, 0, _number(data, 96, 4)) - 2


def _chunk(data: bytes) -> int:
    """Return how many points the chunks of LAZ hold, for each of which its reader makes room; 0 where that varies."""
    record = _laszip(data)
    points = _number(data, record + VLR + CHUNK, 4) if record >= 0 else 0
    return 0 if points == ANY_CHUNK else points


def _chunks(data: bytes, start: int) -> int:
    """Return how many chunks the table of LAZ has, for each of which its reader makes room; 0 where it is not found."""
    table = _number(data, start, 8)
    if table == AT_THE_END:
        table = _number(data, len(data) - 8, 8)
    return _number(data, table + 4, 4) if table + 8 <= len(data) else 0


def _number(data: bytes, at: int, size: int) -> int:
    return int.from_bytes(data[at : at + size], "little")


def _sniff(data: Any) -> bool:
    return bool(data.startswith(MARK))


LAS = Format("LAS", (".las", ".laz"), read, None, _sniff)
