"""Benchmarks: a function that measures and yields rows, and beside it what it asks and what its columns mean.

::

    @benchmark(
        question="What does a factorisation cost?",
        columns={"scene": "", "order": "", "unknowns": "", "factor": "s", "ratio": ""},
        plots=(Plot(x="unknowns", y="factor", by="order"),),
        limits={"ratio": (1.6, "isomortar's time over that of the fastest other program")},
    )
    def factorisation(quick: bool) -> Iterator[Row]:
        ...
        yield {"scene": "press", "order": 2, "unknowns": 4704, "factor": 0.38, "ratio": 1.2}

The function stands in ``FOLDER/performance/*.py`` and is run in a process of its own. With `quick` it does the same on the smallest
input there is, in seconds: that says nothing about speed, but that the benchmark works.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from statistics import median
from time import process_time

from isomortar._frozen import frozen
from isomortar.errors import InputError

#: One measurement: a value for every column; or what is known of them, and in ``note`` why the others could not be measured.
Row = Mapping[str, float | int | str]

#: The entry of a row that could not be measured.
NOTE = "note"
#: In place of a value where a column says nothing of a row: a program beside itself.
ASIDE = "-"
#: Work of fewer CPU seconds is measured `REPEATS` times.
SHORT, REPEATS = 10.0, 3


@frozen
class Plot:
    """A plot of one column over another on logarithmic axes, a line with its slope for every value of the column `by`."""

    x: str
    y: str
    by: str = ""


@frozen
class Benchmark:
    """A measuring function with what it asks; `benchmark` makes one, and says what the parameters are."""

    function: Callable[[bool], Iterator[Row]]
    question: str
    columns: Mapping[str, str]
    plots: tuple[Plot, ...] = ()
    limits: Mapping[str, tuple[float, str]] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The function's name."""
        return self.function.__name__

    @property
    def path(self) -> Path:
        """The file that it stands in."""
        return Path(inspect.getfile(self.function)).resolve()

    @property
    def about(self) -> str:
        """What is measured and how: the function's docstring."""
        return inspect.getdoc(self.function) or ""

    def __post_init__(self) -> None:
        if not self.question.endswith("?"):
            raise InputError(f"is {self.question!r}; it must be one question and end with its mark", f"{self.name}.question")
        if not self.columns or NOTE in self.columns:
            raise InputError(f"needs one column at least, and none called {NOTE!r}: that is where a row says why", f"{self.name}.columns")
        for plot in self.plots:
            self._check_columns("plots", [plot.x, plot.y, *filter(None, [plot.by])])
        self._check_columns("limits", self.limits)

    def _check_columns(self, where: str, names: Sequence[str] | Mapping[str, object]) -> None:
        unknown = [name for name in names if name not in self.columns]
        if unknown:
            raise InputError(f"names {', '.join(unknown)}; the columns are {', '.join(self.columns)}", f"{self.name}.{where}")

    def checked(self, row: Row) -> Row:
        """The row, if it fits the columns.

        Raises
        ------
        InputError
            It has an entry that is no column, or lacks one without a note.
        """
        unknown = [name for name in row if name not in self.columns and name != NOTE]
        missing = [name for name in self.columns if name not in row and NOTE not in row]
        if unknown or missing:
            said = [f"{what} {', '.join(names)}" for what, names in (("lacks", missing), ("has the unknown", unknown)) if names]
            raise InputError(f"a row {' and '.join(said)}; the columns are {', '.join(self.columns)}", self.name)
        return row


def benchmark(
    *,
    question: str,
    columns: Mapping[str, str],
    plots: tuple[Plot, ...] = (),
    limits: Mapping[str, tuple[float, str]] | None = None,
) -> Callable[[Callable[[bool], Iterator[Row]]], Benchmark]:
    """Mark a function of `quick` that yields rows as a benchmark.

    Parameters
    ----------
    question : str
        What it answers, in one sentence; heads its table.
    columns : mapping
        Every entry of a row with its unit (empty: none), in the order of the table.
    plots : tuple of Plot
        Shown under the table.
    limits : mapping, optional
        By column the most that a value should be, and why. Shown as met, missed, or not compared where a row lacks the column, as beside a
        program that is not installed; rows with `ASIDE` there do not count. A missed limit is a finding and fails nothing.

    Raises
    ------
    InputError
        The question is none, or a plot or limit names no column.
    """
    return lambda function: Benchmark(function, question, dict(columns), plots, dict(limits or {}))


def cpu_seconds(work: Callable[[], object], repeats: int = REPEATS) -> tuple[float, float]:
    """Median and least CPU seconds of some work in this process, over `repeats` runs; long work is done once.

    Parameters
    ----------
    work : callable
        Is called without arguments; what it returns is dropped.
    repeats : int
        How often, where the first run takes less than 10 s.
    """
    seconds: list[float] = []
    while not seconds or (seconds[0] < SHORT and len(seconds) < repeats):
        start = process_time()
        work()
        seconds.append(process_time() - start)
    return median(seconds), min(seconds)
