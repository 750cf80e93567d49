"""Start Taichi once, silently, and only when a kernel is about to run.

Four things about Taichi 1.7 shape this file. It prints to stdout while it
starts, which would corrupt a pipe. Its defaults are single precision and fast
maths, which would change results. It does not survive a fork. And it serves
one thread at a time: the thread that starts it must also lay out its (empty)
tree of fields, after which any thread may call kernels, those not yet compiled
included, but never two at once. So a start is always complete, and one lock
holds start and kernels together. Threads wait for each other's kernels, which
use all cores anyway; the lock costs a call less than a microsecond, where a
thread of its own for Taichi would cost a hundred.
"""

import contextlib
import functools
import os
import threading
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from .engine import ti
from .errors import TiskelError
from .folders import make_cache_folder, somewhere
from .running import started_in
from .threads import requested_threads

impl, kernel_impl, misc = ti.lang.impl, ti.lang.kernel_impl, ti.lang.misc
_lock = threading.RLock()
_F = TypeVar("_F", bound=Callable[..., Any])

if hasattr(os, "register_at_fork"):  # a child must not inherit the lock of a thread that it does not inherit
    os.register_at_fork(before=_lock.acquire, after_in_parent=_lock.release, after_in_child=_lock.release)


def ensure() -> None:
    """Start Taichi on the CPU in double precision, or do nothing where it runs already; from any thread.

    Raises
    ------
    TiskelError
        In a process forked after the start, where Taichi would hang, and where TISKEL_NUM_THREADS is wrong.
    """
    with _lock:
        if not started_in:
            _start()
        elif started_in[0] != os.getpid():
            raise TiskelError(
                "kernels do not survive a fork, and this process was forked after the first of them ran; "
                "start workers with multiprocessing.get_context('spawn') or 'forkserver'"
            )


def started(kernel: _F) -> _F:
    """Wrap a kernel so that calling it starts Taichi first, and waits for kernels of other threads."""

    @functools.wraps(kernel)
    def call(*arguments: Any) -> Any:
        with _lock:
            ensure()
            return kernel(*arguments)

    return call  # type: ignore[return-value]


def _start() -> None:
    threads = requested_threads()
    make_cache_folder()
    _lay_out_faster()
    with _without_print(), somewhere():
        try:
            ti.init(
                arch=ti.cpu,
                default_fp=ti.f64,
                default_ip=ti.i32,
                fast_math=False,
                cpu_max_num_threads=threads,
                log_level="error",
            )
        except RuntimeError as error:
            raise TiskelError(
                f"kernels cannot start: {str(error).rpartition(']')[2].strip()} Allow the process more memory "
                "(ulimit -v), 3 GB or more"
            ) from None
    impl.get_runtime().materialize()  # only this thread can, and its kernel may fail before it would
    started_in.append(os.getpid())


def _lay_out_faster() -> None:
    """Take two thirds off the first call of a kernel, which Taichi lays out anew in every process, cached or not.

    For every node of its source it prepares words that quote that source, wrapped and underlined; a place will do.
    And it looks the source of a function up wherever that is called.
    """
    ti.lang.ast.ast_transformer_utils.ASTTransformerContext.get_pos_info = _place
    kernel_impl.getsourcelines = functools.cache(kernel_impl.getsourcelines)
    kernel_impl.getsourcefile = functools.cache(kernel_impl.getsourcefile)


def _place(context: Any, node: Any) -> str:
    """Return where a node of a kernel's source stands."""
    return f'File "{context.file}", line {node.lineno + context.lineno_offset}, in {context.func.func.__name__}:\n'


@contextlib.contextmanager
def _without_print() -> Iterator[None]:
    """Silence the module that starts Taichi; to redirect stdout would silence the other threads as well."""
    misc.print = lambda *_, **__: None
    try:
        yield
    finally:
        del misc.print
