"""The one exception that callers need to know."""

from tiskel.kernels.errors import TiskelError

__all__ = ["TiskelError"]
