"""A campaign: faults are built, drawn until enough are distinct, and attacked by the gate; what is known is not done again."""

from __future__ import annotations

import math
import shutil
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from types import TracebackType

from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.harness.cases import TIMEOUTS, Cell
from isomortar.harness.compare import Lookup, judge
from isomortar.harness.crew import Crew
from isomortar.harness.journal import Journal
from isomortar.harness.mutants.bench import Bench, freeze
from isomortar.harness.mutants.build import content, workshop_of
from isomortar.harness.mutants.faults import Fault
from isomortar.harness.mutants.gate import Finding, Gate
from isomortar.harness.mutants.layers import Layer
from isomortar.harness.mutants.reach import Lines, that_may_run, without_lines
from isomortar.harness.report import sentence
from isomortar.harness.store import cell_key

#: Tells what is being done, how much of it is done, and how much there is (0: not known).
Tell = Callable[[str, int, int], None]
#: What a faulty program is that does not count.
_REJECTED, _SOUND, _TWICE = "rejected by the compiler", "same as the sound program", "same as another fault"


@frozen
class Attacked:
    """A fault and the gate's finding on it; `whole`: a cell was red, or every cell met it."""

    fault: Fault
    finding: Finding
    whole: bool


@frozen
class Tally:
    """All of a campaign.

    Parameters
    ----------
    attacked : tuple of Attacked
        Faults that compile and are distinct; those planted by hand first.
    dropped : Counter
        How many faults were drawn and do not count, by reason.
    unused : tuple of str
        Cells that are red on the sound program, in words; they can tell nothing.
    seconds : dict of cell name to seconds
        The gate on the sound program, CPU seconds.
    """

    attacked: tuple[Attacked, ...]
    dropped: Counter[str]
    unused: tuple[str, ...]
    seconds: dict[str, float]


