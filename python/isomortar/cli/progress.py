"""What a person sees of a run: a bar that lives on a terminal or below a notebook's cell, plain lines elsewhere and in a log file."""

from __future__ import annotations

import os
import shlex
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from datetime import datetime
from enum import IntEnum
from functools import partial
from importlib.metadata import version
from pathlib import Path
from time import monotonic
from types import NoneType
from typing import TYPE_CHECKING

import numpy as np

from isomortar._arguments import kind
from isomortar.cli.words import many
from isomortar.errors import InputError
from isomortar.model.entities import Problem
from isomortar.results.files import is_marked, make_folder, named
from isomortar.solve.record import AugmentationRecord, IterationRecord, Observer, StepResult

if TYPE_CHECKING:
    from rich.table import Table

#: Seconds after which a bar in a notebook is drawn anew, at the earliest.
REDRAWN = 0.2


class Detail(IntEnum):
    """What is told of a run; each tells what those before it tell as well, the last one in the log alone."""

    WARNINGS, EVENTS, STEPS, ITERATIONS, LOG = range(5)


class Progress(Observer):
    """Lines about a run, as many as are wanted.

    Parameters
    ----------
    problem : Problem
    tell : callable
        Prints a line.
    detail : Detail
        What is told.
    log : callable, optional
        Gets every line, told or not.
    """

    def __init__(
        self, problem: Problem, tell: Callable[[str], None], detail: Detail = Detail.STEPS, log: Callable[[str], None] | None = None
    ) -> None:
        self._problem, self._tell, self._detail, self._log = problem, tell, detail, log
        self._stages = [stage.name for stage in problem.stages for _ in range(stage.steps)]
        self._total, self._first, self._done = problem.total_steps, 1, 0
        self._begin: float | None = None
        self._warnings = set[str]()
        self._work = np.zeros((len(problem.contacts), 2))
        self._reason = ""

    def started(self, total_steps: int, first_step: int) -> None:
        """Say how much there is to do."""
        self._first, self._done, self._begin = first_step, first_step - 1, monotonic()
        if first_step > total_steps:
            self._say(f"{self._problem.name}: all {many(total_steps, 'load step')} are there already")
        elif first_step > 1:
            self._say(f"{self._problem.name}: {first_step - 1} of {many(total_steps, 'load step')} are there, going on")
        else:
            self._say(f"{self._problem.name}: {many(total_steps, 'load step')}")

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:
        """One line an iteration."""
        within = f"augmentation {augmentation}, " if self._problem.settings.method == "uzawa" else ""
        self._say(
            f"  step {step}, load time {time:.6g}: {within}iteration {record.iteration}, residual {record.residual:.1e}; "
            f"{'; '.join((_active(record), *record.notes))}",
            Detail.ITERATIONS,
        )

    def augmented(self, step: int, time: float, record: AugmentationRecord) -> None:
        """One line an augmentation."""
        self._say(
            f"  step {step}, load time {time:.6g}: augmentation {record.augmentation} changed pressures by "
            f"{record.change_pressure:.1e}, tractions by {record.change_traction:.1e}",
            Detail.ITERATIONS,
        )

    def recorded(self, result: StepResult) -> None:
        """One line a load step, and one of what it took."""
        self._count(result)
        self._say(self._step_line(result), Detail.STEPS)
        self._say(_effort(result), Detail.ITERATIONS)

    def cut(self, step: int, time: float, increment: float, reason: str) -> None:
        """Say what failed and what is tried next."""
        why = "for the same reason" if reason == self._reason else reason
        self._reason = reason
        self._say(f"step {step}: load increment to {time:.6g} failed, cut to 1/{round(1 / increment)} step: {why}")

    def warned(self, message: str) -> None:
        """Pass it on, once, also when quiet."""
        if message not in self._warnings:
            self._warnings.add(message)
            self._say(f"warning: {message}", Detail.WARNINGS)

    def _count(self, result: StepResult) -> None:
        self._done = result.step
        self._work += np.reshape([contact.work for contact in result.contacts], (-1, 2))

    def finished(self, kept: Iterable[str] = ()) -> None:
        """Say that all is done, what averaged normals cost, and how many warnings there were to read.

        `kept`: those that the results file holds, of which a run that was resumed has told a part before.
        """
        for message in kept:
            self.warned(message)
        for contact, (friction, spurious) in zip(self._problem.contacts, self._work, strict=True):
            if contact.averaged and friction > 0.0:
                self._say(f"contact {contact.name!r}: spurious work is {spurious / friction:.2%} of the friction work")
        count = len(self._warnings)
        line = f"{many(self._total, 'load step')} done, {many(count, 'warning')}"
        if count:
            self._say(f"{line}: read {'it' if count == 1 else 'them'}", Detail.WARNINGS)
        else:
            self._say(line)

    def stopped(self, path: Path, error: BaseException) -> None:
        """Say what is left of a run that came to no end; what ended it the command line says itself."""
        self._say(f"{type(error).__name__}: {error}", Detail.LOG)
        interrupted = isinstance(error, KeyboardInterrupt)
        if self._begin is not None:
            where = f"; they are in {path}" if self._done else ""
            advice = "; to go on, repeat the command with --resume" if interrupted else ""
            self._say(f"stopped with {self._done} of {many(self._total, 'load step')} done{where}{advice}", Detail.WARNINGS)
        elif interrupted:
            self._say("stopped before the first load step", Detail.WARNINGS)

    def _say(self, line: str, detail: Detail = Detail.EVENTS) -> None:
        if self._log is not None:
            self._log(line)
        if detail <= self._detail:
            self._tell(line)

    def _step_line(self, result: StepResult) -> str:
        iterations = [iteration for record in result.augmentations for iteration in record.iterations]
        augmented = f", {many(len(result.augmentations), 'augmentation')}" if len(result.augmentations) > result.substeps else ""
        cuts = f", {many(result.substeps, 'increment')}" if result.substeps > 1 else ""
        contact = f"; {_active(iterations[-1])}" if self._problem.contacts else ""
        return (
            f"step {result.step:>{len(str(self._total))}}/{self._total}  {result.stage}: {many(len(iterations), 'iteration')}"
            f"{augmented}{cuts}, residual {iterations[-1].residual:.1e}{contact}; {self._clock()}"
        )

    def _clock(self) -> str:
        """Time that has passed, and an estimate of what is left from the mean of the steps so far."""
        elapsed = monotonic() - self._begin if self._begin is not None else 0.0
        computed = self._done - self._first + 1
        left = f", left about {_minutes(elapsed / computed * (self._total - self._done))}" if computed > 0 else ""
        return f"elapsed {_minutes(elapsed)}{left}"


