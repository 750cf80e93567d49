"""Definitions and equations whose value is known in closed form, or from the published code."""

from math import cos, pi
from pathlib import Path
from typing import Any

import numpy as np

from tiskel import LbcParams, contract, load_cloud
from tiskel.arrays import Points, normalisation
from tiskel.geometry.graph import CurveGraph
from tiskel.methods.laplacian.gls import explained_score
from tiskel.methods.laplacian.lbc import published_rings
from tiskel.metrics.betas import betas
from tiskel.metrics.smoothness import vertex_smoothness
from tiskel.rolling.equations import Rates, local_rates, object_rates, sphere_rates
from tiskel.rolling.sphere import orientation
from tiskel.surfaces.analytic import Ellipsoid, Torus
from tiskel.surfaces.forms import Forms, forms_of
from tiskel.surfaces.tube import Radius

Json = dict[str, Any]
HEIGHT, REACH, PLANE = 1e-4, 1.0, 20_000  # of a place over a disc, the disc's radius, and its points
STEP = 1e-5  # of central differences along the flow
STATE, OMEGA, VELOCITY, RADIUS = Rates(0.3, 0.4, 0.4, 0.2, 0.5), (0.4, -0.8, 0.3), (0.1, -0.2, 0.0), 0.3


def rings_and_steps(name: str, folder: Path) -> Json:
    """Return how many one-rings are those of the published code, and how far lbc's contracted cloud is from its own."""
    points = load_cloud(folder / "clouds" / f"{name}.ply").points
    theirs, frame = dict(np.load(folder / "toolbox" / f"{name}_lbc.npz")), normalisation(points)
    found: Json = {"rings": None, "count": len(points)}
    if "rings" in theirs:
        ours = published_rings(frame.apply(points), LbcParams().neighbours_for(len(points)))
        same = [
            {*row[row >= 0]} == {*other[other >= 0]} for row, other in zip(ours.members, theirs["rings"], strict=True)
        ]
        found["rings"] = int(sum(same))
    c = contract(points, LbcParams())
    away = np.abs(frame.apply(c.points) - theirs["contracted"]).max()
    return found | {"away": float(away), "steps": len(c.steps), "theirs": int(theirs["iterations"])}


def scores() -> Json:
    """Return the explained score of a line, a disc and a ball of points."""
    generator = np.random.default_rng(0)
    ball = generator.normal(size=(200_000, 3))
    return {
        "line": explained_score(ball * (1, 0, 0)),
        "disc": explained_score(ball * (1, 1, 0)),
        "ball": explained_score(ball),
    }


def beta_over_a_plane() -> Json:
    """Return beta just over the middle of a large disc, by the hull: (2 pi + pi) / 4 pi for an endless one."""
    generator = np.random.default_rng(0)
    far, turn = REACH * np.exp(generator.uniform(np.log(HEIGHT / 10), 0, PLANE)), generator.uniform(0, 2 * pi, PLANE)
    disc = np.stack([far * np.cos(turn), far * np.sin(turn), 0 * far], axis=1)
    return {"beta": float(betas(np.array([[0, 0, HEIGHT]]), disc, "hull")[0])}


def corners() -> Json:
    """Return the smoothness of a vertex in a straight line, at a right angle, and in a hairpin."""
    ends = {"straight": (2.0, 0.0, 0.0), "right angle": (1.0, 1.0, 0.0), "hairpin": (0.0, 1e-9, 0.0)}
    edges = np.array([[0, 1], [1, 2]], np.int32)
    return {name: float(vertex_smoothness(CurveGraph(np.array([[0.0, 0, 0], [1, 0, 0], end]), edges))[1][0])
            for name, end in ends.items()}  # fmt: skip


def contact_equations() -> Json:
    """Return what the global model misses a given twist by, with print's torsion beside it, and two closed forms."""
    surface = Ellipsoid(2.0, 3.0, 1.8)
    forms = forms_of(surface.jet(STATE.u_o, STATE.v_o), 1.0)
    tube = Radius(R=2.0, u=0.0, v=0.0, uu=0.0, uv=0.0, vv=0.0)
    local = {
        sigma: local_rates(tube, 1.0, sigma, 0.5, 0.1, 0.2, (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)).u_o
        for sigma in (1.0, -1.0)
    }
    along = object_rates(forms_of(Torus(5.0, 2.0).jet(0.4, 1.0), 1.0), 0.5, (0.7, 0.4, 0.0), (0.0, 0.0, 0.0))[1]
    return {
        "ours": missed(surface, forms), "printed torsion": missed(surface, forms._replace(T=forms.K[0])),
        "tunnel": local[-1.0], "printed tunnel": local[1.0],
        "torus": abs(along - 0.5 * 0.7 / (5.0 - 2.5 * cos(0.4))),
    }  # fmt: skip


def missed(surface: Any, forms: Forms) -> float:
    """Return by how much the twist of the pose, by central differences, misses the one that was given."""
    rates = sphere_rates(forms, RADIUS, STATE.u_s, STATE.psi, OMEGA, VELOCITY)
    (before, there), (after, then) = (
        pose(surface, Rates(*np.add(STATE, np.multiply(side, rates)))) for side in (-STEP, STEP)
    )
    q, centre = pose(surface, STATE)
    spin = (after - before) / (2 * STEP) @ q.T
    turning = np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]]) / 2
    frame = np.array(forms[:3], float).T
    contact = np.array(surface.jet(STATE.u_o, STATE.v_o).f, float)
    moved = (then - there) / (2 * STEP) + np.cross(turning, contact - centre)
    return float(max(np.abs(-frame.T @ turning - OMEGA).max(), np.abs(-frame.T @ moved - VELOCITY).max()))


def pose(surface: Any, state: Rates) -> tuple[Points, Points]:
    forms = forms_of(surface.jet(state.u_o, state.v_o), 1.0)
    frame = np.array(forms[:3], float).T
    centre = np.array(surface.jet(state.u_o, state.v_o).f, float) + RADIUS * frame[:, 2]
    return orientation(frame, state.u_s, state.v_s, state.psi), centre
