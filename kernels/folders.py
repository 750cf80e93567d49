"""The folder of compiled kernels, named before Taichi is imported and made before it starts.

Taichi 1.7 learns it from the environment. Its import aborts where neither
XDG_CACHE_HOME nor HOME is set; an empty XDG_CACHE_HOME is the root folder to
it; and a folder that it cannot make is a segmentation fault, even with the
cache switched off. With the cache off and a folder that is there, read-only or
not, nothing is read or kept. So the environment is mended before Taichi reads it.
"""

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

HOME_VARIABLE = "XDG_CACHE_HOME"
CACHE_VARIABLE = "TI_OFFLINE_CACHE_FILE_PATH"
CACHE_SWITCH = "TI_OFFLINE_CACHE"


def name_cache_home() -> None:
    """Set XDG_CACHE_HOME where HOME is unset, and forget it where it is empty; to be called before Taichi's import."""
    if not os.environ.get(HOME_VARIABLE):
        os.environ.pop(HOME_VARIABLE, None)
        if "HOME" not in os.environ:
            os.environ[HOME_VARIABLE] = str(_cache_home())


def make_cache_folder() -> None:
    """Make the folder of compiled kernels; where it cannot be made, give Taichi another to look at, and no cache."""
    name_cache_home()
    if not _writable(_folder()):  # variables, because those of the user would overrule arguments
        os.environ[CACHE_VARIABLE] = str(Path(__file__).parent)
        os.environ[CACHE_SWITCH] = "0"


def cache_folder() -> Path | None:
    """Return the folder of compiled kernels, None where the cache is switched off."""
    return None if os.environ.get(CACHE_SWITCH) == "0" else _folder()


@contextlib.contextmanager
def somewhere() -> Iterator[None]:
    """Give Taichi a working folder where the process has none any more; relative names mean nothing there anyway."""
    try:
        Path.cwd()
    except OSError:
        here = os.open(".", os.O_RDONLY)
        os.chdir(Path(__file__).parent)
        try:
            yield
        finally:
            os.chdir(here)
            os.close(here)
    else:
        yield


def _folder() -> Path:
    """Return TI_OFFLINE_CACHE_FILE_PATH, or Taichi's own folder under the cache home."""
    given = os.environ.get(CACHE_VARIABLE)
    return Path(given) if given else _cache_home() / "taichi" / "ticache"


def _cache_home() -> Path:
    """Return XDG_CACHE_HOME or ~/.cache; without a home, a place where no folder can be made."""
    given = os.environ.get(HOME_VARIABLE)
    try:
        return Path(given) if given else Path.home() / ".cache"
    except RuntimeError:  # HOME is unset, and the list of users does not know this one
        return Path(os.devnull)


def _writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