class Campaign:
    """A workshop, benches, and what is known. A context manager.

    Parameters
    ----------
    layer : Layer
        Where faults are put.
    project : Path
        The checkout.
    cases : Path
        Folder of families of cases.
    cells : sequence of Cell
        The gate, of these cases.
    lookup : Lookup
        Finds references.
    folder : Path
        Where to work and to keep what is known.
    jobs : int
        Faults at the same time.
    progress : Tell
    """

    def __init__(
        self, layer: Layer, project: Path, cases: Path, cells: Sequence[Cell], lookup: Lookup, folder: Path, jobs: int, progress: Tell
    ) -> None:
        self._cells, self._lookup, self._progress = cells, lookup, progress
        self._builds, self._findings, self._sound = (Journal(folder / f"{name}.jsonl") for name in ("builds", "verdicts", "sound"))
        progress("building the sound program", 0, 0)
        self._workshop = workshop_of(layer, project, folder)
        package, frozen = freeze(cases, folder / "frozen")
        self._keys = {cell.name: cell_key(cell, self._workshop.rest)[:20] for cell in cells}
        self._crew = Crew([Bench(package, frozen, folder / f"bench{i + 1}") for i in range(jobs)])
        self._scouts = Crew([Bench(package, frozen, folder / f"scout{i + 1}", self._workshop.scout) for i in range(jobs)])
        self._ran: dict[str, Lines] = {}
        self._numbers: dict[str, int] = {}

    def __enter__(self) -> Campaign:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self._scouts.__exit__(kind, value, trace)
        self._crew.__exit__(kind, value, trace)

    def run(self, planted: Sequence[Fault], drawn: Iterable[Fault], sample: int, most: float) -> Tally:
        """Attack the planted faults with the whole gate, and the first `sample` of those drawn that are distinct.

        The latter are given up when cells that take `most` CPU seconds on the sound program are green, and all that are newer than an
        earlier finding.

        Raises
        ------
        InputError
            A planted fault does not compile, or changes nothing; fewer faults than asked for; no cell is green on the sound program.
        """
        seconds, unused = self._sound_seconds()
        gate = Gate(seconds, self._cells, self._lookup, self._workshop.sound)
        dropped: Counter[str] = Counter()
        known = {self._workshop.identity(self._workshop.sound): _SOUND}
        hand = list(self._distinct(planted, len(planted), known, dropped))
        if dropped:
            names = {fault.name for fault in planted} - {fault.name for fault, _ in hand}
            raise InputError(f"{', '.join(sorted(names))}: {', '.join(dropped)}", "planted faults")
        random = list(self._distinct(drawn, sample, known, dropped))
        if len(random) < sample:
            raise InputError(f"is {sample}; only {len(random)} of the random faults compile and are distinct", "sample")
        attacked = tuple(self._attacked(gate, [*hand, *random], most))
        return Tally(attacked, dropped, unused, seconds)

    def _sound_seconds(self) -> tuple[dict[str, float], tuple[str, ...]]:
        """CPU seconds of the cells that are green on the sound program, and the others in words; notes which lines of it they run."""
        sound = f"{self._workshop.identity(self._workshop.sound)[:20]}-{self._workshop.scout}"

        def measured(scout: Bench, cell: Cell) -> tuple[float, str]:
            key = f"{self._keys[cell.name]}-{sound}"
            known = self._sound.get(key)
            if known is None:
                measurement, lines = without_lines(scout.measure(self._workshop.scouted, cell, TIMEOUTS[cell.tier]))
                red = [sentence(check) for check in judge(cell, measurement, self._lookup) if check.state != "passed"]
                known = {"cell": cell.name, "seconds": measurement.cpu_seconds, "red": next(iter(red), ""), "lines": lines}
                known["number"] = len(self._sound.entries)
                if measurement.lasts:
                    self._sound.put(key, known)
            self._ran[cell.name], self._numbers[cell.name] = known["lines"], known.get("number", -1)
            return known["seconds"], known["red"]

        seconds, unused = {}, []
        for i, (cell, (taken, red)) in enumerate(self._scouts.each(measured, self._cells)):
            self._progress("the gate on the sound program", i + 1, len(self._cells))
            if red:
                unused.append(f"{cell.name}: {red}")
            else:
                seconds[cell.name] = taken
        self._ran = {name: self._ran[name] for name in seconds}
        if not seconds:
            raise InputError(f"no cell is green on the sound program: {unused[0]}", "gate")
        return seconds, tuple(unused)

    def _distinct(self, faults: Iterable[Fault], count: int, known: dict[str, str], dropped: Counter[str]) -> Iterator[tuple[Fault, str]]:
        """The first `count` faults that compile to a program that is not `known`, each with its identity."""
        found = 0
        if not count:
            return
        for fault, program in self._crew.each(self._program_of, faults):
            reason = _REJECTED if program is None else known.get(program)
            if program is None or reason:
                dropped[str(reason)] += 1
                continue
            known[program] = _TWICE
            found += 1
            self._progress("building faulty programs", found, count)
            yield fault, program
            if found == count:
                return

    def _program_of(self, _: Bench, fault: Fault) -> str | None:
        made_from = content(self._workshop, fault)
        known = self._builds.get(made_from)
        if known is None:
            built = self._workshop.build(fault)
            known = {"place": fault.place, "program": self._workshop.identity(built) if built else None}
            self._builds.put(made_from, known)
        return known["program"]

    def _attacked(self, gate: Gate, programs: Sequence[tuple[Fault, str]], most: float) -> Iterator[Attacked]:
        """Attack programs one by one."""

        def attack(bench: Bench, item: tuple[Fault, str]) -> Finding:
            fault, program = item
            limit = math.inf if fault.name else most
            able = self._able(fault)
            finding, newer = self._remembered(program)
            if finding.killer is None and gate.left(able, finding.passed, limit, newer):
                built = self._workshop.build(fault)
                assert built is not None
                finding = gate.attack(bench, built, fault.file, able, finding.passed, limit, newer)
                self._remember(program, finding)
                shutil.rmtree(built)
            gate.learn(fault.folder, finding)
            return finding

        survivors = 0
        for i, ((fault, _), finding) in enumerate(self._crew.each(attack, programs)):
            survivors += finding.killer is None
            self._progress(f"attacking faulty programs, {survivors} survived", i + 1, len(programs))
            yield Attacked(fault, finding, gate.is_whole(finding, self._able(fault)))

    def _able(self, fault: Fault) -> set[str]:
        """Cells that may be red on a fault."""
        return that_may_run(self._ran, fault.file, self._workshop.places(fault))

    def _remember(self, program: str, finding: Finding) -> None:
        entry = {"killer": finding.killer, "found": finding.found, "passed": {name: self._keys[name] for name in finding.passed}}
        known = {"killer key": self._keys[finding.killer] if finding.killer else None, "cells": len(self._sound.entries)}
        self._findings.put(program, entry | known)

    def _remembered(self, program: str) -> tuple[Finding, set[str]]:
        """What earlier runs found with cells that are still the same, and the cells that are newer than that."""
        entry = self._findings.get(program)
        if entry is None:
            return Finding(None, "", ()), set()
        newer = {name for name, number in self._numbers.items() if number >= entry.get("cells", 0)}
        passed = tuple(name for name, key in entry["passed"].items() if self._keys.get(name) == key)
        if entry["killer"] and self._keys.get(entry["killer"]) == entry["killer key"]:
            return Finding(entry["killer"], entry["found"], passed), newer
        return Finding(None, "", passed), newer
