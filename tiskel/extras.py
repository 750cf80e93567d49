"""Packages that only some features need: the extra `full`, which a light installation is without."""

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from tiskel.errors import TiskelError

ADVICE = "pip install 'tiskel[full]'"


def there(package: str) -> bool:
    """Tell whether a package is installed, without importing it.

    Examples
    --------
    >>> from tiskel.extras import there
    >>> there("numpy"), there("a_package_that_nobody_has")
    (True, False)
    """
    try:
        return find_spec(package) is not None
    except (ImportError, ValueError):
        return False


def extra(module: str, what: str) -> Any:
    """Return a module of a package of the extra `full`.

    Parameters
    ----------
    module : str
        Its dotted name.
    what : str
        What it is needed for, as the first words of the message.

    Raises
    ------
    TiskelError
        Where the package is not installed.

    Examples
    --------
    >>> from tiskel.extras import extra
    >>> extra("a_package_that_nobody_has.drawing", "a picture")
    Traceback (most recent call last):
        ...
    tiskel.errors.TiskelError: a picture needs a_package_that_nobody_has; pip install 'tiskel[full]'
    """
    package = module.partition(".")[0]
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise
        raise TiskelError(f"{what} needs {package}; {ADVICE}") from None
