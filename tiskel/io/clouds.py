"""Clouds from files of many formats, or from standard input."""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Edges, Points
from tiskel.errors import TiskelError
from tiskel.geometry.mesh_facts import MeshFacts
from tiskel.geometry.mesh_sample import sample_mesh
from tiskel.geometry.mesh_surface import MeshSurface
from tiskel.io.formats import format_of, text, writer_of
from tiskel.io.formats.base import Parsed
from tiskel.io.limits import unpacked
from tiskel.io.streams import STANDARD, read_bytes
from tiskel.shown import Shown


@dataclass(frozen=True, eq=False, repr=False)
class Cloud(Shown):
    r"""A point cloud as it was read.

    Attributes
    ----------
    points : (n, 3) float64
        In the file's units; rows may be NaN or Inf.
    properties : mapping of str to (n,) array
        Further columns of the file by name.
    name : str
        The file's name without folders; "stdin" for standard input.
    sha256 : str
        Of the file.
    warnings : tuple of str
        What had to be decided while reading.
    notes : tuple of str
        What was done, and is no reason to worry: what a mesh is, and to how many points it was sampled.
    mesh : MeshFacts or None
        Counts of the mesh that the points lie on.
    surface : MeshSurface or None
        What that mesh knows about each point; for :func:`tiskel.contract`.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from tiskel import load_cloud
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "c.csv").write_text("x,y,z,intensity\n0,0,0.5,7\n1,0,0.5,8\n")
    ...     cloud = load_cloud(f"{folder}/c.csv")
    >>> cloud.name, cloud.points.shape, cloud.properties["intensity"].tolist()
    ('c.csv', (2, 3), [7.0, 8.0])
    """

    _said = ("name", "points", "properties", "warnings")

    points: Points
    properties: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)
    name: str = ""
    sha256: str = ""
    warnings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    mesh: MeshFacts | None = None
    surface: MeshSurface | None = None

    @property
    def source(self) -> dict[str, str]:
        """What a stage file records of its input: a name and a hash, no path and no time."""
        return {"name": self.name, "sha256": self.sha256}

    def of_classes(self, classes: Sequence[int]) -> "Cloud":
        """Return the points whose property "classification" is one of the classes, and their properties.

        Raises
        ------
        TiskelError
            Where there is no such property, or no such point.
        """
        if "classification" not in self.properties:
            raise TiskelError(f"{self.name} says no classification of its points; leave --classification out")
        found = self.properties["classification"]
        kept = np.isin(found, list(classes))
        if not kept.any():
            there = ", ".join(f"{value:g}" for value in np.unique(found)[:12].tolist())
            raise TiskelError(f"{self.name} has no point of class {', '.join(map(str, classes))}; it has {there}")
        properties = {name: values[kept] for name, values in self.properties.items()}
        note = f"{kept.sum()} of {len(kept)} points are of class {', '.join(map(str, classes))}"
        return replace(self, points=self.points[kept], properties=properties, notes=(*self.notes, note))


def load_cloud(
    source: str | Path,
    *,
    mesh_samples: int | None = None,
    seed: int = 0,
    columns: Sequence[str] | None = None,
    classification: Sequence[int] | None = None,
) -> Cloud:
    r"""Read a cloud; a mesh is sampled to points.

    Parameters
    ----------
    source : str or Path
        A path (PLY, XYZ, PTS, CSV, TSV, TXT, PTX, NPY, NPZ, PCD, LAS, LAZ, E57, OFF, OBJ, STL; each also packed by
        gzip), or "-" for standard input. Where the suffix does not say what it is, the first bytes do.
    mesh_samples : int, optional
        Points to sample a mesh to; without it as many as its thickness asks for, 4096 to 32768.
    seed : int
        Of that sampling.
    columns : sequence of three str, optional
        Of a text file: the columns of x, y and z, by name or counted from 1.
    classification : sequence of int, optional
        Keep the points of these classes, of a file with a property "classification" such as LAS.

    Returns
    -------
    Cloud

    Raises
    ------
    TiskelError
        Where the file is missing, damaged, empty or of an unknown kind.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from tiskel import load_cloud
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "c.xyz").write_text("0 0 0.5\n1 0 0.5\n")
    ...     load_cloud(f"{folder}/c.xyz").points.tolist()
    [[0.0, 0.0, 0.5], [1.0, 0.0, 0.5]]
    """
    cloud = parse_cloud(read_bytes(source), source, mesh_samples=mesh_samples, seed=seed, columns=columns)
    return cloud if classification is None else cloud.of_classes(classification)


