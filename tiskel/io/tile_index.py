"""The index of a cloud that was split: which files there are, where they lie, and how they were cut.

``index.json`` holds the source (name, SHA-256, points, rows that are not finite),
the settings, the spacing, and a list of parts: name, file, SHA-256, points, how many of them
are in the core, and the box of the core's points. Tiles have their planes as a
tree, objects none. ``rest`` are points of objects too small for a file of their own.
"""

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from tiskel.errors import TiskelError
from tiskel.io.streams import read_bytes
from tiskel.params import SplitParams
from tiskel.tiles.tiling import Tiling
from tiskel.version import version

INDEX, FORMAT = "index.json", 1
CLOUDS, SKELETONS = "clouds", "skeletons"  #: folders of the parts, and of what is made of them, unless one is named


@dataclass(frozen=True)
class Part:
    """A file of a cloud that was split.

    Attributes
    ----------
    name : str
        Of the part; its file is NAME.ply.
    sha256 : str
        Of the file.
    points, core : int
        Of the file, and those that are in no other core.
    low, high : tuple of float
        The box of the core's points.
    """

    name: str
    sha256: str
    points: int
    core: int
    low: tuple[float, ...]
    high: tuple[float, ...]


@dataclass(frozen=True)
class TileIndex:
    """What ``index.json`` holds.

    Attributes
    ----------
    source : dict
        Name and SHA-256 of the cloud.
    points, not_finite : int
        Its rows, and how many of them were left out because they are not finite.
    settings : SplitParams
        As they were asked for.
    spacing : float
        How far points are apart, about, in the cloud's unit.
    tiling : Tiling or None
        How tiles lie; None for objects.
    gap : float or None
        Side of the cells that objects hang together by; None for tiles.
    parts : tuple of Part
        The files, tile after tile, or the largest object first.
    rest : int
        Points of objects too small for a file of their own.
    """

    source: dict[str, str]
    points: int
    not_finite: int
    settings: SplitParams
    spacing: float
    tiling: Tiling | None
    gap: float | None
    parts: tuple[Part, ...]
    rest: int = 0

    def as_dict(self) -> dict[str, Any]:
        """Return plain JSON values."""
        tiling = {"tiling": self.tiling.as_dict()} if self.tiling else {"gap": self.gap}
        return {
            "tiskel": version(),
            "format": FORMAT,
            "source": self.source,
            "points": self.points,
            "not_finite": self.not_finite,
            "settings": asdict(self.settings),
            "spacing": self.spacing,
            **tiling,
            "rest": self.rest,
            "parts": [asdict(part) | {"file": f"{CLOUDS}/{part.name}.ply"} for part in self.parts],
        }


def read_index(folder: str | Path) -> TileIndex:
    """Read the index of a folder that ``tiskel split`` made.

    Raises
    ------
    TiskelError
        Where there is none, or it is damaged or of a newer format.
    """
    path = Path(folder) / INDEX
    if not path.is_file():
        raise TiskelError(f"{folder} has no {INDEX}; make it with: tiskel split IN -o {folder}")
    try:
        values = json.loads(read_bytes(path))
        if values["format"] > FORMAT:
            raise TiskelError(f"{path} has format {values['format']} of a newer tiskel; update tiskel")
        tiling = Tiling.from_dict(values["tiling"]) if "tiling" in values else None
        parts = tuple(_part(part) for part in values["parts"])
        known = {"source", "points", "not_finite", "spacing", "rest"}
        settings = SplitParams(**values["settings"])
        return TileIndex(
            **{name: values[name] for name in known},
            settings=settings, tiling=tiling, gap=values.get("gap"), parts=parts,
        )  # fmt: skip
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise TiskelError(f"{path} is damaged: {error!r}; run tiskel split again") from None


def _part(values: dict[str, Any]) -> Part:
    given = {name: value for name, value in values.items() if name != "file"}
    return Part(**{**given, "low": tuple(given["low"]), "high": tuple(given["high"])})
