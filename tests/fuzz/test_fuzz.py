"""A short run of the fuzzer; ``python tests/fuzz/run.py`` has the long one."""

import signal
import warnings
from collections.abc import Iterator

import pytest

from fuzz.mutations import damaged
from fuzz.originals import originals
from fuzz.run import _alarm, fault

CASES = 120  #: of every reader
APART = 3  #: of those whose library has a process of its own for every file


@pytest.fixture(autouse=True)
def alarm() -> Iterator[None]:
    before = signal.signal(signal.SIGPROF, _alarm)
    yield
    signal.signal(signal.SIGPROF, before)


def test_damaged_files_give_a_value_or_a_reason() -> None:
    wrong, every = [], originals()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for name, (read, files) in every.items():
            for seed in range(APART if name in ("cloud.laz", "cloud.e57") else CASES):
                if name == "stdin" and damaged(files, seed)[:4] in (b"LASF", b"ASTM"):
                    continue
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
