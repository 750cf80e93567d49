"""What settings may be: the checks that all of them share."""

from collections.abc import Iterable
from math import inf, isfinite

from tiskel.errors import TiskelError
from tiskel.wording import nearest

LARGEST = 1e308  #: a setting; larger whole numbers are no floating point numbers


def among(name: str, value: str, allowed: tuple[str, ...]) -> None:
    """Raise TiskelError where a word is none of those allowed."""
    if value not in allowed:
        raise TiskelError(f"{name} must be one of {', '.join(allowed)}, got {value!r}")


def at_least(name: str, value: int | None, least: int) -> None:
    """Raise TiskelError where a number is given and too small."""
    if value is not None and value < least:
        raise TiskelError(f"{name} must be at least {least}, got {value}")


def finite(name: str, values: tuple[float, ...] | None, count: int) -> None:
    """Raise TiskelError where numbers are given and not so many, or not finite."""
    if values is not None and (len(values) != count or not all(map(isfinite, values))):
        raise TiskelError(f"{name} must be {count} finite numbers, got {values}")


def between(name: str, value: float, low: float, high: float) -> None:
    """Raise where a number is not finite or lies outside its limits, which it may reach."""
    if not (isfinite(value) and low <= value <= high):
        limits = f"at least {low:g}" if high == inf else f"from {low:g} to {high:g}"
        raise TiskelError(f"{name} must be a number {limits}, got {value}")


def so_many(name: str, value: object, words: tuple[str, ...], least: int) -> None:
    """Raise where a value is neither a whole number of at least so many nor one of the words."""
    if value not in words and (not isinstance(value, int) or isinstance(value, bool) or value < least):
        raise TiskelError(f"{name} must be {', '.join(words)} or a whole number of at least {least}, got {value!r}")


def of_its_type(name: str, value: object, default: object) -> None:
    """Raise where a value from a file is of another type than the default of its setting; None says nothing of it."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if default is None:
        right = value is None or isinstance(value, int | list | tuple)
    elif isinstance(default, bool):
        right = isinstance(value, bool)
    elif isinstance(default, int | float):
        right = number and abs(value) < LARGEST and (isinstance(default, float) or isinstance(value, int))  # type: ignore[arg-type]
    else:
        right = isinstance(value, str) or (number and isinstance(value, int))
    if not right:
        raise TiskelError(f"setting {name} cannot be {str(value)[:40]!r}; run the stage that wrote it again")


def meant(name: str, known: Iterable[str]) -> str:
    """Return a question after the name that was probably meant, empty where none is like it.

    Examples
    --------
    >>> from tiskel.params.checks import meant
    >>> meant("intervall", ["interval", "gap"]), meant("colour", ["interval"])
    ('; did you mean interval?', '')
    """
    near = nearest(name, known)
    return f"; did you mean {near}?" if near else ""
