"""Clouds as NumPy arrays: NPY and NPZ."""

import io
import zipfile
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io.formats.base import Format, Parsed, short
from tiskel.io.limits import check_unpacked

PACKED = b"PK"  #: first bytes of an archive of arrays
USUAL = ("points", "xyz", "pts", "pos", "positions", "coords", "vertices", "cloud", "pc", "pcd", "arr_0")  #: in an NPZ
NUMBERS = "fiu"  #: kinds of dtype that are coordinates: floating, signed and unsigned


def read(data: bytes, name: str) -> Parsed:
    """Return the cloud of an NPY file, or of the array of a usual name or the only array of an NPZ file.

    An array is (n, 3), or (n, 4 and more) with x, y, z first, or of (n,) records
    with fields x, y, z; leading axes of length 1 are dropped.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        For anything else, in particular for (3, n).
    """
    array = _load(data, name)
    while array.ndim > (1 if array.dtype.names else 2) and array.shape[0] == 1:
        array = array[0]
    return _from_records(array, name) if array.dtype.names else Parsed(_from_columns(array, name))


def write(points: Points) -> bytes:
    """Return points (n, 3) as NPY."""
    out = io.BytesIO()
    np.save(out, np.ascontiguousarray(points))
    return out.getvalue()


def _load(data: bytes, name: str) -> npt.NDArray[Any]:
    """Return the one array of the file."""
    try:
        if data.startswith(PACKED):
            _check_packed(data, name)
        loaded = np.load(io.BytesIO(data), allow_pickle=False)
        return np.asarray(_chosen(loaded, name) if isinstance(loaded, np.lib.npyio.NpzFile) else loaded)
    except TiskelError:
        raise
    except Exception as error:  # zipfile, tokenize, zlib, lzma and struct each raise their own
        reason = short(str(error)) or type(error).__name__
        raise TiskelError(f"{name} is not a valid NumPy file of numbers: {reason}; save it again") from None


def _chosen(archive: Any, name: str) -> Any:
    files = list(archive.files)
    usual = [key for key in USUAL if key in files]
    key = usual[0] if usual else files[0] if len(files) == 1 else None
    if key is None:
        raise TiskelError(f"{name} holds {short(', '.join(files)) or 'nothing'}; name the cloud 'points'")
    return archive[key]


def _check_packed(data: bytes, name: str) -> None:
    """Raise where arrays unpack to far more than the file, which is how archives fill memories."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        for entry in archive.infolist():
            check_unpacked(entry.file_size, len(data), name)


def _from_columns(array: npt.NDArray[Any], name: str) -> Points:
    if array.dtype.kind not in NUMBERS:
        raise TiskelError(f"{name} holds {short(str(array.dtype))}, not real numbers; save its coordinates as float64")
    if array.ndim != 2 or array.shape[1] < 3:
        hint = "; save one cloud per file, an organised one as array.reshape(-1, 3)" if array.ndim == 3 else ""
        raise TiskelError(f"{name} must hold an array of shape (n, 3), got {array.shape}{hint}")
    if array.shape[1] > 3 and array.shape[0] < array.shape[1]:
        raise TiskelError(f"{name} must hold an array of shape (n, 3), got {array.shape}; transpose it")
    return np.ascontiguousarray(array[:, :3], dtype=np.float64)


def _from_records(array: npt.NDArray[Any], name: str) -> Parsed:
    """Return the fields x, y and z, in upper or lower case, and the other fields of single numbers."""
    fields = array.dtype.names or ()
    numbers = [key for key in fields if array.dtype[key].kind in NUMBERS]
    names = {key.lower(): key for key in reversed(numbers)}
    if array.ndim != 1 or not {"x", "y", "z"} <= set(names):
        raise TiskelError(
            f"{name} holds records of {short(', '.join(fields))} and shape {array.shape}; it needs x, y and z"
        )
    points = np.stack([array[names[axis]].astype(np.float64) for axis in "xyz"], axis=1)
    others = {key: array[key] for key in numbers if key not in {names[axis] for axis in "xyz"}}
    return Parsed(points, properties=others)


NPY = Format("NPY", (".npy",), read, write, lambda data: data.startswith(b"\x93NUMPY"))
NPZ = Format("NPZ", (".npz",), read, None, lambda data: data.startswith(PACKED))
