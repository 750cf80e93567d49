"""Settings as functions are given them: an object, keywords, or keywords over an object."""

import sys
from collections.abc import Mapping
from dataclasses import MISSING, fields, replace
from typing import Any, TypeVar

from tiskel.errors import TiskelError
from tiskel.params.checks import meant
from tiskel.params.methods import ContractionParams, refuse_foreign

if sys.version_info >= (3, 11):
    from typing import Unpack
else:
    from typing_extensions import Unpack

__all__ = ["Unpack", "settled", "settled_method"]  #: ``**settings: Unpack[RollSettings]``: keywords of known names
P = TypeVar("P")


def settled(kind: type[P], params: P | None, keywords: Mapping[str, Any]) -> P:
    """Return the settings of a stage.

    Parameters
    ----------
    kind : type
        Their class.
    params : object of that class, or None
        None: the defaults.
    keywords : mapping of str to object
        What takes the place of the settings of these names; arrays and lists are tuples here.

    Raises
    ------
    TiskelError
        For settings of another stage, an unknown or a missing name, and a value that a setting cannot have.

    Examples
    --------
    >>> from tiskel import StabilityParams
    >>> from tiskel.params.given import settled
    >>> settled(StabilityParams, StabilityParams(bins=20), {"seed": 3}).bins
    20
    >>> settled(StabilityParams, None, {"binz": 20})
    Traceback (most recent call last):
    tiskel.errors.TiskelError: StabilityParams has no setting binz; did you mean bins?
    """
    if params is not None and not isinstance(params, kind):
        raise TiskelError(f"settings must be {kind.__name__}, got {type(params).__name__}")
    if params is not None and not keywords:
        return params
    every = fields(kind)  # type: ignore[arg-type]
    names = [field.name for field in every]
    for name in keywords:
        if name not in names:
            near = meant(name, names) or f"; it has {', '.join(names)}"
            raise TiskelError(f"{kind.__name__} has no setting {name}{near}")
    if params is not None:
        return replace(params, **_plain(keywords))  # type: ignore[type-var]
    absent = [field.name for field in every if field.default is field.default_factory is MISSING]
    if missing := [name for name in absent if name not in keywords]:
        raise TiskelError(f"{kind.__name__} needs {' and '.join(missing)}; give them by name")
    return kind(**_plain(keywords))


def settled_method(params: ContractionParams | None, keywords: Mapping[str, Any]) -> ContractionParams:
    """Return the settings of a method, as :func:`settled` does; without params ``method`` says of which.

    Raises
    ------
    TiskelError
        For a setting that the method does not read, and for another method than that of the params.

    Examples
    --------
    >>> from tiskel.params.given import settled_method
    >>> settled_method(None, {"method": "gls", "theta": 0.03}).theta
    0.03
    """
    if params is None:
        return ContractionParams(**_plain(keywords))
    if not isinstance(params, ContractionParams):
        raise TiskelError(f"settings must be those of a method, such as RobustParams, got {type(params).__name__}")
    method = keywords.get("method", params.method)
    if method != params.method:
        raise TiskelError(f"method is {method!r}, the settings are those of {params.method}; leave one of them out")
    refuse_foreign(type(params), keywords)
    return replace(params, **_plain(keywords)) if keywords else params  # type: ignore[type-var]


def _plain(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """Return the same with tuples in the place of lists and arrays, and numbers in that of scalars of NumPy."""
    return {name: _tuple(value.tolist() if hasattr(value, "tolist") else value) for name, value in keywords.items()}


def _tuple(value: Any) -> Any:
    return tuple(map(_tuple, value)) if isinstance(value, list) else value
