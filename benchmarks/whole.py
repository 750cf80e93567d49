"""The surface of the whole body: how near it is to every point, and how exact its curvatures are.

    python benchmarks/whole.py [folder]

1. The clouds of the issue: egg of the gallery, the others from the reference clouds where these are. Distances of all
   points from the surface in local radii, and of a tenth of the points that the surface was not fitted to (skeleton and
   tubes without them as well); what of it is little seen and bridged; the closed mesh.
2. Bodies with closed forms, 4096 points, clean and with noise in shares of the radius: errors of both curvatures, the
   larger one at each place, in 1/R, of the whole surface everywhere, and of the tubes and of it where tubes are.
3. What a place costs: function, gradient and Hessian at one place and at many, against a matrix product of NumPy.

Writes whole.md to benchmarks/rolling.
"""

import os
import statistics
import sys
import time
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from tiskel import (
    BodySurface,
    Skeleton,
    Surfaces,
    TiskelError,
    contract,
    extract_skeleton,
    fit_body,
    fit_surface,
    load_cloud,
    make_shape,
    shape_graph,
)
from tiskel.arrays import Mask, Numbers, Points, Stack
from tiskel.geometry.mesh import TriangleMesh
from tiskel.slicing.body_mesh import BodyMesh, body_mesh
from tiskel.surfaces.forms import forms_of, principal_curvatures
from tiskel.surfaces.implicit import ImplicitSurface, projected, tangency
from tiskel.surfaces.implicit_bodies import Capsule, Ellipsoid, Torus, y_of_capsules
from tiskel.surfaces.tube import V_STOP

HERE = Path(__file__).parent
OUT = HERE / "rolling"
REFERENCE = Path(os.environ.get("TISKEL_REFERENCE", HERE / ".." / ".." / "shared" / "reference")) / "clouds"
CLOUDS = ("egg", "hammer", "joint", "bunny", "fertility", "cave", "horse")
HELD, SEED = 0.1, 4  # share of the points that are held out, and the seed that chooses them
NEAR = 0.05  # local radii
COUNT, PLACES = 4096, 2000  # points of a cloud, and places where its surface is judged
NOISE = (0.0, 0.005, 0.01)  # of the radius
BAND = 0.05  # radii about a surface, in which points are drawn before they are moved onto it
ON_TUBE = 0.1  # radii that a place of a tube may be from where it is compared
ROUNDS = 201

Known = tuple[ImplicitSurface, tuple[float, float, float], float]
BODIES: dict[str, Known] = {  # the body, half of its box, its radius
    "capsule": (Capsule((-2, 0, 0), (2, 0, 0), 1.0), (3.0, 1.0, 1.0), 1.0),
    "torus": (Torus(3.5, 1.0), (4.5, 4.5, 1.0), 1.0),
    "Y, smooth": (y_of_capsules(), (2.4, 2.4, 0.4), 0.4),
    "ellipsoid": (Ellipsoid(2.0, 1.2, 1.0), (2.0, 1.2, 1.0), 1.0),
}


def main() -> None:
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else OUT
    out.mkdir(exist_ok=True, parents=True)
    lines = ["# The surface of the whole body", "", "Made by `python benchmarks/whole.py`.", "", *distances()]
    lines += ["", *curvatures(), "", *costs()]
    (out / "whole.md").write_text("\n".join(lines) + "\n")
    sys.stdout.write("\n".join(lines) + "\n")


def distances() -> list[str]:
    """Return the table of the clouds; distances in percent of the local radius."""
    head = "| cloud | points | patches | of tubes | distance: mean | 95 % | within 5 %"
    head += " | held out: mean | 95 % | within 5 % | little seen | bridged | seconds | triangles | closed | genus |"
    lines = ["## Distance of every point, in local radii", "", head, "|---" * 16 + "|"]
    for name in CLOUDS:
        if name != "egg" and not (REFERENCE / f"{name}.ply").exists():
            continue
        cloud = make_shape(shape_graph(name))[0] if name == "egg" else load_cloud(REFERENCE / f"{name}.ply").points
        lines.append(row_of(name, cloud))
    return lines


def row_of(name: str, cloud: Points) -> str:
    skeleton, surfaces = sliced(cloud)
    start = time.perf_counter()
    body = fit_body(skeleton, surfaces)
    seconds = time.perf_counter() - start
    off, mesh, tubes = body.summary, body_mesh(body), f"{body.of_tubes:.0%}"
    apart = held_out(cloud, skeleton)
    cells = [
        name, str(len(cloud)), str(len(body.patches)), tubes, f"{off['mean']:.2%}", f"{off['p95']:.2%}",
        f"{off['coverage']:.1%}", f"{np.nanmean(apart):.2%}", f"{np.nanquantile(apart, 0.95):.2%}",
        f"{(apart < NEAR).mean():.1%}", f"{body.share(1):.1%}", f"{body.share(0):.1%}", f"{seconds:.2f}", *facts(mesh),
    ]  # fmt: skip
    return "| " + " | ".join(cells) + " |"


def sliced(cloud: Points) -> tuple[Skeleton, Surfaces | None]:
    skeleton = extract_skeleton(contract(cloud))
    try:
        return skeleton, fit_surface(skeleton)
    except TiskelError:
        return skeleton, None


