"""What became of the runs: solves, curves, and the work that averaged normals cost."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np
from masters.plan import INSTANTS, Planned
from paper import measures
from paper.outcome import Outcome, outcome
from paper.statements import quotient

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.harness.runs import ByMethod, Computed
from isomortar.harness.statement import Values
from isomortar.program.getfem import GetFEM


@frozen
class _OfPlan(Computed):
    """A run that is planned, by whatever program."""

    planned: Planned

    @property
    def name(self) -> str:
        """Its scene and its master."""
        return self.planned.name


@frozen
class Found(_OfPlan):
    """A run by isomortar."""

    @property
    def method(self) -> str:
        """How feet are found."""
        return self.planned.way

    @cached_property
    def outcome(self) -> Outcome:
        """Its curves, up to where it came."""
        return outcome(self.planned.section, self.planned.variant, "monolithic", self.result)

    @property
    def ending(self) -> str:
        """In the words of a process's ending."""
        return self.result.measurement.ending

    @property
    def words(self) -> str:
        """Why it ended so; empty where all load steps are there."""
        return self.outcome.failure

    @property
    def cpu_seconds(self) -> float:
        """Of the run, and of reading its results."""
        return self.result.measurement.cpu_seconds

    @property
    def missing(self) -> int:
        """Load steps that are not there."""
        return self.outcome.total_steps - self.outcome.steps

    def by_step(self, name: str) -> FloatArray:
        """A number by load step, shape (load steps that converged,)."""
        return self.outcome.array(name) if self.outcome.numbers else np.zeros(0)

    @property
    def cuts(self) -> float:
        """Of load increments; NaN: no load step converged."""
        return float(self.outcome.numbers.get("cuts", np.nan))

    @property
    def mean(self) -> float:
        """Of the curve over the window of the last stage; NaN where the run stopped before its end."""
        return np.nan if self.words else measures.mean(self.outcome)

    @property
    def roughness(self) -> float:
        """Root mean square second difference of the curve over its mean; NaN as there."""
        return np.nan if self.words else measures.rms_second_difference(self.outcome) / abs(self.mean)

    @property
    def shares(self) -> FloatArray:
        """Spurious work up to a load step over the friction work of all; NaN without friction, shape (load steps that converged,)."""
        friction, spurious = self.by_step("friction_work").sum(), np.cumsum(self.by_step("spurious_work"))
        return spurious / friction if friction > 0.0 else np.full(len(spurious), np.nan)

    @property
    def share(self) -> float:
        """The same of all load steps that converged; NaN: there is none."""
        return float(self.shares[-1]) if len(self.shares) else np.nan

    @property
    def slid(self) -> dict[str, float]:
        """Forces and works of the block."""
        works = np.column_stack([self.by_step("friction_work"), self.by_step("spurious_work")])
        return slide(self.planned, self.by_step("force").reshape(-1, 3), works)

    def off(self, other: Found) -> float:
        """How far the mean is off another's, both over the load steps of the window that both have; NaN: there is none."""
        curves = [run.outcome.curve[run.outcome.window] if run.outcome.steps else np.zeros(0) for run in (self, other)]
        common = min(map(len, curves))
        own, theirs = (float(curve[:common].mean()) if common else np.nan for curve in curves)
        return abs(own / theirs - 1.0)


@frozen
class Beside(_OfPlan):
    """The block by another program."""

    @property
    def method(self) -> str:
        """The program."""
        return str(self.result.cell.settings["program"])

    @property
    def slid(self) -> dict[str, float]:
        """Forces and works of the block."""
        supports = self.planned.section.load(self.planned.variant, "monolithic").problem().supports
        moving = next(number for number, support in enumerate(supports) if support.moves)
        return slide(self.planned, self.curves("force", len(supports), 3)[:, moving], self.curves("works", 2))


