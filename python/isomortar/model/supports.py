"""Control points of supports: prescribed, with their motion, or with a component in common that a force moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.entities import Body, Face, Problem, Stage, Support, unit
from isomortar.model.numbering import Numbering

BoolArray = NDArray[np.bool_]


def progress(stages: Sequence[Stage], time: float) -> FloatArray:
    """Share of each stage that has passed at a load time (in load steps), shape (stages,) (theory 5.1)."""
    starts = np.cumsum([0] + [stage.steps for stage in stages])[:-1]
    return np.clip((time - starts) / np.array([stage.steps for stage in stages]), 0.0, 1.0)


def factor_at(stages: Sequence[Stage], factors: Sequence[float], time: float) -> float:
    """A factor that grows linearly from stage to stage, from zero to what it is at the end of each, 1 if not given (theory 5.14)."""
    return float(np.interp(time, np.cumsum([0] + [stage.steps for stage in stages]), [0.0, *(factors or np.ones(len(stages)))]))


def rotation(axis: FloatArray, angle: float) -> FloatArray:
    """Matrix that turns vectors about a unit axis, by Rodrigues' formula (theory 5.3); SciPy's take a tenth of a run's start."""
    x, y, z = axis
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * across + 2.0 * np.sin(0.5 * angle) ** 2 * across @ across


def moved_by(support: Support, shares: FloatArray) -> tuple[FloatArray, float]:
    """Displacement of a support's centre, shape (3,), and its angle in degrees, where shares of the stages have passed (theory 5.2)."""
    parts = list(zip(shares, support.motions, strict=True))
    shift = sum((share * np.asarray(motion.translate) for share, motion in parts), np.zeros(3))
    return shift, sum(share * motion.rotate for share, motion in parts)


def _carried(body: Body, place: Face, numbering: Numbering) -> IntArray:
    """Control points that a support at a place of a body prescribes."""
    return numbering.whole(body) if body.rigid else numbering.points_at(body, place)


@dataclass(frozen=True)
class Plate:
    """A component in which all control points of a support move as one: the unknown is that of the first of them (theory 5.17).

    `support` is the number of the support, `force` what it exerts, by the factors of the support, on what is computed of the body.
    """

    support: int
    component: int
    points: IntArray
    force: float

    @property
    def unknowns(self) -> IntArray:
        """Its places among 3 * control point + component."""
        return np.asarray(3 * self.points + self.component, dtype=np.int32)


