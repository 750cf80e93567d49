"""Inputs over time from CSV, trajectories to CSV."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tiskel.errors import TiskelError
from tiskel.io.streams import read_bytes
from tiskel.rolling.inputs import Inputs, pauses
from tiskel.rolling.trajectory import Trajectory

INPUTS = ("t", "wx", "wy", "wz", "vx", "vy", "vz")
NEEDED = INPUTS[:4]
COLUMNS = (  # seconds, radians, the cloud's unit of length; margin in 1 / length, det in 1 / length^2; inputs as given
    "model", "t", "u_o", "v_o", "u_s", "v_s", "psi", "contact_x", "contact_y", "contact_z", "centre_x", "centre_y",
    "centre_z", "q_w", "q_x", "q_y", "q_z", "R_o", "margin", "det_Q", "normal_x", "normal_y", "normal_z", "wx", "wy",
    "wz", "vx", "vy", "vz", "way_o", "way_s",
)  # fmt: skip


def read_inputs(source: str | Path) -> Inputs:
    r"""Read inputs over time from CSV.

    Parameters
    ----------
    source : str or Path
        A file with a header t, wx, wy, wz (seconds, radians per second) and, if there is slip, vx, vy, vz (the
        cloud's unit per second); "-" is standard input.

    Returns
    -------
    Inputs

    Raises
    ------
    TiskelError
        With the row of the first value that is missing, no number, or a time that does not rise.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from tiskel.io.stages.roll import read_inputs
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "w.csv").write_text("t,wx,wy,wz\n0,0,1,0\n2,0,3,0\n")
    ...     inputs = read_inputs(f"{folder}/w.csv")
    >>> inputs.t.tolist(), inputs.values.shape
    ([0.0, 2.0], (2, 6))
    """
    return parse_inputs(read_bytes(source), Path(source).name if str(source) != "-" else "stdin")


def parse_inputs(data: bytes, name: str) -> Inputs:
    """Return the inputs in the bytes of a file of this name; see :func:`read_inputs`."""
    try:
        rows = list(csv.reader(io.StringIO(data.decode("utf-8-sig"))))
    except (UnicodeDecodeError, csv.Error) as error:
        raise TiskelError(f"{name} is not a CSV file: {error}; write t,wx,wy,wz,vx,vy,vz") from None
    rows = [row for row in rows if any(cell.strip() for cell in row)]
    header = [cell.strip().lower() for cell in rows[0]] if rows else []
    missing = [column for column in NEEDED if column not in header]
    if missing:
        raise TiskelError(f"{name} has no column {', '.join(missing)}; the first line names t,wx,wy,wz,vx,vy,vz")
    if len(rows) < 2:
        raise TiskelError(f"{name} has no row below its header; give at least one")
    table = np.array([_numbers(name, number, row, header) for number, row in enumerate(rows[1:], 1)])
    try:
        made = Inputs(table[:, 0], table[:, 1:])
    except TiskelError as error:
        raise TiskelError(f"{name}: {error}") from None
    return Inputs(made.t, made.values, pauses(made.t))


def _numbers(name: str, number: int, row: list[str], header: list[str]) -> list[float]:
    """Return the seven values of a row; columns that the header does not name are 0."""
    found = dict(zip(header, row, strict=False))
    values = []
    for column in INPUTS:
        cell = found.get(column, "").strip() if column in header else "0"
        try:
            values.append(float(cell))
        except ValueError:
            said = f"{cell!r} is no number" if cell else "is missing"
            raise TiskelError(f"{name}: {column} {said} in row {number}; fill it or leave the row out") from None
    return values


def inputs_csv(inputs: Inputs) -> bytes:
    """Return inputs over time as :func:`read_inputs` reads them, to the last bit."""
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow(INPUTS)
    table.writerows([map(repr, row) for row in np.column_stack([inputs.t, inputs.values]).tolist()])
    return out.getvalue().encode()


def to_csv(trajectories: Sequence[Trajectory]) -> bytes:
    """Return one table of all trajectories as CSV: a row for every time, each named by its model."""
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow(COLUMNS)
    for r in trajectories:
        parts = [r.t[:, None], r.state, r.contact, r.centre, r.orientation]
        parts += [column[:, None] for column in (r.object_radius, r.margin, r.determinant)]
        parts += [r.normal, r.inputs, r.ways]
        name = r.params.model if r.params.normals == "surface" else f"{r.params.model}-{r.params.normals}"
        for row in np.concatenate(parts, axis=1).tolist():
            table.writerow([name, *("" if value != value else repr(value) for value in row)])  # noqa: PLR0124
    return out.getvalue().encode()
