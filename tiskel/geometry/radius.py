"""What the radius of a node of a curve is worth."""

from enum import IntEnum


class RadiusSource(IntEnum):
    """What the radius of a node is worth; the numbers stand in files.

    Examples
    --------
    >>> from tiskel import RadiusSource
    >>> RadiusSource.MODELLED.name
    'MODELLED'
    """

    UNKNOWN = 0  #: nobody said
    MEASURED = 1  #: points about the node determine it
    BOUNDED = 2  #: the body is thinner than its points can tell: it is at most about so much
    MODELLED = 3  #: no points, as on a bridge over a gap: taken from the nodes beside it
