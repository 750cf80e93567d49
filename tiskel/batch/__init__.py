"""Many clouds: processes on one machine, machines that share a folder, a Dask cluster.

What is done with a cloud is a function that a child process is told by name
(``"module:function"``); the room knows of files only that the function writes
them into a folder of its own. That folder takes its place when it is complete,
a line of the manifest says so, and whoever comes later believes the line.
"""

from tiskel.batch.plan import Plan
from tiskel.batch.run import Settled, run_batch
from tiskel.batch.tasks import Task, find_tasks

__all__ = ["Plan", "Settled", "Task", "find_tasks", "run_batch"]
