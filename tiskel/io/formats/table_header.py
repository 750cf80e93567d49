"""Which columns of a table are x, y and z, by the names in its header."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from tiskel.errors import TiskelError
from tiskel.io.formats.base import short

AXES = ("x", "y", "z")
UNIT = re.compile(r"\s*(\(.*\)|\[.*\]|[ _](um|mm|cm|dm|m|km|in|ft))$")
SURVEYED = {  # what surveyors call them
    "easting": "x", "eastings": "x", "e": "x", "northing": "y", "northings": "y", "n": "y",
    "elevation": "z", "elev": "z", "height": "z", "altitude": "z", "alt": "z", "h": "z",
}  # fmt: skip
PARAVIEW = re.compile(r"points?\w*:([012])")  #: Points:0, and Points_m_XYZ:0 as VeloView has it
LONGEST_NAME = 40  #: characters of a name that may still be that of a coordinate
INDEX = re.compile(r"|unnamed: ?\d+|index|idx|id|#")  #: names of a column that counts the rows


@dataclass(frozen=True)
class Columns:
    """Which columns of a table are read, counted from 0.

    Attributes
    ----------
    axes : (int, int, int)
        The columns of x, y and z.
    others : dict of str to int
        The other columns by name.
    warnings : tuple of str
        What had to be decided.
    """

    axes: tuple[int, int, int] = (0, 1, 2)
    others: dict[str, int] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()


def columns_of(names: Sequence[str], name: str) -> Columns:
    """Return the columns that a header names.

    Parameters
    ----------
    names : sequence of str
        Of all columns. x, y and z in either case count, alone, with a unit (X(m), x_mm), or as ParaView writes them
        (Points:0); easting, northing and height do, too, with a warning; where there are three columns without these
        names, they are taken in order, with a warning.
    name : str
        The file's name, for messages.

    Returns
    -------
    Columns

    Raises
    ------
    TiskelError
        Where neither the names nor the number of the columns say which are x, y and z.

    Examples
    --------
    >>> from tiskel.io.formats.table_header import columns_of
    >>> columns_of(["id", "X(m)", "Y(m)", "Z(m)"], "c.csv").axes
    (1, 2, 3)
    """
    axes = named(names)
    if axes is not None:
        surveyed = all(_surveyed(names[i]) for i in axes)
        said = (_taken(name, ", ".join(names[i] for i in axes)),) if surveyed else ()
        return Columns(axes, {key: i for i, key in enumerate(names) if i not in axes and key}, said)
    rest = [i for i, key in enumerate(names) if not INDEX.fullmatch(key.lower())]
    found = ", ".join(key or "(no name)" for key in names)
    misplaced = any(_plain(names[i]) in AXES and AXES[at] != _plain(names[i]) for at, i in enumerate(rest[:3]))
    if len(rest) != 3 or misplaced:
        raise TiskelError(f"{name}: its columns are {short(found)}; name those of the coordinates x, y and z")
    return Columns((rest[0], rest[1], rest[2]), {}, (_taken(name, found),))


def _taken(name: str, found: str) -> str:
    return f"{name}: its columns {short(found)} were taken as x, y and z"


def named(names: Sequence[str]) -> tuple[int, int, int] | None:
    """Return the columns of x, y and z by name; None where one is missing, or there twice in the plainest spelling."""
    spellings: tuple[Callable[[str], str], ...] = (str.lower, _plain, _paraview, _surveyed)
    for spelling in spellings:
        spelt = [spelling(name) for name in names]
        if all(spelt.count(axis) == 1 for axis in AXES):
            return spelt.index("x"), spelt.index("y"), spelt.index("z")
    return None


def _plain(name: str) -> str:
    """Return the name in lower case without a unit."""
    return UNIT.sub("", name.lower()) if len(name) <= LONGEST_NAME else name


def _surveyed(name: str) -> str:
    return SURVEYED.get(_plain(name), "")


def chosen(asked: Sequence[str], names: Sequence[str] | None, width: int, name: str) -> Columns:
    """Return the columns that the user asked for.

    Parameters
    ----------
    asked : sequence of three str
        Names, in any case, or numbers counted from 1.
    names : sequence of str or None
        Of all columns, None where they have none.
    width : int
        How many columns there are.
    name : str
        The file's name, for messages.

    Raises
    ------
    TiskelError
        Where there is no such column, or they are not three different ones.
    """
    lower = [key.lower() for key in names or ()]
    axes = []
    for one in map(str.strip, asked):
        if one.lower() in lower:
            axes.append(lower.index(one.lower()))
        elif one.isascii() and one.isdigit() and len(one) < 9 and 1 <= int(one) <= width:
            axes.append(int(one) - 1)
        else:
            known = short(", ".join(names)) if names else f"numbers from 1 to {width}"
            raise TiskelError(f"{name} has no column {short(one)!r}; it has {known}")
    if len(axes) != 3 or len(set(axes)) != 3:
        raise TiskelError(
            f"columns must be three different ones, such as x,y,z or 2,3,4; got {short(','.join(asked))!r}"
        )
    others = {key: i for i, key in enumerate(names or ()) if i not in axes and key}
    return Columns((axes[0], axes[1], axes[2]), others)


def _paraview(name: str) -> str:
    found = PARAVIEW.fullmatch(name.lower())
    return AXES[int(found[1])] if found else ""
