"""The study of the paper's Section 4: its sections with all their runs, its statements, its page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from paper import page
from paper.catalogue import chosen
from paper.findings import STATEMENTS
from paper.outcome import Outcomes, cells_of, outcome
from paper.sections import Section
from paper.settled import Settled, settled_curves

from isomortar.harness.cases import Cell
from isomortar.harness.measurement import Measurement
from isomortar.harness.study import Conclusion


@dataclass(frozen=True)
class Paper:
    """The chosen sections, in full or as their quick variants, and over-refined curves by scene."""

    sections: tuple[Section, ...]
    quick: bool
    settled: Mapping[str, Settled]

    @classmethod
    def of(cls, names: Sequence[str], quick: bool, references: Path) -> Paper:
        """The sections of these names, all if there are none.

        Raises
        ------
        InputError
            There is no such section, or the reference of over-refined curves is damaged.
        """
        return cls(chosen(names, quick), quick, {} if quick else settled_curves(references))

    def cells(self, folder: Path) -> list[Cell]:
        """A cell a run and method."""
        return [cell for *_, cell in cells_of(self.sections, folder)]

    def conclude(self, folder: Path, measurements: Sequence[Measurement], started: datetime) -> Conclusion:
        """Judge the statements and write ``paper.html``."""
        planned = cells_of(self.sections, folder)
        outcomes = Outcomes(self.sections, tuple(outcome(*plan, found) for plan, found in zip(planned, measurements, strict=True)))
        statements = [statement for statement in STATEMENTS if statement.concerns(self.sections)]
        judgements = tuple(statement.judge(outcomes) for statement in statements)
        report = page.Report(outcomes, judgements, len(STATEMENTS) - len(statements), self.quick, started, self.settled)
        counts = ", ".join(f"{count} {state}" for state, count in report.counts.items())
        return Conclusion(page.write(folder, report), len(report.failed), report.complete, counts)
