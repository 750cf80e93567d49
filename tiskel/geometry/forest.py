"""Minimum spanning forests of links between labels, whatever their weights."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import minimum_spanning_tree

from tiskel.arrays import Indices, Numbers


def spanning_links(one: Indices, other: Indices, weights: Numbers) -> Indices:
    """Return which links between labels (m,) make a minimum spanning forest of them; of equal weights any.

    Parameters
    ----------
    one, other : (m,) int32
        The labels at both ends of every link, from 0 on.
    weights : (m,) float64
        Of any sign.

    Returns
    -------
    (k,) int32
        Ascending.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.forest import spanning_links
    >>> spanning_links(np.array([0, 1, 2]), np.array([1, 2, 0]), np.array([0.0, 5, -1])).tolist()
    [0, 2]
    """
    count = int(max(one.max(initial=0), other.max(initial=0))) + 1
    keys = np.minimum(one, other) * np.int64(count) + np.maximum(one, other)
    _, rows = np.unique(keys, return_index=True)
    ranks = np.argsort(np.argsort(weights[rows], kind="stable")) + 1.0  # a weight of zero would be no link
    links = sparse.coo_array((ranks, (one[rows], other[rows])), shape=(count, count))
    kept = minimum_spanning_tree(links.tocsr()).data
    return np.sort(rows[np.argsort(ranks)[kept.astype(np.intp) - 1]]).astype(np.int32)
