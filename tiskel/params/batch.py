"""Settings of a batch: how many clouds at once, and what each may cost."""

from dataclasses import dataclass
from math import inf

from tiskel.errors import TiskelError
from tiskel.params.checks import at_least, between


@dataclass(frozen=True, kw_only=True)
class BatchParams:
    """Settings of :func:`tiskel.batch.run_batch`; none of them changes what is written for a cloud.

    Examples
    --------
    >>> from tiskel.params import BatchParams
    >>> BatchParams(jobs=2, timeout=600.0, shard=(1, 4)).lease
    60.0
    """

    jobs: int | None = None  #: processes at once; None: as many as there are threads
    threads: int | None = None  #: of the kernels in each process; None: the machine's divided by the jobs
    timeout: float | None = None  #: seconds that a cloud may take; None: any
    memory: float | None = None  #: GB (10^9 bytes) that a process may hold; None: any
    fresh: bool = False  #: do again what is done
    shard: tuple[int, int] = (1, 1)  #: this part of so many of the list, counted from 1
    lease: float = 60.0  #: seconds without a sign of life after which another machine takes a cloud over

    def __post_init__(self) -> None:
        at_least("jobs", self.jobs, 1)
        at_least("threads", self.threads, 1)
        for name in ("timeout", "memory"):
            value = getattr(self, name)
            if value is not None and not 0 < value < inf:
                raise TiskelError(f"{name} must be a positive number, got {value}")
        between("lease", self.lease, 1.0, inf)
        part, parts = self.shard
        if not 1 <= part <= parts:
            raise TiskelError(f"shard must be I/N with I from 1 to N, got {part}/{parts}")
