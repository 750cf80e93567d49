"""How large the cells are that the points of a large cloud go into: as the surface about each allows, and few enough.

Cells of doubling size, from a few points to whole limbs, are looked at
together with the eleven nearest of their size: the ratio of the two lesser
variances of all their points says how flat the surface is at that size. Of a
clean tube it is a sixteenth of the squared ratio of the neighbourhood's radius to
the tube's, so it grows with the size of the cells; of noise it is near one and
falls, until the surface emerges. Every place takes the largest cells that are
still flat, or, where noise leaves none flat, the smallest that are nearly as flat
as any. A gap between two sheets, a twig, an edge are not flat at cells of their
own size, so that smaller cells keep them, or single points. So do wires, and wires
across each other, which are flat, but hold twice as many points in cells of twice the
size, where a surface holds four times as many.

Where that leaves too many, the smallest cells grow, those of twigs, wires and edges, to one size all over the cloud, as
the wire regime goes by one spacing. The curve of wires is the better for it: of a crossing of two wires with 262 144
points chance has made 9524 ends. Bodies do with fewer points than thin limbs, and time grows with the points.
"""

import numpy as np

from tiskel.arrays import TINY, Indices, Lists, Numbers, Points, Table
from tiskel.geometry.cells import numbered
from tiskel.geometry.neighbours import nearest_neighbours, principal_axes
from tiskel.geometry.spacing import SAMPLED, spacing_of
from tiskel.methods.robust.axes import sums

# Points; clouds of no more are taken as they are [12 000: bodies take half the time, a seedling's curve is in the air],
# larger ones thinned to no more [30 000: wires get more ends].
ENOUGH = 20_000
OF_BODY = 0.45  # share of the points of a body that are left at most; all of thin limbs [of trees too: F is 1 % less]
MANY = 0.15  # share of points on thin limbs from which on a cloud is of these: bodies have 0 to 0.04, trees 0.18 to 0.9
A_POINT = 0.05  # cells for every point of a surface, at most: six times the tree's query leaves time for no more

# Found by trial on a half torus, trunks with noise of a tenth and a quarter, and shapes of the gallery, 30 000 to
# 262 144 points; on wires and thin trees of 65 536 and 262 144.
AROUND = 12  # cells whose points are looked at together, the cell itself included
FINEST = 1.75  # spacings: side of the smallest cells [2: fingers of a hand touch at 100 000; 1.5: noisy trunks wobble]
# Ratio of the lesser variances; flatter cells may be larger: their side is a sixth of a tube's radius [a quarter: ends
# of a thick body with knobs were lost].
FLAT = 0.006
RESOLVED = 0.06  # the same of limbs thick enough to have a surface: the side of the smallest cells is half a radius
NEARLY = 2.2  # times the least ratio of all sizes, for a size to be as good as any
SHAPELESS = 0.6  # ratio that no size of cells is below, as where there is no surface: nothing is thinned
VOLUME = 0.8  # ratio above which cells show a volume of noise, not yet the surface in it
FEW = 3.2  # a volume of N points seems flatter than it is, by 1 + FEW / sqrt(N); measured on 12 to 700 points
LINEAR = 0.6  # (s1 - s2) / s1 of the root variances: larger is a wire, which says nothing of a surface
MOSTLY = 0.5  # share of the cells about a cell that are linear, from which on it is of a wire
GROWTH = 2**1.5  # times as many points in cells of twice the size, between a wire's two and a surface's four
ALMOST = 0.9  # of the most cells: how many are asked for, by what their number falls with
FULL = 3  # points to a cell, above which that can be seen: cells of one point each hold one at twice the size, too
SIZES = 12  # of cells at most, each twice as large as the last
FEWEST = 40  # cells of a size that are looked at
# Fewer cells of a size may be as large as limbs, and in one plane as flat at that [40: plates and persons scanned from
# one side lost bars and arms; 800: the same curves].
LIMBS = 400
CREASE = 0.3  # ratio at a crease, whatever the size of the cells, at most; a right angle has 0.25
FINER = 2  # sizes that the cells at a crease may be smaller than those about them
CHUNK = 65_536  # cells whose neighbourhoods are summed at once, to bound memory


