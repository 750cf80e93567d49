"""The program ``tiskel``: its commands, and how it ends."""

import signal
import sys
from types import FrameType
from typing import Annotated, NoReturn

import typer

from tiskel.cli import console, descriptors, logbook
from tiskel.cli.commands import MARKUP, Commands
from tiskel.errors import TiskelError

FAILED, INTERRUPTED = 1, 130

app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
    rich_markup_mode=MARKUP,
    help="Curve skeletons of point clouds. Stages chain through pipes:\n\n"
    "tiskel contract in.ply | tiskel skeleton - -o out.ply",
)


class Interrupted(BaseException):
    """Ctrl-C, past every handler that would turn it into something else."""


def _interrupt(signum: int, frame: FrameType | None) -> NoReturn:
    raise Interrupted


def _print_version(wanted: bool) -> None:
    if wanted:
        from tiskel import __version__

        typer.echo(f"tiskel {__version__}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[
        bool,
        typer.Option("--version", "-V", callback=_print_version, is_eager=True, help="Print the version and stop."),
    ] = False,
) -> None:
    """Take the options that come before the command."""


def main() -> None:
    """Run the program; never show a traceback unless asked with --verbose."""
    signal.signal(signal.SIGINT, _interrupt)
    descriptors.guard()
    try:
        app()
    except TiskelError as error:
        _fail(str(error), error)
    except Interrupted:
        logbook.ended("interrupted", console.session.began)
        console.errors().print("interrupted")
        _leave(INTERRUPTED)
    except BrokenPipeError:
        descriptors.abandon_output()
        _leave(FAILED)
    except MemoryError as error:
        _fail("out of memory; thin the cloud with --voxel or --sample", error)
    except ImportError as error:
        _fail(
            f"a library cannot be loaded: {error}; tiskel doctor says which, ulimit -v whether memory is limited", error
        )
    except OSError as error:
        descriptors.abandon_output()
        place = f" {error.filename}" if error.filename else ""
        _fail(f"the system refuses{place}: {error.strerror or error}; check space, permissions and memory", error)
    except Exception as error:
        _fail(f"unexpected {type(error).__name__}: {error}; run again with --verbose and report what it prints", error)


def _fail(message: str, error: BaseException) -> NoReturn:
    if console.session.verbose:
        console.errors().print_exception()
    console.fail(message)
    _leave(FAILED)


def _leave(code: int) -> NoReturn:
    try:
        sys.stdout.flush()
    except OSError:
        descriptors.abandon_output()
    sys.exit(code)
