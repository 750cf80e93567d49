"""Shared fixtures: the reference clouds, where they are, and the program in a process of its own."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from reference.fixtures import PROGRAM, Load, Runner

settings.register_profile("tiskel", deadline=None)  # timing decides no test; a kernel's first call compiles it
settings.load_profile("tiskel")

SHARED = Path(__file__).parents[1] / ".." / "shared"
REFERENCE = Path(os.environ.get("TISKEL_REFERENCE", SHARED / "reference"))
CASES = Path(os.environ.get("TISKEL_CASES", SHARED / "cases"))


@pytest.fixture(autouse=True)
def _kernels_run_where_they_are_tested(request: pytest.FixtureRequest) -> None:
    """Start Taichi for tests of kernels: until it runs, NumPy does their work on small clouds."""
    if request.path.parent.name == "kernels":
        from tiskel.kernels import runtime

        runtime.ensure()


@pytest.fixture(scope="session")
def reference_folder() -> Path:
    if not (REFERENCE / "clouds").is_dir():
        pytest.skip(f"no reference clouds in {REFERENCE}; set TISKEL_REFERENCE")
    return REFERENCE


@pytest.fixture(scope="session")
def reference_cloud(reference_folder: Path) -> Load:
    from tiskel import load_cloud

    return lambda name: load_cloud(reference_folder / "clouds" / f"{name}.ply").points


@pytest.fixture(scope="session")
def toolbox(reference_folder: Path) -> Load:
    return lambda name: dict(np.load(reference_folder / "toolbox" / f"{name}.npz"))


@pytest.fixture
def tiskel(tmp_path: Path) -> Runner:
    """Run the program in a fresh folder and return the finished process."""

    def run(*words: object, data: bytes | None = None, **variables: str) -> subprocess.CompletedProcess[bytes]:
        environment = {**os.environ, "COLUMNS": "200", **variables}
        return subprocess.run(
            [PROGRAM, *map(str, words)],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            check=False,
            input=data or b"",
        )

    return run


@pytest.fixture(scope="session")
def capsule() -> np.ndarray:
    from tiskel import ShapeParams, make_shape, shape_graph

    return make_shape(shape_graph("capsule"), ShapeParams(count=800))[0]


@pytest.fixture
def cloud(tiskel: Runner, tmp_path: Path) -> Path:
    assert tiskel("shape", "y", "-n", 900, "-o", "y.ply").returncode == 0
    return tmp_path / "y.ply"


@pytest.fixture(scope="session")
def cases_folder() -> Path:
    if not CASES.is_dir():
        pytest.skip(f"no failing inputs in {CASES}; set TISKEL_CASES")
    return CASES
