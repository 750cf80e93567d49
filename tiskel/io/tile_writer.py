"""Clouds that are written a few rows at a time, many at once: the files of tiles and of objects."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Indices, Mask, Points
from tiskel.errors import TiskelError
from tiskel.io.pieces import hash_of
from tiskel.version import version

ROW = np.dtype([("x", "<f8"), ("y", "<f8"), ("z", "<f8"), ("row", "<u4"), ("core", "u1")])
KINDS = {"<f8": "double", "<u4": "uint", "|u1": "uchar"}
WAITING = 1 << 27  # bytes of rows that wait in memory before all files get theirs
DIGITS = 20  # that a number of rows has at most; a comment fills up what it lacks


class CloudFiles:
    """Files of one folder that grow together; each gets its name when all are whole.

    Parameters
    ----------
    folder : Path
        Where they are; it is there.

    Examples
    --------
    >>> import tempfile
    >>> import numpy as np
    >>> from pathlib import Path
    >>> from tiskel import load_cloud
    >>> from tiskel.io.tile_writer import CloudFiles
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with CloudFiles(Path(folder)) as files:
    ...         files.add("a", np.eye(3), np.arange(3), np.array([True, False, True]))
    ...         made = files.finish()
    ...     cloud = load_cloud(f"{folder}/a.ply")
    >>> sorted(made), cloud.properties["row"].tolist(), cloud.properties["core"].tolist()
    (['a'], [0, 1, 2], [1, 0, 1])
    """

    def __init__(self, folder: Path) -> None:
        self._folder, self._waiting, self._bytes = folder, dict[str, list[npt.NDArray[Any]]](), 0
        self._counts: dict[str, int] = {}

    def __enter__(self) -> "CloudFiles":
        return self

    def __exit__(self, *error: object) -> None:
        for name in self._counts:
            self._part(name).unlink(missing_ok=True)

    def add(self, name: str, points: Points, rows: npt.NDArray[np.integer[Any]], core: Mask) -> None:
        """Add points (n, 3) to a file, with their rows (n,) in the source and whether they are in the core (n,)."""
        table = np.empty(len(points), ROW)
        table["x"], table["y"], table["z"] = points.T
        table["row"], table["core"] = rows, core
        self._waiting.setdefault(name, []).append(table)
        self._bytes += table.nbytes
        if self._bytes > WAITING:
            self._write()

    def finish(self) -> dict[str, str]:
        """Complete all files and give them their names; return the SHA-256 of each by its name."""
        self._write()
        try:
            for name, count in self._counts.items():
                with self._part(name).open("r+b") as file:
                    file.write(_header(count))
            hashes = {name: hash_of(self._part(name)) for name in self._counts}
            for name in self._counts:
                self._part(name).replace(self._folder / f"{name}.ply")
        except OSError as error:
            raise self._failed(error) from None
        return hashes

    def _write(self) -> None:
        try:
            for name, tables in self._waiting.items():
                begun = name in self._counts
                self._counts.setdefault(name, 0)
                with self._part(name).open("ab" if begun else "wb") as file:
                    if not begun:
                        file.write(_header(0))
                    for table in tables:
                        file.write(table.data)
                        self._counts[name] += len(table)
        except OSError as error:
            raise self._failed(error) from None
        self._waiting, self._bytes = {}, 0

    def _part(self, name: str) -> Path:
        return self._folder / f".{name}.ply.part"

    def _failed(self, error: OSError) -> TiskelError:
        return TiskelError(f"cannot write into {self._folder}: {error.strerror}; check its permissions and the disk")


def _header(count: int) -> bytes:
    """Return the header of so many rows, as long as that of any other number."""
    lines = ["ply", "format binary_little_endian 1.0", f"comment tiskel {version()} cloud", "comment format 2"]
    lines.append("comment " + "." * (DIGITS - len(str(count))))
    lines.append(f"element vertex {count}")
    lines += [f"property {KINDS[ROW[name].str]} {name}" for name in ROW.names or ()]
    return ("\n".join([*lines, "end_header"]) + "\n").encode("ascii")


def read_rows(path: Path) -> tuple[Points, Indices, Mask]:
    """Return what a file of a tile holds.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    points : (n, 3) float64
        In the cloud's unit.
    rows : (n,) int32
        Of the points in the cloud that was split.
    core : (n,) bool
        Whether they are in the core of the tile.

    Raises
    ------
    TiskelError
        Where the file is missing, or no tile.
    """
    from tiskel.io.clouds import load_cloud

    cloud = load_cloud(path)
    if not {"row", "core"} <= set(cloud.properties):
        raise TiskelError(f"{path.name} is no tile: it has no properties row and core; run tiskel split again")
    return cloud.points, cloud.properties["row"].astype(np.int32), cloud.properties["core"] != 0


def document(values: dict[str, Any]) -> bytes:
    """Return JSON as files of this kind have it."""
    return (json.dumps(values, allow_nan=False, indent=1) + "\n").encode()
