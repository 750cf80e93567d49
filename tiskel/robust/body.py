"""The solid inside a cloud, as far as its normals agree on one."""

from dataclasses import dataclass

import numpy as np

from tiskel.quality.loops import solid_loops
from tiskel.quality.surface import Surface, checked

PROBED = 16384  # points; of larger clouds so many are taken


@dataclass(frozen=True)
class Body:
    """Whether there is an inside to speak of, and how many handles it has, None where they cannot be told."""

    trusted: bool
    handles: int | None


def body_of(surface: Surface) -> Body:
    """Return the body inside a surface."""
    step = -(-len(surface.points) // PROBED)
    points, normals = (np.ascontiguousarray(rows[::step]) for rows in (surface.points, surface.normals))
    thinned = checked(Surface(points, normals, step * surface.areas[::step]), seed=0)
    return Body(thinned.trusted, solid_loops(thinned)[0])
