"""The one exception that callers need to know; it stands in the lowest room, so that kernels can raise it too."""


class TiskelError(Exception):
    """The input or the run failed; the message says what, which value, and what to do."""

    __module__ = "tiskel.errors"  # where callers find it
