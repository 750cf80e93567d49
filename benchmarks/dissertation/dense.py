"""A bent tube whose surface is known, fitted from so many points: errors of the fit, and of a roll on it."""

from math import pi
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from tiskel import FittedSurface, RollParams, Skeleton, SurfaceParams, fit_surface, roll
from tiskel.arrays import Numbers, Points
from tiskel.surfaces.forms import forms_of, principal_curvatures
from tiskel.surfaces.tube import V_STOP

Json = dict[str, Any]
BEND, ROUND, FLAT = 3.0, (0.5, 0.5), (0.6, 0.4)  # radius of the bend, half-axes of sections
ARC = 1.6  # radians of it


def bent(half: tuple[float, float], count: int, noise: float, seed: int) -> tuple[Points, Points]:
    """Return a cloud of a bent tube of elliptic section, even by area, and its axis."""
    a, b = half
    generator = np.random.default_rng(seed)
    t, s = generator.uniform(0, 2 * pi, 6 * count), generator.uniform(0, ARC, 6 * count)
    area = np.hypot(a * np.sin(t), b * np.cos(t)) * (BEND + a * np.cos(t))
    kept = np.flatnonzero(generator.uniform(0, area.max(), len(t)) < area)[:count]
    out = BEND + a * np.cos(t[kept])
    cloud = np.stack([out * np.cos(s[kept]), out * np.sin(s[kept]), b * np.sin(t[kept])], axis=1)
    along = np.linspace(0, ARC, 60)
    axis = BEND * np.stack([np.cos(along), np.sin(along), 0 * along], axis=1)
    return cloud + generator.normal(size=cloud.shape) * noise * (a + b) / 2, axis


def bent_truth(places: Points, half: tuple[float, float]) -> tuple[Numbers, Points, Numbers, Numbers]:
    """Return of places the relative error of radius, true normals, and both true curvatures, ascending."""
    (a, b), s = half, np.arctan2(places[:, 1], places[:, 0])
    across, up = np.hypot(places[:, 0], places[:, 1]) - BEND, places[:, 2]
    t = np.arctan2(up / b, across / a)
    off = np.hypot(across, up) / np.hypot(a * np.cos(t), b * np.sin(t)) - 1
    stretch = np.hypot(a * np.sin(t), b * np.cos(t))
    out = b * np.cos(t) / stretch
    normals = np.stack([out * np.cos(s), out * np.sin(s), a * np.sin(t) / stretch], axis=1)
    both = np.stack([a * b / stretch**3, out / (BEND + a * np.cos(t))])
    return off, normals, both.min(axis=0), both.max(axis=0)


def bent_surface(half: list[float], count: int, noise: float) -> FittedSurface:
    cloud, axis = bent((half[0], half[1]), count, noise, 0)
    rows = np.arange(len(cloud), dtype=np.int32)
    edges = np.stack([np.arange(len(axis) - 1), np.arange(1, len(axis))], axis=1).astype(np.int32)
    true = Skeleton(
        nodes=axis, edges=edges, radii=np.full(len(axis), sum(half) / 2), cloud=cloud, input_rows=rows, rows=rows,
        node_of_point=cKDTree(axis).query(cloud)[1].astype(np.int32), contracted=np.zeros((0, 3)), origin=np.zeros((0, 3)),  # noqa: E501
    )  # fmt: skip
    return fit_surface(true, SurfaceParams(branch="longest")).named(None)


def dense(half: list[float], count: int, noise: float) -> Json:
    """Return errors of a fitted surface of so many points, and where a roll on it ends."""
    fitted = bent_surface(half, count, noise)
    u, v = np.meshgrid(np.linspace(0, 2 * pi, 48, endpoint=False), np.linspace(0.15, 0.85, 60) * V_STOP)
    jet = fitted.jet(u.ravel(), v.ravel())
    forms, places, mean = forms_of(jet), np.stack(jet.f, axis=1), sum(half) / 2
    off, normals, low, high = bent_truth(places, (half[0], half[1]))
    found = principal_curvatures(forms)
    cosine = np.clip((np.array(forms.z).T * normals).sum(axis=1), -1, 1)
    middle, top = ARC / 2, BEND + half[0] * np.cos(1.0)
    start = (top * np.cos(middle), top * np.sin(middle), half[1] * np.sin(1.0))
    run = roll(fitted, RollParams(radius=mean / 4, omega=(1, 1, 0), start_at=start, duration=6, meet=False))  # type: ignore[arg-type]
    return {
        "radius": float(np.abs(off).mean()), "normal": float(np.degrees(np.arccos(cosine)).mean()),
        "least": float(np.abs(found[0] - low).mean() * mean), "most": float(np.abs(found[1] - high).mean() * mean),
        "end": run.contact[-1].tolist(), "time": float(run.t[-1]), "R_s": mean / 4,
    }  # fmt: skip
