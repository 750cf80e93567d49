"""Whether Taichi runs in this process; to ask does not import it."""

started_in: list[int] = []  #: the number of the process that started it, none before


def running() -> bool:
    """Return whether a kernel can be called without starting Taichi, or was started before this process was forked."""
    return bool(started_in)
