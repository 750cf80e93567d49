"""Blocks, plates and brackets, some with holes through them, whose skeletons run around the holes."""

import numpy as np
import numpy.typing as npt

from tiskel.arrays import Numbers, Points
from tiskel.gallery.body import Body, joined
from tiskel.gallery.solids import Hole, around_holes, plate

AROUND = 33  # nodes of a piece of the curve about a hole


def _pierced(length: float, width: float, thickness: float, holes: int, radius: float) -> Body:
    """Return a block with a row of holes; the radius of the curve is that of the area of the section there."""
    pitch = length / holes
    places: list[Hole] = [((number - (holes - 1) / 2) * pitch, 0.0, radius) for number in range(holes)]
    part = plate([(-length / 2, -width / 2, length / 2, width / 2)], thickness, places)
    lines = around_holes(length, width, holes, radius, AROUND)
    least = min(min(width, pitch) / 2 - radius, thickness) / 2
    radii = [np.sqrt(2 * room * thickness / np.pi) for _, room in lines]
    return joined([line for line, _ in lines], radii, [part], least)


def block(holes: int) -> Body:
    """Return a block with so many holes through it, and as many loops."""
    return _pierced(1.1 * holes, 1.0, 0.6, holes, 0.28)


def block_1() -> Body:
    """A block with a hole through it: one loop."""
    return block(1)


def block_2() -> Body:
    """A block with two holes through it: two loops."""
    return block(2)


def block_3() -> Body:
    """A block with three holes through it: three loops."""
    return block(3)


def washer_plate() -> Body:
    """A thin plate with a wide hole: one loop."""
    return _pierced(1.6, 1.4, 0.12, 1, 0.45)


def strip() -> Body:
    """A thin strip with four holes: four loops."""
    return _pierced(3.2, 0.7, 0.1, 4, 0.2)


def _bracket(corners: npt.ArrayLike, width: float, thickness: float) -> Body:
    """Return a bar along a path of right angles in the plan; the curve ends half a width before its ends."""
    path = np.asarray(corners, dtype=float)
    boxes = []
    for start, stop in zip(path[:-1], path[1:], strict=True):
        low, high = np.minimum(start, stop), np.maximum(start, stop)
        boxes.append((*(low - width / 2).tolist(), *(high + width / 2).tolist()))
    line = _densified(path)
    radius = float(np.sqrt(width * thickness / np.pi))
    part = plate(boxes, thickness)
    return joined([line], [np.full(len(line), radius)], [part], min(width, thickness) / 2)


def _densified(path: npt.NDArray[np.float64]) -> Points:
    """Return places along a path in the plan, its corners among them."""
    pieces: list[Numbers] = []
    for start, stop in zip(path[:-1], path[1:], strict=True):
        share = np.linspace(0, 1, 17)[:-1, None]
        pieces.append(start * (1 - share) + stop * share)
    flat = np.concatenate([*pieces, path[-1:]])
    return np.concatenate([flat, np.zeros((len(flat), 1))], axis=1)


def l_bracket() -> Body:
    """A bracket with a right angle."""
    return _bracket([(0, 1.0), (0, 0), (0.8, 0)], 0.3, 0.5)


def u_bracket() -> Body:
    """A bracket with two right angles."""
    return _bracket([(-0.5, 0.9), (-0.5, 0), (0.5, 0), (0.5, 0.9)], 0.25, 0.4)
