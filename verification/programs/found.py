"""What became of the runs, and the differences that statements and figures are about."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import accumulate

import numpy as np
from programs.plan import MESHES, Mesh, Planned, programs_of
from programs.run import PROGRAMS

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.harness.runs import ByMethod, Computed
from isomortar.model.entities import Problem

#: What others are compared with.
OWN = next(iter(PROGRAMS))
#: Stages of the scenes, each with what is compared in it: a component of the force on the support that moves.
STAGES = {"pressed": 2, "dragged": 0}


@frozen
class Found(Computed):
    """A run, and how it ended."""

    planned: Planned

    @property
    def name(self) -> str:
        """What of the study it is, for a program: ``block L1 fine``."""
        return " ".join((self.planned.setup.scene, self.planned.kind, self.planned.mesh))

    @property
    def method(self) -> str:
        """The program."""
        return self.planned.program

    @cached_property
    def forces(self) -> FloatArray:
        """On all supports, shape (load steps that converged, supports, 3)."""
        return self.curves("force", len(self._problem.supports), 3)

    @property
    def missing(self) -> int:
        """Load steps that are not there."""
        return self._problem.total_steps - len(self.forces)

    def curve(self, component: int) -> FloatArray:
        """A component of the force on the support that moves, shape (load steps that converged,)."""
        moving = next(number for number, support in enumerate(self._problem.supports) if support.moves)
        return self.forces[:, moving, component]

    def stage(self, name: str) -> FloatArray:
        """The curve that is compared in a stage, over its load steps."""
        ends = self._ends
        number = list(STAGES).index(name)
        return self.curve(STAGES[name])[ends[number] : ends[number + 1]]

    def last(self, name: str) -> float:
        """The force that is compared in a stage, at its end; NaN where the run did not come there."""
        curve, end = self.curve(STAGES[name]), self._ends[1 + list(STAGES).index(name)]
        return float(curve[end - 1]) if len(curve) >= end else np.nan

    @property
    def _ends(self) -> list[int]:
        """Load steps before each stage and after the last."""
        return [0, *accumulate(stage.steps for stage in self._problem.stages)]

    @cached_property
    def _problem(self) -> Problem:
        return self.planned.setup.load(self.planned.kind, self.planned.mesh).problem()


def common(runs: Sequence[Found]) -> list[Found]:
    """The runs on elements that all programs have."""
    return [run for run in runs if len(programs_of(run.planned.kind)) > 1]


class Evidence(ByMethod[Found]):
    """The `common` runs by one program, which is the method here, beside those of isomortar."""

    def compared(self, stage: str) -> Iterator[tuple[str, dict[Mesh, FloatArray], dict[Mesh, FloatArray]]]:
        """Scene and kind, and by mesh the curves of a stage by isomortar and by the program; without those of which one stopped before.

        Raises
        ------
        NotMeasuredError
            As by `by`, of isomortar too.
        """
        pairs = list(zip(self.by(OWN), self.by(self.method), strict=True))
        for first in range(0, len(pairs), len(MESHES)):
            by_mesh = pairs[first : first + len(MESHES)]
            stopped = [run for pair in by_mesh for run in pair if np.isnan(run.last(stage))]
            said = [f"{run.name} by {run.method}, {run.ending}" for run in stopped]
            self.left_out.extend(words for words in said if words not in self.left_out)
            if not stopped:
                own, other = ({run.planned.mesh: run.stage(stage) for run in runs} for runs in zip(*by_mesh, strict=True))
                yield by_mesh[0][0].name.rpartition(" ")[0], own, other
