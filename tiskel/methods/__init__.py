"""Methods: ways from a cloud to a curve skeleton, each behind the same two functions.

``contract(points, params, weights, surface, span) -> Trace`` and ``curve(trace,
params, span) -> MethodCurve``, both in normalised coordinates; checks and units are
the two stages' (:mod:`tiskel.contraction`, :mod:`tiskel.skeleton`). What a method
does not read, its settings do not have; the span is told how far it is. Each function
is imported where it is called: a command that contracts needs no curves.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tiskel.arrays import Numbers, Points
from tiskel.geometry.mesh_surface import MeshSurface
from tiskel.methods.trace import MethodCurve, Trace
from tiskel.params import GlsParams, LbcParams, RobustParams
from tiskel.progress import Span


@dataclass(frozen=True)
class Method:
    """A method's two functions.

    Attributes
    ----------
    contract : callable
        Points (n, 3), the method's params, weights (n,) or None, and what is known of the mesh that the points lie on
        or None, and the span that the contraction is, to a Trace.
    curve : callable
        A Trace, the method's params, and the span that the extraction is, to a MethodCurve.
    """

    contract: Callable[[Points, Any, Numbers | None, MeshSurface | None, Span], Trace]
    curve: Callable[[Trace, Any, Span], MethodCurve]


def _robust(
    points: Points, params: RobustParams, weights: Numbers | None, surface: MeshSurface | None, span: Span
) -> Trace:  # fmt: skip
    from tiskel.methods.robust.contraction import contract

    return contract(points, params, weights, surface, span)


def _robust_curve(trace: Trace, params: RobustParams, span: Span) -> MethodCurve:
    from tiskel.methods.robust.extraction import curve

    return curve(trace, params, span)


def _gls(
    points: Points, params: GlsParams, weights: Numbers | None, surface: MeshSurface | None, span: Span
) -> Trace:  # fmt: skip
    """Contract as published: a mesh is points to it."""
    from tiskel.methods.laplacian.gls import contract_gls
    from tiskel.methods.laplacian.toolbox_gls import contract_as_toolbox

    contracted = contract_as_toolbox if params.variant == "toolbox" else contract_gls
    return contracted(points, params, weights, span)


def _lbc(
    points: Points, params: LbcParams, weights: Numbers | None, surface: MeshSurface | None, span: Span
) -> Trace:  # fmt: skip
    """Contract as published: a mesh is points to it."""
    from tiskel.methods.laplacian.lbc import contract_lbc

    return contract_lbc(points, params, weights, span)


def _published_curve(trace: Trace, params: GlsParams | LbcParams, span: Span) -> MethodCurve:
    from tiskel.methods.laplacian.curve import curve

    return curve(trace, params, span)


METHODS: dict[str, Method] = {
    "robust": Method(_robust, _robust_curve),
    "gls": Method(_gls, _published_curve),
    "lbc": Method(_lbc, _published_curve),
}
