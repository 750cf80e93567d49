"""The one exception that callers need to know."""


class TiskelError(Exception):
    """The input or the run failed; the message says what, which value, and what to do."""
