"""The methods that benchmarks/field.py compares: tiskel's own, a shortest-path tree, and PyGEL's local separators.

PyGEL3D (Bærentzen, Rotenberg: Skeletonization via local separators, ACM TOG 40, 2021) is not among the requirements;
`pip install --no-deps PyGEL3D` adds the column. Its input is a graph: here that of the nearest neighbours.
"""

import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from tiskel import ContractionParams, CurveGraph, contract, extract_skeleton
from tiskel.geometry.graph import node_radii, tidy_edges

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))  # the shortest-path tree is a reference of the tests

OWN = ("robust", "lbc", "gls")
PATH, PYGEL = "path", "pygel"
METHODS = (*OWN, PATH, PYGEL)
NEIGHBOURS = 20  # of PyGEL's graph: with 8 or 12 a torso of 4096 points has 59 to 459 ends, with 20 or 30 five
RAISED = 64  # its grow_thresh, the default


def missing(method: str) -> str | None:
    """Return why a method is not there, None where it is."""
    if method == PYGEL and not find_spec("pygel3d"):
        return "PyGEL3D is not installed"
    if method == PATH and not find_spec("reference.path_tree"):
        return "tests/reference/path_tree.py is not there"
    return None


def curve_of(cloud: np.ndarray, method: str) -> tuple[CurveGraph, tuple[object, ...]]:
    """Return the curve of a cloud and the method's warnings."""
    if method in OWN:
        found = extract_skeleton(contract(cloud, ContractionParams(method=method)))  # type: ignore[arg-type]
        return found, tuple(found.warnings)
    finite = np.unique(cloud[np.isfinite(cloud).all(axis=1)], axis=0)
    if method == PATH:
        from reference.path_tree import path_tree

        return path_tree(finite), ()
    return local_separators(finite), ()


def local_separators(cloud: np.ndarray) -> CurveGraph:
    """Return PyGEL's skeleton of a cloud (n, 3), by multi-scale local separators."""
    from pygel3d import graph as gel

    made = gel.Graph()
    for point in cloud:
        made.add_node(point)
    near = cKDTree(cloud).query(cloud, k=NEIGHBOURS + 1)[1]
    for a, others in enumerate(near):
        for b in others[1:]:
            made.connect_nodes(a, int(b))
    found = gel.MSLS_skeleton(made, RAISED)
    places, rows = np.array(found.positions()), {int(n): i for i, n in enumerate(found.nodes())}
    links = [(rows[int(a)], rows[int(b)]) for a in rows for b in found.neighbors(a)]
    nodes = places[list(rows)]
    edges = tidy_edges(np.array(links, np.int32).reshape(-1, 2))
    return CurveGraph(nodes, edges, node_radii(nodes, cloud, cKDTree(nodes).query(cloud)[1].astype(np.int32)))
