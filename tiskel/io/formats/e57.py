"""Scans in E57, the exchange format of laser scanners, by a reader in Rust (extra ``e57``)."""

import tempfile
from pathlib import Path

import numpy as np

from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed, short

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
    try:
        import e57
    except ImportError:
        raise TiskelError(
            f"{name}: E57 needs a reader; pip install 'tiskel[e57]', or convert it to LAS or PLY"
        ) from None
    try:
        with tempfile.NamedTemporaryFile(prefix="tiskel-", suffix=".e57") as file:
            file.write(data)
            file.flush()
            path = Path(f"/proc/self/fd/{file.fileno()}")
            if path.exists():  # without a name there is nothing that a killed run leaves behind
                Path(file.name).unlink()
            found = e57.read_points(str(path if path.exists() else file.name))
        points = np.array(found.points, np.float64).reshape(-1, 3)
        intensity, colour = np.asarray(found.intensity), np.asarray(found.color)
    except Exception as error:
        raise _damaged(name, error) from None
    except BaseException as error:  # Rust's panics are no Exception
        if type(error).__name__ != "PanicException":
            raise
        raise _damaged(name, error) from None
    properties = {"intensity": intensity.ravel()} if intensity.size == len(points) else {}
    if colour.shape == points.shape:
        properties |= dict(zip(("red", "green", "blue"), colour.T.copy(), strict=True))
    return Parsed(points, properties=properties)


def _damaged(name: str, error: BaseException) -> TiskelError:
    reason = short(str(error)) or type(error).__name__
    return TiskelError(f"{name} is not a valid E57 file: {reason}; export it again")


E57 = Format("E57", (".e57",), read, None, lambda data: data.startswith(MARK))
