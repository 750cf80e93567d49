"""The array types are different types to mypy: a table in the place of a column is an error, not a surprise."""

import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
KINDS = ("Numbers", "Points", "Stack", "Indices", "Edges", "Mask", "Masks")
PROGRAM = """
import numpy as np
from tiskel.arrays import Edges, Floats, Indices, Lists, Mask, Masks, Numbers, Points, Stack, Table

def right(points: Points, rows: Indices, numbers: Numbers) -> tuple[Points, Numbers, Table, Floats]:
    return points[rows], np.linalg.norm(points, axis=1), points, numbers * 2

def edges() -> Edges:
    return np.zeros((3, 2), np.int32)
"""
WRONG = """
def {given}_for_{wanted}(array: {given}) -> {wanted}:
    return array
"""


@pytest.mark.slow
@pytest.mark.skipif(find_spec("mypy") is None, reason="mypy is not installed")
def test_mypy_tells_the_kinds_of_arrays_apart(tmp_path: Path) -> None:
    pairs = [(given, wanted) for given in KINDS for wanted in KINDS if given != wanted]
    program = tmp_path / "program.py"
    program.write_text(PROGRAM + "".join(WRONG.format(given=given, wanted=wanted) for given, wanted in pairs))
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path), str(program)]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout
    lines = program.read_text().splitlines()
    refused = [lines[int(number) - 2] for number in re.findall(r"program\.py:(\d+): error: .*\[return-value\]", said)]
    assert refused == [f"def {given}_for_{wanted}(array: {given}) -> {wanted}:" for given, wanted in pairs], said
    assert f"Found {len(pairs)} errors in 1 file" in said
