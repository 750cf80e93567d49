"""Fitted surfaces: what the stage ``slice`` returns."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tiskel.arrays import Floats, Indices, Labels, Points
from tiskel.errors import TiskelError
from tiskel.shown import Shown
from tiskel.slicing.sections import Case, Section
from tiskel.surfaces.jets import Jet, Scalar
from tiskel.surfaces.patches import BodySurface
from tiskel.surfaces.tube import V_STOP, Tube

BRIDGED, UNSEEN, MEASURED = 0, 1, 2  # trust in a place: slices without a fit, a side without points, points all about


@dataclass(frozen=True, eq=False, repr=False)
class FittedSurface(Shown):
    """A Fourier surface along one path of a skeleton; lengths in the input's unit.

    Attributes
    ----------
    tube : Tube
        The surface itself.
    name : str
        The name of the branch.
    nodes : (k,) int32
        The nodes of the path in order; a closed one repeats its first.
    frame : str
        "m", "normal" or "rotation-minimising".
    sections : tuple of Section
        Every slice, fitted or rejected.
    trimmed : dict of str to int
        How many slices beyond both ends of the surface there are of each case.
    rows : (p,) int32
        Rows in the cloud that the surface was fitted to.
    error : float
        RMS of their misfit over the mean radius.
    distance : dict of str to float
        Their distance to the mesh of the surface: "mean", "p95" and "max".
    radius : float
        Median of the mean radii of the sections.
    length : float
        Of the skeleton curve.
    cloud : (n, 3) float64
        The whole cloud.
    note : str
        Why the frame is not the one asked for; empty where it is.
    warnings : tuple of str
        Where the surface may be wrong, and why.

    Examples
    --------
    >>> from tiskel import ShapeParams, SurfaceParams, fit_surface, make_shape, shape_graph
    >>> true = make_shape(shape_graph("banana"), ShapeParams(count=1000))[1]
    >>> surface = fit_surface(true, SurfaceParams(interval=0.05))[0]
    >>> surface.frame, surface.cases(), surface.warnings
    ('m', {'fitted': 19}, ())
    """

    _said = ("name", "order", "sections", "length", "radius", "error", "warnings")

    tube: Tube
    name: str
    nodes: Indices
    frame: str
    sections: tuple[Section, ...]
    trimmed: dict[str, int]
    rows: Indices
    error: float
    distance: dict[str, float]
    radius: float
    length: float
    cloud: Points
    note: str
    warnings: tuple[str, ...]

    @property
    def v_range(self) -> tuple[float, float]:
        """The least and the largest v, 0 and pi; infinite where the skeleton curve is a loop."""
        return self.tube.v_range

    @property
    def periods(self) -> tuple[float | None, float | None]:
        """The periods of u and v, 2 pi and pi; None for v where the skeleton curve is no loop."""
        return self.tube.periods

    @property
    def order(self) -> int:
        """The order of the Fourier series."""
        return int(self.tube.series.coefficients.shape[1]) // 2

    def jet(self, u: Scalar, v: Scalar) -> Jet:
        """Return the surface and its derivatives at (u, v), in radians."""
        return self.tube.jet(u, v)

    @property
    def unseen(self) -> float:
        """The share of the surface's turn and length that no points say anything of: sides without points."""
        return float(np.mean([section.unseen / (2 * np.pi) for section in self.sections]))

    def trust(self, u: Floats, v: Floats) -> Labels:
        """Return how far places u and v, arrays of one shape in radians, are to be trusted.

        2 where points say that the surface is there, 1 on a side of which its slice has none, 0 where it was bridged.
        """
        count = len(self.sections)
        near = np.floor(np.asarray(v) / V_STOP * count).astype(int)
        near = np.mod(near, count) if self.tube.closed else np.clip(near, 0, count - 1)
        unseen, at = (np.array([getattr(s, name) for s in self.sections])[near] for name in ("unseen", "gap_at"))
        off = np.abs(np.mod(np.asarray(u) - np.nan_to_num(at) + np.pi, 2 * np.pi) - np.pi)
        found = np.where((off < unseen / 2) & np.isfinite(at), UNSEEN, MEASURED)
        return np.where(np.array([s.case is Case.FITTED for s in self.sections])[near], found, BRIDGED).astype(np.uint8)

    def roughness(self, v: float) -> float:
        """Return how far points are off the section at v, in the input's unit: robust RMS, in between linearly."""
        fitted = [section for section in self.sections if section.case is Case.FITTED]
        rough = [section.error * section.series[0] for section in fitted]
        period = V_STOP if self.tube.closed else None
        return float(np.interp(v, [section.v for section in fitted], rough, period=period))

    def cases(self) -> dict[str, int]:
        """Return how many slices there are of each case, those beyond the ends among them."""
        return dict(Counter(section.case.value for section in self.sections) + Counter(self.trimmed))


