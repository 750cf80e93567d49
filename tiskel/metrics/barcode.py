"""Barcodes of points: H0 of the Vietoris-Rips filtration, H1 of the Delaunay-Rips complex.

The deaths in H0 are the edge lengths of the Euclidean minimum spanning tree, in double precision; no triangulation is
needed for them. In H1 the flag complex of the Delaunay graph is the Delaunay-Rips complex (Mishra and Motta 2023),
close to the Vietoris-Rips complex though not equal to it.
"""

from dataclasses import dataclass
from importlib import import_module
from itertools import combinations

import numpy as np
from scipy import sparse
from scipy.spatial import Delaunay

from tiskel.arrays import FLATNESS, TINY, Edges, Numbers, Points, Table
from tiskel.extras import extra
from tiskel.geometry.distinct import distinct
from tiskel.geometry.graph import edge_lengths
from tiskel.geometry.spanning import spanning_tree

PRIME = 2  # of the field of the coefficients: what a loop is does not hang on its direction
NO_CYCLES: Table = np.zeros((0, 2))


@dataclass(frozen=True, eq=False)
class Barcode:
    """Persistent homology of a set of points, in their unit.

    Attributes
    ----------
    deaths : (n - 1,) float64
        Deaths in H0, longest first. Bars of length zero, which coincident points make, are counted in; the infinite
        bar is left out.
    cycles : (b, 2) float64
        Births and deaths in H1 of the Delaunay-Rips complex, by falling ratio of death to birth; no row where loops
        were not asked for.
    """

    deaths: Numbers
    cycles: Table


def barcode(points: Points, *, loops: bool = False) -> Barcode:
    """Return the barcode of points.

    Parameters
    ----------
    points : (n, 3) float64
        The points, in any unit.
    loops : bool
        Whether H1 is computed beside H0.

    Returns
    -------
    Barcode
        In the unit of the points; without bars where there are fewer than two points.

    References
    ----------
    A. Mishra, F. Motta: Stability and machine learning applications of persistent homology using the Delaunay-Rips
    complex, 2023.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.metrics.barcode import barcode
    >>> barcode(np.array([[0, 0, 0], [1, 0, 0], [4.0, 0, 0]])).deaths.tolist()
    [3.0, 1.0]
    """
    deaths = spanning_tree(points).lengths[::-1]
    return Barcode(deaths, _cycles(points) if loops and len(points) > 1 else NO_CYCLES)


def _cycles(points: Points) -> Table:
    """Return births and deaths in H1, by falling ratio."""
    edges = delaunay_edges(points)
    lengths = edge_lengths(points, edges)
    distances = sparse.coo_matrix((lengths, (edges[:, 0], edges[:, 1])), shape=(len(points), len(points)))
    bars = _rips_cycles(distances.tocsr())
    return np.asarray(bars[np.argsort(-bars[:, 1] / bars[:, 0], kind="stable")])


def _rips_cycles(distances: sparse.csr_array) -> Table:
    """Return births and deaths in H1 of a flag complex, from the upper triangle of its distances.

    By the compiled part of ripser alone: the module about it takes a second to import scikit-learn and pandas, for
    other things. Where a release has that part otherwise, by the module.
    """
    edges, count = distances.tocoo(), distances.shape[0]
    lengths = edges.data.astype(np.float32)
    try:
        core = import_module("pyRipser").doRipsFiltrationDMSparse
        found = core(edges.row.astype(np.int32), edges.col.astype(np.int32), lengths, count, 1, np.inf, PRIME, 0)
        bars = found["births_and_deaths_by_dim"][1]
    except (ImportError, AttributeError, TypeError, KeyError):
        bars = extra("ripser", "H1").ripser(distances, maxdim=1, distance_matrix=True, coeff=PRIME)["dgms"][1]
    return np.asarray(bars, np.float64).reshape(-1, 2)


def delaunay_edges(points: Points) -> Edges:
    """Return (e, 2) int32, the edges of the Delaunay triangulation of points (n, 3), lower row first.

    A point that the triangulation leaves out, because it coincides with
    another, is joined to that one. Points on a plane or a line are triangulated
    there.
    """
    flat = _within_span(points)
    if flat.shape[1] <= 1:
        order = np.argsort(flat[:, 0] if flat.shape[1] else np.zeros(len(flat)), kind="stable")
        edges = np.stack([order[:-1], order[1:]], axis=1)
    else:
        made = Delaunay(flat)
        pairs = [made.simplices[:, list(pair)] for pair in combinations(range(flat.shape[1] + 1), 2)]
        edges = np.concatenate([*pairs, made.coplanar[:, [0, 2]]])
    edges = np.sort(edges, axis=1).astype(np.int64)
    keys = distinct(edges[:, 0] * len(points) + edges[:, 1])
    return np.stack([keys // len(points), keys % len(points)], axis=1).astype(np.int32)


def _within_span(points: Points) -> Table:
    """Return coordinates (n, r) in the span of the points, r below 3 where they are flat to rounding."""
    centred = points - points.mean(axis=0)
    _, singular, axes = np.linalg.svd(centred, full_matrices=False)
    rank = int((singular > FLATNESS * max(singular[0], TINY)).sum()) if singular[0] > 0 else 0
    return centred if rank == 3 else np.asarray(centred @ axes[:rank].T)
