"""Skeletons as tables of pandas."""

from collections.abc import Callable
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from tiskel.errors import TiskelError
from tiskel.geometry.labels import labels
from tiskel.geometry.radius import RadiusSource
from tiskel.geometry.regime import Regime
from tiskel.skeleton import Rows, Skeleton

if TYPE_CHECKING:
    import pandas


def skeleton_table(skeleton: Skeleton, what: Rows = "nodes") -> "pandas.DataFrame":
    """Return a table of pandas.

    Parameters
    ----------
    skeleton : Skeleton
        Of any method, or read from a file.
    what : "nodes", "edges" or "branches"
        What has a row each. Nodes: x, y, z, radius (in the input's unit), radius_source, regime, branch (-1 at
        joints), degree. Edges: first, last, length, bridged. Branches: the columns of
        :class:`tiskel.geometry.branch_table.BranchRow`, as in ``tiskel skeleton --branches``.

    Returns
    -------
    pandas.DataFrame

    Raises
    ------
    TiskelError
        Where pandas is not installed, and for another word.

    Examples
    --------
    >>> from tiskel import make_shape, skeleton_table
    >>> true = make_shape("y", 500)[1]
    >>> len(skeleton_table(true)), skeleton_table(true, "branches")["kind"].tolist()  # doctest: +SKIP
    (4, ['joint-end', 'joint-end', 'joint-end'])
    """
    if what not in get_args(Rows):
        raise TiskelError(f"a skeleton has tables of {', '.join(get_args(Rows))}, not of {what!r}; choose one")
    try:
        import pandas
    except ImportError:
        raise TiskelError('tables need pandas, which is not installed; run: pip install "tiskel[pandas]"') from None
    return pandas.DataFrame(TABLES[what](skeleton))


def _nodes(s: Skeleton) -> dict[str, Any]:
    return {
        **dict(zip("xyz", s.nodes.T, strict=True)),
        "radius": s.radii,
        "radius_source": labels(RadiusSource, s.radius_sources),
        "regime": labels(Regime, s.regimes),
        "branch": s.branch_of_node(),
        "degree": s.degrees,
    }


def _edges(s: Skeleton) -> dict[str, Any]:
    first, last = np.asarray(s.edges).T
    return {"first": first, "last": last, "length": s.lengths, "bridged": s.bridged}


def _branches(s: Skeleton) -> list[dict[str, Any]]:
    return [asdict(row) for row in s.branch_table()]


TABLES: dict[str, Callable[[Skeleton], Any]] = {"nodes": _nodes, "edges": _edges, "branches": _branches}
