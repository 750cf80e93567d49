"""Runs and batches that are killed at any moment: benchmarks/kills.py has two hundred of them."""

import signal
import subprocess
import time
from pathlib import Path

import pytest

from reference.fixtures import PROGRAM
from reference.kills import Scene, damaged, goes_on, killed, orphans, scenes

pytestmark = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="asks /proc which processes are left")
KILLS = 3  #: of each command


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Scene]:
    return scenes(tmp_path_factory.mktemp("kills"))


@pytest.mark.slow
@pytest.mark.parametrize("name", ["run", "batch"])
def test_nothing_is_half_written_and_the_next_goes_on(name: str, made: dict[str, Scene]) -> None:
    ends, faults = killed(made[name], range(KILLS), seed=5)
    assert (sum(ends.values()), faults) == (KILLS, [])


@pytest.mark.slow
def test_a_batch_that_is_terminated_ends_its_workers_with_143_and_goes_on(made: dict[str, Scene]) -> None:
    scene = made["batch"]
    with subprocess.Popen([PROGRAM, *scene.words], cwd=scene.folder, start_new_session=True) as process:
        while not any(scene.out.glob(".batch/*")):  # a worker has begun
            assert process.poll() is None
            time.sleep(0.02)
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == 143
    assert orphans(process.pid) == []
    assert not (scene.out / ".batch").exists()
    assert damaged(scene) == []
    assert goes_on(scene) == []
