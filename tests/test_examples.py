"""The examples in the docstrings say what happens, and every public name has one."""

import doctest
import importlib
import pkgutil

import pytest

import tiskel

SKIPPED = ("tiskel.cli", "tiskel.kernels")
MODULES = [
    module.name for module in pkgutil.walk_packages(tiskel.__path__, "tiskel.") if not module.name.startswith(SKIPPED)
]


@pytest.mark.parametrize("name", ["tiskel", *MODULES])
def test_examples_are_true(name: str) -> None:
    assert doctest.testmod(importlib.import_module(name)).failed == 0


@pytest.mark.parametrize("name", tiskel.__all__)
def test_every_public_name_shows_how(name: str) -> None:
    assert ">>> " in (getattr(tiskel, name).__doc__ or "")