class Supports:
    """All supports of a problem.

    Attributes
    ----------
    prescribed : ndarray of int, shape (m,)
        Prescribed unknowns (3 * control point + component), sorted; those of rigid bodies are, with or without a support.
    free : ndarray of int, shape (u,)
        The others, of a plate the first one.
    equation : ndarray of int32, shape (3 * control points,)
        Equation number of each unknown; -1: prescribed; all of a plate have the same.
    plates : tuple of Plate
    held : ndarray of bool, shape (control points, 3)
        Components that are prescribed.
    points : list of ndarray of int
        Control points of each support: those of its face, edge or corner, or of the whole of a rigid body with all that is glued to it.
    shares : list of ndarray, shapes (control points of the support, 3)
        What each support bears of the forces at its control points: nothing of a component that it leaves free, equal parts of one that
        several supports prescribe.
    """

    def __init__(self, problem: Problem, numbering: Numbering) -> None:
        self._problem = problem
        self._numbering = numbering
        self.points: list[IntArray] = [_carried(problem.body(s.place.body), s.place, numbering) for s in problem.supports]
        unknowns = [self._unknowns(k) for k in range(len(problem.supports))]
        self.plates = tuple(
            Plate(k, component, self.points[k], float(support.force[component] or 0.0) / problem.images)
            for k, support in enumerate(problem.supports)
            for component in support.pressed
        )
        holders = np.zeros(3 * numbering.count)
        for of_support in (*unknowns, *(plate.unknowns for plate in self.plates)):
            holders[of_support] += 1.0
        rigid = [3 * numbering.points[body.name].astype(np.int64)[:, None] + np.arange(3) for body in problem.bodies if body.rigid]
        self.prescribed = np.unique(np.concatenate([np.zeros(0, dtype=np.int64), *unknowns, *map(np.ravel, rigid)]))
        self.shares: list[FloatArray] = [
            np.isin(range(3), (*s.components, *s.pressed)) / np.maximum(holders.reshape(-1, 3)[points], 1.0)
            for s, points in zip(problem.supports, self.points, strict=True)
        ]
        mask = np.ones(3 * numbering.count, dtype=bool)
        mask[self.prescribed] = False
        self.held = ~mask.reshape(-1, 3)
        leading = mask.copy()
        for plate in self.plates:
            leading[plate.unknowns[1:]] = False
        self.free = np.flatnonzero(leading)
        self.equation = np.full(3 * numbering.count, -1, dtype=np.int32)
        self.equation[self.free] = np.arange(len(self.free), dtype=np.int32)
        for plate in self.plates:
            self.equation[plate.unknowns] = self.equation[plate.unknowns[0]]

    def _unknowns(self, k: int) -> IntArray:
        components = np.asarray(self._problem.supports[k].components, dtype=np.int64)
        return (3 * self.points[k].astype(np.int64)[:, None] + components).ravel()

    def gathered(self, forces: FloatArray) -> FloatArray:
        """Forces, shape (control points, 3), with those of a plate all at its first control point; where there is none the same array."""
        if not self.plates:
            return forces
        forces = forces.copy()
        for plate in self.plates:
            total = forces[plate.points, plate.component].sum()
            forces[plate.points, plate.component] = 0.0
            forces[plate.points[0], plate.component] = total
        return forces

    def unbalanced(self, forces: FloatArray, time: float) -> FloatArray:
        """The same with what supports exert on plates at a load time taken off: zero where forces are in balance (theory 5.17)."""
        forces = self.gathered(forces)
        for plate in self.plates:
            factors = self._problem.supports[plate.support].factors
            forces[plate.points[0], plate.component] -= plate.force * factor_at(self._problem.stages, factors, time)
        return forces

    def spread(self, solution: FloatArray) -> FloatArray:
        """A field of control points, shape (control points, 3), from its values by equation, zero where it is prescribed (theory 5.17)."""
        field, free = np.zeros(len(self.equation)), self.equation >= 0
        field[free] = solution[self.equation[free]]
        return field.reshape(-1, 3)

    def longest_increment(self, step: int) -> float:
        """The largest share of a recorded load step in which no support turns by more than LARGEST_TURN (theory 5.2): 1 / n."""
        stage = int(np.searchsorted(np.cumsum([stage.steps for stage in self._problem.stages]), step))
        turns = [abs(support.motions[stage].rotate) / self._problem.stages[stage].steps for support in self._problem.supports]
        return 1.0 / max(1, int(np.ceil(max(turns, default=0.0) / constants.LARGEST_TURN)))

    def moved(self, time: float) -> BoolArray:
        """Prescribed components that their supports have moved, or move, by a load time, shape (control points, 3)."""
        moved = np.zeros_like(self.held)
        begun = int(np.count_nonzero(progress(self._problem.stages, time) > 0.0))
        for support, points in zip(self._problem.supports, self.points, strict=True):
            turns = any(motion.rotate for motion in support.motions[:begun])
            for component in support.components:
                across = abs(unit(support.axis)[component]) < 1.0
                shifts = any(motion.translate[component] for motion in support.motions[:begun])
                moved[points, component] |= shifts or (turns and across)
        return moved

    def centre(self, support: Support, time: float, positions: FloatArray | None = None) -> FloatArray:
        """The moving centre c + u(t) of a support, shape (3,); without positions plates are where they were at first."""
        return np.asarray(support.centre, dtype=np.float64) + self.way(support, time, positions)

    def way(self, support: Support, time: float, positions: FloatArray | None = None) -> FloatArray:
        """How far a support has gone, u(t), shape (3,): by its motions, and where positions are given by its forces as well."""
        way, _ = moved_by(support, progress(self._problem.stages, time))
        if positions is None or not support.pressed:
            return way
        number = self._problem.supports.index(support)
        first, own = self.points[number][0], list(support.pressed)
        way[own] += (positions - self.place(time))[first, own]
        return way

    def increment(self, positions: FloatArray, time: float) -> FloatArray:
        """What prescribed positions lack to where supports put them, and plates of their shape; zero elsewhere, (control points, 3)."""
        lacking = np.zeros_like(positions)
        lacking.ravel()[self.prescribed] = (self.place(time) - positions).ravel()[self.prescribed]
        for plate in self.plates:  # turned about its axis; else it is in shape
            if self._problem.supports[plate.support].turns:
                lacking[plate.points, plate.component] = (self.placed(positions, time) - positions)[plate.points, plate.component]
        return lacking

    def placed(self, positions: FloatArray, time: float) -> FloatArray:
        """Positions with the prescribed ones in their places, and plates in shape with their first control point (theory 5.17)."""
        places = self.place(time)
        placed = np.where(self.held, places, positions)
        for plate in self.plates:
            points, k = plate.points, plate.component
            placed[points, k] = positions[points[0], k] + (places[points, k] - places[points[0], k])
        return placed

    def place(self, time: float) -> FloatArray:
        """Positions of all control points with the prescribed ones where their supports put them at a load time (theory 5.2).

        Returns
        -------
        ndarray, shape (control points, 3)
            Rows of control points without support hold their reference positions; those of plates are as if no force had moved them.
        """
        positions = self._numbering.reference.copy()
        shares = progress(self._problem.stages, time)
        for k, support in enumerate(self._problem.supports):
            shift, angle = moved_by(support, shares)
            points = self.points[k]
            arms = self._numbering.reference[points] - np.asarray(support.centre)
            target = np.asarray(support.centre, dtype=np.float64) + shift + arms @ rotation(unit(support.axis), np.radians(angle)).T
            for component in (*support.components, *support.pressed):
                positions[points, component] = target[:, component]
        return positions
