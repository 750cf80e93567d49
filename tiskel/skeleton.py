"""The stage ``skeleton``: a contracted cloud in, a curve skeleton out."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tiskel.arrays import Indices, Numbers, Points
from tiskel.contraction import Contraction
from tiskel.errors import TiskelError
from tiskel.extras import extra
from tiskel.geometry.branch_table import BranchRow, branch_table
from tiskel.geometry.doubt import CurveWarning
from tiskel.geometry.graph import CurveGraph
from tiskel.geometry.labels import labels
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.methods import METHODS
from tiskel.params import ContractionParams, SkeletonParams, Up
from tiskel.params.given import Unpack, settled
from tiskel.params.keywords import SkeletonSettings
from tiskel.progress import Report, Span

if TYPE_CHECKING:
    from pathlib import Path

    import networkx
    import pandas

    from tiskel import View

Rows = Literal["nodes", "edges", "branches"]  #: what a table may have a row for each of


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Skeleton(CurveGraph):
    """A curve skeleton and the cloud it stands for; coordinates in the input's units.

    Attributes
    ----------
    nodes, edges, radii, bridged, radius_sources, regimes
        The curve, see :class:`tiskel.CurveGraph`. Radii are those of the fitted round cones by robust; else the
        mean distance of a node's points of the cloud to it, 0 for a node without points.
    node_of_point : (n,) int32
        The node of every point of the cloud.
    cloud : (n, 3) float64
        The finite points of the input.
    input_rows : (n,) int32
        Their rows in the input.
    contracted : (m, 3) float64
        The contracted points, by robust on the curve; empty where unknown.
    origin : (m, 3) float64
        Where these came from.
    rows : (m,) int32
        Their rows in the cloud.
    warnings : tuple of CurveWarning
        Where the curve may be wrong, and why; ``str()`` of each is a line for a reader.
    notes : tuple of CurveWarning
        What to know of a curve that may well be right: bridged gaps, radii that are bounds, sides not seen.
    params : ContractionParams or None
        The settings of the method that made it; None where no method did.

    Examples
    --------
    >>> from tiskel import make_shape, shape_graph
    >>> cloud, true = make_shape(shape_graph("y"))
    >>> true.components, true.loops, true.ends, len(true.branches)
    (1, 0, 3, 3)
    """

    _said = ("nodes", "components", "loops", "ends", "junctions", "length", "cloud", "warnings")

    node_of_point: Indices
    cloud: Points
    input_rows: Indices
    contracted: Points
    origin: Points
    rows: Indices
    warnings: tuple[CurveWarning, ...] = ()
    notes: tuple[CurveWarning, ...] = ()
    params: ContractionParams | None = field(default=None, repr=False)

    @property
    def radius(self) -> Numbers:
        """(v,) the radii, by the name that files and tables have for them."""
        return self.radii

    def doubts(self) -> dict[str, list[dict[str, Any]]]:
        """Return warnings and notes by these names, as plain JSON values; see :meth:`tiskel.CurveWarning.as_dict`."""
        return {"warnings": [w.as_dict() for w in self.warnings], "notes": [n.as_dict() for n in self.notes]}

    def branch_of_node(self) -> Indices:
        """Return (v,) the branch of each node, -1 for junctions, which belong to several."""
        branch = np.full(len(self.nodes), -1, np.int32)
        for number, nodes in enumerate(self.branches):
            branch[nodes] = number
        branch[self.degrees > 2] = -1
        return branch

    def branch_table(self) -> tuple[BranchRow, ...]:
        """Return a row for every branch: ends, kind, length, radii, volume, order from the root, angle, parent.

        The root is that of the settings (``root``) where they have one; see
        :func:`tiskel.geometry.branch_table.branch_table`.
        """
        return branch_table(self, getattr(self.params, "root", None))

    def save(self, target: "str | Path") -> None:
        """Write it in the format that the suffix names, see :func:`tiskel.write_skeleton`; PLY holds all of it."""
        from tiskel import write_skeleton

        write_skeleton(target, self)

    @staticmethod
    def load(source: "str | Path") -> "Skeleton":
        """Read a skeleton of any format, see :func:`tiskel.load_skeleton`."""
        from tiskel import load_skeleton

        return load_skeleton(source)

    def plot(self, target: "str | Path | None" = None, *, title: str = "", up: Up = "auto", unit: str = "") -> Any:
        """Draw it from three sides and in space, into a file where one is named; see :func:`tiskel.plot_skeleton`."""
        from tiskel import plot_skeleton

        return plot_skeleton(self, target, title=title, up=up, unit=unit)

    def to_pandas(self, what: Rows = "nodes") -> "pandas.DataFrame":
        """Return a table of nodes, edges or branches, a row each; see :func:`tiskel.skeleton_table`."""
        from tiskel import skeleton_table

        return skeleton_table(self, what)

    def view(self, *more: Any, up: Up = "auto", unit: str = "") -> "View":
        """Return it as something to look at, with other things: ``.save("look.html")``; see :func:`tiskel.view`."""
        from tiskel import view

        return view(self, *more, up=up, unit=unit)

    def _repr_html_(self) -> str:
        return str(self.view()._repr_html_())

    def to_networkx(self) -> "networkx.Graph":
        """Return a networkx.Graph.

        Nodes have x, y, z, radius, radius_source ("measured", "bounded",
        "modelled", "unknown") and regime ("tube", "sheet", "wire",
        "unknown"), edges length and bridged.
        """
        network = extra("networkx", "a graph of networkx").Graph()
        sources, regimes = labels(RadiusSource, self.radius_sources), labels(Regime, self.regimes)
        said = zip(self.nodes.tolist(), self.radii.tolist(), sources, regimes, strict=True)
        for i, ((x, y, z), radius, source, regime) in enumerate(said):
            network.add_node(i, x=x, y=y, z=z, radius=radius, radius_source=source, regime=regime)
        measured = zip(self.edges.tolist(), self.lengths.tolist(), self.bridged.tolist(), strict=True)
        for (a, b), length, bridged in measured:
            network.add_edge(a, b, length=length, bridged=bridged)
        return network


def extract_skeleton(
    contraction: Contraction, params: SkeletonParams | None = None, *, progress: Report | None = None,
    **settings: Unpack[SkeletonSettings],
) -> Skeleton:  # fmt: skip
    """Turn a contracted cloud into a curve skeleton, by the method that contracted it.

    Method robust fits a curve of round cones to the original cloud along the
    graph of its sections (:mod:`tiskel.methods.robust`); ``contracted`` of the
    result are the points' feet on it, and the warnings say where it is in
    doubt. lbc and gls have the published curve, without short spurs unless
    ``raw`` (:mod:`tiskel.methods.laplacian.curve`).

    Parameters
    ----------
    contraction : Contraction
        A contracted cloud.
    params : SkeletonParams, optional
        What is to differ from the settings that the contraction was made with.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts begin; what it raises ends the extraction.
    **settings
        Those of :class:`tiskel.SkeletonParams` by name; over those of params.

    Returns
    -------
    Skeleton

    Raises
    ------
    TiskelError
        Where the contracted cloud is empty, or a setting is none of the method's.

    Examples
    --------
    >>> from tiskel import contract, extract_skeleton, make_shape, shape_graph
    >>> cloud, true = make_shape(shape_graph("y"))
    >>> skeleton = extract_skeleton(contract(cloud))
    >>> skeleton.components, skeleton.loops, skeleton.ends
    (1, 0, 3)
    """
    c, span = contraction, Span(progress, "skeleton")
    span.at(0, "cloud")
    if len(c.points) == 0:
        raise TiskelError("the contraction holds no point; run tiskel contract again")
    chosen = settled(SkeletonParams, params, settings).over(c.params)
    trace, frame = c.as_trace()
    made = METHODS[chosen.method].curve(trace, chosen.placed(frame.place), span)
    doubts = [doubt.moved(frame.undo) for doubt in made.warnings]
    body = np.flatnonzero(~c.strays)
    node_of_point = np.full(len(c.cloud), -1, np.int32)
    node_of_point[body] = made.node_of_point
    others = np.flatnonzero(c.strays)
    node_of_point[others] = node_of_point[c.merged_into[others]]
    span.at(1)
    return Skeleton(
        nodes=frame.undo(made.graph.nodes),
        edges=made.graph.edges,
        radii=made.graph.radii / frame.scale,
        bridged=made.graph.bridged,
        radius_sources=made.graph.radius_sources,
        regimes=made.graph.regimes,
        node_of_point=node_of_point,
        cloud=c.cloud,
        input_rows=c.input_rows,
        contracted=frame.undo(made.contracted),
        origin=c.origin,
        rows=c.rows,
        warnings=tuple(doubt for doubt in doubts if doubt.severity == "warning"),
        notes=tuple(doubt for doubt in doubts if doubt.severity == "note"),
        params=chosen,
    )
