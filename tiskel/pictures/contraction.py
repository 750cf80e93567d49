"""A contracted cloud in the cloud that it was."""

from tiskel.contraction import Contraction
from tiskel.params import LookParams
from tiskel.pictures.skeleton import three_views


def contraction_picture(c: Contraction, title: str, kind: str = "png", look: LookParams | None = None) -> bytes:
    """Return front, side and top view of contracted points in their cloud, at one scale, and a view in space.

    Parameters
    ----------
    c : Contraction
        What is drawn.
    title : str
        The name of the cloud.
    kind : "png", "svg" or "pdf"
        The format.
    look : LookParams, optional
        Which axis points up, and the unit of length.

    Returns
    -------
    bytes
    """
    steps = f"{len(c.points)} of {len(c.cloud)} points after {len(c.steps)} step{'' if len(c.steps) == 1 else 's'}"
    return three_views(c.cloud[~c.strays], c.points, f"{title}: {steps}", kind, look)
