"""What the program costs before it does anything: alternating runs of fresh processes, medians and minima.

    python benchmarks/startup.py             # 15 rounds
    python benchmarks/startup.py --rounds 31

Every case runs once a round, so that whatever else the machine does falls on
all of them; ratios are to ``import typer, rich``, what any program with these
two pays. The overview, ``tiskel --help``, is held at 2.5 at most.
"""

import argparse
import statistics
import subprocess
import sys
import time

BASE = "import typer, rich"
PROGRAM = "import sys; sys.argv = ['tiskel', *{words}]; from tiskel.cli.app import main; main()"
CASES = {
    "python": "pass",
    BASE: BASE,
    "import tiskel": "import tiskel",
    "import tiskel.params": "import tiskel.params",
    "tiskel --help": PROGRAM.format(words=["--help"]),
    "tiskel contract --help": PROGRAM.format(words=["contract", "--help"]),
    "tiskel run --help": PROGRAM.format(words=["run", "--help"]),
}


def seconds(code: str) -> float:
    """Return the wall time of one process."""
    start = time.perf_counter()
    subprocess.run([sys.executable, "-c", code], stdout=subprocess.DEVNULL, check=True)
    return time.perf_counter() - start


def measured(rounds: int) -> dict[str, list[float]]:
    """Return the wall times of every case; a first round, which fills caches of files, is thrown away."""
    times: dict[str, list[float]] = {name: [] for name in CASES}
    for number in range(rounds + 1):
        for name, code in CASES.items():
            once = seconds(code)
            if number:
                times[name].append(once)
    return times


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=15)
    times = measured(parser.parse_args().rounds)
    base = statistics.median(times[BASE])
    print(f"{'':24}{'median ms':>10}{'least ms':>10}{'ratio':>7}")
    for name, several in times.items():
        median = statistics.median(several)
        print(f"{name:24}{median * 1e3:10.0f}{min(several) * 1e3:10.0f}{median / base:7.2f}")


if __name__ == "__main__":
    main()