def parse_cloud(
    data: bytes,
    source: str | Path,
    *,
    mesh_samples: int | None = None,
    seed: int = 0,
    columns: Sequence[str] | None = None,
) -> Cloud:
    """Return the cloud in the bytes of a file.

    Parameters
    ----------
    data : bytes
        What the file holds.
    source : str or Path
        Where it was read from; the suffix says of which kind it is, "-" that the bytes do.
    mesh_samples : int, optional
        Points to sample a mesh to; without it as many as its thickness asks for, 4096 to 32768.
    seed : int
        Of that sampling.
    columns : sequence of three str, optional
        Of a text file: the columns of x, y and z, by name or counted from 1.

    Returns
    -------
    Cloud

    Raises
    ------
    TiskelError
        Where the bytes are damaged, hold no points or are of an unknown kind.
    """
    name = "stdin" if str(source) == STANDARD else Path(source).name
    if not data:
        raise TiskelError(f"{name} is empty; check how it was made")
    plain, inner = unpacked(data, name)
    parsed = _parsed(plain, inner, name, str(source) == STANDARD, columns)
    if len(parsed.points) == 0:
        raise TiskelError(f"{name} holds no points; check how it was made")
    cloud = Cloud(parsed.points, parsed.properties, name, hashlib.sha256(data).hexdigest(), parsed.warnings)
    return _sampled(cloud, parsed.faces, mesh_samples, seed) if len(parsed.faces) else cloud


def _parsed(data: bytes, inner: str, name: str, by_content: bool, columns: Sequence[str] | None) -> Parsed:
    """Return what the reader of the file's type makes of it."""
    kind = format_of(inner, data, by_content=by_content)
    if columns is None:
        return kind.parse(data, name)
    if kind.read is not text.read:
        raise TiskelError(f"{name}: columns are chosen in text, {kind.name} names its own; leave --columns out")
    return text.read(data, name, columns)


def _sampled(cloud: Cloud, faces: Edges, count: int | None, seed: int) -> Cloud:
    """Return a mesh as points, and what there is to say about it."""
    finite = np.asarray(np.isfinite(cloud.points).all(axis=1))
    whole = finite[faces].all(axis=1)
    if not whole.all():
        said = (
            f"{cloud.name}: {np.sum(~whole)} of {len(faces)} faces have corners that are not finite and were left out"
        )
        cloud, faces = replace(cloud, warnings=(*cloud.warnings, said)), faces[whole]
    if len(faces) == 0:
        raise TiskelError(f"{cloud.name} has no face whose corners are finite; export it again")
    found = sample_mesh(np.where(np.isfinite(cloud.points), cloud.points, 0), faces, count, seed)
    asked = "as asked" if count else f"its thickness asks for {found.wanted}; choose with --sample"
    remarks = (
        f"{cloud.name} is a mesh: {found.facts}",
        f"sampled to {len(found.points)} points, closer where it is thin ({asked})",
        f"{found.hidden} points inside other parts are left out: parts that run into each other are one body"
        if found.hidden
        else "",
        "" if found.surface else "its faces hardly hang together; what is connected follows from the points alone",
    )
    notes = tuple(filter(None, remarks))
    return replace(cloud, points=found.points, properties={}, notes=notes, mesh=found.facts, surface=found.surface)


def dump_cloud(points: Points, target: str | Path) -> bytes:
    """Return the bytes of a cloud file.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud.
    target : str or Path
        Where it is to go: the suffix says in which format; PLY for standard output.

    Raises
    ------
    TiskelError
        Where clouds are not written in this format.
    """
    return writer_of(".ply" if str(target) == STANDARD else Path(target).suffix)(points)
