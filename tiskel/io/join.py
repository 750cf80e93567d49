"""Skeletons of the parts of a cloud, read from their files and made one."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Indices, Points
from tiskel.errors import TiskelError
from tiskel.geometry.doubt import CurveWarning, Severity
from tiskel.io import ply
from tiskel.io.stages.skeleton import parse_skeleton
from tiskel.io.streams import mapped
from tiskel.io.tile_index import CLOUDS, SKELETONS, Part, TileIndex, read_index
from tiskel.io.tile_writer import read_rows
from tiskel.params import JoinParams
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import JoinSettings
from tiskel.progress import Report, Span
from tiskel.skeleton import Skeleton
from tiskel.tiles.cells import Integers
from tiskel.tiles.join import doubts_of, joined, side_by_side, trimmed
from tiskel.tiles.web import Web, web_of

NAMES = ("{name}/skeleton.ply", "{name}.ply/skeleton.ply", "{name}.skeleton.ply", "{name}.ply")  #: of a part's skeleton
OF_CUTS = ("open-ends", "short", "small-parts")  #: what is said of a tile because limbs were cut open at its border
OF_TILES = ("loops", "in-air")  #: warnings of a whole cloud, of a tile notes: of limbs cut open and what bridges them
NAMED = 5  # parts that a message names


@dataclass(frozen=True, eq=False)
class _Read:
    """What is needed of the skeleton of a part: points that are kept, and the node of each."""

    skeleton: Skeleton
    points: Points
    rows: Indices
    node: Indices


def join_skeletons(
    folder: str | Path,
    params: JoinParams | None = None,
    skeletons: str | Path | None = None,
    *,
    progress: Report | None = None,
    **settings: Unpack[JoinSettings],
) -> tuple[Skeleton, TileIndex]:
    """Return the skeleton of a cloud from those of its tiles or objects.

    Curves of tiles are cut where two of them agree about the planes between
    them, and go on in one another; where one does not, a warning says so. The
    result holds points of the cloud, each with its row in the cloud, and its
    node: that of the tile it is in the core of, or the nearest where that node
    went to another tile.

    Parameters
    ----------
    folder : str or Path
        What ``tiskel split`` made, with ``index.json``.
    params : JoinParams, optional
        The settings.
    skeletons : str or Path, optional
        Where the skeletons are, FOLDER/skeletons when not given: NAME/skeleton.ply (as ``tiskel batch`` and
        ``tiskel run`` write it), NAME.skeleton.ply or NAME.ply, for the NAME of each part.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the work.
    **settings
        Those of :class:`tiskel.JoinParams` by name; over those of params.

    Returns
    -------
    skeleton : Skeleton
        In the cloud's unit; without contracted points.
    index : TileIndex
        Of the folder.

    Raises
    ------
    TiskelError
        Where a skeleton is missing, damaged or of another cloud than the part is.

    Examples
    --------
    >>> from tiskel import TiskelError, join_skeletons
    >>> try:
    ...     join_skeletons("nowhere")
    ... except TiskelError as error:
    ...     print(error)
    nowhere has no index.json; make it with: tiskel split IN -o nowhere
    """
    params, span = settled(JoinParams, params, settings), Span(progress, "join")
    span.at(0, "reading")
    index = read_index(folder)
    files, missing = _files(index, Path(skeletons) if skeletons else Path(folder) / SKELETONS)
    if missing and (not params.incomplete or not files):
        raise TiskelError(
            f"{_named(missing)} of {len(index.parts)} parts have no skeleton; run: tiskel batch {folder}/{CLOUDS} -o "
            f"{folder}/{SKELETONS}, or join what there is with --incomplete"
        )
    webs: dict[int, Web] = {}
    read: dict[int, _Read] = {}
    for done, (number, file) in enumerate(files.items()):
        span.at(0.8 * done / len(files), index.parts[number].name)
        one = _read(file, Path(folder) / CLOUDS / f"{index.parts[number].name}.ply", index.parts[number], index, params)
        webs[number], read[number] = _web(one.skeleton, number, index), replace(one, skeleton=_light(one.skeleton))
    span.at(0.8, "joining")
    web = side_by_side(webs.values()) if index.tiling is None else joined(webs, index.tiling)
    said = _said({number: one.skeleton for number, one in read.items()}, index, missing)
    if index.tiling is not None:
        said = [*doubts_of(web, index.tiling), *said]
    made = _skeleton(web, read, said)
    span.at(1)
    return made, index


def _files(index: TileIndex, folder: Path) -> tuple[dict[int, Path], list[str]]:
    """Return the files of the skeletons by number, and the names of the parts without one."""
    files: dict[int, Path] = {}
    for number, part in enumerate(index.parts):
        there = (folder / name.format(name=part.name) for name in NAMES)
        found = next((path for path in there if path.is_file()), None)
        if found is not None:
            files[number] = found
    return files, [part.name for number, part in enumerate(index.parts) if number not in files]


def _read(file: Path, cloud: Path, part: Part, index: TileIndex, params: JoinParams) -> _Read:
    """Return the skeleton of a part and the points of its core that are kept."""
    data = mapped(file)
    skeleton = parse_skeleton(data, str(file))
    source = ply.facts(ply.parse(data, file.name), "skeleton", file.name).get("source", {})
    if source.get("sha256", part.sha256) != part.sha256:
        raise TiskelError(f"{file} is the skeleton of another cloud than {cloud.name}; run its batch again")
    if len(skeleton.nodes) == 0:
        raise TiskelError(f"{file} is a skeleton without nodes; look at what was said when it was made")
    points, rows, core = read_rows(cloud)
    share = 1.0 if params.keep == "all" else min(1.0, params.keep / max(index.points, 1))
    chosen = np.flatnonzero(core & (np.floor((rows + 1) * share) > np.floor(rows * share)))
    return _Read(skeleton, points[chosen], rows[chosen], _nodes(skeleton, points, chosen))


def _nodes(skeleton: Skeleton, points: Points, chosen: Integers) -> Indices:
    """Return (k,) the node of chosen points of a part (n, 3): as the skeleton says, or the nearest."""
    at = skeleton.input_rows
    if np.array_equal(np.sort(at), np.arange(len(points))) and np.array_equal(points[at], skeleton.cloud):
        node = np.empty(len(points), np.int32)
        node[at] = skeleton.node_of_point
        return np.asarray(node[chosen])
    return np.asarray(cKDTree(skeleton.nodes).query(points[chosen])[1], np.int32)


def _web(skeleton: Skeleton, number: int, index: TileIndex) -> Web:
    if index.tiling is None:
        return web_of(skeleton, number)
    return trimmed(skeleton, number, index.tiling.cores()[number], index.tiling.overlap)


def _light(skeleton: Skeleton) -> Skeleton:
    """Return a skeleton without its cloud, of which there would be too much in memory."""
    none, nowhere = np.zeros(0, np.int32), np.zeros((0, 3))
    return replace(
        skeleton, node_of_point=none, cloud=nowhere, input_rows=none, contracted=nowhere, origin=nowhere, rows=none
    )


def _skeleton(web: Web, read: dict[int, _Read], said: Sequence[CurveWarning]) -> Skeleton:
    graph = web.graph()
    points = np.concatenate([one.points for one in read.values()])
    rows = np.concatenate([one.rows for one in read.values()])
    node = np.concatenate([_new_nodes(web, number, one) for number, one in read.items()])
    lost = np.flatnonzero(node < 0)
    node[lost] = cKDTree(graph.nodes).query(points[lost])[1]
    order = np.argsort(rows, kind="stable")
    settings = {repr(one.skeleton.params): one.skeleton.params for one in read.values()}
    none = np.zeros((0, 3))
    return Skeleton(
        nodes=graph.nodes, edges=graph.edges, radii=graph.radii, bridged=graph.bridged,
        radius_sources=graph.radius_sources, regimes=graph.regimes,
        node_of_point=node[order].astype(np.int32), cloud=points[order], input_rows=rows[order],
        contracted=none, origin=none, rows=np.zeros(0, np.int32),
        warnings=tuple(doubt for doubt in said if doubt.severity == "warning"),
        notes=tuple(doubt for doubt in said if doubt.severity == "note"),
        params=next(iter(settings.values())) if len(settings) == 1 else None,
    )  # fmt: skip


def _new_nodes(web: Web, number: int, one: _Read) -> Indices:
    """Return (k,) the nodes of the points of a part in the whole curve, -1 where they are none of it."""
    new = np.full(len(one.skeleton.nodes), -1, np.int32)
    mine = np.flatnonzero((web.tile == number) & (web.node >= 0))
    new[web.node[mine]] = mine
    return np.asarray(new[one.node])


def _said(skeletons: dict[int, Skeleton], index: TileIndex, missing: Sequence[str]) -> list[CurveWarning]:
    """Return what the parts say of their curves, each code once, and which of them are missing."""
    found = []
    if missing:
        text = f"{_named(missing)} of {len(index.parts)} parts are missing: nothing is known of the curve there"
        found.append(CurveWarning("missing", text, share=len(missing) / len(index.parts)))
    by_code: dict[tuple[str, Severity], list[CurveWarning]] = {}
    for number, skeleton in skeletons.items():
        for doubt in (*skeleton.warnings, *skeleton.notes):
            if _counts(doubt, index, number):
                by_code.setdefault((doubt.code, doubt.severity), []).append(doubt)
    for (code, severity), doubts in by_code.items():
        milder: Severity = "note" if index.tiling is not None and code in OF_TILES else severity
        worst = max(doubts, key=lambda doubt: doubt.share)
        places = tuple(place for doubt in doubts for place in doubt.places[:1])[:NAMED]
        text = f"in {len(doubts)} of {len(skeletons)} parts, in one of them: {worst.text}"
        found.append(CurveWarning(code, text, milder, worst.share, places))
    return found


def _counts(doubt: CurveWarning, index: TileIndex, number: int) -> bool:
    """Return whether a doubt is about the core of a part, not about limbs that were cut open at its border."""
    if index.tiling is None or not doubt.places:
        return index.tiling is None or doubt.code not in OF_CUTS
    low, high = index.tiling.cores()[number]
    places = np.array(doubt.places)
    return doubt.code not in OF_CUTS and bool(((places >= low) & (places < high)).all(axis=1).any())


def _named(names: Iterable[str]) -> str:
    first, *others = names
    more = len(others) - NAMED + 1
    return ", ".join([first, *others[: NAMED - 1]]) + (f" and {more} more" if more > 0 else "")
