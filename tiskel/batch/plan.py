"""What all processes of a batch need to know."""

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tiskel.params.batch import BatchParams
from tiskel.version import version

#: What is done with one cloud: (its path, an empty folder for files, settings) -> facts for the record, JSON values:
#: "warnings" by code, "parts" in seconds, and a "row" for the summary. Where its module has prepare(settings),
#: a process calls it before its first cloud, and the limits do not count that.
Work = Callable[[Path, Path, Any], dict[str, Any]]
STATE = ".batch"  #: the folder, in that of the output, of leases and of results that are not complete


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A batch: where to, what is done with each cloud, and its limits. Sent to other processes by pickle.

    Attributes
    ----------
    output : Path
        The folder of all results.
    work : str
        Which function does one cloud, as "module:function".
    settings : object
        What the function is handed.
    parameters : mapping
        The settings as JSON values: what is recorded, and what must be the same for a result to be kept.
    params : BatchParams
    since : int
        Bytes of the manifest before this batch began; what stands beyond was done by it, here or elsewhere.
    """

    output: Path
    work: str
    settings: Any = None
    parameters: Mapping[str, Any] = field(default_factory=dict)
    params: BatchParams = field(default_factory=BatchParams)
    since: int = 0

    @property
    def digest(self) -> str:
        """A short hash of the parameters, of what is done and of the version of the program."""
        told = json.dumps([self.parameters, self.work, version()], sort_keys=True)
        return hashlib.sha256(told.encode()).hexdigest()[:16]

    @property
    def manifest(self) -> Path:
        """The file that says what is done."""
        return self.output / "manifest.jsonl"

    @property
    def leases(self) -> Path:
        """The folder of the files that say who is at which cloud."""
        return self.output / STATE / "leases"

    @property
    def unfinished(self) -> Path:
        """The folder of results that are not complete."""
        return self.output / STATE / "unfinished"

    def folder(self, name: str) -> Path:
        """Return the folder of one cloud's results."""
        return self.output / name