def cells_of(points: Points, most: int | None = None) -> Indices:
    """Return the number (n,) of the cell that each point goes into, from 0; so many at most, if that is given.

    points (n, 3) are in their own axes.
    """
    side = FINEST * spacing_of(points, most=SAMPLED)
    ratios, doubt, cells = _sizes(points, side)
    size = _levelled(_chosen(ratios, doubt), ratios, cells)
    if most is None:
        most = _enough(ratios, size)
    size, cells = _few_enough(points, size, cells, side, most)
    key = np.take_along_axis(cells, size[None], axis=0)[0] * (len(cells) + 1) + size
    return np.unique(key, return_inverse=True)[1].ravel().astype(np.int32)


def _enough(ratios: Table, size: Indices) -> int:
    """Return how many points are enough, by how flat cells are (s, n) and by the sizes chosen (n,)."""
    smallest = np.where(np.isinf(ratios[0]), np.inf, ratios[1])  # wires side by side are flat, each a line
    of_surface = (size > 0) | (smallest <= RESOLVED)
    thin = min(float((~of_surface & (smallest > CREASE)).mean()) / MANY, 1.0)
    return int(min((OF_BODY + thin * (1 - OF_BODY)) * len(size), ENOUGH + A_POINT * of_surface.sum()))


def _sizes(points: Points, side: float) -> tuple[Table, Table, Lists]:
    """Return (s, n) for every size of cells how flat it is about each point, its doubt, and each point's cell.

    Linear is inf, as what grows like lines and what few cells show; the doubt is
    what few points in a volume would have to be multiplied by. The first size,
    points alone, is looked at only where the next is not flat; elsewhere it
    counts as no flatter than that.
    """
    corner = np.floor((points - points.min(axis=0)) / side).astype(np.int64)
    totals = np.concatenate([np.ones((len(points), 1)), points, _products(points)], axis=1)
    cell: Indices = np.arange(len(points), dtype=np.int32)
    ratios, cells, many = list[Numbers](), [cell], list[Numbers]()
    before = np.ones(len(points))  # points to the cells about each, of the size before
    for number in range(SIZES):
        corner, into = numbered(corner)
        if len(corner) < FEWEST and number:
            break
        totals = sums(totals, into, len(corner))
        cell = into[cell]
        around = min(AROUND, len(corner))
        nearest = nearest_neighbours(np.ascontiguousarray(totals[:, 1:4] / totals[:, :1]), around)[0]
        flatness, inside = _flatness(_variances(totals, nearest), nearest), totals[nearest, 0].sum(axis=1)
        usual = inside[nearest].mean(axis=1)
        if number == 0:
            ratios, many = [_alone(points, cell, flatness, nearest)], [np.where(flatness > FLAT, AROUND, inside)[cell]]
        else:
            fewer = np.bincount(into, before) / np.bincount(into)
            of_lines = (fewer > FULL * AROUND) & (usual < GROWTH * fewer)
            flatness[of_lines | (len(corner) < LIMBS)] = np.inf
        before = usual
        ratios.append(flatness[cell])
        cells.append(cell)
        many.append(inside[cell])
        corner //= 2
    return np.array(ratios), 1 + FEW / np.sqrt(np.array(many)), np.array(cells)


def _alone(points: Points, cell: Indices, flatness: Numbers, nearest: Lists) -> Numbers:
    """Return (n,) how flat the surface is about each point alone; in flat cells as flat as they are.

    flatness (m,) is that of the cells, nearest (m, k) are the cells about each.
    """
    out, bent = flatness[cell], flatness > FLAT
    about = np.zeros(len(bent), bool)
    about[nearest[bent]] = True  # a point's neighbours are there
    rows = np.flatnonzero(about[cell])
    if len(rows) < AROUND:
        return out
    few = np.ascontiguousarray(points[rows])
    next_to = nearest_neighbours(few, AROUND)[0]
    own = bent[cell[rows]]
    out[rows[own]] = _flatness(principal_axes(few, next_to)[0], next_to)[own]
    return out


