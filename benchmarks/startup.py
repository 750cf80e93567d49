"""What the program costs before it does anything: alternating runs of fresh processes, medians and minima.

    python benchmarks/startup.py                    # 15 rounds
    python benchmarks/startup.py --rounds 31
    python benchmarks/startup.py --cloud horse.ply  # the cloud that is contracted; a Y of 2000 points without
    python benchmarks/startup.py --write            # into benchmarks/speed/startup.csv and .md

Every case runs once a round, so that whatever else the machine does falls on
all of them; a ratio is the median of the rounds' ratios to a yardstick: ``import
typer, rich``, what any program with these two pays, or the start of Taichi, what
any program with a kernel pays. Held at most: ``tiskel --help`` 2.5 times the
first, a warm contraction 1.8 times the second, and a warm pipe of four commands
at 4096 points 6 seconds. Cold is without Taichi's cache of kernels.
"""

import argparse
import shlex
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from tables import Row, shown, written

BASE, TAICHI = "import typer, rich", "import taichi; taichi.init"
PROGRAM = "import sys; sys.argv = ['tiskel', *{words}]; from tiskel.cli.app import main; main()"
COUNT = 4096  # points of the cloud that goes through the pipe


def python(code: str) -> str:
    """Return a command of the shell that runs some Python."""
    return shlex.join([sys.executable, "-c", code])


def program(*words: str) -> str:
    """Return a command of the shell that runs tiskel."""
    return python(PROGRAM.format(words=list(words)))


def cases(folder: Path, cloud: Path) -> dict[str, tuple[str, str]]:
    """Return by name the command of every case, and its yardstick."""
    four = " | ".join([
        program("contract", str(folder / "pipe.ply"), "-q"), program("skeleton", "-", "-q"),
        program("slice", "-", "-q"), program("roll", "-", "-q"),
    ])  # fmt: skip
    return {
        BASE: (python(BASE), BASE),
        "python": (python("pass"), BASE),
        "import tiskel": (python("import tiskel"), BASE),
        "import tiskel.params": (python("import tiskel.params"), BASE),
        "tiskel --help": (program("--help"), BASE),
        "tiskel contract --help": (program("contract", "--help"), BASE),
        TAICHI: (python("import taichi; taichi.init(arch=taichi.cpu)"), TAICHI),
        "import tiskel.contraction": (python("import tiskel.contraction"), TAICHI),
        f"tiskel contract {cloud.name}": (program("contract", str(cloud), "-q"), TAICHI),
        "the same, cold": (f"TI_OFFLINE_CACHE=0 {program('contract', str(cloud), '-q')}", TAICHI),
        f"contract | skeleton | slice | roll, {COUNT} points": (four, TAICHI),
    }


def seconds(command: str) -> float:
    """Return the wall time of a command of the shell."""
    start = time.perf_counter()
    subprocess.run(command, shell=True, stdout=subprocess.DEVNULL, check=True)
    return time.perf_counter() - start


def measured(rounds: int, commands: dict[str, tuple[str, str]], clock: Callable[[str], float]) -> list[Row]:
    """Return a row for every case; a first round, which fills caches of files and kernels, is thrown away."""
    times: dict[str, list[float]] = {name: [] for name in commands}
    for number in range(rounds + 1):
        for name, (command, _) in commands.items():
            once = clock(command)
            if number:
                times[name].append(once)
    rows = []
    for name, (_, base) in commands.items():
        ratios = [one / other for one, other in zip(times[name], times[base], strict=True)]
        rows.append({
            "case": name, "median s": f"{statistics.median(times[name]):.3f}", "least s": f"{min(times[name]):.3f}",
            "ratio": f"{statistics.median(ratios):.2f}", "to": base,
        })  # fmt: skip
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--cloud", type=Path)
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        seconds(program("shape", "quadruped", "-n", str(COUNT), "-o", f"{folder}/pipe.ply"))
        seconds(program("shape", "y", "-n", "2000", "-o", f"{folder}/y.ply"))
        rows = measured(given.rounds, cases(Path(folder), given.cloud or Path(folder, "y.ply")), seconds)
    print(shown(rows))
    if given.write:
        written(
            "startup", rows, f"Fresh processes, {given.rounds} rounds in turn; a ratio is the median of the rounds'."
        )


if __name__ == "__main__":
    main()
