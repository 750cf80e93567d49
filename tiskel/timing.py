"""Wall time by part; measured times never reach a result file."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager


class Stopwatch:
    """Collect wall time by part.

    Parameters
    ----------
    began : callable, optional
        Called with the name of every part as it begins.

    Attributes
    ----------
    seconds : dict of str to float
        Wall time of each part so far.

    Examples
    --------
    >>> from tiskel.timing import Stopwatch
    >>> watch = Stopwatch()
    >>> with watch.measure("solve"):
    ...     pass
    >>> list(watch.seconds)
    ['solve']
    """

    def __init__(self, began: Callable[[str], None] = lambda part: None) -> None:
        self.began = began
        self.seconds: dict[str, float] = {}

    @contextmanager
    def measure(self, part: str) -> Iterator[None]:
        """Add the time of a block to a part, of one that fails too."""
        self.began(part)
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[part] = self.seconds.get(part, 0.0) + time.perf_counter() - start
