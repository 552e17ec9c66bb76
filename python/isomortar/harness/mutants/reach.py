"""Which cells a fault can reach: one that does not run a fault's statement can not be red on it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import replace

from isomortar.harness.cases import Cell
from isomortar.harness.measurement import Measurement, measure

#: Under this name among the numbers of a measurement.
_LINES = "lines run"
#: Lines that were run, by file below the folder of the sources.
Lines = Mapping[str, list[int]]


def with_lines(cell: Cell, begin: Callable[[], None], end: Callable[[], Mapping[str, Set[int]]]) -> Measurement:
    """Measure a cell, and the lines that are run between `begin` and `end`."""
    begin()
    measurement = measure(cell)
    lines = {file: sorted(run) for file, run in end().items()}
    return replace(measurement, numbers=measurement.numbers | {_LINES: lines})


def without_lines(measurement: Measurement) -> tuple[Measurement, Lines]:
    """A measurement as it is elsewhere, and the lines that were run."""
    numbers = dict(measurement.numbers)
    lines = numbers.pop(_LINES, {})
    assert isinstance(lines, dict)
    return replace(measurement, numbers=numbers), lines


def that_may_run(ran: Mapping[str, Lines], file: str, places: Sequence[Set[int]]) -> set[str]:
    """Cells, of those with the lines that they `ran`, that run one of a fault's lines in a file.

    `places` are sets of lines, narrowest first: the first counts that any cell runs. Where there is none all cells may see the fault:
    files are run when they are imported, before a cell begins, and what is declared leaves no trace.
    """
    for lines in places:
        if run_it := {name for name, files in ran.items() if not lines.isdisjoint(files.get(file, ()))}:
            return run_it
    return set(ran)
