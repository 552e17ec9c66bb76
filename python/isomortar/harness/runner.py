"""Running cells: what is measured already is taken from the store, the rest goes to local processes or to a Dask cluster."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, as_completed
from contextlib import contextmanager
from difflib import get_close_matches
from typing import Any

from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.harness.cases import TIERS, Case, Cell, Tier
from isomortar.harness.compare import Check, CheckState, Lookup, judge, worst
from isomortar.harness.crew import Crew
from isomortar.harness.measurement import Measurement
from isomortar.harness.store import Store, sources_hash
from isomortar.harness.worker import Worker, task_of

#: Starts the measurement of a task.
Submit = Callable[[dict[str, Any]], "Future[Measurement]"]
#: Cases, or cells of one, that are told where the one that is asked for is not there.
NEAREST = 6


@frozen
class Result:
    """A cell, its measurement, the checks of its numbers; `fresh`: measured in this run."""

    cell: Cell
    measurement: Measurement
    checks: tuple[Check, ...]
    fresh: bool

    @property
    def state(self) -> CheckState:
        """The worst state of its checks."""
        return worst(check.state for check in self.checks)


def select(cases: Sequence[Case], tier: Tier, family: str | None = None, name: str | None = None) -> list[Cell]:
    """Cells of a tier and of those below it, of one family or of one case or cell if asked.

    Raises
    ------
    InputError
        Nothing is left.
    """
    chosen = [c for c in cases if family in (None, c.family)]
    if not chosen:
        raise InputError(f"there is no family {family!r}; there are {', '.join(sorted({c.family for c in cases}))}", "family")
    cells = [cell for c in chosen for cell in c.cells if name in (None, c.name, cell.name)]
    if not cells:
        asked = str(name).partition("[")[0]
        settings = [cell.name for c in chosen if c.name == asked for cell in c.cells]
        near = get_close_matches(str(name), settings or [c.name for c in chosen], NEAREST, 0.0)
        of = f"cells of {asked}" if settings else "cases"
        raise InputError(f"there is no case {name!r}; of {len(settings) or len(chosen)} {of} the nearest are {', '.join(near)}", "case")
    within = [cell for cell in cells if TIERS.index(cell.tier) <= TIERS.index(tier)]
    if not within:
        raise InputError(f"no cell in tier {tier}; what was asked for is {', '.join(sorted({cell.tier for cell in cells}))}", "tier")
    return within


def not_measured(cells: Sequence[Cell], lookup: Lookup) -> list[Result]:
    """What a run leaves behind if it never comes to its end."""
    nothing = Measurement("not measured", message="the run has not come to its end")
    return [Result(cell, nothing, tuple(judge(cell, nothing, lookup)), False) for cell in cells]


@frozen
class Measuring:
    """A cell that is being measured, or was already (then it is not `fresh`)."""

    cell: Cell
    future: Future[Measurement]
    fresh: bool

    def result(self, lookup: Lookup, store: Store) -> Result:
        """Wait for the measurement, keep it and judge it. Whatever goes wrong with it is a failure of this cell."""
        error = self.future.exception()
        measurement = Measurement("trouble", message=f"{type(error).__name__}: {error}") if error else self.future.result()
        told = measurement.lasts or measurement.sources  # one that ended with its process told nothing
        if self.fresh and told and measurement.sources != sources_hash(self.cell.case):
            words = f"{measurement.host} has other sources: not the kernel, the package or the case of this run"
            measurement = Measurement("trouble", message=words)
        if self.fresh:
            store.put(self.cell, measurement)
        return Result(self.cell, measurement, tuple(judge(self.cell, measurement, lookup)), self.fresh)


def start(cells: Sequence[Cell], store: Store, submit: Submit, fresh: bool = False) -> list[Measuring]:
    """Begin to measure cells, `fresh` also those that the store holds."""
    started = []
    for cell in cells:
        known = None if fresh else store.get(cell)
        future: Future[Measurement] = Future()
        if known:
            future.set_result(known)
        else:
            future = submit(task_of(cell))
        started.append(Measuring(cell, future, known is None))
    return started


def run(started: Sequence[Measuring], lookup: Lookup, store: Store, finished: Callable[[Result], None] = lambda _: None) -> list[Result]:
    """Wait for all cells; `finished` is called in this thread with every result as it comes.

    Returns
    -------
    list of Result
        In the order of `started`.
    """
    by_future = {measuring.future: measuring for measuring in started}
    results: dict[str, Result] = {}
    for future in as_completed(by_future):
        result = by_future[future].result(lookup, store)
        results[result.cell.name] = result
        finished(result)
    return [results[measuring.cell.name] for measuring in started]


@contextmanager
def local_processes(jobs: int) -> Iterator[Submit]:
    """A pool of `jobs` measuring processes on this machine."""
    if jobs < 1:
        raise InputError(f"is {jobs}; at least one process is needed", "jobs")
    with Crew([Worker() for _ in range(jobs)]) as crew:
        yield lambda task: crew.submit(Worker.measure, task)


@contextmanager
def dask_cluster(address: str) -> Iterator[Submit]:
    """Workers of a Dask cluster that sees the same files (a shared file system, the same environment).

    Raises
    ------
    InputError
        Dask is not installed, or nobody answers there.
    """
    try:
        from distributed import Client  # optional
    except ImportError:
        raise InputError("Dask is not installed: pip install 'isomortar[dask]'", "dask") from None
    try:
        client = Client(address, timeout="10s")  # type: ignore[no-untyped-call]
    except OSError as error:
        raise InputError(f"no Dask scheduler answers at {address}: {error}", "dask") from None
    sent = []  # kept, as the scheduler drops what nobody holds

    def submit(task: dict[str, Any]) -> Future[Measurement]:
        answer: Future[Measurement] = Future()
        sent.append(client.submit(_measure_alone, task, pure=False))
        # Not in Dask's own thread, which the program waits for at its end: of a client that is closed meanwhile no result ever comes.
        waiting = threading.Thread(target=_settle, args=(answer, sent[-1]), daemon=True)
        sent[-1].add_done_callback(lambda _: waiting.start())  # type: ignore[no-untyped-call]
        return answer

    with client:
        try:
            yield submit
        except BaseException:  # Ctrl-C too: nothing goes on measuring behind
            client.cancel(sent, force=True)  # type: ignore[no-untyped-call]
            raise


def _settle(answer: Future[Measurement], done: Any) -> None:
    """Hand over what a future of Dask's came to."""
    try:
        answer.set_result(done.result())
    except Exception as error:  # of the cluster: a worker that is gone, a task that was cancelled
        answer.set_exception(error)


def _measure_alone(task: dict[str, Any]) -> Measurement:
    """On a Dask worker: a cell in a process of its own, whose crash leaves the Dask worker alive, until the task is cancelled."""
    from distributed import get_worker

    here = get_worker()
    key = here.get_current_task()

    def wanted() -> bool:
        known = here.state.tasks.get(key)
        return known is not None and known.state == "executing"

    with Worker() as worker:
        return worker.measure(task, wanted)
