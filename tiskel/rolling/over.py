"""What a run goes over: the surface of a branch, or that of the whole body."""

from tiskel.errors import TiskelError
from tiskel.params import RollParams
from tiskel.progress import Report
from tiskel.rolling.inputs import Inputs
from tiskel.rolling.roll import roll
from tiskel.rolling.roll_on import roll_on
from tiskel.rolling.trajectory import Trajectory
from tiskel.slicing.fitted import FittedSurface, Surfaces
from tiskel.surfaces.patches import BodySurface


def ground_of(surfaces: Surfaces, params: RollParams, branch: str | None = None) -> FittedSurface | BodySurface:
    """Return what the settings roll over: the body, else the surface of a branch, the longest without a name.

    Raises
    ------
    TiskelError
        Where it is not there.
    """
    if params.model != "body":
        return surfaces.named(branch)
    if surfaces.body is None:
        raise TiskelError("there is no surface of the whole body; slice again without --no-body, or choose a model")
    if branch is not None:
        raise TiskelError("the model of the body knows no branches; leave --branch out, or choose another model")
    return surfaces.body


def roll_over(
    surfaces: Surfaces, params: RollParams, inputs: Inputs | None = None, *, branch: str | None = None,
    progress: Report | None = None,
) -> Trajectory:  # fmt: skip
    """Roll a sphere over the surface that the settings name, see :func:`tiskel.roll` and :func:`tiskel.roll_on`."""
    ground = ground_of(surfaces, params, branch)
    if isinstance(ground, BodySurface):
        return roll_on(ground, params, inputs, progress=progress)
    return roll(ground, params, inputs, progress=progress)
