"""Kill `tiskel run` and `tiskel batch` at random moments: nothing half-written, no orphans, and the next goes on.

    python benchmarks/kills.py --count 200 --seed 0 --state out/kills.json

SIGKILL, SIGTERM or SIGINT by chance, half of the kills on each command. After every kill each file under its own name
is whole: the same bytes as of an undisturbed run. After every fifth the command comes to its end, all files are there,
and none that was being written is left. Resumable: kills of earlier calls with the same --state count.
`benchmarks/reliability.py --kills out/kills.json` puts them into its page.
"""

import argparse
import json
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from reference.kills import Scene, killed, scenes

BLOCK = 5  # tries between two runs that come to their end


def main() -> None:
    """Kill, count and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=200, help="of both commands together, earlier calls included")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--state", type=Path, default=Path("out/kills.json"), help="a JSON file for the counts")
    given = parser.parse_args()
    found = json.loads(given.state.read_text()) if given.state.exists() else {}
    given.state.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        made = scenes(Path(folder))
        print({name: f"{scene.seconds:.1f} s undisturbed" for name, scene in made.items()}, flush=True)
        while sum(one["kills"] for one in found.values()) < given.count:
            for number, (name, scene) in enumerate(made.items()):
                _block(
                    found.setdefault(name, {"tries": 0, "kills": 0, "ends": {}, "faults": []}),
                    scene,
                    given.seed + number,
                )
            given.state.write_text(json.dumps(found, indent=1) + "\n")
            print({name: (one["kills"], one["ends"], one["faults"]) for name, one in found.items()}, flush=True)


def _block(told: dict[str, Any], scene: Scene, seed: int) -> None:
    """Kill a command a few times, and add what came of it."""
    ends, faults = killed(scene, range(told["tries"], told["tries"] + BLOCK), seed)
    told["tries"] += BLOCK
    told["ends"] = dict(sorted((Counter(told["ends"]) + ends).items()))
    told["kills"] = told["tries"] - told["ends"].get("done", 0)
    told["faults"] += faults


if __name__ == "__main__":
    main()
