"""Many clouds: processes on one machine, machines that share a folder, a Dask cluster.

What is done with a cloud is a function that a child process is told by name
(``"module:function"``); the room knows of files only that the function writes
them into a folder of its own. That folder takes its place when it is complete,
a line of the manifest says so, and whoever comes later believes the line.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tiskel.batch.plan import Plan as Plan
    from tiskel.batch.run import run_batch as run_batch
    from tiskel.batch.supervisor import Settled as Settled
    from tiskel.batch.tasks import Task as Task
    from tiskel.batch.tasks import find_tasks as find_tasks

_HOME = {"Plan": "plan", "Settled": "supervisor", "Task": "tasks", "find_tasks": "tasks", "run_batch": "run"}
__all__ = sorted(_HOME)  # noqa: PLE0605


def __getattr__(name: str) -> Any:  # a child process loads what it needs, which is little
    if name not in _HOME:
        raise AttributeError(f"module 'tiskel.batch' has no attribute {name!r}")
    return getattr(import_module(f"tiskel.batch.{_HOME[name]}"), name)
