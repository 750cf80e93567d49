"""The stage file ``surface.json``: fitted surfaces and all that rolling on them needs. Format 1.

    {"tiskel": version of the writer, "stage": "surface", "format": 1, "source", "params",
     "rejected": {branch: reason}, "cloud": [[x, y, z], ...],
     "coverage": {"points", "length", "distance": {"mean", "p95", "max"}, "radii": {"mean", "p95", "max"}} or null,
     "surfaces": [{"branch", "nodes", "closed", "frame", "note", "length", "radius", "order", "error", "warnings",
                   "trimmed", "distance": {"mean", "p95", "max"}, "rows",
                   "axis", "field", "series": coefficients of quintic B-splines,
                   "unseen", "sections": [{"v", "case", "points", "gap", "gap_at", "error", "series"}, ...]}, ...],
     "body": the surface of the whole body, see :mod:`tiskel.io.stages.body`; null or absent where there is none}

Lengths are in the input's unit, angles in radians, rows count from 0 in
``cloud``. A spline with b rows of coefficients has b - 5 even intervals from
v = 0 to pi; of a closed surface the last five rows repeat the first five. The
columns of ``axis`` are x, y, z of the skeleton curve, of ``field`` those of m,
of ``series`` a0, a1, b1, a2, b2, ...; ``error`` is the RMS misfit over the mean
radius, ``distance`` that of the fitted points to the mesh of the surface. The
largest angle without a point of a slice is ``gap``, its middle ``gap_at``;
``unseen`` is the share of turn and length that lies in such sides. ``coverage``
tells of all points but stray ones: the share within a twentieth of the local
radius of a surface, distances, and the same in local radii; of the curve the
share of its length with a surface. Files of older versions have neither
``coverage`` nor ``gap_at`` and are read as before.
"""

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from tiskel.arrays import Points, Table
from tiskel.errors import TiskelError
from tiskel.geometry.bspline import DEGREE, BSplineCurve
from tiskel.io import ply
from tiskel.io.stages import door
from tiskel.io.stages.body import body_document, body_of
from tiskel.io.streams import read_bytes, write_bytes
from tiskel.params import SurfaceParams
from tiskel.slicing.fitted import Coverage, FittedSurface, Surfaces
from tiskel.slicing.sections import Case, Section
from tiskel.surfaces.tube import V_STOP, Tube
from tiskel.version import version

STAGE, FORMAT = "surface", 1


def write_surfaces(
    target: str | Path, surfaces: Surfaces, params: SurfaceParams | None = None, source: dict[str, str] | None = None
) -> None:
    """Write a stage file.

    Parameters
    ----------
    target : path, or "-" for standard output
        Where to.
    surfaces : Surfaces
        What is written.
    params : SurfaceParams, optional
        The settings that it was made with.
    source : dict, optional
        Name and SHA-256 of the input.

    Raises
    ------
    TiskelError
        Where the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from tiskel import ShapeParams, SurfaceParams, fit_surface, make_shape, shape_graph, write_surfaces
    >>> true = make_shape(shape_graph("banana"), ShapeParams(count=1000))[1]
    >>> params = SurfaceParams(interval=0.05)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_surfaces(f"{folder}/surface.json", fit_surface(true, params), params)
    """
    write_bytes(target, dump_surfaces(surfaces, params, source))


def dump_surfaces(
    surfaces: Surfaces, params: SurfaceParams | None = None, source: dict[str, str] | None = None
) -> bytes:
    """Return the bytes of a stage file, the same for the same surfaces; see :func:`write_surfaces`."""
    document = {
        "tiskel": version(),
        "stage": STAGE,
        "format": FORMAT,
        "source": source or {},
        "params": None if params is None else ply.plain(params),
        "rejected": surfaces.rejected,
        "coverage": None if surfaces.coverage is None else asdict(surfaces.coverage),
        "surfaces": [_surface_document(surface) for surface in surfaces],
        "cloud": surfaces.cloud.tolist(),
        "body": None if surfaces.body is None else body_document(surfaces.body),
    }
    return (json.dumps(document, allow_nan=False) + "\n").encode()


def _surface_document(s: FittedSurface) -> dict[str, Any]:
    return {
        "branch": s.name, "nodes": s.nodes.tolist(), "closed": s.tube.closed, "frame": s.frame, "note": s.note,
        "length": s.length, "radius": s.radius, "order": s.order, "error": s.error, "warnings": list(s.warnings),
        "trimmed": s.trimmed, "unseen": s.unseen, "distance": s.distance, "rows": s.rows.tolist(),
        "axis": s.tube.axis.coefficients.tolist(), "field": s.tube.field.coefficients.tolist(),
        "series": s.tube.series.coefficients.tolist(), "sections": [_section_document(one) for one in s.sections],
    }  # fmt: skip


def _section_document(section: Section) -> dict[str, Any]:
    error = None if np.isnan(section.error) else section.error
    return {
        "v": float(section.v), "case": section.case.value, "points": section.points, "gap": section.gap,
        "gap_at": None if np.isnan(section.gap_at) else section.gap_at, "error": error,
        "series": section.series.tolist(),
    }  # fmt: skip


