"""The surface of a whole body as a part of ``surface.json``.

    {"radius", "warnings": [...], "distances": [of every point of the cloud, null where it is stray],
     "patches": {"centres": [[x, y, z], ...], "supports", "values", "gradients",
                 "hessians": [[xx, yy, zz, xy, xz, yz], ...], "radii", "trust", "of_tube"}}

Lengths are in the input's unit. A patch is a quadric q about its centre, given by
value, gradient and Hessian there; the surface is where sum w q = 0 with
w = (1 - d^2 / support^2)^4, d the distance from the centre. ``trust`` is 2 where
points all about determine the place, 1 where little was seen, 0 over gaps.
"""

from typing import Any

import numpy as np

from tiskel.arrays import Points
from tiskel.surfaces.patches import BodySurface, Patches

TYPES = {"trust": np.uint8, "of_tube": np.bool_}  # of all others float64
WIDTHS = {"centres": 3, "gradients": 3, "hessians": 6}


def body_document(body: BodySurface) -> dict[str, Any]:
    """Return a surface as JSON values, from which it is read back to the last bit."""
    return {
        "radius": body.radius,
        "warnings": list(body.warnings),
        "distances": [None if np.isnan(far) else far for far in body.distances.tolist()],
        "patches": {name: getattr(body.patches, name).tolist() for name in Patches.__dataclass_fields__},
    }


def body_of(document: dict[str, Any], cloud: Points) -> BodySurface:
    """Return the surface of a cloud (n, 3) from what a file holds; raise ValueError or KeyError where it is damaged."""
    patches = Patches(**{name: _column(document["patches"], name) for name in Patches.__dataclass_fields__})
    if len({len(getattr(patches, name)) for name in Patches.__dataclass_fields__}) > 1 or len(patches) == 0:
        raise ValueError("columns of patches have different lengths, or none")
    if not (patches.supports > 0).all():
        raise ValueError("the support of a patch must be positive")
    distances = np.array([np.nan if far is None else far for far in document["distances"]], np.float64)
    if len(distances) != len(cloud):
        raise ValueError(f"{len(distances)} distances of {len(cloud)} points")
    return BodySurface(patches, cloud, distances, float(document["radius"]), tuple(map(str, document["warnings"])))


def _column(patches: dict[str, Any], name: str) -> Any:
    values: Any = np.array(patches[name], TYPES.get(name, np.float64))
    if name in WIDTHS:
        values = values.reshape(-1, WIDTHS[name])
    if values.ndim != 1 + (name in WIDTHS) or not np.isfinite(values).all():
        raise ValueError(f"{name} of patches must be finite numbers, one row each")
    return values
