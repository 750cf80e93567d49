"""Whether points are a scan of a body at all: many far from all others, twofold ones, or a swarm without a surface."""

import numpy as np
from scipy.spatial import cKDTree

from tiskel.arrays import Points

FEWEST = 200  #: points; fewer say nothing about themselves
LOOKED_AT, ASKED = 20_000, 2_000  #: points that are neighbours, and points whose neighbours are looked at, at most
NEIGHBOURS, NEAR = 20, 8  #: of which shapes are told, and whose distance is the spacing
# Thresholds lie between 25 clouds of scans, models and generated bodies, and the swarms: the share beyond five spacings
# was at most 0.003 and is 0.25; flatness was at most 0.145 and is 0.202; the tail of bodies as isotropic is 0.01.
FAR, MANY_FAR = 5.0, 0.05  #: spacings to a neighbour, and the share of points beyond that are not strays any more
TAIL, MANY_IN_TAIL = 1.5, 0.1  #: spacings, and the share beyond of a swarm that thins out
ISOTROPIC = 0.17  #: median share of the least variance about a point: 0 on a surface, 1/3 where no side is different
TWOFOLD, MANY_TWOFOLD = 0.05, 0.5  #: of the second nearest distance, and the share of points with so near a neighbour


def doubts_about(points: Points) -> tuple[str, ...]:
    """Return what speaks against points being a scan of a body, in words for a reader; nothing as a rule.

    Parameters
    ----------
    points : (n, 3) float64
        Distinct, without strays; of many every so manieth is looked at.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.scatter import doubts_about
    >>> [said.split(",")[0] for said in doubts_about(np.random.default_rng(0).normal(size=(2000, 3)))]
    ['the points thin out in all directions like a swarm']
    """
    if len(points) < FEWEST:
        return ()
    some = points[:: -(-len(points) // LOOKED_AT)]
    asked = some[:: -(-len(some) // ASKED)]
    distance, rows = cKDTree(some).query(asked, NEIGHBOURS + 1)
    spacing = float(np.median(distance[:, NEAR]))
    if spacing == 0:
        return ()
    far = float((distance[:, NEAR] > FAR * spacing).mean())
    tail = float((distance[:, NEAR] > TAIL * spacing).mean())
    twofold = float((distance[:, 1] < TWOFOLD * distance[:, 2]).mean())
    said = []
    if far > MANY_FAR:
        said.append(f"{far:.0%} of the points are far from all others, more than {FAR:g} spacings: try --outliers")
    elif tail > MANY_IN_TAIL and _isotropy(some[rows]) > ISOTROPIC:
        said.append(
            "the points thin out in all directions like a swarm, without a surface: a curve says little of them"
        )
    if twofold > MANY_TWOFOLD:
        said.append(f"{twofold:.0%} of the points have a twin much closer than the next: two copies? try --voxel")
    return tuple(said)


def _isotropy(groups: Points) -> float:
    """Return the median over groups of points (g, k, 3) of the share of the least principal variance."""
    centred = groups - groups.mean(axis=1, keepdims=True)
    variances = np.linalg.eigvalsh(np.einsum("gki,gkj->gij", centred, centred))
    whole = variances.sum(axis=1)
    return float(np.median(variances[whole > 0, 0] / whole[whole > 0])) if (whole > 0).any() else 0.0
