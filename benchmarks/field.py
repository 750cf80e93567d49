"""Skeletons in the field: families that are no round cones, one-sided views, generated trees, and real clouds.

    python benchmarks/field.py [SETTING...]     # names as in field_subjects.EVERY; all of them without
    python benchmarks/field.py "4096 points" front --methods robust path --shapes torso maize --out before
    python benchmarks/field.py "trees clean" --seeds 8 --methods robust path

Writes table.csv and table.md into benchmarks/field, or the folder of --out. Methods are tiskel's, the shortest-path
tree of tests/reference, and PyGEL's local separators where PyGEL3D is installed. The trees are seeded by the hash of
the commit that is scored, so that nobody can have tuned to them. Real clouds are those of TISKEL_REFERENCE and
TISKEL_CASES. Two settings run side by side, one thread each; what crashes is a line of the table, too. A run that was
stopped goes on where it was when it is called again for the same commit: until the end rows are kept beside the table.
"""

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from field_methods import METHODS
from field_page import page
from field_scores import Row, scored
from field_subjects import EVERY, SEEDS, Make, Subject, commit, subjects

from tiskel import ShapeParams, TiskelError, make_shape, shape_graph
from tiskel.metrics.tables import to_csv

HERE = Path(__file__).parent
OUT = HERE / "field"


def rows_of(setting: str, options: argparse.Namespace) -> None:
    """Score all of a setting with some methods; print a line of JSON for each curve that is not kept yet."""
    warm = make_shape(shape_graph("capsule"), ShapeParams(count=500))[0]
    for method in options.methods:  # kernels compile once
        scored(Subject("capsule", warm, (1, 0, 2), shape_graph("capsule")), setting, method)
    have = {(row["setting"], row["shape"], row["method"]) for row in kept(options.out)}
    for name, make in subjects(setting, options.seeds):
        left = [method for method in options.methods if (setting, name, method) not in have]
        if left and (not options.shapes or name in options.shapes):
            for row in rows_of_one(setting, name, make, left):
                print("\n" + json.dumps(row), flush=True)


def rows_of_one(setting: str, name: str, make: Make, methods: list[str]) -> Iterator[Row]:
    """Yield the scores of one subject, or why there is none."""
    try:
        subject = make()
    except TiskelError as error:
        unread = {"setting": setting, "shape": name, "group": "", "kind": "whole"}
        yield from (unread | {"method": method, "skipped": str(error)} for method in methods)
        return
    yield from (scored(subject, setting, method) for method in methods)


def in_process(setting: str, options: argparse.Namespace) -> None:
    """Score a setting in a process of its own, and keep its rows."""
    words = [sys.executable, __file__, "--rows", setting, "--seeds", str(options.seeds), "--out", str(options.out)]
    words += ["--shapes", *options.shapes] if options.shapes else []
    words += ["--methods", *options.methods]
    environment = {**os.environ, "TISKEL_NUM_THREADS": "1"}
    with subprocess.Popen(words, env=environment, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if line.startswith("{"):
                with keeping(options.out).open("a") as file:
                    file.write(line)
                row = json.loads(line)
                print(f"{setting}: {row['shape']} {row['method']} {row.get('wrong', '')}", flush=True)
    if process.returncode:
        print(f"{setting}: ended with {process.returncode}", file=sys.stderr)


def keeping(out: Path) -> Path:
    """Return the file that keeps the rows of a run until its end."""
    return out / f"rows-{commit()[:12]}.jsonl"


def kept(out: Path) -> list[Row]:
    """Return the rows of a run so far, in the order of the settings, shapes and methods."""
    path = keeping(out)
    rows = [json.loads(line) for line in path.read_text().splitlines()] if path.is_file() else []
    return sorted(rows, key=lambda row: (EVERY.index(row["setting"]), METHODS.index(row["method"])))


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("settings", nargs="*", metavar="SETTING", choices=[[], *EVERY])
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=list(METHODS))
    parser.add_argument("--shapes", nargs="+", metavar="NAME", help="only these shapes, trees or files")
    parser.add_argument("--seeds", type=int, default=SEEDS, help="generated trees of each setting")
    parser.add_argument("--out", type=Path, default=OUT, help="folder of the tables")
    parser.add_argument("--rows", metavar="SETTING", help="print the rows of one setting as lines of JSON")
    options = parser.parse_args()
    commit()
    if options.rows:
        rows_of(options.rows, options)
        return
    options.out.mkdir(exist_ok=True, parents=True)
    settings = options.settings or EVERY
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(in_process, settings, [options] * len(settings)))
    rows = kept(options.out)
    keys = dict.fromkeys(key for row in rows for key in row)
    (options.out / "table.csv").write_bytes(to_csv([{key: row.get(key) for key in keys} for row in rows]))
    (options.out / "table.md").write_text(page(rows))
    keeping(options.out).unlink(missing_ok=True)


if __name__ == "__main__":
    main()
