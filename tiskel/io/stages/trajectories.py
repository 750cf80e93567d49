"""Trajectories for other programs: TUM, nav_msgs/Path in YAML, and tables of bodies; and poses read back."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tiskel.arrays import Numbers, Points, Table
from tiskel.errors import TiskelError
from tiskel.io.stages.roll import to_csv
from tiskel.io.streams import read_bytes
from tiskel.rolling.bodies import BodyTrajectory
from tiskel.rolling.trajectory import Trajectory

FRAME = "map"  # the frame of reference that a nav_msgs/Path names: the cloud's
BODY_COLUMNS = (
    "t", "u_o", "v_o", "u_s", "v_s", "psi", "contact_x", "contact_y", "contact_z", "position_x", "position_y",
    "position_z", "q_w", "q_x", "q_y", "q_z", "margin",
)  # fmt: skip
POSE = ("t", "centre_x", "centre_y", "centre_z", "q_w", "q_x", "q_y", "q_z")  # in a table of tiskel


class Poses(NamedTuple):
    """Poses over time.

    Attributes
    ----------
    t : (n,) float64
        Seconds.
    centre : (n, 3) float64
        Of the sphere, in the cloud's unit.
    orientation : (n, 4) float64
        Unit quaternions w, x, y, z.
    """

    t: Numbers
    centre: Points
    orientation: Table


def as_suffixed(name: str, runs: Sequence[Trajectory]) -> bytes:
    """Return runs as the suffix of a name asks for: .tum, .yaml or .yml, else CSV.

    Raises
    ------
    TiskelError
        Where there is more than one run, and the format has place for one.
    """
    suffix = name.rpartition(".")[2].lower()
    if suffix not in {"tum", "yaml", "yml"}:
        return to_csv(runs)
    if len(runs) > 1:
        raise TiskelError(f"{name}: a .{suffix} file holds one run, there are {len(runs)}; choose one model, or CSV")
    return to_tum(runs[0]) if suffix == "tum" else to_path(runs[0])


def to_tum(run: Trajectory) -> bytes:
    """Return the sphere's poses as the TUM trajectory format has them: t tx ty tz qx qy qz qw, a line each."""
    table = np.column_stack([run.t, run.centre, run.orientation[:, [1, 2, 3, 0]]])
    lines = [" ".join(map(repr, row)) for row in table.tolist()]
    return ("# timestamp tx ty tz qx qy qz qw\n" + "\n".join(lines) + "\n").encode()


def to_path(run: Trajectory) -> bytes:
    """Return the sphere's poses as a message nav_msgs/Path of ROS 2 in YAML."""
    head = f"header: {{stamp: {{sec: 0, nanosec: 0}}, frame_id: {FRAME}}}\nposes:\n"
    lines = []
    for t, (x, y, z), (qw, qx, qy, qz) in zip(
        run.t.tolist(), run.centre.tolist(), run.orientation.tolist(), strict=True
    ):
        ticks = round(t * 1e9)
        stamp = f"{{sec: {ticks // 10**9}, nanosec: {ticks % 10**9}}}"
        lines.append(
            f"- header: {{stamp: {stamp}, frame_id: {FRAME}}}\n  pose: {{position: {{x: {x!r}, y: {y!r}, z: {z!r}}}, "
            f"orientation: {{x: {qx!r}, y: {qy!r}, z: {qz!r}, w: {qw!r}}}}}\n"
        )
    return (head + "".join(lines)).encode()


def body_csv(run: BodyTrajectory) -> bytes:
    """Return the trajectory of a body that is no sphere as CSV."""
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow(BODY_COLUMNS)
    rows = np.column_stack([run.t, run.state, run.contact, run.position, run.orientation, run.margin])
    table.writerows([map(repr, row) for row in rows.tolist()])
    return out.getvalue().encode()


def read_poses(source: str | Path) -> Poses:
    """Read the poses of a trajectory from a table of ``tiskel roll`` or from TUM.

    Raises
    ------
    TiskelError
        Where it is neither.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from tiskel.io.stages.trajectories import read_poses
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "r.tum").write_text("0 1 2 3 0 0 0 1\\n0.5 1 2 4 0 0 0 1\\n")
    ...     poses = read_poses(f"{folder}/r.tum")
    >>> poses.centre[1].tolist(), poses.orientation[0].tolist()
    ([1.0, 2.0, 4.0], [1.0, 0.0, 0.0, 0.0])
    """
    name = Path(source).name
    try:
        lines = [line for line in read_bytes(source).decode("utf-8-sig").splitlines() if line.strip()]
        if lines and lines[0].startswith("model,"):
            rows = list(csv.DictReader(lines))
            table = np.array([[float(row[column]) for column in POSE] for row in rows])
        else:
            table = np.array([[float(word) for word in line.split()] for line in lines if line[0] != "#"])
            table = table[:, [0, 1, 2, 3, 7, 4, 5, 6]]
    except (UnicodeDecodeError, ValueError, KeyError, TypeError, IndexError):
        raise TiskelError(f"{name} holds no trajectory; give a CSV file of tiskel roll, or TUM") from None
    return Poses(table[:, 0], table[:, 1:4], table[:, 4:8])
