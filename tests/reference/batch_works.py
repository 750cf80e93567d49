"""Works for the tests of batches: what a cloud file says is done to the process that reads it."""

import ctypes
import os
import signal
import time
from pathlib import Path
from typing import Any

from tiskel.errors import TiskelError

FAILING = {
    "refuse": "refused",
    "raise": "error",
    "eat": "memory",
    "wait": "timeout",
    "kill": "killed",
    "abort": "crashed",
    "leave": "crashed",
}  #: words that a file may hold, and the kind of failure that follows


def obey(path: Path, folder: Path, settings: Any) -> dict[str, Any]:
    """Do what the first word of a file says; else write the file backwards, slowly, in two files."""
    text = path.read_text()
    log(settings, f"begin {path.stem} {os.getpid()}")
    _misbehave(text.split()[0])
    (folder / "half.txt").write_text(text[: len(text) // 2])
    time.sleep((settings or {}).get("pause", 0.0))
    (folder / "deep").mkdir()
    (folder / "deep" / "back.txt").write_text(text[::-1])
    return {"row": {"length": len(text)}, "warnings": {"odd": 1} if "odd" in text else {}, "parts": {"all": 0.5}}


def log(settings: Any, line: str) -> None:
    """Append a line to a log that all processes share."""
    if settings and "log" in settings:
        with Path(settings["log"]).open("a") as file:
            file.write(f"{line}\n")


def _misbehave(word: str) -> None:
    if word == "refuse":
        raise TiskelError("it is no cloud; choose another")
    if word == "raise":
        raise RuntimeError("broken\nin two lines")
    if word == "eat":
        held = []
        while True:
            held.append(b"x" * 20_000_000)
            time.sleep(0.01)
    if word == "wait":
        time.sleep(600)
    if word == "kill":
        os.kill(os.getpid(), signal.SIGKILL)
    if word == "abort":
        os.write(2, b"assertion failed somewhere\n")
        ctypes.CDLL(None).abort()
    if word == "leave":
        os._exit(3)
