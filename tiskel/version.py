"""The version of the installed package, which stage files carry."""

from functools import cache
from importlib import metadata


@cache
def version() -> str:
    """Return the version, as pyproject.toml has it."""
    return metadata.version("tiskel")
