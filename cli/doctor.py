"""``tiskel doctor``."""

import importlib
import platform
from importlib import metadata

import typer

from tiskel.cli import console
from tiskel.cli.common import common
from tiskel.errors import TiskelError
from tiskel.extras import ADVICE, there

NEEDED = ("numpy", "scipy", "taichi", "plyfile", "typer", "rich")
OPTIONAL = {
    "ripser": f"loops of the surface in tiskel metrics; {ADVICE}",
    "matplotlib": f"pictures, films, --cap; {ADVICE}",
    "networkx": f"GraphML, graphs in Python; {ADVICE}",
    "cvxopt": "--solver cholmod; pip install 'tiskel[cholmod]'",
    "laspy": "LAS and LAZ; pip install 'tiskel[las]'",
    "e57": "E57; pip install 'tiskel[e57]'",
    "distributed": "tiskel batch --scheduler; pip install 'tiskel[cluster]'",
}


@common
def doctor() -> None:
    """Check the installation: versions, optional parts, threads, and that a kernel runs."""
    from tiskel import __version__

    lines = [("tiskel", __version__, True), ("python", platform.python_version(), True)]
    lines += [(name, *_state(name)) for name in NEEDED]
    for name, remark in OPTIONAL.items():
        if not there(name):
            lines.append((name, f"not installed; optional: {remark}", True))
            continue
        version, usable = _state(name)
        lines.append((name, version if usable else f"not usable ({version}); optional: {remark}", True))
    lines += _kernels()
    for name, remark, fine in lines:
        typer.echo(f"{'ok ' if fine else 'BAD'} {name:12} {remark}")
    bad = [name for name, _, fine in lines if not fine]
    if bad:
        raise TiskelError(f"not usable: {', '.join(bad)}; install tiskel again")
    console.say("everything needed is there")


def _state(module: str) -> tuple[str, bool]:
    """Return the version of a module, or why it cannot be imported."""
    try:
        loaded = importlib.import_module(module)
    except Exception as error:  # a broken native library can raise anything
        return str(error).splitlines()[0] if str(error) else type(error).__name__, False
    version = getattr(loaded, "__version__", None) or metadata.version(module)
    return ".".join(map(str, version)) if isinstance(version, tuple) else str(version), True


def _kernels() -> list[tuple[str, str, bool]]:
    """Run a small contraction and say with how many threads, and where compiled kernels are kept."""
    from tiskel import ShapeParams, contract, make_shape, shape_graph
    from tiskel.kernels import folders, threads

    try:
        from tiskel.kernels import runtime

        runtime.ensure()  # so few points would do without
        left = len(contract(make_shape(shape_graph("capsule"), ShapeParams(count=200))[0]).points)
        state = (f"run on {threads.requested_threads()} threads; 200 points contracted to {left}", True)
    except Exception as error:
        state = (f"{type(error).__name__}: {error}", False)
    cache = folders.cache_folder() or "off: its folder cannot be made, or TI_OFFLINE_CACHE is 0"
    return [("kernels", *state), ("cache", str(cache), True)]
