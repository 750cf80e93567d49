"""The one exception that callers need to know; it stands in the lowest room, so that kernels can raise it too."""

LONGEST = 300  #: characters of a message; what is longer, as names and numbers of files may be, loses its middle


class TiskelError(Exception):
    """The input or the run failed; the message says what, which value, and what to do.

    Examples
    --------
    >>> from tiskel import TiskelError, load_cloud
    >>> try:
    ...     load_cloud("missing.xyz")
    ... except TiskelError as error:
    ...     print(error)
    no file missing.xyz; check the path
    """

    __module__ = "tiskel.errors"  # where callers find it

    def __init__(self, message: str) -> None:
        half = (LONGEST - 3) // 2
        super().__init__(message if len(message) <= LONGEST else f"{message[:half]}...{message[-half:]}")
