"""Views along the input's own axes: one convention for all pictures, the viewer and the report.

With a and b the horizontal axes, right-handed with up: front shows a to the
right, seen against b; side shows b to the right, seen from where a points to;
top shows a to the right and b upwards. For z up, a and b are x and y; for y up,
x and -z, as in computer graphics; for x up, y and z. No view is a mirror image.

Which axis is up, ``auto``: z, as scanners, maps and robots have it; but y where
the cloud stands on y = 0 and not on z = 0, as models made for graphics do.
"""

from dataclasses import dataclass, replace

import numpy as np

from tiskel.arrays import Numbers, Points
from tiskel.params.look import Up

AXES = "xyz"
FRAMES = {"z": ((0, 1), (1, 1)), "y": ((0, 1), (2, -1)), "x": ((1, 1), (2, 1))}  # a and b: axis and sign
OPPOSITE = {"front": "back", "side": "other side", "top": "bottom"}
OPPOSITE |= {other: name for name, other in OPPOSITE.items()}
# By reasoning, unit-free: feet of a model that was set on the ground are within a hundredth of its height.
GROUND = 0.01  # share of the height between the lowest point and 0
# By looking: a quarter turn shows a second side, a low sun's height keeps what stands upright.
SIDEWAYS, UPWARDS = np.radians(-28.0), np.radians(18.0)  # of the viewpoint in space, against the broadest view


@dataclass(frozen=True)
class View:
    """A way to look at a cloud along one of its own axes.

    Attributes
    ----------
    name : str
        "front", "side" or "top", or "back", "other side" or "bottom".
    axes : (int, int)
        The input's axes that run across and up.
    signs : (int, int)
        1, or -1 where an axis runs the other way, to the left or downwards.
    towards : (int, int)
        The axis that points to the eye, and its sign.

    Examples
    --------
    >>> from tiskel.geometry.views import views
    >>> [(view.name, *view.labels, view.signs) for view in views("z")]
    [('front', 'x', 'z', (1, 1)), ('side', 'y', 'z', (1, 1)), ('top', 'x', 'y', (1, 1))]
    >>> [(view.name, *view.labels, view.signs) for view in views("y")]
    [('front', 'x', 'y', (1, 1)), ('side', 'z', 'y', (-1, 1)), ('top', 'x', 'z', (1, -1))]
    """

    name: str
    axes: tuple[int, int]
    signs: tuple[int, int]
    towards: tuple[int, int]

    @property
    def labels(self) -> tuple[str, str]:
        """The names of the axes that run across and up."""
        return AXES[self.axes[0]], AXES[self.axes[1]]

    @property
    def up(self) -> str:
        """The axis that points up in the pictures that this view belongs to, whatever it shows upwards itself."""
        return AXES[self.towards[0] if self.name in ("top", OPPOSITE["top"]) else self.axes[1]]

    def behind(self) -> "View":
        """Return the view from the other end of its axis."""
        axis, sign = self.towards
        return replace(
            self, name=OPPOSITE[self.name], signs=(-self.signs[0], self.signs[1]), towards=(axis, -sign)
        )  # fmt: skip

    def flat(self, points: Points) -> Points:
        """Return (n, 2) the input's own coordinates across and up, whichever way they run."""
        return np.asarray(points[..., list(self.axes)])

    def depth(self, points: Points) -> Numbers:
        """Return (n,) how near to the eye points (n, 3) are; more is nearer."""
        axis, sign = self.towards
        return np.asarray(sign * points[..., axis])

    def extent(self, points: Points) -> tuple[float, float]:
        """Return the width and the height of points (n, 3)."""
        width, height = np.ptp(self.flat(points), axis=0)
        return float(width), float(height)


def up_axis(points: Points, up: Up = "auto") -> str:
    """Return "x", "y" or "z": the axis that points up.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud without stray points.
    up : "auto", "x", "y" or "z"
        The axis; auto: z, but y where the cloud stands on y = 0 and not on z = 0.

    Examples
    --------
    >>> import numpy as np
    >>> from tiskel.geometry.views import up_axis
    >>> standing = np.random.default_rng(0).random((100, 3)) - [0.5, 0.0, 0.5]
    >>> up_axis(standing), up_axis(standing + 5), up_axis(standing, "x")
    ('y', 'z', 'x')
    """
    if up != "auto":
        return up
    if len(points) == 0:
        return "z"
    low, height = points.min(axis=0), np.maximum(np.ptp(points, axis=0), np.finfo(float).tiny)
    grounded = np.abs(low) <= GROUND * height
    return "y" if grounded[1] and not grounded[2] else "z"


def views(up: str) -> tuple[View, View, View]:
    """Return front, side and top with the axis up ("x", "y" or "z") pointing up."""
    (a, a_sign), (b, b_sign) = FRAMES[up]
    u = AXES.index(up)
    return (
        View("front", (a, u), (a_sign, 1), (b, -b_sign)),
        View("side", (b, u), (b_sign, 1), (a, a_sign)),
        View("top", (a, b), (a_sign, b_sign), (u, 1)),
    )


def broad_view(points: Points, up: Up = "auto") -> View:
    """Return the view that shows the largest box of points (n, 3); front where several do."""
    return max(views(up_axis(points, up)), key=lambda view: np.prod(view.extent(points)))


def eye_direction(points: Points, up: Up = "auto") -> Numbers:
    """Return (3,) the unit vector from the cloud to an eye in space: in front of its broader upright side, and above.

    Parameters
    ----------
    points : (n, 3) float64
        The cloud without stray points.
    up : "auto", "x", "y" or "z"
        The axis that points up.
    """
    chosen = up_axis(points, up)
    front, side, top = views(chosen)
    upright = max((front, side), key=lambda view: view.extent(points)[0])
    back, right, above = (np.zeros(3) for _ in range(3))
    back[upright.towards[0]], right[upright.axes[0]], above[top.towards[0]] = upright.towards[1], upright.signs[0], 1
    level = np.cos(SIDEWAYS) * back + np.sin(SIDEWAYS) * right
    return np.asarray(np.cos(UPWARDS) * level + np.sin(UPWARDS) * above)


def screen_axes(eye: Numbers, up: str) -> Points:
    """Return (3, 3) unit vectors: to the right, upwards, and towards an eye (3,)."""
    above = np.eye(3)[AXES.index(up)]
    right = np.cross(above, eye)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(eye, right), eye])
