"""What `evaluate` needs, gathered from stage files, clouds and curves."""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from tiskel.arrays import Edges, Points
from tiskel.errors import TiskelError
from tiskel.io.clouds import load_cloud, parse_cloud
from tiskel.io.curves import load_curve, parse_curve
from tiskel.io.stages.contraction import parse_contraction
from tiskel.io.stages.skeleton import parse_skeleton
from tiskel.io.stages.which import stage_of
from tiskel.io.streams import read_bytes


@dataclass(frozen=True, eq=False)
class Measurable:
    """What :func:`tiskel.evaluate` measures, all in one unit; None where there is none.

    Attributes
    ----------
    name : str
        The name of the file that came first.
    cloud : (n, 3) float64
        The cloud; no row where there is none.
    points : (m, 3) float64 or None
        Skeletal points.
    origin : (m, 3) float64 or None
        Where they came from.
    nodes : (v, 3) float64 or None
        Nodes of the curve.
    edges : (e, 2) int32 or None
        The two nodes of every edge.
    """

    name: str
    cloud: Points = field(default_factory=lambda: np.zeros((0, 3)))
    points: Points | None = None
    origin: Points | None = None
    nodes: Points | None = None
    edges: Edges | None = None


def gather(
    skeleton: Path | None, cloud: Path | None = None, points: Path | None = None, curve: Path | None = None
) -> Measurable:
    """Read what there is; what is named on its own takes the place of what a stage file holds.

    Parameters
    ----------
    skeleton : Path or None
        A stage file, or a curve.
    cloud : Path, optional
        A cloud.
    points : Path, optional
        Skeletal points: a cloud, or a stage file, which brings their origin along.
    curve : Path, optional
        A curve.

    Returns
    -------
    Measurable

    Raises
    ------
    TiskelError
        Where in the end there is no cloud, or nothing to measure against it.
    """
    found = Measurable("") if skeleton is None else _parsed(read_bytes(skeleton), skeleton)
    if points is not None:
        found = _with_points(found, points)
    if curve is not None:
        read = load_curve(curve)
        found = replace(found, nodes=read.nodes, edges=read.edges, name=found.name or read.name)
    if cloud is not None:
        found = replace(found, cloud=load_cloud(cloud).points)
    if found.points is None and found.nodes is None:
        raise TiskelError("there is a cloud, but nothing to measure against it; name --points or --curve")
    if len(found.cloud) == 0:
        raise TiskelError(f"{found.name or 'the skeleton'} comes without its cloud; name it with --cloud")
    return found


def _parsed(data: bytes, path: Path) -> Measurable:
    """Return what a stage file holds, or a curve."""
    name = path.name
    stage = stage_of(data)
    if stage == "skeleton":
        s = parse_skeleton(data, str(path))
        some = len(s.contracted) > 0
        return Measurable(name, s.cloud, s.contracted if some else None, s.origin if some else None, s.nodes, s.edges)
    if stage == "contraction":
        c = parse_contraction(data, str(path))
        return Measurable(name, c.cloud, c.points, c.origin)
    read = parse_curve(data, path)
    return Measurable(name, nodes=read.nodes, edges=read.edges)


def _with_points(found: Measurable, path: Path) -> Measurable:
    """Return the same with skeletal points of a file; a stage file brings their origin, and a cloud where none is."""
    data, name = read_bytes(path), found.name or path.name
    if stage_of(data) not in ("contraction", "skeleton"):
        return replace(found, points=parse_cloud(data, path).points, origin=None, name=name)
    held = _parsed(data, path)
    cloud = found.cloud if len(found.cloud) else held.cloud
    return replace(found, points=held.points, origin=held.origin, cloud=cloud, name=name)