def held_out(cloud: Points, whole: Skeleton) -> Numbers:
    """Return how far points are from a surface that never saw them, in local radii."""
    out: Mask = np.random.default_rng(SEED).uniform(size=len(cloud)) < HELD
    body = fit_body(*sliced(np.ascontiguousarray(cloud[~out])))
    apart = np.linalg.norm(projected(body, cloud[out]) - cloud[out], axis=1)
    return np.asarray(apart / whole.radii[whole.node_of_point[out]])


def facts(mesh: BodyMesh) -> list[str]:
    """Return triangles, whether each side meets exactly one other that runs the opposite way, and the genus."""
    halves = TriangleMesh(mesh.vertices, mesh.triangles).halves
    closed = len(halves.free) == 0 and bool(halves.opposite.all())
    euler = len(mesh.vertices) - len(halves.meeting) + len(mesh.triangles)
    return [str(len(mesh.triangles)), "yes" if closed else "no", str((2 - euler) // 2)]


def curvatures() -> list[str]:
    head = "| body | noise | whole: mean | 95 % | tubes at | tubes: mean | 95 % | whole there: mean | 95 % | distance |"
    lines = ["## Errors of curvature, in 1/R", "", head, "|---" * 10 + "|"]
    for name, known in BODIES.items():
        lines += [curvature_row(name, known, noise) for noise in NOISE]
    return lines


def curvature_row(name: str, known: Known, noise: float) -> str:
    truth, half, radius = known
    generator = np.random.default_rng(SEED)
    cloud = sampled(truth, half, radius, COUNT, generator)
    cloud += generator.normal(size=cloud.shape) * noise * radius
    skeleton, surfaces = sliced(cloud)
    body = fit_body(skeleton, surfaces)
    at = projected(body, sampled(truth, half, radius, PLACES, generator))
    right = principal(tangency(truth, projected(truth, at)).shape)
    errors = worst(principal(tangency(body, at).shape), right) * radius
    of_tubes = tube_errors(surfaces, at, right, radius)
    there = np.isfinite(of_tubes)
    off = np.abs(truth.level(at).value) / radius
    cells = [
        name, f"{noise:.1%}", *told(errors), f"{there.mean():.0%}", *told(of_tubes[there]), *told(errors[there]),
        f"{off.mean():.2%}",
    ]  # fmt: skip
    return "| " + " | ".join(cells) + " |"


def told(errors: Numbers) -> list[str]:
    return [f"{errors.mean():.1%}", f"{np.quantile(errors, 0.95):.1%}"] if len(errors) else ["", ""]


def sampled(
    truth: ImplicitSurface, half: tuple[float, float, float], radius: float, count: int, generator: np.random.Generator
) -> Points:
    """Return points on a surface: of those drawn evenly in a thin band about it, where they are moved to."""
    found: list[Points] = []
    while sum(map(len, found)) < count:
        drawn = generator.uniform(-1, 1, (100_000, 3)) * (np.array(half) + BAND * radius)
        found.append(projected(truth, drawn[np.abs(truth.level(drawn).value) < BAND * radius]))
    return np.ascontiguousarray(np.concatenate(found)[:count])


def principal(shape: Stack) -> tuple[Numbers, Numbers]:
    mean = np.trace(shape, axis1=1, axis2=2) / 2
    half = np.sqrt(np.maximum((shape**2).sum(axis=(1, 2)) / 2 - mean**2, 0.0))
    return mean - half, mean + half


def worst(ours: tuple[Numbers, Numbers], right: tuple[Numbers, Numbers]) -> Numbers:
    return np.asarray(np.maximum(np.abs(ours[0] - right[0]), np.abs(ours[1] - right[1])))


def tube_errors(
    surfaces: Surfaces | None, at: Points, right: tuple[Numbers, Numbers], radius: float
) -> Numbers:  # fmt: skip
    """Return the errors of the tubes' curvatures at places, NaN where no tube is."""
    errors = np.full(len(at), np.nan)
    for tube in surfaces or ():
        u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 96, endpoint=False), np.linspace(0.02, 0.98, 200) * V_STOP)
        far, place = cKDTree(np.stack(tube.jet(u, v).f, axis=-1).reshape(-1, 3)).query(at)
        found = principal_curvatures(forms_of(tube.jet(u.ravel()[place], v.ravel()[place])))
        near = far < ON_TUBE * radius
        errors[near] = (worst(found, right) * radius)[near]
    return errors


def costs() -> list[str]:
    """Return what places cost, and the yardstick beside them, alternately in this process."""
    body: BodySurface = fit_body(*sliced(make_shape(shape_graph("y"))[0]))
    square, one, many = np.random.default_rng(SEED).normal(size=(64, 64)), body.cloud[:1], np.tile(body.cloud, (10, 1))
    seconds: dict[str, list[float]] = {"one place": [], "many places, each": [], "product of 64 x 64": []}
    works = (lambda: body.level(one), lambda: body.level(many), lambda: square @ square)
    for _ in range(ROUNDS):
        for key, work in zip(seconds, works, strict=True):
            if key == "many places, each" and len(seconds[key]) >= ROUNDS // 20:
                continue
            start = time.perf_counter()
            work()
            seconds[key].append((time.perf_counter() - start) / (len(many) if key == "many places, each" else 1))
    unit = statistics.median(seconds["product of 64 x 64"])
    lines = ["## Function, gradient and Hessian", "", "| what | median, microseconds | in products |", "|---|---|---|"]
    for key, values in seconds.items():
        median = statistics.median(values)
        lines.append(f"| {key} | {1e6 * median:.1f} | {median / unit:.2g} |")
    return lines


if __name__ == "__main__":
    main()
