"""Where a sphere begins on a surface without a chart: its radius, and the place of its first contact."""

import numpy as np

from tiskel.arrays import TINY, Numbers, Points
from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.rolling.ambient import Ground
from tiskel.rolling.second import Surroundings
from tiskel.surfaces.implicit import ImplicitSurface, projected

USUAL_RADIUS = 0.25  # of the surface's median radius
FAR = 4.0  # radii of the sphere: a start that is farther from the surface than that is told
ROOMY = 0.5  # of lambda_min(K_o) R_s + 1, which is 1 on a plane: what a first place has at least
LOOKED = 400  # points of a cloud among which a start is chosen


def radius_of(surface: ImplicitSurface, radius: float | None) -> float:
    """Return the sphere's radius: the one given, else a quarter of the surface's median radius.

    Raises
    ------
    TiskelError
        Where neither is known.
    """
    usual = getattr(surface, "radius", None) if hasattr(surface, "cloud") else None
    if radius is None and usual is None:
        raise TiskelError("the radius of the sphere is missing; only surfaces of clouds suggest one")
    return radius or USUAL_RADIUS * float(usual or 0)


def first_place(ground: Ground, around: Surroundings, params: RollParams) -> Numbers:
    """Return the place (3,) where the contact begins: at start_at, else where the body is as thick as usual
    and the sphere has room.

    Raises
    ------
    TiskelError
        Where there is neither a point nor a cloud, or the point is far from the surface.
    """
    if params.start_at is not None or around.cloud is None:
        return standing_place(ground, params.start_at)
    rows = np.unique(np.linspace(0, len(around.cloud) - 1, LOOKED).astype(int))
    places = projected(ground.surface, around.cloud[rows])
    margin = ground.margin(places)
    centres = places + ground.radius * ground.touches(places)[1]
    good = (margin * ground.radius > ROOMY) & around.free(places, centres)
    score = np.where(good, -_unusual(ground, places), -np.inf) if good.any() else np.nan_to_num(margin, nan=-np.inf)
    best: Numbers = places[int(np.argmax(score))]
    return best


def _unusual(ground: Ground, places: Points) -> Numbers:
    """Return (n,) how far the body's thickness about places is from the median, as the logarithm of their ratio."""
    known = getattr(ground.surface, "local_radius", None)
    usual = float(getattr(ground.surface, "radius", 1.0))
    ratio = np.ones(len(places)) if known is None else np.asarray(known(places)) / usual
    return np.asarray(np.abs(np.log(np.where(ratio > 0, ratio, TINY))))


def standing_place(ground: Ground, point: tuple[float, float, float] | None, what: str = "start") -> Numbers:
    """Return the place (3,) of the surface at a point.

    Raises
    ------
    TiskelError
        Where the point is missing, or far from what is known of the surface.
    """
    if point is None:
        raise TiskelError(f"a surface without a chart needs the {what} as a point x,y,z (start_at, --start-at)")
    at = np.array(point, float)
    place: Numbers = projected(ground.surface, at[None])[0]
    if not np.isfinite(place).all():
        place = _by_cloud(ground, at)
    far = float(np.linalg.norm(place - at))
    if not far < FAR * ground.radius:
        raise TiskelError(
            f"the {what} {point} is {far:.4g} from the surface, {far / ground.radius:.3g} radii of the sphere; "
            "name a point near it"
        )
    return place


def _by_cloud(ground: Ground, point: Numbers) -> Numbers:
    """Return the place of the surface at the point of its cloud that is nearest; NaN without one."""
    cloud = getattr(ground.surface, "cloud", None)
    if cloud is None:
        return np.full(3, np.nan)
    nearest = cloud[np.argmin(np.linalg.norm(cloud - point, axis=1))]
    found: Numbers = projected(ground.surface, nearest[None])[0]
    return found
