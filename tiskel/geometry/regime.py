"""What kind of body a node of a curve stands in, and with it how the curve was found there."""

from enum import IntEnum


class Regime(IntEnum):
    """What the body is like about a node; the numbers stand in files.

    Examples
    --------
    >>> from tiskel import Regime
    >>> Regime.WIRE.name
    'WIRE'
    """

    UNKNOWN = 0  #: nobody said
    TUBE = 1  #: points lie all about the curve, which is in the middle of the body
    SHEET = 2  #: one side was seen, or the body is a sheet: the curve is on the middle of what was seen
    WIRE = 3  #: thinner than its points are apart: the curve follows the points
