"""Kill `tiskel run` and `tiskel batch` at random moments: nothing half-written, no orphans, and the next goes on.

    python benchmarks/kills.py --count 200 --seed 0 --state out/kills.json

SIGKILL, SIGTERM or SIGINT by chance, half of the kills on each command. After every kill each file under its own name
is whole: the same bytes as of an undisturbed run. After every fifth the command comes to its end, all files are there,
and none that was being written is left. `benchmarks/reliability.py --kills out/kills.json` puts the counts into its
page.
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from reference.kills import killed, scenes


def main() -> None:
    """Kill, count and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=200, help="of both commands together")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--state", type=Path, help="a JSON file for the counts")
    given = parser.parse_args()
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        made = scenes(Path(folder))
        for number, (name, scene) in enumerate(made.items()):
            count = (given.count + number) // len(made)
            ends, faults = killed(scene, count, given.seed + number)
            found[name] = {"kills": count, "ends": dict(sorted(ends.items())), "faults": faults}
            print(f"{name}: {count} kills, {len(faults)} faults; {dict(sorted(ends.items()))}", flush=True)
            print("\n".join(faults), flush=True)
    if given.state is not None:
        given.state.parent.mkdir(parents=True, exist_ok=True)
        given.state.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
