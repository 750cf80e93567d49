"""Signs of normals, passed on from point to point (Hoppe et al. 1992)."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree

from tiskel.arrays import Indices, Lists, Numbers, Points
from tiskel.geometry.distinct import distinct


def propagated_signs(neighbours: Lists, normals: Points) -> tuple[Numbers, Indices]:
    """Return signs that make neighbouring normals agree.

    Along the minimum spanning tree of 1 - |n_i . n_j|, so that signs pass
    between points whose normals say most about each other.

    Parameters
    ----------
    neighbours : (n, k) int32
        The nearest of every point, itself first.
    normals : (n, 3) float64
        Unit vectors.

    Returns
    -------
    sign : (n,) float64
        1 or -1; which of the two a whole part has is arbitrary.
    part : (n,) int32
        The connected part of the neighbour graph that a sign holds in.
    """
    count = len(normals)
    i = np.repeat(np.arange(count), neighbours.shape[1] - 1)
    j = neighbours[:, 1:].ravel()
    keys = distinct(np.minimum(i, j) * np.int64(count) + np.maximum(i, j))
    i, j = (keys // count).astype(np.int32), (keys % count).astype(np.int32)  # all that older SciPy's trees take
    weight = 1 - np.abs(np.einsum("ij,ij->i", normals[i], normals[j])) + 1e-6  # zeros would be no edges
    tree = minimum_spanning_tree(sparse.coo_array((weight, (i, j)), shape=(count, count)).tocsr())
    _, part = connected_components(tree, directed=False)
    parent = np.arange(count)
    for root in np.unique(part, return_index=True)[1]:
        order, before = breadth_first_order(tree, root, directed=False)
        parent[order[1:]] = before[order[1:]]
    sign = np.where(np.einsum("ij,ij->i", normals, normals[parent]) < 0, -1.0, 1.0)
    while (parent != parent[parent]).any():  # pointer doubling: products of signs along the way to the root
        sign, parent = sign * sign[parent], parent[parent]
    return sign, part.astype(np.int32)
