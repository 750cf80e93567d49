"""Films of rolling spheres, as ``tiskel roll`` and ``tiskel plan`` write them."""

from collections.abc import Sequence

from tiskel.errors import TiskelError
from tiskel.params import LookParams
from tiskel.rolling.trajectory import Trajectory
from tiskel.slicing.fitted import FittedSurface
from tiskel.surfaces.patches import BodySurface


def film(surface: FittedSurface | BodySurface, runs: Sequence[Trajectory], target: str, look: LookParams) -> bytes:
    """Return a film of the first run, or a page with all of them, by the suffix."""
    kind = target.rpartition(".")[2].lower()
    if kind == "gif":
        from tiskel.pictures.animation import animation

        return animation(surface, runs[0], look)
    if kind != "html":
        raise TiskelError(f"an animation cannot be written as {kind!r}; choose one of gif, html")
    from tiskel import view

    tube = (surface,) if isinstance(surface, FittedSurface) else ()
    title = f"{f'branch {surface.name}' if isinstance(surface, FittedSurface) else 'the whole body'}, rolling"
    return view(surface.cloud, *tube, *runs, up=look.up, unit=look.unit, title=title).html().encode()
