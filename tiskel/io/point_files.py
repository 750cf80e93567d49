"""Clouds for other programs: PLY, text and NPY."""

from pathlib import Path

from tiskel.arrays import Points
from tiskel.errors import TiskelError
from tiskel.io import ply, text

SUFFIXES = (".ply", ".xyz", ".pts", ".csv", ".txt", ".npy")


def dump_cloud(points: Points, target: str | Path) -> bytes:
    """Return the points in the format that the suffix of the target asks for; PLY for standard output."""
    suffix = Path(target).suffix.lower()
    if suffix == ".ply" or str(target) == "-":
        return ply.dump([ply.element("vertex", ply.xyz(points))], "cloud", {})
    if suffix == ".npy":
        return text.dump_numpy(points)
    if suffix == ".csv":
        return b"x,y,z\n" + text.dump_text(points, ",")
    if suffix == ".pts":
        return f"{len(points)}\n".encode() + text.dump_text(points)
    if suffix in SUFFIXES:
        return text.dump_text(points)
    raise TiskelError(
        f"a cloud cannot be written as {suffix or 'a file without a suffix'!r}; choose {', '.join(SUFFIXES)}"
    )
