"""A cloud of any size cut into files, in two passes and with little in memory."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Mask, Points, finite_rows
from tiskel.errors import TiskelError
from tiskel.io.pieces import Pieces, hash_of, pieces_of
from tiskel.io.streams import write_bytes
from tiskel.io.tile_index import CLOUDS, INDEX, Part, TileIndex, read_index
from tiskel.io.tile_writer import CloudFiles, document
from tiskel.params import SplitParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import SplitSettings
from tiskel.progress import Report, Span
from tiskel.tiles.cells import MOST, CellGrid, Counting
from tiskel.tiles.margin import overlap_of
from tiskel.tiles.objects import CellLookup, connecting, objects_of
from tiskel.tiles.tiling import Tiling, tiles_of

OBJECT_CELLS = 4 * MOST  # cells kept at most where objects are told apart by them
FIRST_PASS = 0.4  # of the time, about
MOST_ROWS = 2**31 - 1  # rows of a cloud that stage files can name
REST = "rest"
Dealt = Iterator[tuple[str, Points, npt.NDArray[np.int64], Mask]]


def split_cloud(
    source: str | Path, folder: str | Path, params: SplitParams | None = None, *, progress: Report | None = None,
    **settings: Unpack[SplitSettings],
) -> tuple[TileIndex, tuple[str, ...]]:  # fmt: skip
    """Cut a cloud into tiles or objects, each a file, with an index.

    Files are FOLDER/clouds/NAME.ply, binary PLY with two properties besides x, y
    and z: ``row``, the row in the source, and ``core``, 1 where the point is in
    the core of the tile. Every finite point is in exactly one core, or in
    exactly one object; FOLDER/rest.ply has those of objects that are too small.
    An index that is there is replaced together with its files.

    Parameters
    ----------
    source : str or Path
        A file; it is read twice.
    folder : str or Path
        Where to; made when absent.
    params : SplitParams, optional
        The settings.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the work.
    **settings
        Those of :class:`tiskel.SplitParams` by name; over those of params.

    Returns
    -------
    index : TileIndex
        What was made, as ``index.json`` says it.
    notes : tuple of str
        What to know of it.

    Raises
    ------
    TiskelError
        Where the file cannot be read, the folder not be written, or the settings do not fit the cloud.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from tiskel import ShapeParams, SplitParams, make_shape, shape_graph, split_cloud
    >>> from tiskel.io.clouds import dump_cloud
    >>> cloud, true = make_shape(shape_graph("capsule"), ShapeParams(count=1000))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "c.ply").write_bytes(dump_cloud(cloud, "c.ply"))
    ...     index, _ = split_cloud(f"{folder}/c.ply", f"{folder}/parts", SplitParams(points=600, overlap=0.2))
    >>> len(index.parts), sum(part.core for part in index.parts)
    (2, 1000)
    """
    params, span, path, target = (
        settled(SplitParams, params, settings),
        Span(progress, "split"),
        Path(source),
        Path(folder),
    )
    span.at(0, "counting")
    pieces = pieces_of(path)
    objects = params.parts == "objects"
    grid, rows, finite = _counted(pieces, params.gap if objects else None, OBJECT_CELLS if objects else MOST)
    clouds = _emptied(target)
    spacing, notes = grid.spacing(), pieces.notes
    span.at(FIRST_PASS, "writing")
    with CloudFiles(clouds) as files:
        if objects:
            gap, tiling = params.gap or (grid := connecting(grid, spacing)).side, None
            names, dealt = _objects(pieces, grid, params.least)
        else:
            gap, tiling = None, tiles_of(grid, params, params.overlap or overlap_of(grid, spacing))
            names = [f"t{tile:04}" for tile in range(len(tiling.cores()))]
            dealt = _tiles(pieces, tiling, names)
        extents = {name: _Extent() for name in (*names, REST)}
        for name, points, at, core in dealt:
            files.add(name, points, at, core)
            extents[name].add(points, core)
            span.at(FIRST_PASS + (1 - FIRST_PASS) * min(1.0, float(at[-1] + 1) / rows), "writing")
        hashes = files.finish()
    if REST in hashes:
        (clouds / f"{REST}.ply").replace(target / f"{REST}.ply")
    parts = tuple(extents[name].part(name, hashes[name]) for name in names)
    source_said = {"name": path.name, "sha256": hash_of(path)}
    index = TileIndex(
        source_said, rows, rows - finite, params, spacing, tiling, gap, parts, rest=extents[REST].core
    )  # fmt: skip
    write_bytes(target / INDEX, document(index.as_dict()))
    span.at(1)
    return index, (*notes, *_notes(index))


def _counted(pieces: Pieces, side: float | None, most: int) -> tuple[CellGrid, int, int]:
    """Return the cells of a cloud, its rows, and how many of them are finite."""
    counting, rows, finite = Counting(side, most), 0, 0
    for points in pieces.read():
        good = points[finite_rows(points)]
        counting.add(good)
        rows, finite = rows + len(points), finite + len(good)
    if rows > MOST_ROWS:
        raise TiskelError(f"{pieces.name} has {rows} rows, files name at most {MOST_ROWS}; cut it in two first")
    return counting.grid(), rows, finite


def _finite_pieces(pieces: Pieces) -> Iterator[tuple[Points, npt.NDArray[np.int64]]]:
    """Yield finite points and their rows."""
    first = 0
    for points in pieces.read():
        rows = np.flatnonzero(finite_rows(points))
        if len(rows):
            yield points[rows], rows + first
        first += len(points)


def _tiles(pieces: Pieces, tiling: Tiling, names: list[str]) -> Dealt:
    for points, rows in _finite_pieces(pieces):
        for tile, inside, core in tiling.deal(points):
            yield names[tile], points[inside], rows[inside], core


def _objects(pieces: Pieces, grid: CellGrid, least: int) -> tuple[list[str], Dealt]:
    """Return the names of the objects, and what goes into each."""
    labels = objects_of(grid)
    counts = np.bincount(labels, grid.counts)
    names = [f"o{number:04}" for number in range(int((counts >= least).sum()))]
    lookup = CellLookup(grid, labels)

    def dealt() -> Dealt:
        for points, rows in _finite_pieces(pieces):
            label = np.minimum(lookup.of(points), len(names))
            order = np.argsort(label, kind="stable")
            starts = np.flatnonzero(np.diff(label[order], prepend=-1))
            for inside in np.split(order, starts[1:]):
                name = [*names[label[inside[0]] :][:1], REST][0]
                yield name, points[inside], rows[inside], np.ones(len(inside), bool)

    return names, dealt()


class _Extent:
    """Counts and the box of the points of a core."""

    def __init__(self) -> None:
        self.points = self.core = 0
        self.low, self.high = np.full(3, np.inf), np.full(3, -np.inf)

    def add(self, points: Points, core: Mask) -> None:
        self.points, self.core = self.points + len(points), self.core + int(core.sum())
        if core.any():
            self.low = np.minimum(self.low, points[core].min(axis=0))
            self.high = np.maximum(self.high, points[core].max(axis=0))

    def part(self, name: str, sha256: str) -> Part:
        return Part(name, sha256, self.points, self.core, tuple(self.low.tolist()), tuple(self.high.tolist()))


def _emptied(folder: Path) -> Path:
    """Return the folder of the parts, made when absent, without the files and the index of an earlier split."""
    clouds = folder / CLOUDS
    try:
        if (folder / INDEX).is_file():
            old = read_index(folder)
            (folder / INDEX).unlink()
            for file in (*(clouds / f"{part.name}.ply" for part in old.parts), folder / f"{REST}.ply"):
                file.unlink(missing_ok=True)
        clouds.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise TiskelError(f"cannot make the folder {clouds}: {error.strerror}; choose another with -o") from None
    return clouds


def _notes(index: TileIndex) -> tuple[str, ...]:
    largest = max(part.core for part in index.parts) if index.parts else 0
    asked = index.settings.points
    if index.tiling and index.settings.size is None and largest > 1.5 * asked:
        return (
            f"tiles hold up to {largest} points without their margins, {asked} were asked for: none is narrower than "
            f"two overlaps of {index.tiling.overlap:.4g}; choose a smaller one with --overlap",
        )
    return ()
