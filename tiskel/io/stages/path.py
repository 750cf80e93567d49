"""Ways of rolling spheres from CSV, as ``tiskel roll`` writes them."""

import csv
import io
from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Numbers, Points, Table
from tiskel.errors import TiskelError

NEEDED = (
    "t", "contact_x", "contact_y", "contact_z", "centre_x", "centre_y", "centre_z", "q_w", "q_x", "q_y", "q_z",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class RolledPath:
    """The way of a sphere; lengths in the cloud's unit.

    Attributes
    ----------
    name : str
        The model.
    t : (n,) float64
        Seconds.
    contact : (n, 3) float64
        Where sphere and object touch.
    centre : (n, 3) float64
        Of the sphere.
    orientation : (n, 4) float64
        Unit quaternions w, x, y, z.
    radius : float
        Of the sphere.
    """

    name: str
    t: Numbers
    contact: Points
    centre: Points
    orientation: Table
    radius: float


def is_path(data: bytes) -> bool:
    """Return whether the first line of a file names the columns of a path."""
    header = data[:4096].splitlines()[:1]
    return bool(header) and {b"contact_x", b"centre_x", b"q_w"} <= set(header[0].split(b","))


def parse_paths(data: bytes, name: str) -> tuple[RolledPath, ...]:
    """Return the ways in a table of trajectories, one for each model.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where a column is missing, a value is no number, or there is no row.
    """
    rows = list(csv.DictReader(io.StringIO(data.decode("utf-8", "replace"))))
    missing = [column for column in NEEDED if not rows or column not in rows[0]]
    if missing:
        raise TiskelError(f"{name} has no rows with {', '.join(missing)}; write a path with tiskel roll")
    models = dict.fromkeys(row.get("model") or "sphere" for row in rows)
    return tuple(_path([r for r in rows if (r.get("model") or "sphere") == model], model, name) for model in models)


def _path(rows: list[dict[str, str]], model: str, name: str) -> RolledPath:
    try:
        table = np.array([[float(row[column]) for column in NEEDED] for row in rows])
    except (ValueError, TypeError) as error:
        raise TiskelError(f"{name} is a damaged path: {error}; run tiskel roll again") from None
    contact, centre = table[:, 1:4], table[:, 4:7]
    radius = float(np.median(np.linalg.norm(contact - centre, axis=1)))
    return RolledPath(model, table[:, 0], contact, centre, table[:, 7:11], radius)
