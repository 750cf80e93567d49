"""What settings may be: the checks that all of them share."""

from math import isfinite

from tiskel.errors import TiskelError


def among(name: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise TiskelError(f"{name} must be one of {', '.join(allowed)}, got {value!r}")


def at_least(name: str, value: int | None, least: int) -> None:
    if value is not None and value < least:
        raise TiskelError(f"{name} must be at least {least}, got {value}")


def finite(name: str, values: tuple[float, ...] | None, count: int) -> None:
    if values is not None and (len(values) != count or not all(map(isfinite, values))):
        raise TiskelError(f"{name} must be {count} finite numbers, got {values}")
