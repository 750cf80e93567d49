"""Scans in E57, the exchange format of laser scanners, by a reader in Rust (extra ``e57``)."""

import importlib.util
import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed
from tiskel.io.formats.isolated import read_apart

MARK = b"ASTM-E57"
HEADER, LENGTH = 48, slice(16, 24)  #: bytes of the header, and where in it the length of the file stands


def read(data: bytes, name: str) -> Parsed:
    """Return the points of all scans in the world's coordinates, their intensities and colours.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where the file is cut short or damaged, and without the reader.
    """
    if not data.startswith(MARK) or len(data) < HEADER:
        raise TiskelError(f"{name} is no E57 file: it does not begin with a whole header; is its suffix right?")
    promised = int.from_bytes(data[LENGTH], "little")
    if promised != len(data):
        raise TiskelError(f"{name}: the header promises {promised} bytes, there are {len(data)}; copy it again")
    if importlib.util.find_spec("e57") is None:
        raise TiskelError(f"{name}: E57 needs a reader; pip install 'tiskel[e57]', or convert it to LAS or PLY")
    arrays = dict(read_apart(arrays_of, data, name, "E57"))
    return Parsed(arrays.pop("points"), properties=arrays)


def arrays_of(data: bytes) -> dict[str, npt.NDArray[Any]]:
    """Return the points, intensity and colour; raises what the reader raises, which takes nothing but a path."""
    import e57

    handle, name = tempfile.mkstemp(prefix="tiskel-", suffix=".e57")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            path = Path(f"/proc/self/fd/{handle}")
            if path.exists():  # a file without a name is none that a killed run leaves behind
                Path(name).unlink()
            found = e57.read_points(str(path if path.exists() else name))
    finally:
        Path(name).unlink(missing_ok=True)
    points = np.array(found.points, np.float64).reshape(-1, 3)
    intensity, colour = np.asarray(found.intensity), np.asarray(found.color)
    arrays = {"points": points} | ({"intensity": intensity.ravel()} if intensity.size == len(points) else {})
    if colour.shape == points.shape:
        arrays |= dict(zip(("red", "green", "blue"), colour.T.copy(), strict=True))
    return arrays


E57 = Format("E57", (".e57",), read, None, lambda data: data.startswith(MARK))
