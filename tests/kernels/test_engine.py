"""How Taichi is imported: as ever, but for the search for sources that there are none of."""

import subprocess
import sys
from pathlib import Path

import pytest

CLASSES = """
import inspect
thorough = inspect.getframeinfo
{first}
{second}
assert inspect.getframeinfo is thorough
import taichi as ti

@ti.data_oriented
class Body:
    @ti.kernel
    def three(self) -> ti.i32:
        return self.one() + 2

    @ti.func
    def one(self):
        return 1

def inner():
    @ti.kernel
    def four() -> ti.i32:
        return 4
    return four

@ti.kernel
def five() -> ti.i32:
    return 5

ti.init(arch=ti.cpu, offline_cache=False, log_level="error")
print(Body().three(), inner()(), five())
"""
IMPORTED = """
import inspect, sys
from tiskel.kernels.engine import _importing_has_no_source
importer = sys._getframe(1)
thorough = inspect.getframeinfo(importer)
with _importing_has_no_source():
    quick = inspect.getframeinfo(importer)
print(thorough[:5] == quick[:5], quick.code_context)
"""
ORDERS = [("import tiskel.kernels.engine", "import taichi"), ("import taichi", "import tiskel.kernels.engine")]


def printed(source: str, folder: Path, *words: str) -> str:
    """Return the last line that Python prints with a module of this source, which Taichi reads, in a folder."""
    (folder / "theirs.py").write_text(source)
    done = subprocess.run([sys.executable, *words], check=False, capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()[-1]


@pytest.mark.parametrize(("first", "second"), ORDERS, ids=["ours first", "theirs first"])
def test_kernels_of_others_in_classes_and_functions_work_beside_ours(first: str, second: str, tmp_path: Path) -> None:
    assert printed(CLASSES.format(first=first, second=second), tmp_path, "theirs.py") == "3 4 5"


def test_the_import_system_has_no_source_by_the_long_way_either(tmp_path: Path) -> None:
    assert printed(IMPORTED, tmp_path, "-c", "import theirs") == "True None"
