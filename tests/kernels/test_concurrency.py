"""Kernels of many threads and processes.

Each test runs a script in a process of its own: Taichi must not have started, and what hangs must not hang the suite.
"""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

SECONDS = 240  # a script that takes longer hangs

CLOUDS = '''
import numpy as np
from tiskel import ContractionParams, ShapeParams, TiskelError, contract, extract_skeleton, make_shape, shape_graph

def cloud(name):
    return make_shape(shape_graph(name), ShapeParams(count=300))[0]

def work(name, method="robust"):
    contraction = contract(cloud(name), ContractionParams(method=method))
    skeleton = extract_skeleton(contraction)
    return contraction.points, skeleton.nodes, skeleton.edges, skeleton.radius

def say(*words):
    """Write a line for the test; in debug mode Taichi writes on standard output, too."""
    with open("said", "a") as file:
        print(*words, file=file)

def same(one, other):
    return all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))

'''
JOBS = """
jobs = [("y", "robust"), ("capsule", "robust"), ("cross", "gls"), ("torus", "lbc")]
"""


def run(script: str, folder: Path) -> str:
    """Run a script and return what it said, having checked that it ended well; what it printed is in a file."""
    path = folder / "script.py"
    path.write_text(CLOUDS + script)
    with (
        (folder / "printed").open("w") as printed,
        subprocess.Popen(
            [sys.executable, path],
            stdout=printed,
            stderr=subprocess.PIPE,
            text=True,
            cwd=folder,
            start_new_session=True,
        ) as process,
    ):
        try:
            errors = process.communicate(timeout=SECONDS)[1]
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)  # and its children
            raise
    assert process.returncode == 0, errors
    return (folder / "said").read_text().strip()


def test_the_first_kernel_may_run_in_a_thread_that_ends(tmp_path: Path) -> None:
    """Then kernels not yet compiled run in the main thread, and what the main thread prints meanwhile is not lost."""
    script = """
import threading

done = []
worker = threading.Thread(target=lambda: done.append(work("y")))
worker.start()
bells = 0
while worker.is_alive():
    print("\\a")
    bells += 1
    worker.join(0.001)
say(same(done[0], work("y")), len(work("torus", "gls")), bells)
"""
    *said, bells = run(script, tmp_path).split()
    assert said == ["True", "4"]
    assert (tmp_path / "printed").read_text().count("\a") == int(bells) > 0


def test_a_notebook_hears_nothing_of_the_start(tmp_path: Path) -> None:
    """There sys.stdout is an object of its own."""
    script = """
import contextlib, io, os

with open("errors", "w") as file, contextlib.redirect_stdout(io.StringIO()) as heard:
    os.dup2(file.fileno(), 2)
    work("y")
say(repr(heard.getvalue() + open("errors").read()))
"""
    assert run(script, tmp_path) == "''"


def test_a_kernel_that_fails_first_does_not_bind_the_start_to_its_thread(tmp_path: Path) -> None:
    script = """
import threading
from tiskel.kernels import winding

def fail():
    try:
        winding.winding_numbers(1, 2, 3)
    except Exception:
        say("failed")

worker = threading.Thread(target=fail)
worker.start()
worker.join()
say(len(work("y")))
"""
    assert run(script, tmp_path) == "failed\n4"


def test_four_threads_at_once_give_what_they_give_one_after_the_other(tmp_path: Path) -> None:
    script = """
from concurrent.futures import ThreadPoolExecutor

with ThreadPoolExecutor(4) as pool:
    parallel = list(pool.map(lambda job: work(*job), 2 * jobs))
serial = [work(*job) for job in jobs]
say([same(one, other) for one, other in zip(parallel, 2 * serial, strict=True)])
"""
    assert run(JOBS + script, tmp_path) == str([True] * 8)


@pytest.mark.parametrize("method", ["spawn", "forkserver"])
def test_processes_of_their_own_run_kernels_of_their_own(method: str, tmp_path: Path) -> None:
    script = f"""
import multiprocessing

if __name__ == "__main__":
    serial = [work(*job) for job in jobs]
    with multiprocessing.get_context("{method}").Pool(2) as pool:
        say([same(*pair) for pair in zip(pool.starmap(work, jobs), serial, strict=True)])
"""
    assert run(JOBS + script, tmp_path) == str([True] * 4)


FORK = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")


@FORK
def test_a_process_forked_after_the_first_kernel_is_told_what_to_do(tmp_path: Path) -> None:
    script = """
import multiprocessing

first = work("y")
with multiprocessing.get_context("fork").Pool(1) as pool:
    try:
        pool.apply(work, ["y"])
    except TiskelError as error:
        say(error)
say(same(first, work("y")))
"""
    error, after = run(script, tmp_path).splitlines()
    assert "do not survive a fork" in error
    assert "get_context('spawn')" in error
    assert after == "True"


@FORK
def test_a_process_forked_before_the_first_kernel_runs_its_own(tmp_path: Path) -> None:
    script = """
import multiprocessing

with multiprocessing.get_context("fork").Pool(1) as pool:
    say(same(pool.apply(work, ["y"]), work("y")))
"""
    assert run(script, tmp_path) == "True"


@FORK
def test_a_fork_waits_for_the_kernel_of_another_thread(tmp_path: Path) -> None:
    """Or its child would wait for ever: it inherits the lock, and not the thread that holds it."""
    script = """
import os
import threading
from tiskel.kernels import runtime

runtime.ensure()
held, forking = threading.Event(), threading.Event()

def kernel():
    with runtime._lock:
        held.set()
        forking.wait()

os.register_at_fork(before=forking.set)  # the last to be registered is the first to be called
threading.Thread(target=kernel).start()
held.wait()
child = os.fork()
if child == 0:
    try:
        runtime.ensure()
    except TiskelError:
        os._exit(3)
say(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    assert run(script, tmp_path) == "3"
