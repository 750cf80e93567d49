"""A batch from its beginning to its end."""

from collections.abc import Generator, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from tiskel.batch.manifest import Manifest
from tiskel.batch.plan import Plan
from tiskel.batch.pool import News, Pool
from tiskel.batch.summary import write_summary
from tiskel.batch.supervisor import Supervisor
from tiskel.batch.tasks import Task, absolute
from tiskel.errors import TiskelError
from tiskel.version import version


def run_batch(tasks: Sequence[Task], plan: Plan, scheduler: str = "") -> Generator[News, None, None]:
    """Do many clouds, those that are done already left out; yield what becomes of each of them as it happens.

    At the end, and where the generator is closed before it, processes are ended, and summary.csv and failed.txt are
    written.

    Parameters
    ----------
    tasks : sequence of Task
        See :func:`tiskel.batch.find_tasks`.
    plan : Plan
        Where to, what is done, and the limits.
    scheduler : str
        The address of a Dask scheduler; without it processes of this machine do the work.

    Yields
    ------
    Settled, Begun or None
        What became of a cloud; the name of one that begins, on this machine; and nothing, four times a second, where
        there is no news.

    Raises
    ------
    TiskelError
        Where the output holds files and no manifest, cannot be written, or processes or the cluster do not start.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from tiskel.batch import Plan, Settled, find_tasks, run_batch
    >>> from tiskel.params import BatchParams
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     scan, output = Path(folder, "a.xyz"), Path(folder, "out")
    ...     _ = scan.write_text("0 0 0\\n")
    ...     plan = Plan(output=output, work="tiskel.batch.example:count_bytes", params=BatchParams(jobs=1))
    ...     for news in run_batch(find_tasks([str(scan)], output), plan):
    ...         if isinstance(news, Settled):
    ...             print(news.task.name, news.outcome, (output / "a" / "size.txt").read_text())
    a done 6
    """
    plan = _begin(plan)
    jobs = plan.params.jobs or available_threads()
    supervisor = Supervisor(plan, plan.params.threads or max(1, available_threads() // jobs))
    supervisor.sweep()
    ordered = sorted(tasks, key=lambda task: (-_size(task), task.name))  # the largest first: none is left to the end
    try:
        if scheduler:
            from tiskel.batch.cluster import Cluster

            news = Cluster(plan, ordered, scheduler).news()
        else:
            news = Pool(supervisor, ordered, jobs).news()
        with closing(news):
            yield from news
    finally:
        supervisor.sweep()  # after workers of a cluster that were lost
        supervisor.close()
        write_summary(plan)


def _begin(plan: Plan) -> Plan:
    """Make the folder, unless it is somebody else's, and tell the manifest the settings."""
    try:
        plan.output.mkdir(parents=True, exist_ok=True)
        if not plan.manifest.exists() and any(plan.output.iterdir()):
            raise TiskelError(f"{plan.output} is not empty and holds no manifest.jsonl; choose another with -o")
        manifest = Manifest(plan.manifest)
        manifest.refresh()
        if plan.digest not in manifest.settings:
            manifest.append({"settings": plan.digest, "version": version(), "parameters": dict(plan.parameters)})
    except OSError as error:
        raise TiskelError(f"cannot write to {plan.output}: {error.strerror or error}; choose another with -o") from None
    return replace(plan, output=absolute(plan.output), since=plan.manifest.stat().st_size)


def _size(task: Task) -> int:
    try:
        return Path(task.path).stat().st_size
    except OSError:
        return 0


def available_threads() -> int:
    """Return the threads that this process may use."""
    from tiskel.kernels.threads import available_threads as available

    return available()
