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
    tube : the surface itself. name : of the branch. nodes : (k,) of the path; a closed one repeats its first.
    frame : "m", "normal" or "rotation-minimising"; note : why it is not the one asked for.
    sections : every slice, fitted or rejected; trimmed : the cases of those beyond both ends of the surface.
    rows : (p,) rows in the cloud that the surface was fitted to; error : RMS of their misfit over the mean radius;
    distance : theirs to the mesh of the surface, mean, p95 and max.
    radius : median of the mean radii. length : of the skeleton curve. cloud : (n, 3), all of it.
    warnings : what a user should know.
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
        return self.tube.v_range

    @property
    def periods(self) -> tuple[float | None, float | None]:
        return self.tube.periods

    @property
    def order(self) -> int:
        """The order of the Fourier series."""
        return int(self.tube.series.coefficients.shape[1]) // 2

    def jet(self, u: Scalar, v: Scalar) -> Jet:
        return self.tube.jet(u, v)

    def cases(self) -> dict[str, int]:
        """Return how many slices there are of each case."""
        return dict(Counter(section.case.value for section in self.sections) + Counter(self.trimmed))


@dataclass(frozen=True)
class Surfaces:
    """The surfaces of a skeleton, by place or in order; ``rejected`` says of the other branches why not."""

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
        """Return the surface of a branch, without a name the longest."""
        if name is None:
            return max(self.surfaces, key=lambda s: s.length)
        known = [s.name for s in self.surfaces]
        if name not in known:
            why = f": {self.rejected[name]}" if name in self.rejected else ""
            raise TiskelError(f"there is no surface of branch {name}{why}; there are {', '.join(known)}")
        return self.surfaces[known.index(name)]
