"""The fitted surface as a triangle mesh, its distance to the cloud, and what its slices measure."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Edges, Labels, Numbers, Points, Stack, Table
from tiskel.geometry.bspline import BSplineCurve
from tiskel.geometry.ellipse import fit_ellipse
from tiskel.slicing.fitted import BRIDGED, FittedSurface
from tiskel.slicing.sections import Section
from tiskel.surfaces.forms import forms_of, principal_curvatures
from tiskel.surfaces.tube import V_STOP, Tube, radius_of

AROUND, PER_SLICE = 96, 3  # vertices around the curve, and rows of them per slice
SAMPLES = 512  # of one section, for its area and perimeter


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh.

    Attributes
    ----------
    vertices : (p, 3) float64
        The corners, in the input's unit.
    triangles : (q, 3) int32
        Their rows, counter-clockwise seen from outside.
    trust : (p,) uint8 or None
        Of every corner: 2 where points say that it is there, 1 on a side of which there are none, 0 where slices were
        bridged and on caps; None where nothing is known of it.
    fields : mapping of str to (p,) array
        Further values of every corner, see :func:`fields_of`.
    """

    vertices: Points
    triangles: Edges
    trust: Labels | None = None
    fields: Mapping[str, npt.NDArray[np.generic]] = field(default_factory=dict)


def surface_mesh(surface: FittedSurface, *, caps: bool = False) -> Mesh:
    """Return a surface as triangles, closed around u, and along v if the curve is a loop.

    Parameters
    ----------
    surface : FittedSurface
        The surface.
    caps : bool
        Whether the ends of a surface that is no loop are closed by fans.

    Returns
    -------
    Mesh
    """
    closed = surface.tube.closed
    u, v = _places(surface)
    rows, grid = len(v), np.stack(surface.jet(u, v).f, axis=-1)
    number = np.arange(rows * AROUND, dtype=np.int32).reshape(rows, AROUND)
    after = np.roll(number, -1, axis=0) if closed else number[1:]
    here = number[: len(after)]
    corners = [here, np.roll(here, -1, axis=1), after, np.roll(after, -1, axis=1)]
    a, b, c, d = (corner.ravel() for corner in corners)
    triangles = [np.stack([a, b, d], axis=1), np.stack([a, d, c], axis=1)]
    vertices, trust = [grid.reshape(-1, 3)], surface.trust(u, v).ravel()
    if caps and not closed:
        trust = np.append(trust, [BRIDGED, BRIDGED])
        vertices.append(surface.tube.curve(np.array([0.0, V_STOP])))
        for row, tip in ((number[0, ::-1], rows * AROUND), (number[-1], rows * AROUND + 1)):
            triangles.append(np.stack([row, np.roll(row, -1), np.full(AROUND, tip)], axis=1))
    return Mesh(np.concatenate(vertices), np.concatenate(triangles).astype(np.int32), trust.astype(np.uint8))


def fields_of(surface: FittedSurface, number: int = 0, *, caps: bool = False) -> dict[str, npt.NDArray[np.generic]]:
    """Return what is known at every vertex of the mesh of a surface.

    Parameters
    ----------
    surface : FittedSurface
        The surface.
    number : int
        Its own, among several.
    caps : bool
        As in :func:`surface_mesh`; values in the middle of caps are NaN.

    Returns
    -------
    dict of str to (p,) array
        branch, the number; u and v, radians; radius, from the curve, in the input's unit; curvature_min and
        curvature_max, 1 / length, positive where convex.
    """
    u, v = _places(surface)
    jet = surface.jet(u, v)
    out = np.stack(jet.f, axis=-1) - surface.tube.curve(v.ravel()).reshape(*v.shape, 3)
    least, most = principal_curvatures(forms_of(jet))
    found = {"u": u, "v": v, "radius": np.linalg.norm(out, axis=-1), "curvature_min": least, "curvature_max": most}
    more = 2 if caps and not surface.tube.closed else 0
    known = {name: np.append(np.ravel(values), np.full(more, np.nan)) for name, values in found.items()}
    return {"branch": np.full(u.size + more, number, np.int32), **known}


def _places(surface: FittedSurface) -> tuple[Table, Table]:
    """Return u and v (r, AROUND) of the vertices of its mesh, a row for each place along the curve."""
    around, along = np.meshgrid(np.arange(AROUND) / AROUND * 2 * np.pi, row_places(surface))
    return around, along


def row_places(surface: FittedSurface) -> Numbers:
    """Return v (r,) of the rows of vertices of its mesh."""
    return np.linspace(0, V_STOP, PER_SLICE * len(surface.sections), endpoint=not surface.tube.closed)