@frozen
class Evidence(ByMethod[Found]):
    """The runs by one way, beside those by the others, and the block by GetFEM."""

    getfem: Sequence[Beside] = ()

    def missing(self) -> Values:
        """Load steps that are missing, by run."""
        return {run.name: float(run.missing) for run in self.by(self.method)}

    def tangents(self) -> Values:
        """Median over the load steps, by run."""
        return {run.name: float(np.median(run.by_step("factorisations"))) for run in self.by(self.method) if run.outcome.steps}

    def cuts(self) -> Values:
        """Of all runs but those of the refinement."""
        return {"all": float(sum(run.cuts for run in self.by(self.method) if not run.planned.finer))}

    def cuts_of_block(self) -> Values:
        """Of linear elements."""
        return {run.name: run.cuts for run in self._linear_block}

    def tangents_of_block(self) -> Values:
        """Of all load steps, linear elements."""
        return {run.name: float(run.by_step("factorisations").sum()) for run in self._linear_block}

    def spurious(self) -> Values:
        """Share of the spurious work over that on the next coarser master of the refinement."""
        return self._refined(lambda kinks, _: abs(kinks.share))

    def apart(self) -> Values:
        """How far the mean is off that on a smooth master of the same elements, over the same on the next coarser ones.

        Runs that stopped count as far as they came; before the window there is nothing to compare.
        """
        stopped = [run for pair in refinement(self.runs) for run in pair if run.missing]
        self.left_out.extend(f"{run.name} ({run.method}) after load step {run.outcome.steps}" for run in stopped)
        return {name: value for name, value in self._refined(Found.off).items() if not (stopped and np.isnan(value))}

    def beside_getfem(self) -> Values:
        """Difference of the works of pushing the block, over the spurious works of both programs."""
        (other,) = (run.slid for run in ByMethod(self.getfem, GetFEM.name).by(GetFEM.name))
        own = {run.name: run.slid for run in self._linear_block}
        return {
            name: quotient(abs(found["pushed"] - other["pushed"]), abs(found["spurious"]) + abs(other["spurious"]))
            for name, found in own.items()
        }

    @property
    def _linear_block(self) -> list[Found]:
        return [run for run in self.by(self.method) if (run.planned.section.scene, run.planned.variant.kind) == ("block", "L1")]

    def _refined(self, measure: Callable[[Found, Found], float]) -> Values:
        pairs = refinement([*self.by(self.method), *self.by("smooth, averaged")])
        return {f"{fine[0].name} / {coarse[0].name}": quotient(measure(*fine), measure(*coarse)) for coarse, fine in pairwise(pairs)}


def refinement(runs: Sequence[Found]) -> list[tuple[Found, Found]]:
    """Of masters that are refined, runs along averaged normals on L1 and on N2 of the same elements, coarsest first."""
    smooth = {run.planned.variant.elements: run for run in runs if run.method == "smooth, averaged"}
    scenes = {run.planned.section.scene for run in smooth.values()}
    kinks = [run for run in runs if run.method == "averaged" and run.planned.variant.kind == "L1" and run.planned.section.scene in scenes]
    return [(run, smooth[run.planned.variant.elements]) for run in kinks]


def slide(planned: Planned, force: FloatArray, works: FloatArray) -> dict[str, float]:
    """Forces on the block at the instants, and works between them; NaN where a run did not come there.

    Parameters
    ----------
    planned : Planned
    force : ndarray, shape (load steps, 3)
        On the support that moves.
    works : ndarray, shape (load steps, 2)
        Friction work and spurious work.

    Returns
    -------
    dict
        Normal forces ``N(5)``, ``N(15)`` and tangential force ``T(15)``; ``pushed``: work of the tangential force on the way from the
        first instant to the last, ``friction`` and ``spurious`` work there.
    """
    names = (*(f"N({step})" for step in INSTANTS), f"T({INSTANTS[-1]})", "pushed", "friction", "spurious")
    begin, end = INSTANTS
    if len(force) < end:
        return dict.fromkeys(names, np.nan) | ({names[0]: -float(force[begin - 1, 2])} if len(force) >= begin else {})
    (motion,) = planned.section.load(planned.variant, "monolithic").tables.stages[-1].motions.values()
    along = force[begin - 1 : end, 0]
    pushed = float((0.5 * (along[1:] + along[:-1])).mean() * motion.translate[0])
    values = (-force[begin - 1, 2], -force[end - 1, 2], force[end - 1, 0], pushed, *works[begin:end].sum(axis=0))
    return dict(zip(names, map(float, values), strict=True))
