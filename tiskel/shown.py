"""How results say themselves in one line, and show themselves in a notebook."""

from enum import Enum
from typing import Any, ClassVar


class Brief:
    """A result whose repr is one line: arrays and sequences by how many there are, numbers by four digits.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from tiskel.shown import Brief
    >>> class Run(Brief, SimpleNamespace):
    ...     _said = ("rows", "length", "status")
    >>> Run(rows=[1, 2, 3], length=2 / 3, status="ended")
    <Run rows=3 length=0.6667 status='ended'>
    """

    _said: ClassVar[tuple[str, ...]] = ()  #: names of what the line says

    def __repr__(self) -> str:
        words = (f"{name.rpartition('.')[2]}={_brief(_value(self, name))}" for name in self._said)
        return f"<{type(self).__name__} {' '.join(words)}>"


class Shown(Brief):
    """A result that is also something to look at: a notebook shows it as :func:`tiskel.view` does."""

    def _repr_html_(self) -> str:
        from tiskel import view

        return str(view(self)._repr_html_())


def _value(thing: Any, path: str) -> Any:
    for name in path.split("."):
        thing = getattr(thing, name)
    return thing


def _brief(value: Any) -> str:
    if isinstance(value, Enum):
        return repr(value.value)
    if isinstance(value, float):
        return f"{value:.4g}"
    return str(len(value)) if hasattr(value, "__len__") and not isinstance(value, str) else repr(value)
