"""The linear system of a contraction step."""

from collections.abc import Callable

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from tiskel.arrays import Floats, Numbers, Points
from tiskel.errors import TiskelError
from tiskel.params import Solver

Factorisation = Callable[[Floats], Floats]  #: right-hand side (n,) or (n, c) to solution


class SingularStep(Exception):
    """The normal equations of a step cannot be solved."""


def contracted(
    laplacian: sparse.csr_array, contraction: float, attraction: Numbers, points: Points, solver: Solver
) -> Points:
    """Return the cloud P' that solves (W_L^2 L^T L + W_H^2) P' = W_H^2 P, all three coordinates at once.

    Parameters
    ----------
    laplacian : (n, n) sparse array
        L.
    contraction : float
        W_L.
    attraction : (n,) float64
        W_H of every point.
    points : (n, 3) float64
        P, in normalised coordinates.
    solver : Solver
        A key of ``BACKENDS``.

    Returns
    -------
    (n, 3) float64
        P'.

    Raises
    ------
    SingularStep
        Where the matrix has no factorisation or the solution is not finite.
    TiskelError
        Where the solver is not installed.
    """
    squares = attraction**2
    try:
        square = contraction**2
    except OverflowError:  # of a weight above 1e154
        raise SingularStep from None
    normal = sparse.csc_array(square * (laplacian.T @ laplacian) + sparse.diags_array(squares))
    solution = BACKENDS[solver](normal)(squares[:, None] * points)
    if not np.isfinite(solution).all():
        raise SingularStep
    return np.ascontiguousarray(solution)


def _superlu(normal: sparse.csc_array) -> Factorisation:
    """Factorise with SuperLU in its symmetric mode: half the time of its defaults on these matrices."""
    try:
        factor = splu(normal, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError as error:
        raise SingularStep(str(error)) from None
    return lambda right: np.asarray(factor.solve(right))


def _cholmod(normal: sparse.csc_array) -> Factorisation:
    """Factorise with CHOLMOD as cvxopt ships it (GPL, hence an extra)."""
    try:
        from cvxopt import cholmod, matrix, spmatrix
    except ImportError:
        raise TiskelError("the cholmod solver needs cvxopt; install it with: pip install 'tiskel[cholmod]'") from None
    lower = sparse.coo_array(sparse.tril(normal))
    symmetric = spmatrix(lower.data, *(axis.astype(int) for axis in lower.coords), normal.shape)

    def solve(right: Floats) -> Floats:
        out = matrix(np.asfortranarray(right))
        try:
            cholmod.linsolve(symmetric, out)
        except ArithmeticError as error:
            raise SingularStep(str(error)) from None
        return np.array(out)

    return solve


BACKENDS: dict[Solver, Callable[[sparse.csc_array], Factorisation]] = {"scipy": _superlu, "cholmod": _cholmod}
