"""Many runs of the program, each in a process of its own, for the start of one: a forked child for every run.

    python forked.py < runs.json > outcomes.json

Reads a list of lists of arguments; writes a list of objects: code (negative: the
signal), seconds, megabytes (peak), out and err. What a command loads is loaded
before the forks; Taichi is not started there, since it would not survive.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

PATIENCE = 60  #: seconds after which a run counts as hanging


def outcomes(runs: list[list[str]], folder: Path, **variables: str) -> list[dict[str, Any]]:
    """Return what came of each run, all of them in one folder."""
    done = subprocess.run(
        [sys.executable, __file__], input=json.dumps(runs), capture_output=True, text=True, check=False, cwd=folder,
        env={**os.environ, "COLUMNS": "200", "TISKEL_NUM_THREADS": "1", **variables},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


def _run(words: list[str]) -> dict[str, Any]:
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = os.fork()
        if child == 0:
            _become(words, out.fileno(), err.fileno())
        _, status, usage = os.wait4(child, 0)
        seconds = usage.ru_utime + usage.ru_stime  # of the processor: others may be at work
        said = []
        for file in (out, err):
            file.seek(0)
            said.append(file.read().decode("utf-8", "backslashreplace"))
    code = os.waitstatus_to_exitcode(status)
    return {"code": code, "seconds": seconds, "megabytes": usage.ru_maxrss / 1024, "out": said[0], "err": said[1]}


def _become(words: list[str], out: int, err: int) -> None:
    """Turn this child into a run of the program; never returns."""
    from tiskel.cli.app import main

    os.dup2(out, 1)
    os.dup2(err, 2)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    signal.alarm(PATIENCE)
    sys.argv = ["tiskel", *words]
    code = 70
    try:
        main()
        code = 0
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _load() -> None:
    import tiskel.cli.app
    import tiskel.io.clouds
    import tiskel.io.stages.surface
    import tiskel.skeleton  # noqa: F401


if __name__ == "__main__":
    _load()
    json.dump([_run(words) for words in json.load(sys.stdin)], sys.stdout)
