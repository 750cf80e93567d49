"""A few places that stand for many, so that a user knows where to look."""

import numpy as np

from tiskel.arrays import Numbers, Points

FEW = 3  # places that are named


def few_places(places: Points, weight: Numbers, count: int = FEW) -> Points:
    """Return a few of many places: the weightiest, then those that weigh much and are far from the ones before.

    What is largest each time is the weight times the distance from the nearest
    place that was taken.

    Parameters
    ----------
    places : (n, 3) float64
        In any unit.
    weight : (n,) float64
        How much each place has of what is looked for; not negative.
    count : int
        How many to return at most.

    Returns
    -------
    (k, 3) float64
        Distinct; k is at most ``count``.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.representatives import few_places
    >>> line = np.outer(np.arange(5.0), [1, 0, 0])
    >>> few_places(line, np.array([1, 3, 2, 1, 2.0]))[:, 0].tolist()
    [1.0, 4.0, 2.0]
    """
    if len(places) == 0:
        return np.zeros((0, 3))
    taken, away = [int(weight.argmax())], np.full(len(places), np.inf)
    while len(taken) < count:
        away = np.minimum(away, np.linalg.norm(places - places[taken[-1]], axis=1))
        worth = weight * away
        if not worth.max() > 0:
            break
        taken.append(int(worth.argmax()))
    return places[taken]