def read_surfaces(source: str | Path) -> Surfaces:
    """Read a stage file.

    Parameters
    ----------
    source : str or Path
        A path, or "-" for standard input.

    Returns
    -------
    Surfaces

    Raises
    ------
    TiskelError
        Where the file is missing, damaged, or none of this stage.

    Examples
    --------
    >>> import tempfile
    >>> from tiskel import ShapeParams, SurfaceParams, fit_surface, make_shape, shape_graph
    >>> from tiskel import read_surfaces, write_surfaces
    >>> true = make_shape(shape_graph("banana"), ShapeParams(count=1000))[1]
    >>> surfaces = fit_surface(true, SurfaceParams(interval=0.05))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_surfaces(f"{folder}/surface.json", surfaces)
    ...     read_surfaces(f"{folder}/surface.json")[0].length == surfaces[0].length
    True
    """
    return parse_surfaces(read_bytes(source), str(source))


def parse_surfaces(data: bytes, name: str) -> Surfaces:
    """Return the surfaces in the bytes of a stage file.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        Its name, for messages.

    Raises
    ------
    TiskelError
        Where the file is damaged or none of this stage.
    """
    try:
        document = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise TiskelError(f"{name} is not a surface file: {error}; write one with tiskel slice") from None
    if not isinstance(document, dict) or document.get("stage") != STAGE:
        raise TiskelError(f"{name} is not a surface file; write one with tiskel slice")
    written = document.get("format")
    if not isinstance(written, int) or written > FORMAT:
        raise TiskelError(f"{name} has format {written}, this tiskel reads up to {FORMAT}; install a newer tiskel")
    try:
        cloud = _table(document["cloud"], "cloud", 3)
        surfaces = tuple(_surface_of(one, cloud) for one in document["surfaces"])
        coverage = _coverage_of(document.get("coverage"))
        rejected = {str(branch): str(reason) for branch, reason in document["rejected"].items()}
        body = None if document.get("body") is None else body_of(document["body"], cloud)
    except (KeyError, ValueError, TypeError, AttributeError, IndexError, OverflowError) as error:
        said = f"there is no {error}" if isinstance(error, KeyError) else f"{error}"
        raise TiskelError(f"{name} is a damaged surface file: {said}; run tiskel slice again") from None
    if not surfaces and body is None:
        raise TiskelError(f"{name} holds no surface; run tiskel slice again")
    return Surfaces(surfaces, rejected, cloud, coverage, body)


def _coverage_of(one: dict[str, Any] | None) -> Coverage | None:
    if one is None:
        return None
    distance, radii = ({key: float(one[name][key]) for key in ("mean", "p95", "max")} for name in ("distance", "radii"))
    return Coverage(float(one["points"]), float(one["length"]), distance, radii)


def _surface_of(one: dict[str, Any], cloud: Points) -> FittedSurface:
    closed = one["closed"] is True
    axis, field = (_strip(one, key, closed, 3) for key in ("axis", "field"))
    series = _strip(one, "series", closed)
    if len({len(strip.coefficients) for strip in (axis, field, series)}) > 1:
        raise ValueError("axis, field and series have different intervals")
    rows = door.numbered(door.listed(one["rows"], "rows"), "rows", "a row", len(cloud))
    return FittedSurface(
        tube=Tube(axis, field, series),
        name=str(one["branch"]),
        nodes=door.numbered(door.listed(one["nodes"], "nodes"), "nodes", "a node"),
        frame=str(one["frame"]),
        sections=tuple(_section_of(section) for section in one["sections"]),
        trimmed={str(case): int(count) for case, count in one["trimmed"].items()},
        rows=rows,
        error=_size(one, "error"),
        distance={key: _size(one["distance"], key) for key in ("mean", "p95", "max")},
        radius=_size(one, "radius"),
        length=_size(one, "length"),
        cloud=cloud,
        note=str(one["note"]),
        warnings=tuple(map(str, one["warnings"])),
    )


def _table(rows: Any, what: str, width: int | None = None) -> Table:
    """Return rows of so many finite numbers each, of the same number where none is said."""
    lengths = set(map(len, rows))
    if len(lengths) > 1 or (width is not None and not lengths <= {width}):
        raise ValueError(f"rows of {what} have {' or '.join(map(str, sorted(lengths)))} numbers")
    table = np.array(rows, np.float64).reshape(len(rows), -1 if rows else width or 1)
    return door.finite(table, what, "it")


def _size(holder: dict[str, Any], key: str) -> float:
    value = float(holder[key])
    if not 0 <= value < np.inf:
        raise ValueError(f"{key} is {value}, it must be a number of 0 or more")
    return value


def _strip(one: dict[str, Any], key: str, closed: bool, width: int | None = None) -> BSplineCurve:
    coefficients = _table(one[key], key, width)
    if len(coefficients) <= DEGREE or (width is None and coefficients.shape[1] % 2 == 0):
        raise ValueError(f"{key} has {coefficients.shape} coefficients; more than {DEGREE} rows are needed, a0 first")
    return BSplineCurve(coefficients, V_STOP, closed)


def _section_of(one: dict[str, Any]) -> Section:
    error = np.nan if one["error"] is None else _size(one, "error")
    series = _table([one["series"]], "series of sections")[0]
    gap_at = np.nan if one.get("gap_at") is None else float(one["gap_at"])
    return Section(float(one["v"]), Case(one["case"]), series, int(one["points"]), float(one["gap"]), error, gap_at)
