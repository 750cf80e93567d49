"""Damaged files through every reader: each gives a value or a TiskelError, in two seconds and in proportion.

    python tests/fuzz/run.py                                   # 1000 cases of every reader
    python tests/fuzz/run.py --cases 100000 --state out/fuzz   # as many as it takes, to be continued
    python tests/fuzz/run.py --readers cloud.ply stage.skeleton --first 5000

A reader and a seed are a case. Cases run in a child process, which is started
again behind a case that killed it. Faults: a crash, more than two seconds of the
processor, more memory than ten times the file and 200 MB, any exception but
TiskelError, a warning of NumPy, a message of several lines or more than 300
characters. With --state the number of cases and the faults of every reader are
kept in a file each, and the next call goes on behind them. The exit code is 1
where there were faults.
"""

import argparse
import faulthandler
import json
import multiprocessing
import re
import resource
import signal
import sys
import time
import warnings
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzz.forked_reader import forks
from fuzz.mutations import damaged
from fuzz.originals import Reader, originals
from tiskel import TiskelError

PATIENCE = 2.0  #: seconds of the processor
STUCK = 60.0  #: seconds after which a case that cannot be interrupted counts as hanging
FREE, PER_BYTE = 200 << 20, 10  #: bytes that a case may take: so many, and so many for each of the file's
LONGEST = 300  #: characters of a message
BLOCK = 250  #: cases between two reports of a child


class Slow(BaseException):
    """A case that takes too long, past every handler of exceptions."""


def peak() -> int:
    """Return the most memory, in bytes, that this process has had."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def fault(read: Reader, data: bytes) -> str:
    """Return what is wrong with how a reader takes a file, nothing where it does as it should."""
    before = peak()
    said = _outcome(read, data)
    grown = peak() - before
    if not said and grown > FREE + PER_BYTE * len(data):
        return f"{grown >> 20} MB for {len(data)} bytes"
    return said


def _outcome(read: Reader, data: bytes) -> str:
    signal.setitimer(signal.ITIMER_PROF, PATIENCE)
    try:
        read(data)
    except TiskelError as error:
        said = str(error)
        wrong = "several lines" if "\n" in said else f"{len(said)} characters" if len(said) > LONGEST else ""
        return wrong and f"a message of {wrong}: {said[:80]!r}"
    except Slow:
        return f"more than {PATIENCE:g} s"
    except Exception as error:
        return f"{type(error).__name__}: {str(error)[:100]} ({_place(error)})"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    return ""


def _place(error: BaseException) -> str:
    import traceback

    frames = [f for f in traceback.extract_tb(error.__traceback__) if "tiskel" in f.filename]
    return f"{Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else "outside"


def _alarm(*_: Any) -> None:
    raise Slow


def run(name: str, first: int, stop: int, pipe: Connection) -> None:
    """Run cases in a child and report: (next case, faults since the last report)."""
    read, files = originals(stages=name.startswith("stage"))[name]
    signal.signal(signal.SIGPROF, _alarm)
    warnings.simplefilter("error")
    found: list[tuple[int, str]] = []
    with forks(int(PATIENCE), FREE, PER_BYTE):
        for seed in range(first, stop):
            faulthandler.dump_traceback_later(STUCK, exit=True)
            if seed % BLOCK == 0:
                pipe.send((seed, found))
                found = []
            data = damaged(files, seed)
            if said := fault(read, data):
                found.append((seed, said))
    faulthandler.cancel_dump_traceback_later()
    pipe.send((stop, found))


def fuzz(name: str, first: int, cases: int) -> list[tuple[int, str]]:
    """Return the faults of a reader: case and what is wrong."""
    stop, found = first + cases, []
    context = multiprocessing.get_context("spawn")
    while first < stop:
        mine, theirs = context.Pipe(duplex=False)
        child = context.Process(target=run, args=(name, first, stop, theirs))
        child.start()
        theirs.close()
        try:
            while first < stop:
                first, faults = mine.recv()
                found += faults
        except EOFError:  # the child is gone: its block once more, case by case
            child.join()
            found.append((first, f"a crash ({child.exitcode}) within {BLOCK} cases from here"))
            first += BLOCK
        child.join()
    return found


def main() -> None:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=1000, help="of every reader, those of earlier calls included")
    parser.add_argument("--readers", nargs="*", help="names; without it all")
    parser.add_argument("--first", type=int, default=0, help="the first case, without --state")
    parser.add_argument("--state", type=Path, help="a folder in which counts and faults are kept")
    given = parser.parse_args()
    faults = 0
    for name in given.readers or originals():
        state = _state(given.state, name, given.first)
        todo, start = given.cases - (state["cases"] if given.state else 0), time.monotonic()
        if todo > 0:
            state["faults"] += fuzz(name, given.first + state["cases"], todo)
            state["cases"] += todo
        if given.state:
            given.state.mkdir(parents=True, exist_ok=True)
            (given.state / f"{name}.json").write_text(json.dumps(state))
        faults += len(state["faults"])
        print(
            f"{name:22} {state['cases']:7} cases {len(state['faults']):4} faults {time.monotonic() - start:6.0f} s",
            flush=True,
        )
        kinds: dict[str, int] = {}
        for seed, said in state["faults"]:
            kinds.setdefault(re.sub(r"\d+", "N", said), seed)
        for said, seed in list(kinds.items())[:12]:
            print(f"    {seed}: {said}", flush=True)
    sys.exit(faults > 0)


def _state(folder: Path | None, name: str, first: int) -> dict[str, Any]:
    path = None if folder is None else folder / f"{name}.json"
    found: dict[str, Any] = (
        json.loads(path.read_text()) if path is not None and path.exists() else {"cases": 0, "faults": []}
    )
    return found


if __name__ == "__main__":
    main()