def _products(points: Points) -> Table:
    return np.asarray((points[:, :, None] * points[:, None, :]).reshape(-1, 9))


def _variances(totals: Table, nearest: Lists) -> Table:
    """Return (m, 3) the descending variances of all points in the cells (m, k) about each; totals (m, 13) of each."""
    found = []
    for start in range(0, len(nearest), CHUNK):
        total = totals[nearest[start : start + CHUNK]].sum(axis=1)
        mean = total[:, 1:] / total[:, :1]
        found.append(np.linalg.eigvalsh((mean[:, 3:] - _products(mean[:, :3])).reshape(-1, 3, 3))[:, ::-1])
    return np.asarray(np.maximum(np.concatenate(found), 0))


def _flatness(variances: Table, nearest: Lists) -> Numbers:
    """Return (m,) the ratio of the lesser variances, in the mean over the cells about each; inf where linear."""
    ratio = variances[:, 2] / np.maximum(variances[:, 1], TINY)
    root = np.sqrt(np.maximum(variances[:, :2], 0))
    linear = root[:, 1] < (1 - LINEAR) * root[:, 0]
    ratio = ratio[nearest].mean(axis=1)
    ratio[linear[nearest].mean(axis=1) > MOSTLY] = np.inf
    return np.asarray(ratio)


def _chosen(ratios: Table, doubt: Table) -> Indices:
    """Return (n,) the size of the cells that each point goes into, 0 for itself alone."""
    known = np.cumprod(np.isfinite(ratios), axis=0).astype(bool)  # what is linear stays so at larger sizes
    ratios = np.where(known, ratios, np.inf)
    flat = ratios <= FLAT
    first = flat.argmax(axis=0)
    after = np.arange(len(ratios))[:, None] >= first
    last = np.cumprod(np.where(after, flat, True), axis=0).sum(axis=0) - 1
    ratios = ratios * doubt
    least = ratios.min(axis=0)
    nearly = (ratios <= np.minimum(NEARLY * least, VOLUME)).argmax(axis=0)
    chosen = np.where(flat.any(axis=0), last, np.where(least < SHAPELESS, nearly, 0))
    return np.asarray(chosen, np.int64)


def _levelled(size: Indices, ratios: Table, cells: Lists) -> Indices:
    """Return the sizes (n,), not much smaller at creases than about them: bands of single points look like wires."""
    about = cells[min(int(np.median(size)) + 1, len(cells) - 1)]
    usual = (np.bincount(about, size) / np.bincount(about))[about]
    least = np.maximum(np.floor(usual).astype(np.int64) - FINER, 0)
    there = np.take_along_axis(ratios, least[None], axis=0)[0]
    return np.where(there < CREASE, np.maximum(size, least), size)


def _few_enough(points: Points, size: Indices, cells: Lists, side: float, most: int) -> tuple[Indices, Lists]:
    """Return sizes (n,) and cells, the smallest as large, all over the cloud, as it takes for so many at most.

    Between two sizes there is one more, by how the number of cells falls from one to the next.
    """
    counts = [_count(size, cells)]
    while counts[-1] > most and len(counts) < len(cells):
        counts.append(_count(np.maximum(size, len(counts)), cells))
    least = len(counts) - 1
    if least == 0 or counts[-1] > most:
        return np.maximum(size, least), cells
    share = np.log(counts[-2] / (ALMOST * most)) / np.log(counts[-2] / counts[-1])
    between = side * 2 ** (least - 2 + min(max(float(share), 0.0), 1.0))
    one_more = numbered(np.floor((points - points.min(axis=0)) / between).astype(np.int64))[1]
    finer, with_it = np.where(size < least, len(cells), size), np.concatenate([cells, one_more[None]])
    return (finer, with_it) if _count(finer, with_it) <= most else (np.maximum(size, least), cells)


def _count(size: Indices, cells: Lists) -> int:
    """Return how many cells points of these sizes (n,) go into."""
    count = 0
    for number in np.unique(size).tolist():
        used = np.zeros(len(size), bool)
        used[cells[number][size == number]] = True
        count += int(used.sum())
    return count
