"""Orientations of the rolling sphere, and its chart.

f_s(u_s, v_s) = R_s [cos u_s cos v_s, -cos u_s sin v_s, sin u_s] with frame
F_s, z_s outward. At the contact Q F_s = F R3 with
R3 = [[cos psi, -sin psi, 0], [-sin psi, -cos psi, 0], [0, 0, -1]], its own
inverse. The chart is singular at cos u_s = 0, so that a run integrates unit
quaternions (w, x, y, z) and reads the chart off them.
"""

from math import cos, sin
from typing import Any

import numpy as np

from tiskel.arrays import Floats, Numbers, Stack, Table
from tiskel.surfaces.jets import Scalar


def chart_frame(u_s: float, v_s: float) -> Table:
    """Return F_s (3, 3), its columns x_s, y_s and z_s."""
    cu, su, cv, sv = cos(u_s), sin(u_s), cos(v_s), sin(v_s)
    return np.array([[-su * cv, -sv, cu * cv], [su * sv, -cv, -cu * sv], [cu, 0.0, su]])


def turn_of(psi: float) -> Table:
    """Return R3 (3, 3)."""
    return np.array([[cos(psi), -sin(psi), 0], [-sin(psi), -cos(psi), 0], [0, 0, -1.0]])


def orientation(frame: Table, u_s: float, v_s: float, psi: float) -> Table:
    """Return Q = F R3 F_s^T (3, 3)."""
    return np.asarray(frame @ turn_of(psi) @ chart_frame(u_s, v_s).T)


def chart_of(frame: Floats, rotation: Floats) -> tuple[Scalar, Scalar, Scalar]:
    """Return u_s, v_s and psi from F and Q, (..., 3, 3) each; v_s and psi within half a turn of 0."""
    place = -np.einsum("...ji,...j->...i", rotation, frame[..., 2])  # Q^T (-z_o) = f_s / R_s
    u_s, v_s = np.arcsin(np.clip(place[..., 2], -1, 1)), np.arctan2(-place[..., 1], place[..., 0])
    su, cu, sv, cv = np.sin(u_s), np.cos(u_s), np.sin(v_s), np.cos(v_s)
    x_s = np.stack([-su * cv, su * sv, cu], axis=-1)
    across = np.einsum("...ji,...jk,...k->...i", frame, rotation, x_s)  # F^T Q x_s = R3 x
    return u_s, v_s, np.arctan2(-across[..., 1], across[..., 0])


def quaternion_of(rotation: Table) -> Numbers:
    """Return the unit quaternion (4,) of a rotation (3, 3)."""
    return np.asarray(quaternions_of(rotation[None])[0])


def quaternions_of(rotations: Stack) -> Table:
    """Return unit quaternions (n, 4) of rotations (n, 3, 3), without jumps of sign."""
    from scipy.spatial.transform import Rotation

    q = Rotation.from_matrix(rotations).as_quat()[:, [3, 0, 1, 2]]
    flips = np.where((q[1:] * q[:-1]).sum(axis=1) < 0, -1.0, 1.0)
    return np.asarray(q * np.cumprod(np.concatenate([[1.0], flips]))[:, None])


def rotation_of(q: Floats) -> Floats:
    """Return the rotations (..., 3, 3) of quaternions (..., 4), which need not be of unit length."""
    w, x, y, z = np.moveaxis(q / np.linalg.norm(q, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def quaternion_rate(turning: Any, q: Any) -> tuple[float, float, float, float]:
    """Return q' = (0, turning) q / 2 for an angular velocity in the axes that q turns into."""
    (a, b, c), (w, x, y, z) = turning, q
    return (
        0.5 * (-a * x - b * y - c * z),
        0.5 * (a * w + b * z - c * y),
        0.5 * (b * w + c * x - a * z),
        0.5 * (c * w + a * y - b * x),
    )
