"""The table of benchmarks/dissertation is made, row by row, and published values that are met are held."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).parents[2] / "benchmarks" / "dissertation"


def made(folder: Path, *words: str, reference: Path | None = None) -> str:
    """Run the command on few and small clouds and return what it prints."""
    done = subprocess.run(
        [sys.executable, BENCH, "--quick", "--out", folder / "docs", "--kept", folder / "kept",
         "--reference", reference or folder / "none", *words],
        capture_output=True, text=True, check=True, env=os.environ, timeout=250,
    )  # fmt: skip
    return done.stdout + done.stderr


def test_a_row_is_made_drawn_and_remembered(tmp_path: Path) -> None:
    first = made(tmp_path, "--only", "point reduction speeds")
    assert "Fig 3.6 | 512: lbc" in first
    assert "pair: 0, 512" in first
    assert (tmp_path / "docs" / "dissertation" / "fig-3-6-curve.png").read_bytes().startswith(b"\x89PNG")
    page = (tmp_path / "docs" / "dissertation.md").read_text()
    assert page.count("| Fig 3.6 |") == 2
    assert page.count("this row was not run") == sum("| **" in line for line in page.splitlines()) - 1
    again = made(tmp_path, "--only", "point reduction speeds")
    assert "pair: 0, 512" not in again
    assert first.splitlines()[0] == again.splitlines()[0]


def test_without_reference_clouds_a_row_says_what_is_missing(tmp_path: Path) -> None:
    assert "Eq 4.14 |  | not testable" in made(tmp_path, "--only", "Eq 4.14")


def test_the_published_values_of_rolling_hold(tmp_path: Path) -> None:
    """Slip along -y and +x lengthens the way of .594 on the carrot, +y and -x shorten it."""
    told = made(tmp_path, "--only", "slip makes")
    assert "without 0.594; +x 0.645, -x 0.549, +y 0.525, -y 0.668 | contradicted" in told


@pytest.mark.slow
def test_centredness_of_the_reference_clouds_is_the_published_one(tmp_path: Path, reference_folder: Path) -> None:
    told = made(tmp_path, "--only", "Eq 4.14", reference=reference_folder)
    assert "hammer 0.53" in told
    assert "horse 0.10" in told
    assert "| met" in told
