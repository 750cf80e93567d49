"""A short run of the fuzzer; ``python tests/fuzz/run.py`` has the long one."""

import os
import signal
import warnings
from collections.abc import Iterator

import numpy as np
import pytest

from fuzz.forked_reader import TooMuch, forks
from fuzz.mutations import damaged
from fuzz.originals import originals
from fuzz.run import FREE, PATIENCE, PER_BYTE, _alarm, fault
from tiskel import TiskelError
from tiskel.io.formats.isolated import Arrays, read_apart

CASES = 120  #: of every reader


@pytest.fixture(autouse=True)
def alarm() -> Iterator[None]:
    before = signal.signal(signal.SIGPROF, _alarm)
    yield
    signal.signal(signal.SIGPROF, before)


def test_damaged_files_give_a_value_or_a_reason() -> None:
    wrong, every = [], originals()
    with warnings.catch_warnings(), forks(int(PATIENCE), FREE, PER_BYTE):
        warnings.simplefilter("error")
        for name, (read, files) in every.items():
            for seed in range(CASES):
                if said := fault(read, damaged(files, seed)):
                    wrong.append((name, seed, said))
    assert wrong == []


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (lambda data: 1 / 0, "ZeroDivisionError"),
        (lambda data: all(iter(lambda: 1, 0)), "more than"),
        (lambda data: data, ""),
    ],
)
def test_the_fuzzer_tells_faults(answer: object, said: str) -> None:
    assert said in fault(answer, b"")  # type: ignore[arg-type]
    assert not said or fault(answer, b"")  # type: ignore[arg-type]


def _doubles(data: bytes) -> Arrays:
    return {"points": np.frombuffer(data, "<f8")}


def _dies(data: bytes) -> Arrays:
    os.abort()


def _fills(data: bytes) -> Arrays:
    return {"points": np.ones(len(data) << 20)[:3]}


def _never_ends(data: bytes) -> Arrays:
    while True:
        pass


def test_forks_read_as_processes_do_and_tell_what_takes_too_much() -> None:
    data = np.arange(3.0).tobytes()
    held = np.empty(1 << 29)  # 4 GB of addresses: as many as a suite has that has gone on for long
    with forks(1, 20 << 20, PER_BYTE):
        np.testing.assert_array_equal(read_apart(_doubles, data, "a.e57", "E57")["points"], [0, 1, 2])
        with pytest.raises(TiskelError, match=r"a.e57 is not a valid E57 file: buffer size must be a multiple"):
            read_apart(_doubles, data[:-1], "a.e57", "E57")
        with pytest.raises(TiskelError, match="its reader died"):
            read_apart(_dies, data, "a.e57", "E57")
        with pytest.raises(TooMuch, match="MB for 24 bytes"):
            read_apart(_fills, data, "a.e57", "E57")
        with pytest.raises(TooMuch, match="more than 1 s"):
            read_apart(_never_ends, data, "a.e57", "E57")
    assert held.nbytes == 4 << 30
