"""The one exception that callers need to know."""


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
