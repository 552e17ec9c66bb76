"""What a sweep states: the program is right in an interval, and elsewhere never wrong; of this program and of an earlier one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from extremes.points import Point, Sweep

from isomortar.harness.statement import NotMeasuredError, Statement


@dataclass(frozen=True)
class AsEnded:
    """How the points of sweeps ended by one of the programs, which is the method here."""

    method: Literal["now", "before"]
    sweeps: Sequence[Sweep]

    @property
    def without(self) -> str:
        """Nothing: of a sweep that lacks points nothing is said."""
        return ""

    def points(self, name: str) -> tuple[Sweep, list[Point]]:
        """A sweep and its points.

        Raises
        ------
        NotMeasuredError
            Some of them were not measured.
        """
        sweep = next(sweep for sweep in self.sweeps if sweep.case.name == name)
        found = [point for point in getattr(sweep, self.method) if point is not None]
        missing = len(sweep.settings) - len(found)
        if missing:
            raise NotMeasuredError(f"{missing} of {len(sweep.settings)} points were not measured")
        return sweep, found


def statement(sweep: Sweep) -> Statement[AsEnded]:
    """The statement of a sweep. Values are by how many endings each point is better than what is claimed there: 0 is as claimed."""

    def beyond(evidence: AsEnded) -> dict[str, float]:
        of, found = evidence.points(sweep.case.name)
        return {of.label(number): float(point.ending - of.claimed(number)) for number, point in enumerate(found)}

    return Statement(
        section="extremes",
        text=sweep.case.claim,
        needs=(),
        measure=beyond,
        unit="endings above what is claimed",
        reason="definition: right where that is claimed, and nowhere wrong",
        at_least=0.0,
        methods=("before", "now"),
    )