def joined_mesh(meshes: list[Mesh]) -> Mesh:
    """Return several meshes as one, their vertices one after the other."""
    offsets = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    triangles = [mesh.triangles + offset for mesh, offset in zip(meshes, offsets[:-1], strict=True)]
    known = [mesh.trust for mesh in meshes if mesh.trust is not None]
    trust = np.concatenate(known) if len(known) == len(meshes) else None
    fields = {name: np.concatenate([mesh.fields[name] for mesh in meshes]) for name in meshes[0].fields}
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    return Mesh(vertices, np.concatenate(triangles).astype(np.int32), trust, fields)


def distances_to_mesh(points: Points, mesh: Mesh) -> Numbers:
    """Return (p,) the distance of each of points (p, 3) to the triangles around the vertex nearest to it."""
    nearest = cKDTree(mesh.vertices).query(points)[1]
    order = np.argsort(mesh.triangles.ravel(), kind="stable")
    starts = np.searchsorted(mesh.triangles.ravel()[order], np.arange(len(mesh.vertices) + 1))
    best = np.full(len(points), np.inf)
    sizes = (starts[1:] - starts[:-1])[nearest]
    for k in range(int(sizes.max(initial=0))):
        rows = np.flatnonzero(sizes > k)
        corners = mesh.vertices[mesh.triangles[order[starts[nearest[rows]] + k] // 3]]
        best[rows] = np.minimum(best[rows], _to_triangles(points[rows], corners))
    return best


def _to_triangles(points: Points, corners: Stack) -> Numbers:
    """Return (k,) the distances of points to triangles (k, 3, 3), one each."""
    sides = np.roll(corners, -1, axis=1) - corners
    offset = points[:, None] - corners
    square = np.maximum((sides**2).sum(axis=2), TINY)
    share = np.clip((offset * sides).sum(axis=2) / square, 0, 1)
    to_sides = np.linalg.norm(offset - share[..., None] * sides, axis=2).min(axis=1)
    normal = np.cross(sides[:, 0], sides[:, 1])
    inside = ((np.cross(sides, offset) * normal[:, None]).sum(axis=2) >= 0).all(axis=1)
    height = np.abs((offset[:, 0] * normal).sum(axis=1))
    height /= np.maximum(np.linalg.norm(normal, axis=1), TINY)
    return np.asarray(np.where(inside, height, to_sides))


def mesh_report(surface: FittedSurface) -> dict[str, float]:
    """Return mean, 95th percentile and maximum of the distance from fitted points to surface, in the input's unit."""
    off = distances_to_mesh(surface.cloud[surface.rows], surface_mesh(surface))
    return {"mean": float(off.mean()), "p95": float(np.quantile(off, 0.95)), "max": float(off.max())}


def slice_table(surface: FittedSurface) -> list[dict[str, object]]:
    """Return a row per slice: v, place, case, points, gap, unseen angle, error; area, perimeter, radius, ellipse."""
    return [_row(surface.name, number, surface.tube, section) for number, section in enumerate(surface.sections)]


def _row(branch: str, number: int, tube: Tube, section: Section) -> dict[str, object]:
    x, y, z = (float(c) for c in tube.curve(np.array([section.v]))[0])
    area, perimeter, longer, shorter = measures(tube.series, section.v)
    return {
        "branch": branch, "slice": number, "v": section.v, "x": x, "y": y, "z": z, "case": section.case.value,
        "points": section.points, "gap": section.gap, "unseen": section.unseen,
        "error": None if np.isnan(section.error) else section.error,
        "area": area, "perimeter": perimeter, "equivalent_radius": float(np.sqrt(area / np.pi)),
        "major": longer, "minor": shorter,
    }  # fmt: skip


def measures(series: BSplineCurve, v: float) -> tuple[float, float, float | None, float | None]:
    """Return what the section of a surface at one place measures, in the input's unit.

    Parameters
    ----------
    series : BSplineCurve
        The Fourier coefficients of the surface along v.
    v : float
        The place, from 0 to pi.

    Returns
    -------
    area : float
        Area of the section.
    perimeter : float
        Its perimeter.
    longer : float or None
        The longer semi-axis of its ellipse; None where none fits.
    shorter : float or None
        The shorter semi-axis.
    """
    u = np.arange(SAMPLES) / SAMPLES * 2 * np.pi
    r = radius_of([list(row) for row in series.at(v)], np.exp(1j * u))
    area = float((r.R**2).mean() * np.pi)
    perimeter = float(np.hypot(r.R, r.u).mean() * 2 * np.pi)
    ellipse = fit_ellipse(np.stack([r.R * np.cos(u), r.R * np.sin(u)], axis=1))
    axes = (None, None) if ellipse is None else (float(ellipse.axes[0]), float(ellipse.axes[1]))
    return area, perimeter, *axes