class LiveProgress(Progress):
    """On a terminal: a bar and the newest iteration, redrawn in place, below the lines that are told."""

    _now = ("", "")

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:
        """Keep the newest iteration for the next redraw."""
        super().iteration(step, time, augmentation, record)
        self._now = (
            f"{self._stages[step - 1]}: step {step}/{self._total}  load time {time:.6g}  augmentation {augmentation}  "
            f"iteration {record.iteration}",
            f"residual {record.residual:.1e}  active {record.active}  stick {record.stick}  slip {record.slip}",
        )

    def __rich__(self) -> Table:
        from rich.progress_bar import ProgressBar
        from rich.table import Table
        from rich.text import Text

        table = Table.grid(padding=(0, 1))
        bar = Table.grid(padding=(0, 1))
        bar.add_row(self._problem.name, ProgressBar(self._total, self._done, width=40), f"{self._done}/{self._total}", self._clock())
        table.add_row(bar)
        for line in self._now:
            table.add_row(Text(line, overflow="ellipsis", no_wrap=True))
        return table


def _active(record: IterationRecord) -> str:
    return f"active {record.active} (stick {record.stick}, slip {record.slip})"


def _effort(result: StepResult) -> str:
    """What a load step took."""
    order = f"; Newton's order {result.newton_order:.1f}" if result.newton_order == result.newton_order else ""
    ordered = f"; ordered by {', '.join(result.orderings.values())}" if result.orderings else ""
    seconds = ", ".join(f"{phase} {spent:.3g}" for phase, spent in result.timings.items())
    return (
        f"  step {result.step}: increments {result.substeps}, cuts {result.cuts}, next increment {result.next_increment:.6g} step"
        f"{order}{ordered}; CPU seconds: {seconds}"
    )


