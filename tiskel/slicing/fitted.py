"""Fitted surfaces: what the stage ``slice`` returns."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from tiskel.arrays import Indices, Points
from tiskel.errors import TiskelError
from tiskel.slicing.sections import Section
from tiskel.surfaces.jets import Jet, Scalar
from tiskel.surfaces.tube import Tube


@dataclass(frozen=True)
class FittedSurface:
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

    def cases(self) -> dict[str, int]:
        """Return how many slices there are of each case, those beyond the ends among them."""
        return dict(Counter(section.case.value for section in self.sections) + Counter(self.trimmed))


@dataclass(frozen=True)
class Surfaces:
    """The surfaces of a skeleton, in the order of its branches; a sequence.

    Attributes
    ----------
    surfaces : tuple of FittedSurface
        At least one.
    rejected : dict of str to str
        Why each of the other branches has no surface, by its name.
    cloud : (n, 3) float64
        The cloud, in the input's unit.

    Examples
    --------
    >>> from tiskel import ShapeParams, SurfaceParams, fit_surface, make_shape, shape_graph
    >>> true = make_shape(shape_graph("banana"), ShapeParams(count=1000))[1]
    >>> surfaces = fit_surface(true, SurfaceParams(interval=0.05))
    >>> [surface.name for surface in surfaces], surfaces.rejected, surfaces.named(None) is surfaces[0]
    (['0'], {}, True)
    """

    surfaces: tuple[FittedSurface, ...]
    rejected: dict[str, str]
    cloud: Points

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
        if name is None:
            return max(self.surfaces, key=lambda s: s.length)
        known = [s.name for s in self.surfaces]
        if name not in known:
            why = f": {self.rejected[name]}" if name in self.rejected else ""
            raise TiskelError(f"there is no surface of branch {name}{why}; there are {', '.join(known)}")
        return self.surfaces[known.index(name)]
