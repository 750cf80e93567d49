"""What users do in one call: a skeleton of a cloud, of a file, and a picture of it."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy.typing as npt

from tiskel.arrays import PointsLike
from tiskel.contraction import contract
from tiskel.geometry.doubt import CurveWarning
from tiskel.io.clouds import Cloud, load_cloud
from tiskel.io.curves import as_skeleton, parse_curve
from tiskel.io.stages.skeleton import parse_skeleton
from tiskel.io.stages.which import stage_of
from tiskel.io.streams import read_bytes, write_bytes
from tiskel.params import ContractionParams, LookParams, Up
from tiskel.params.given import Unpack
from tiskel.params.keywords import MethodSettings
from tiskel.pictures.canvas import rendered
from tiskel.pictures.skeleton import skeleton_figure
from tiskel.progress import Report
from tiskel.skeleton import Skeleton, extract_skeleton


def skeletonize(
    cloud: PointsLike | str | Path, params: ContractionParams | None = None, *, weights: npt.ArrayLike | None = None,
    progress: Report | None = None, **settings: Unpack[MethodSettings],
) -> Skeleton:  # fmt: skip
    """Return the curve skeleton of a cloud: :func:`tiskel.contract`, then :func:`tiskel.extract_skeleton`.

    Parameters
    ----------
    cloud : (n, 3) array, path, Cloud, or object of Open3D or trimesh
        In any unit; a mesh is sampled.
    params : RobustParams, LbcParams or GlsParams, optional
        The settings.
    weights : (n,) array, optional
        See :func:`tiskel.contract`.
    progress : callable, optional
        Called with a :class:`tiskel.Progress` as parts of both stages begin; what it raises ends the work.
    **settings
        Those of the method by name, ``method`` itself among them; over those of params.

    Returns
    -------
    Skeleton
        What there was to say of the file and of the contraction is among its warnings, first.

    Raises
    ------
    TiskelError
        Where the file cannot be read, the cloud has no body, or a setting is none of the method's.

    Examples
    --------
    >>> from tiskel import make_shape, skeletonize
    >>> cloud, _ = make_shape("y", 1000)
    >>> skeletonize(cloud).ends, skeletonize(cloud, method="lbc", max_steps=5).params.method
    (3, 'lbc')
    """
    given = load_cloud(cloud) if isinstance(cloud, (str, Path)) else cloud
    contraction = contract(given, params, weights, progress=progress, **settings)
    skeleton = extract_skeleton(contraction, progress=progress)
    of_file = given.warnings if isinstance(given, Cloud) else ()
    said = [CurveWarning("reading", text) for text in of_file]
    said += [CurveWarning("contract", text) for text in contraction.warnings]
    return replace(skeleton, warnings=(*said, *skeleton.warnings))


def load_skeleton(source: str | Path) -> Skeleton:
    """Read a skeleton of any format that :func:`tiskel.write_skeleton` writes, or another program did.

    Parameters
    ----------
    source : str or Path
        A path, or "-" for standard input: the stage file ``skeleton.ply``, or a curve as of :func:`tiskel.load_curve`.

    Returns
    -------
    Skeleton
        All that was written, of the stage file; of other formats the curve alone, without its cloud, radii 0 where
        the file says none.

    Raises
    ------
    TiskelError
        Where the file is missing, damaged or of an unknown kind.

    Examples
    --------
    >>> import tempfile
    >>> from tiskel import load_skeleton, make_shape
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     make_shape("y", 500)[1].save(f"{folder}/y.swc")
    ...     read = load_skeleton(f"{folder}/y.swc")
    >>> read.ends, len(read.cloud)
    (3, 0)
    """
    data = read_bytes(source)
    if stage_of(data) == "skeleton":
        return parse_skeleton(data, str(source))
    return as_skeleton(parse_curve(data, source))


def plot_skeleton(
    skeleton: Skeleton, target: str | Path | None = None, *, title: str = "", up: Up = "auto", unit: str = ""
) -> Any:
    """Draw front, side and top view of a skeleton in its cloud, at one scale, and a view in space.

    Parameters
    ----------
    skeleton : Skeleton
        What is drawn.
    target : path, optional
        Where to, as PNG, SVG or PDF.
    title : str
        What stands above, before the counts.
    up, unit
        See :class:`tiskel.LookParams`.

    Returns
    -------
    matplotlib.figure.Figure
        It is on no screen: notebooks show it, and ``figure.savefig`` writes it.

    Raises
    ------
    TiskelError
        For another suffix, a folder that is not there, and a unit that is none.

    Examples
    --------
    >>> from tiskel import make_shape, plot_skeleton
    >>> len(plot_skeleton(make_shape("y", 500)[1]).axes)
    4
    """
    figure = skeleton_figure(skeleton, title, LookParams(up=up, unit=unit))
    if target is not None:
        write_bytes(target, rendered(figure, Path(target).suffix.lower()[1:]))
    return figure