class NoTubeError(TiskelError):
    """No branch of a skeleton can be sliced.

    Attributes
    ----------
    rejected : dict of str to str
        Why, by the name of the branch.
    """

    def __init__(self, rejected: dict[str, str]) -> None:
        reasons = "; ".join(f"branch {name}: {reason}" for name, reason in rejected.items())
        super().__init__(f"no branch can be sliced: {reasons}")
        self.rejected = rejected


@dataclass(frozen=True)
class Coverage:
    """How much of a cloud and its curve has a surface, and how far all points are from the nearest one.

    Attributes
    ----------
    points : float
        Share of the points, without stray ones, within a twentieth of the local radius of a surface, from 0 to 1.
    length : float
        Share of the curve's length with a surface, bridged slices included, from 0 to 1.
    distance : dict of str to float
        "mean", "p95" and "max" of the distances of all points but stray ones, in the input's unit.
    radii : dict of str to float
        The same in local radii: of each point in the mean radius of the section nearest to it.
    """

    points: float
    length: float
    distance: dict[str, float]
    radii: dict[str, float]


@dataclass(frozen=True, eq=False, repr=False)
class Surfaces(Shown):
    """The surfaces of a skeleton, in the order of its branches; a sequence.

    Attributes
    ----------
    surfaces : tuple of FittedSurface
        Empty only where there is a body.
    rejected : dict of str to str
        Why each of the other branches has no surface, by its name.
    cloud : (n, 3) float64
        The cloud, in the input's unit.
    coverage : Coverage or None
        How much of cloud and curve they cover; None in files of older versions.
    body : BodySurface or None
        The surface of the whole body, joints and ends included.

    Examples
    --------
    >>> from tiskel import ShapeParams, SurfaceParams, fit_surface, make_shape, shape_graph
    >>> true = make_shape(shape_graph("banana"), ShapeParams(count=1000))[1]
    >>> surfaces = fit_surface(true, SurfaceParams(interval=0.05))
    >>> [surface.name for surface in surfaces], surfaces.rejected, surfaces.named(None) is surfaces[0]
    (['0'], {}, True)
    """

    _said = ("surfaces", "rejected", "cloud")

    surfaces: tuple[FittedSurface, ...]
    rejected: dict[str, str]
    cloud: Points
    coverage: Coverage | None = None
    body: BodySurface | None = None

    def __len__(self) -> int:
        return len(self.surfaces)

    def __getitem__(self, place: int) -> FittedSurface:
        return self.surfaces[place]

    def __iter__(self) -> Iterator[FittedSurface]:
        return iter(self.surfaces)

    def named(self, name: str | None) -> FittedSurface:
        """Return the surface of a branch by its name; the longest where the name is None.

        Raises
        ------
        TiskelError
            Where there is none of this name; the message says why, and which names there are.
        """
        if not self.surfaces:
            raise TiskelError("no branch has a surface of its own, only the whole body has one; roll over that")
        if name is None:
            return max(self.surfaces, key=lambda s: s.length)
        known = [s.name for s in self.surfaces]
        if name not in known:
            why = f": {self.rejected[name]}" if name in self.rejected else ""
            raise TiskelError(f"there is no surface of branch {name}{why}; there are {', '.join(known)}")
        return self.surfaces[known.index(name)]
