"""The examples in the docstrings of rolling and surfaces say what happens."""

import doctest
import importlib
import pkgutil

import pytest

import tiskel.rolling
import tiskel.surfaces

MODULES = [
    module.name
    for room in (tiskel.rolling, tiskel.surfaces)
    for module in pkgutil.iter_modules(room.__path__, f"{room.__name__}.")
]


@pytest.mark.parametrize("name", MODULES)
def test_examples_are_true(name: str) -> None:
    assert doctest.testmod(importlib.import_module(name)).failed == 0


@pytest.mark.parametrize("name", ["roll", "roll_body", "Inputs", "Trajectory", "RollStatus"])
def test_what_rolls_shows_how(name: str) -> None:
    assert ">>> " in (getattr(tiskel, name).__doc__ or "")
