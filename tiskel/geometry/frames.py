"""Directions: vectors of length one, two of them across a third, and the steps of a polyline."""

import numpy as np

from tiskel.arrays import Floats, Numbers, Points


def unit(vectors: Points) -> Points:
    """Return vectors (n, 3) at length one; those of length zero stay zero.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.frames import unit
    >>> unit(np.array([[0, 0, 2.0], [0, 0, 0]])).tolist()
    [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]
    """
    lengths = np.linalg.norm(vectors, axis=1)[:, None]
    return np.asarray(np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0))


def across(directions: Floats) -> Floats:
    """Return two unit vectors across each direction; with it, in this order, they are a right-handed frame.

    The first is also across the axis of coordinates that the direction is farthest from.

    Parameters
    ----------
    directions : (..., 3) float64
        Unit vectors; one alone has shape (3,).

    Returns
    -------
    (..., 2, 3) float64

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.frames import across
    >>> u, v = across(np.array([0, 0, 1.0]))
    >>> np.abs(u).tolist(), np.abs(v).tolist()
    ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0])
    """
    least = np.eye(3)[np.abs(directions).argmin(axis=-1)]
    first = np.cross(directions, least)
    first /= np.linalg.norm(first, axis=-1, keepdims=True)
    return np.stack([first, np.cross(directions, first)], axis=-2)


def step_lengths(places: Points) -> Numbers:
    """Return (n - 1,) how far it is from each of places (n, 3) to the next, in their unit."""
    return np.asarray(np.linalg.norm(np.diff(places, axis=0), axis=1))
