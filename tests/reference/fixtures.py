"""Types of the shared fixtures."""

import subprocess
from collections.abc import Callable
from typing import Any

Runner = Callable[..., subprocess.CompletedProcess[bytes]]  #: words, data=bytes, environment variables
Load = Callable[[str], Any]  #: name -> array, or arrays by name
