"""Decorators that give a command the options every command has, and the input options."""

import functools
import inspect
from collections.abc import Callable, Mapping
from typing import Any

from tiskel.cli import look_options, method_options, options, surface_options
from tiskel.cli.console import begin, end
from tiskel.cli.options import CONDITIONING
from tiskel.params import LookParams

Command = Callable[..., None]

COMMON: dict[str, tuple[Any, Any]] = {
    "threads": (options.Threads, None),
    "quiet": (options.Quiet, False),
    "verbose": (options.Verbose, False),
    "strict": (options.Strict, False),
    "log_file": (options.LogFile, None),
    "config": (options.ConfigFile, None),
}
INPUT: dict[str, tuple[Any, Any]] = {
    "columns": (options.Columns, CONDITIONING.columns),
    "classification": (options.Classification, CONDITIONING.classification),
    "voxel": (options.Voxel, CONDITIONING.voxel),
    "sample": (options.Sample, options.SAMPLE),
    "crop": (options.Crop, CONDITIONING.crop),
    "outliers": (options.Outliers, CONDITIONING.outliers),
    "cap": (options.Cap, CONDITIONING.cap),
    "noise": (options.Noise, CONDITIONING.noise),
    "noise_kind": (options.NoiseKindName, CONDITIONING.noise_kind),
    "seed": (options.Seed, CONDITIONING.seed),
}
ROLLING: dict[str, tuple[Any, Any]] = {
    "model": (surface_options.ModelsName, surface_options.USUAL),
    "side": (surface_options.SideName, surface_options.ROLL.side),
    "sphere": (surface_options.Sphere, surface_options.ROLL.radius),
    "omega": (surface_options.Omega, surface_options.OMEGA),
    "duration": (surface_options.Duration, surface_options.ROLL.duration),
    "start": (surface_options.Start, surface_options.START),
    "rtol": (surface_options.Rtol, surface_options.ROLL.rtol),
    "atol": (surface_options.Atol, surface_options.ROLL.atol),
}

LOOKING: dict[str, tuple[Any, Any]] = {
    "up": (look_options.UpAxis, look_options.LOOK.up),
    "unit": (look_options.Unit, look_options.LOOK.unit),
}


def common(command: Command) -> Command:
    """Add the options of all commands, --threads to --config, and act on them before and after the command runs."""

    def run(**arguments: Any) -> None:
        settings = dict(arguments)
        begin(settings, **{name: arguments.pop(name) for name in COMMON})
        command(**arguments)
        end()

    return _with_options(command, run, COMMON, drop=())


def reads_cloud(command: Command) -> Command:
    """Add the input options and hand them to the command as one mapping called conditioning."""

    def run(**arguments: Any) -> None:
        conditioning = {name: arguments.pop(name) for name in INPUT}
        command(**arguments, conditioning=conditioning)

    return _with_options(command, run, INPUT, drop=("conditioning",))


def looks(command: Command) -> Command:
    """Add the options of pictures and hand them to the command as one object called look."""

    def run(**arguments: Any) -> None:
        look = LookParams(**{name: arguments.pop(name) for name in LOOKING})
        command(**arguments, look=look)

    return _with_options(command, run, LOOKING, drop=("look",))


def contracts(command: Command) -> Command:
    """Add the settings of a contraction and hand those that were given to the command as a mapping, contracting."""
    return _with_settings(command, method_options.CONTRACTING, "contracting")


def curves(command: Command) -> Command:
    """Add the settings of a curve and hand those that were given to the command as a mapping, curving."""
    return _with_settings(command, method_options.CURVING, "curving")


def _with_settings(command: Command, settings: Mapping[str, tuple[Any, Any]], name: str) -> Command:
    def run(**arguments: Any) -> None:
        given = {key: value for key in settings if (value := arguments.pop(key)) is not None}
        for key in set(method_options.READ) & set(given):
            given[key] = method_options.READ[key](f"--{key.replace('_', '-')}", given[key])
        command(**arguments, **{name: given})

    return _with_options(command, run, settings, drop=(name,))


def rolls(command: Command) -> Command:
    """Add the options of slicing and rolling and hand those of rolling to the command as one mapping called rolling."""

    def run(**arguments: Any) -> None:
        rolling = {name: arguments.pop(name) for name in ROLLING}
        command(**arguments, rolling=rolling)

    return _with_options(command, run, ROLLING, drop=("rolling",))


def _with_options(
    command: Command, run: Command, extra: Mapping[str, tuple[Any, Any]], drop: tuple[str, ...]
) -> Command:
    """Return run under the name, help and signature of a command, with extra options behind its own."""
    functools.update_wrapper(run, command)
    own = [p for p in inspect.signature(command).parameters.values() if p.name not in drop]
    added = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)
        for name, (annotation, default) in extra.items()
    ]
    ordered = sorted([*own, *added], key=lambda p: p.kind)
    run.__signature__ = inspect.Signature(ordered)  # type: ignore[attr-defined]
    run.__annotations__ = {p.name: p.annotation for p in ordered}
    return run
