"""Taichi itself, imported and told what stands in no class without a search of all modules for its source.

For every kernel and function that is defined Taichi asks whether that is in a class, and for it reads the line in
which the class begins. Where a module is imported and there is none, that line is in the import system, frozen into
Python: inspect looks through all modules for it, 1 to 10 ms each time, a quarter of what Taichi takes to be imported.
Both shortcuts answer as the long ways do.
"""

import contextlib
import inspect
import sys
from collections.abc import Iterator
from types import FrameType, TracebackType

IMPORTING = "<frozen importlib"


@contextlib.contextmanager
def _importing_has_no_source() -> Iterator[None]:
    """Say of frames of the import system, for a while, what inspect does in the end: that they have no source."""
    thorough = inspect.getframeinfo

    def quick(frame: FrameType | TracebackType, context: int = 1) -> inspect.Traceback:
        if isinstance(frame, FrameType) and frame.f_code.co_filename.startswith(IMPORTING):
            code = frame.f_code
            return inspect.Traceback(code.co_filename, frame.f_lineno, code.co_name, None, None)
        return thorough(frame, context)

    inspect.getframeinfo = quick
    try:
        yield
    finally:
        inspect.getframeinfo = thorough


with _importing_has_no_source():
    import taichi as ti
from taichi.lang import kernel_impl  # noqa: E402

__all__ = ["ti"]

_thorough = kernel_impl._inside_class


def _inside_class(level_of_class_stackframe: int) -> bool:
    """Tell whether what is defined stands in a class: never where it stands in a module itself."""
    definer = sys._getframe(level_of_class_stackframe - 1)
    return definer.f_code.co_name != "<module>" and bool(_thorough(level_of_class_stackframe + 1))


kernel_impl._inside_class = _inside_class
