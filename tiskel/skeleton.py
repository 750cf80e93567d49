"""The stage ``skeleton``: a contracted cloud in, a curve skeleton out."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import networkx

from tiskel.arrays import Indices, Numbers, Points, diagonal, normalisation
from tiskel.contraction import Contraction
from tiskel.errors import TiskelError
from tiskel.geometry import graph
from tiskel.methods.laplacian.collapse import collapse_triangles, inherited_edges
from tiskel.methods.laplacian.sampling import front_samples
from tiskel.methods.robust.checks import doubts
from tiskel.methods.robust.network import own_axes
from tiskel.methods.robust.pipeline import build, nodes_of_points
from tiskel.params import SkeletonParams


@dataclass(frozen=True)
class Skeleton:
    """A curve skeleton and the cloud it stands for; coordinates in the input's units.

    Attributes
    ----------
    nodes : (v, 3).
    edges : (e, 2) int32, lower node first.
    radius : (v,), of the fitted round cones by robust; else the mean distance of a node's points of the cloud to it,
        0 for a node without points.
    branches : node lists from joint or end to joint or end; a closed one repeats its first node.
    node_of_point : (n,) int32, the node of every point of the cloud.
    cloud : (n, 3); input_rows : (n,) int32, their rows in the input.
    contracted, origin : (m, 3), the contracted points, by robust on the curve, and where they came from; empty where
        unknown.
    rows : (m,) int32, rows of the cloud of the contracted points.
    warnings : what a user should know.
    """

    nodes: Points
    edges: Indices
    radius: Numbers
    branches: tuple[Indices, ...]
    node_of_point: Indices
    cloud: Points
    input_rows: Indices
    contracted: Points
    origin: Points
    rows: Indices
    warnings: tuple[str, ...] = ()

    @property
    def components(self) -> int:
        return graph.component_count(len(self.nodes), self.edges)

    @property
    def loops(self) -> int:
        return graph.loop_count(len(self.nodes), self.edges)

    @property
    def degrees(self) -> Indices:
        return graph.degrees(len(self.nodes), self.edges)

    @property
    def ends(self) -> int:
        return int((self.degrees == 1).sum())

    @property
    def joints(self) -> int:
        return int((self.degrees > 2).sum())

    @property
    def length(self) -> float:
        return float(graph.edge_lengths(self.nodes, self.edges).sum())

    def counts(self) -> dict[str, float]:
        """Return components, loops, ends, joints and length by name."""
        return graph.counts(self.nodes, self.edges)

    def branch_of_node(self) -> Indices:
        """Return (v,) the branch of each node, -1 for joints, which belong to several."""
        branch = np.full(len(self.nodes), -1, np.int32)
        for number, nodes in enumerate(self.branches):
            branch[nodes] = number
        branch[self.degrees > 2] = -1
        return branch

    def to_networkx(self) -> "networkx.Graph":
        """Return a networkx.Graph with node attributes x, y, z, radius and edge attribute length."""
        import networkx

        network = networkx.Graph()
        for i, ((x, y, z), radius) in enumerate(zip(self.nodes.tolist(), self.radius.tolist(), strict=True)):
            network.add_node(i, x=x, y=y, z=z, radius=radius)
        lengths = graph.edge_lengths(self.nodes, self.edges)
        for (a, b), length in zip(self.edges.tolist(), lengths.tolist(), strict=True):
            network.add_edge(a, b, length=length)
        return network


def extract_skeleton(contraction: Contraction, params: SkeletonParams | None = None) -> Skeleton:
    """Turn a contracted cloud into a curve skeleton.

    What method robust contracted becomes the graph of its sections, cleaned,
    and fitted to the original cloud as a curve of round cones
    (:mod:`tiskel.methods.robust.pipeline`); ``contracted`` of the result are the points'
    feet on it, and the warnings say where it is in doubt.

    What lbc and gls contracted, and everything if ``params.raw``, is sampled by
    a front of balls, joined by first foreign ring members, and rid of triangles
    as published (Cao et al. 2010, section 4); unless ``params.raw``, spurs of a
    single edge shorter than the local radius go, too.

    Raises TiskelError where the contracted cloud is empty.
    """
    params = params or SkeletonParams()
    if len(contraction.points) == 0:
        raise TiskelError("the contraction holds no point; run tiskel contract again")
    if contraction.sections is not None and contraction.levels is not None and not params.raw:
        return _fitted_skeleton(contraction, contraction.sections, contraction.levels)
    skeleton = _published_skeleton(contraction, params)
    return skeleton if params.raw else prune_spurs(skeleton)


def _fitted_skeleton(c: Contraction, sections: Indices, levels: Indices) -> Skeleton:
    frame = normalisation(c.origin)
    origin, k = frame.apply(c.origin), c.params.neighbours_for(len(c.rows))
    axes = own_axes(origin)
    turned, there = (np.ascontiguousarray(points @ axes.T) for points in (origin, frame.apply(c.points)))
    built = build(turned, there, sections, levels, k)
    nodes, contracted = frame.undo(built.curve.nodes @ axes), c.points.copy()
    contracted[built.feet.rows] = frame.undo(built.feet.places(built.curve) @ axes)
    return Skeleton(
        nodes=nodes,
        edges=built.curve.edges,
        radius=built.curve.radii / frame.scale,
        branches=graph.branches(len(nodes), built.curve.edges),
        node_of_point=nodes_of_points(built)[c.survivor_of()],
        cloud=c.cloud,
        input_rows=c.input_rows,
        contracted=contracted,
        origin=c.origin,
        rows=c.rows,
        warnings=doubts(built),
    )


def _published_skeleton(c: Contraction, params: SkeletonParams) -> Skeleton:
    samples, owner = front_samples(c.points, params.radius * diagonal(c.cloud))
    joined = inherited_edges(c.rings, owner, c.points[samples])
    nodes, edges, into = collapse_triangles(c.points[samples], joined)
    node_of_point = into[owner][c.survivor_of()]
    return Skeleton(
        nodes=nodes,
        edges=edges,
        radius=graph.node_radii(nodes, c.cloud, node_of_point),
        branches=graph.branches(len(nodes), edges),
        node_of_point=node_of_point,
        cloud=c.cloud,
        input_rows=c.input_rows,
        contracted=c.points,
        origin=c.origin,
        rows=c.rows,
        warnings=_warnings(nodes),
    )


def prune_spurs(skeleton: Skeleton) -> Skeleton:
    """Return the skeleton without spurs; their points go to the joint they hung on."""
    s = skeleton
    into = graph.without_spurs(s.nodes, s.edges, s.radius)
    kept = np.flatnonzero(into == np.arange(len(into)))
    place = np.full(len(into), -1, np.int32)
    place[kept] = np.arange(len(kept), dtype=np.int32)
    nodes, node_of_point = s.nodes[kept], place[into[s.node_of_point]]
    edges = place[s.edges[(place[s.edges] >= 0).all(axis=1)]]
    return replace(
        s,
        nodes=nodes,
        edges=edges,
        node_of_point=node_of_point,
        radius=graph.node_radii(nodes, s.cloud, node_of_point),
        branches=graph.branches(len(nodes), edges),
    )


def _warnings(nodes: Points) -> tuple[str, ...]:
    if len(nodes) > 1:
        return ()
    return ("the cloud contracted to a single node: it has no elongated part at this sampling radius",)
