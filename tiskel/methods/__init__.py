"""Methods: ways from a cloud to a curve skeleton, each behind the same two functions.

``contract(points, params, weights, surface) -> Trace`` and ``curve(trace, params) ->
MethodCurve``, both in normalised coordinates; checks and units are the two
stages' (:mod:`tiskel.contraction`, :mod:`tiskel.skeleton`). What a method does
not read, its settings do not have.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tiskel.arrays import Numbers, Points
from tiskel.geometry.mesh_surface import MeshSurface
from tiskel.methods import robust
from tiskel.methods.laplacian.curve import curve as published_curve
from tiskel.methods.laplacian.gls import contract_gls
from tiskel.methods.laplacian.lbc import contract_lbc
from tiskel.methods.trace import MethodCurve, Trace
from tiskel.params import GlsParams, LbcParams


@dataclass(frozen=True)
class Method:
    """A method's two functions.

    Attributes
    ----------
    contract : callable
        Points (n, 3), the method's params, weights (n,) or None, and what is known of the mesh that the points lie on
        or None, to a Trace.
    curve : callable
        A Trace and the method's params, to a MethodCurve.
    """

    contract: Callable[[Points, Any, Numbers | None, MeshSurface | None], Trace]
    curve: Callable[[Trace, Any], MethodCurve]


def _gls(points: Points, params: GlsParams, weights: Numbers | None, surface: MeshSurface | None) -> Trace:
    """Contract as published: a mesh is points to it."""
    return contract_gls(points, params, weights)


def _lbc(points: Points, params: LbcParams, weights: Numbers | None, surface: MeshSurface | None) -> Trace:
    """Contract as published: a mesh is points to it."""
    return contract_lbc(points, params, weights)


METHODS: dict[str, Method] = {
    "robust": Method(robust.contract, robust.curve),
    "gls": Method(_gls, published_curve),
    "lbc": Method(_lbc, published_curve),
}
