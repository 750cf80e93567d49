"""How far tiles must overlap: by how thick bodies are, told from some of the cells that were counted.

Near the border of a tile a limb is cut open, and its curve is wrong there for
two or three of its radii. How thick limbs are nobody knows yet, so some cells
look along their normals to both sides for a surface that faces them. They do so
where the surface is flat at the size of the cells, as that of a limb of three
cells' radius is: thinner limbs are seen by smaller cells, and between limbs that
are thinner there is nothing to measure.
"""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import TINY, Numbers, Points
from tiskel.tiles.cells import CellGrid, Integers

MOST = 262_144  # cells of the finest size: thinner limbs are far thinner than the cloud
FEWEST = 64  # cells of the coarsest
LOOKED_AT = 2048  # cells of a size that are looked from
AROUND = 12  # means of cells that a normal is taken from, the cell itself included
FLAT = 0.03  # ratio of the two lesser variances: of a tube, (2 cells / radius)^2 / 16, so a radius of three cells
LINE = 0.1  # ratio of the two larger variances below which cells lie on a line
FLATTER = 0.7  # of the ratio of cells of half the side, at most, where noise hides a surface; a tube's is four times it
FACING = 0.3  # cosine of a look and the normal of the surface that it ends at, as in geometry.thickness
AHEAD = 0.8  # cosine of a look and the way to the mean that it ends at
WIDTH = 0.75  # of a cell: so near to a mean, a look ends there
FIRST, FARTHEST = 2.5, 16.0  # cells from where a look begins to where it ends
STEP = 0.5  # of a cell, that a look goes on at least
ENOUGH = 0.05  # share of the cells that see something; fewer look between limbs of less than three cells' radius
SHARE = 0.98  # of the cells have limbs that are no thicker; what looks between thin limbs is less than the rest
RADII = 4.0  # of the thickest limb that the margin is wide: half is for a curve cut open, half for joining
SPACINGS = 12.0  # that the margin is wide at least: four radii of a limb too thin to be measured
WIDEST = 0.2  # of the longest side of the cloud, at most: two tiles must have room for two each


def overlap_of(grid: CellGrid, spacing: float) -> float:
    """Return a width for the margin of tiles.

    Parameters
    ----------
    grid : CellGrid
        The cells of the cloud.
    spacing : float
        How far its points are apart.

    Returns
    -------
    float
        In the unit of the cells: four radii of the thickest limbs, twelve spacings at least.
    """
    extent = float(np.ptp(grid.means, axis=0).max())
    return float(min(max(RADII * radius_of(grid, spacing), SPACINGS * spacing), WIDEST * extent))


def radius_of(grid: CellGrid, spacing: float) -> float:
    """Return half of how thick the thickest limbs are; 0 where most are too thin, or too noisy, to be seen."""
    while grid.side < spacing or len(grid.counts) > MOST:
        grid = grid.coarser()
    half = half_thicknesses(grid)
    seen = np.isfinite(half)
    return float(np.quantile(np.where(seen, half, 0.0), SHARE)) if seen.mean() >= ENOUGH else 0.0


def half_thicknesses(grid: CellGrid) -> Numbers:
    """Return half the way from some cells to the nearer of the surfaces that face them, infinite where unknown.

    Where a surface is flat and sees nothing, or seems the flatter the larger the
    cells are, as noise does, larger cells are asked; a limb that is round at the
    size of the cells is thin, and stays unknown.

    Parameters
    ----------
    grid : CellGrid
        The smallest cells.

    Returns
    -------
    (k,) float64
        In the unit of the cells.
    """
    places = grid.means[:: -(-len(grid.means) // LOOKED_AT)]
    half, before, asked = np.full(len(places), np.inf), np.full(len(places), np.inf), np.arange(len(places))
    while len(asked) and len(grid.counts) >= FEWEST:
        sight = _Sight(grid)
        rows = sight.tree.query(places[asked])[1]
        normals, ratio = sight.normals(rows)
        flat = ratio < FLAT
        ways = [sight.look(rows[flat], way * normals[flat]) for way in (-1, 1)]
        half[asked[flat]] = np.minimum(*ways) / 2
        more = np.where(flat, ~np.isfinite(half[asked]), ratio < FLATTER * before[asked])
        before[asked] = ratio
        asked, grid = asked[more], grid.coarser()
    return half


class _Sight:
    """What is seen from the means of cells."""

    def __init__(self, grid: CellGrid) -> None:
        self.means, self.side, self.tree = grid.means, grid.side, cKDTree(grid.means)

    def normals(self, rows: Integers) -> tuple[Points, Numbers]:
        """Return the normals (k, 3) about cells (k,), of either sign, and how far from flat the surface is (k,)."""
        around = self.means[self.tree.query(self.means[rows], AROUND)[1]]
        centred = around - around.mean(axis=1, keepdims=True)
        variances, axes = np.linalg.eigh(np.einsum("kmi,kmj->kij", centred, centred))
        least, middle, most = variances.T
        ratio = least / np.maximum(middle, TINY)
        return axes[:, :, 0], np.where(middle > LINE * most, ratio, 1.0)

    def look(self, rows: Integers, directions: Points) -> Numbers:
        """Return (k,) how far it is from cells to the next surface that faces them in a direction."""
        places, seen = self.means[rows], np.full(len(rows), np.inf)
        way, left = np.full(len(rows), FIRST * self.side), np.arange(len(rows))
        while len(left):
            distance, nearest = self.tree.query(places[left] + way[left, None] * directions[left])
            hit = np.flatnonzero(distance < WIDTH * self.side)
            facing = np.abs(np.einsum("ij,ij->i", self.normals(nearest[hit])[0], directions[left[hit]])) > FACING
            offset = self.means[nearest[hit]] - places[left[hit]]
            ahead = np.einsum("ij,ij->i", offset, directions[left[hit]]) > AHEAD * np.linalg.norm(offset, axis=1)
            ends = hit[facing & ahead]
            seen[left[ends]] = way[left[ends]]
            way[left] += np.maximum(distance - WIDTH * self.side / 2, STEP * self.side)
            left = left[~np.isfinite(seen[left]) & (way[left] < FARTHEST * self.side)]
        return seen
