"""Names of what nodes and radii are, as files for other programs have them."""

from enum import IntEnum

import numpy as np
import numpy.typing as npt


def labels(kind: type[IntEnum], numbers: npt.NDArray[np.uint8]) -> list[str]:
    """Return the name of each number, in lower case.

    Parameters
    ----------
    kind : RadiusSource or Regime
        What the numbers are of.
    numbers : (v,) uint8
        One for each node.

    Returns
    -------
    list of str
        "unknown" for a number that has no name.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel import Regime
    >>> from tiskel.geometry.labels import labels
    >>> labels(Regime, np.array([1, 3, 0], np.uint8))
    ['tube', 'wire', 'unknown']
    """
    known = {member.value: member.name.lower() for member in kind}
    return [known.get(number, "unknown") for number in numbers.tolist()]