def _minutes(seconds: float) -> str:
    """As 0:07, 12:34 or 1:02:03."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


class NotebookProgress(LiveProgress):
    """Below the cell of a notebook: the same, a few times a second."""

    _drawn = 0.0

    def started(self, total_steps: int, first_step: int) -> None:
        """Say how much there is to do, and put the bar there."""
        from IPython.display import display

        super().started(total_steps, first_step)
        self._place = display(self, display_id=True)  # type: ignore[no-untyped-call]

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:
        """Keep the newest iteration, and draw it if the last one has been seen."""
        super().iteration(step, time, augmentation, record)
        if monotonic() - self._drawn > REDRAWN:
            self._drawn = monotonic()
            self._place.update(self)

    def recorded(self, result: StepResult) -> None:
        """Move the bar."""
        super().recorded(result)
        self._place.update(self)

    def _repr_html_(self) -> str:
        from html import escape  # within: on a terminal none of it is needed

        name, now = (escape(text) for text in (self._problem.name, "; ".join(self._now)))
        bar = f'<progress value="{self._done}" max="{self._total}"></progress>'
        return f"<p>{name} {bar} {self._done}/{self._total}, {self._clock()}<br>{now}</p>"


@contextmanager
def progress(problem: Problem, quiet: bool = False, verbose: bool = False, log: str | os.PathLike[str] | None = None) -> Iterator[Progress]:
    """The observer that suits where a run is watched: a bar on a terminal or in a notebook, lines elsewhere.

    Parameters
    ----------
    problem : Problem
        What is computed, `Scene.problem()`.
    quiet : bool
        Warnings only.
    verbose : bool
        Every iteration and augmentation, and what each load step took.
    log : path-like, optional
        A file to whose end all of that is written, with the time of each line.

    Raises
    ------
    InputError
        The log is a results file.
    ResultsError
        It cannot be written.

    Examples
    --------
    >>> with isomortar.progress(scene.problem()) as watching:  # doctest: +SKIP
    ...     results = isomortar.run(scene, observer=watching)
    """
    kind("problem", problem, Problem, way=", of a scene: scene.problem()")
    kind("log", log, str, os.PathLike, NoneType)
    with _kept(log) as keep:
        if quiet:
            yield Progress(problem, _print, Detail.WARNINGS, keep)
            return
        drawn, plain = (Detail.ITERATIONS,) * 2 if verbose else (Detail.EVENTS, Detail.STEPS)
        if _in_notebook():
            yield NotebookProgress(problem, print, drawn, keep)
            return
        if not getattr(sys.stderr, "isatty", bool)():
            yield Progress(problem, _print, plain, keep)
            return
        from rich.console import Console  # within: it takes a tenth of a start
        from rich.live import Live

        console = Console(stderr=True)
        if not console.is_terminal:  # the environment says so
            yield Progress(problem, _print, plain, keep)
            return
        tell = partial(console.print, markup=False, highlight=False, soft_wrap=True)
        observer = LiveProgress(problem, tell, drawn, keep)
        with Live(observer, console=console, refresh_per_second=5):
            yield observer


def _in_notebook() -> bool:
    """Whether a kernel runs this process: that its library was imported says nothing, as programs do that run notebooks."""
    shell = sys.modules.get("IPython")
    return getattr(shell and shell.get_ipython(), "kernel", None) is not None


def _print(line: str) -> None:
    """Say a line at once; nowhere, where the standard error is closed."""
    if sys.stderr is not None:
        print(line, file=sys.stderr, flush=True)


@contextmanager
def _kept(log: str | os.PathLike[str] | None) -> Iterator[Callable[[str], None] | None]:
    """Writes lines at the end of a file, each at once and with its time, after one that says which command they are of."""
    if log is None:
        yield None
        return
    if Path(log).is_file() and is_marked(Path(log)):
        raise InputError(f"{log} is a results file: name another one", "log")
    make_folder(Path(log).parent)
    with Path(log).open("ab", buffering=0) as file:

        def keep(line: str) -> None:
            with named(Path(log)):
                file.write(f"{datetime.now().isoformat(' ', 'milliseconds')} {line}\n".encode(errors="backslashreplace"))

        keep(f"isomortar {version('isomortar')}: {shlex.join(sys.argv)}")
        yield keep
