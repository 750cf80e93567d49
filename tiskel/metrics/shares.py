"""Shares and counts that the documents of measures are made of."""

from tiskel.arrays import Mask
from tiskel.metrics.boundedness import COVERED, HULL, MAP, OUTSIDE, Boundedness


def share(mask: Mask | None) -> float | None:
    """Return the share of True in a mask; None for no mask or an empty one."""
    return None if mask is None or len(mask) == 0 else float(mask.mean())


def settled(b: Boundedness) -> dict[str, int]:
    """Return how many places were measured, and what settled them."""
    return {
        "measured": len(b),
        "settled_by_coverage": int((b.settled_by == COVERED).sum()),
        "settled_by_outside": int((b.settled_by == OUTSIDE).sum()),
        "settled_by_hull": int((b.settled_by == HULL).sum()),
        "settled_by_map": int((b.settled_by == MAP).sum()),
        "at_a_cloud_point": int((b.coincident > 0).sum()),
    }
