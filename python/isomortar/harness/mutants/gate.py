"""The gate as an attack on faulty programs: the cells that promise most for their cost come first, the first red one ends it."""

from __future__ import annotations

import re
import threading
from collections import Counter
from collections.abc import Collection, Mapping, Sequence, Set
from pathlib import Path

from isomortar._frozen import frozen
from isomortar.errors import IsomortarError
from isomortar.harness.cases import Cell
from isomortar.harness.compare import Lookup, judge
from isomortar.harness.measurement import Measurement
from isomortar.harness.mutants.bench import Bench
from isomortar.harness.report import sentence

#: A cell has failed after this many times the CPU seconds that it takes on the sound program, and never before so many seconds.
_PATIENCE, _LEAST_SECONDS = 20, 20.0
#: CPU seconds of a cell besides its own: sending and judging.
_OVERHEAD = 0.02
#: A cell of a case that has just passed with other settings promises this much less.
_ALIKE = 0.5
#: A cell promises so many times more for each word that its name shares with the path of the faulty file.
_NAMED = 3.0


@frozen
class Finding:
    """What the gate found in a program.

    Parameters
    ----------
    killer : str or None
        The first red cell; None: the program survived.
    found : str
        What was red about it.
    passed : tuple of str
        Cells that it passed.
    """

    killer: str | None
    found: str
    passed: tuple[str, ...]


class Gate:
    """The cells that judge programs. What they found so far decides which come first.

    Parameters
    ----------
    seconds : mapping of cell name to seconds
        CPU seconds on the sound program of the cells that are green there.
    cells : sequence of Cell
        Those and others, which are not used.
    lookup : Lookup
        Finds references.
    sound : Path
        The program without a fault.
    """

    def __init__(self, seconds: Mapping[str, float], cells: Sequence[Cell], lookup: Lookup, sound: Path) -> None:
        self._cells = {cell.name: cell for cell in cells if cell.name in seconds}
        # A file of tests is a case for itself: they have little in common.
        self._case = {name: f"{cell.case.name} {cell.case.files}, any settings" for name, cell in self._cells.items()}
        self._words = {name: _words(name) for name in self._cells}
        self._seconds = seconds
        self._lookup = lookup
        self._sound = sound
        # By folder of the sources and cell, and by folder and case: its cells are alike.
        self._tries: Counter[tuple[str, str]] = Counter()
        self._kills: Counter[tuple[str, str]] = Counter()
        self._lock = threading.Lock()

    def learn(self, folder: str, finding: Finding) -> None:
        """Note which cells a fault in a folder of the sources passed, and which was red."""
        killers = [name for name in self._cells if name == finding.killer]
        tried = [name for name in finding.passed if name in self._cells] + killers
        with self._lock:
            for counts, names in ((self._tries, tried), (self._kills, killers)):
                counts.update((folder, name) for name in names)
                counts.update((folder, self._case[name]) for name in names)

    def attack(
        self,
        bench: Bench,
        program: Path,
        file: str,
        able: Set[str],
        passed: Collection[str],
        most: float,
        newer: Set[str] = frozenset(),
    ) -> Finding:
        """Measure and judge cells until one is red or none is `left`, those that are `newer` first.

        `passed` are cells that the program passed before. `file` is where in the sources the fault is, `able` are cells that it may
        change.

        Raises
        ------
        IsomortarError
            A cell ended without numbers, and does so on the sound program too: that is the machine's fault.
        """
        done = [name for name in passed if name in self._cells]
        while left := self.left(able, done, most, newer):
            name = self._most_promising(left & newer or left, done, file)
            measurement, red = self._red(bench, program, name)
            if red:
                if measurement.ending != "measured" and (too := self._red(bench, self._sound, name)[1]):
                    raise IsomortarError(
                        f"{name} is red on the sound program too, which it was not before: this machine is in trouble, or busy ({too})"
                    )
                return Finding(name, red, tuple(done))
            done.append(name)
        return Finding(None, "", tuple(done))

    def _red(self, bench: Bench, program: Path, name: str) -> tuple[Measurement, str]:
        """Measure a cell, and what is red about it."""
        cell = self._cells[name]
        measurement = bench.measure(program, cell, max(_PATIENCE * self._seconds[name], _LEAST_SECONDS))
        red = [check for check in judge(cell, measurement, self._lookup) if check.state != "passed"]
        return measurement, sentence(red[0]) if red else ""

    def left(self, able: Set[str], passed: Collection[str], most: float, newer: Set[str]) -> set[str]:
        """Cells that a program has yet to meet: once those that passed cost `most`, only such as are `newer` than what was found before."""
        left = self._cells.keys() & able - set(passed)
        return left if self.cost(passed) < most else left & newer

    def is_whole(self, finding: Finding, able: Set[str]) -> bool:
        """Whether no cell is left that could tell more."""
        return finding.killer is not None or self._cells.keys() & able <= set(finding.passed)

    def cost(self, names: Collection[str]) -> float:
        """CPU seconds of some cells on the sound program."""
        return sum(self._seconds.get(name, 0.0) for name in names)

    def _most_promising(self, left: Collection[str], done: Sequence[str], file: str) -> str:
        alike = Counter(self._case[name] for name in done)
        folder, words = file.partition("/")[0], _words(file)

        def promise(name: str) -> tuple[float, str]:
            case = self._case[name]
            of_case = (self._kills[folder, case] + 1) / (self._tries[folder, case] + 2)
            share = (self._kills[folder, name] + of_case) / (self._tries[folder, name] + 1)
            named = _NAMED ** len(words & self._words[name])
            return named * share * _ALIKE ** alike[case] / (self._seconds[name] + _OVERHEAD), name

        with self._lock:
            return max(left, key=promise)


def _words(name: str) -> set[str]:
    return set(re.split(r"[^a-z]+", name)) - {"", "py", "f"}
