"""Control points of supports: prescribed, with their motion, or going as a plate by forces and a moment; those of each stage."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from isomortar._bindings import Pattern
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.entities import Body, Face, Problem, Stage, Support, unit
from isomortar.model.numbering import Numbering
from isomortar.model.plates import Plate, Seen, rotation, seen

BoolArray = NDArray[np.bool_]


def progress(stages: Sequence[Stage], time: float) -> FloatArray:
    """Share of each stage that has passed at a load time (in load steps), shape (stages,) (theory 5.1)."""
    starts = np.cumsum([0] + [stage.steps for stage in stages])[:-1]
    return np.clip((time - starts) / np.array([stage.steps for stage in stages]), 0.0, 1.0)


def factor_at(stages: Sequence[Stage], factors: Sequence[float], time: float) -> float:
    """A factor that grows linearly from stage to stage, from zero to what it is at the end of each, 1 if not given (theory 5.14)."""
    return float(np.interp(time, np.cumsum([0] + [stage.steps for stage in stages]), [0.0, *(factors or np.ones(len(stages)))]))


def moved_by(support: Support, shares: FloatArray) -> tuple[FloatArray, float]:
    """Displacement of a support's centre, shape (3,), and its angle in degrees, where shares of the stages have passed (theory 5.2)."""
    parts = list(zip(shares, support.motions, strict=True))
    shift = sum((share * np.asarray(motion.translate) for share, motion in parts), np.zeros(3))
    return shift, sum(share * motion.rotate for share, motion in parts)


def _carried(body: Body, place: Face, numbering: Numbering) -> IntArray:
    """Control points that a support at a place of a body prescribes."""
    return numbering.whole(body) if body.rigid else numbering.points_at(body, place)


class Supports:
    """The supports of a problem in a stage.

    Attributes
    ----------
    prescribed : ndarray of int, shape (m,)
        Prescribed unknowns (3 * control point + component), sorted; those of rigid bodies are, with or without a support.
    free : ndarray of int, shape (u,)
        Where each unknown stands among the same numbers: those of a plate at its first control points (`Plate.slots`).
    equation : ndarray of int32, shape (3 * control points,)
        Equation number of each unknown; -1: prescribed; all of a component that a force moves have the same.
    unknowns : ndarray of int32, shape (3 * (control points + copies),)
        The same with those of plates that turn once more: the equation of their angle, -1 in components that it does not move.
    plates : tuple of Plate
    copies : ndarray of int32, shape (copies,)
        Control points of plates that turn.
    held : ndarray of bool, shape (control points, 3)
        Components that are prescribed.
    together : ndarray of bool, shape (control points, 3)
        Components in which plates take their control points along.
    balanced : ndarray of bool, shape (control points, 3)
        Where forces that are out of balance stand, as `unbalanced` has them.
    points : list of ndarray of int
        Control points of each support: those of its face, edge or corner, or of the whole of a rigid body with all that is glued to it.
    shares : list of ndarray, shapes (control points of the support, 3)
        What each support bears of the forces at its control points: nothing of a component that it leaves free, equal parts of one that
        several supports prescribe. One that is released bears what nothing else holds.
    """

    def __init__(self, problem: Problem, numbering: Numbering, stage: int = 0) -> None:
        self._problem, self._numbering, self.stage = problem, numbering, stage
        self.points: list[IntArray] = [_carried(problem.body(s.place.body), s.place, numbering) for s in problem.supports]
        self._shapes = [numbering.reference[points] for points in self.points]
        self.present = self._holding(stage)
        self.plates = tuple(self._plate(k) for k in self.present if problem.supports[k].is_plate)
        self._released: FloatArray | None = None
        self._seen: WeakKeyDictionary[Pattern, Seen] = WeakKeyDictionary()
        self.shares = self._shares()
        self.together = self._taken_along()
        self.held = self._prescribed()
        self.prescribed = np.flatnonzero(self.held)
        self._number()

    def _holding(self, stage: int) -> tuple[int, ...]:
        """Numbers of the supports that hold in a stage."""
        return tuple(k for k, support in enumerate(self._problem.supports) if support.holds(stage))

    def _taken_along(self) -> BoolArray:
        """See `together`."""
        together = np.zeros((self._numbering.count, 3), dtype=bool)
        for plate in self.plates:
            for component in (*plate.pressed, *plate.across):
                together[plate.points, component] = True
        return together

    def _prescribed(self) -> BoolArray:
        """See `held`."""
        held, problem = np.zeros((self._numbering.count, 3), dtype=bool), self._problem
        for body in problem.bodies:
            held[self._numbering.points[body.name]] |= body.rigid
        turned = {plate.support: plate.across for plate in self.plates}
        held[self.together] = False
        for k in self.present:
            for component in problem.supports[k].components:
                held[self.points[k], component] |= component not in turned.get(k, ())
        return held

    def _plate(self, k: int) -> Plate:
        support, images = self._problem.supports[k], self._problem.images
        axis = unit(support.axis)
        across = tuple(i for i in support.carried if abs(axis[i]) < 1.0) if support.moment is not None else ()
        force = np.array([size or 0.0 for size in support.force]) / images
        moment = (support.moment or 0.0) / images
        return Plate(k, self.points[k], support.pressed, across, force, moment, axis, np.asarray(support.centre, float), self._shapes[k])

    def _shares(self) -> list[FloatArray]:
        """See `shares`."""
        supports = self._problem.supports
        before = self._holding(self.stage - 1) if self.stage else ()
        now, then = (np.zeros((self._numbering.count, 3)) for _ in range(2))
        for holders, numbers in ((now, self.present), (then, before)):
            for k in numbers:
                holders[self.points[k]] += np.isin(range(3), supports[k].carried)
        shares = []
        for k, (support, points) in enumerate(zip(supports, self.points, strict=True)):
            held = np.isin(range(3), support.carried).astype(np.float64)
            if k in self.present:
                shares.append(held / np.maximum(now[points], 1.0))
            else:
                shares.append((k in before) * held * (now[points] == 0.0) / np.maximum(then[points], 1.0))
        return shares

    def _number(self) -> None:
        """Number the equations: of plates one a component that a force moves, and one for the angle."""
        leading = ~self.held.ravel()
        for plate in self.plates:
            for k in (*plate.pressed, *plate.across):
                leading[plate.unknowns(k)] = False
            leading[plate.slots] = True
        self.free = np.flatnonzero(leading)
        numbers = np.full(leading.size, -1, dtype=np.int32)
        numbers[self.free] = np.arange(len(self.free), dtype=np.int32)
        self.equation = numbers.copy()
        copies = [self.equation]
        for plate in self.plates:
            for k in plate.across:
                self.equation[plate.unknowns(k)] = -1
            for k in plate.pressed:
                self.equation[plate.unknowns(k)] = numbers[plate.unknowns(k)[0]]
            if plate.across:
                copies.append(np.tile(np.where(np.isin(range(3), plate.across), numbers[plate.slots[-1]], -1), len(plate.points)))
        self.copies = np.concatenate([np.zeros(0, dtype=np.int32), *(plate.points for plate in self._turning)])
        self.unknowns = np.concatenate(copies, dtype=np.int32) if self._turning else self.equation
        self.balanced = ((self.equation >= 0) | leading).reshape(-1, 3)

    def anchor(self, positions: FloatArray, time: float) -> None:
        """Take faces of supports that were not there from the first stage on in the shape that they have at a load time (theory 5.22)."""
        for k in self.present:
            support, points = self._problem.supports[k], self.points[k]
            if all(map(support.holds, range(self.stage + 1))):
                continue
            self._take(k, self._numbering.reference[points])
            centre, angle = self.centre(support, time, positions), np.radians(self.angle(support, time, positions))
            back = (positions[points] - centre) @ rotation(unit(support.axis), angle)
            self._take(k, np.asarray(support.centre) + back)

    def _take(self, k: int, shape: FloatArray) -> None:
        """Give the face of a support another shape."""
        self._shapes[k] = shape
        self.plates = tuple(replace(plate, shape=shape) if plate.support == k else plate for plate in self.plates)

    def released(self, bodies: Collection[str]) -> list[str]:
        """Names of the supports on some bodies that held before, and do not now."""
        supports = self._problem.supports
        return [support.name for k, support in enumerate(supports) if self.left(k) and support.place.body in bodies]

    def left(self, k: int) -> bool:
        """Whether the support of a number held in a stage before, and does not now: it stays where it was (theory 8.1)."""
        return k not in self.present and any(map(self._problem.supports[k].holds, range(self.stage)))

    def release(self, left: FloatArray, time: float) -> None:
        """Let what is `unbalanced` at a load time go linearly to zero by the end of the stage (theory 5.23)."""
        self._released = self.balanced * left / self._remaining(time)

    def _remaining(self, time: float) -> float:
        """Share of the stage that is left."""
        return 1.0 - float(progress(self._problem.stages, time)[self.stage])

    @property
    def _turning(self) -> list[Plate]:
        return [plate for plate in self.plates if plate.across]

    def slopes(self, positions: FloatArray) -> tuple[FloatArray, FloatArray]:
        """First and second derivatives of the positions of `copies` by their angles, shapes (copies, 3) (theory 5.21)."""
        parts = [plate.slopes(plate.angle(positions)) for plate in self._turning]
        first, second = (np.concatenate([np.zeros((0, 3)), *(part[i] for part in parts)]) for i in range(2))
        return first, second

    def gathered(self, forces: FloatArray, positions: FloatArray) -> FloatArray:
        """Forces, shape (control points, 3), as the unknowns of plates have them, at their `slots` (theory 5.21)."""
        if not self.plates:
            return forces
        gathered, slopes, begun = forces.copy(), self.slopes(positions)[0], 0
        for plate in self.plates:
            for k in {*plate.pressed, *plate.across}:
                gathered[plate.points, k] = 0.0
            for k in plate.pressed:
                gathered[plate.points[0], k] = forces[plate.points, k].sum()
            if plate.across:
                own = slopes[begun : begun + len(plate.points)]
                gathered.ravel()[plate.slots[-1]] = np.sum(own * forces[plate.points])
                begun += len(plate.points)
        return gathered

    def unbalanced(self, forces: FloatArray, positions: FloatArray, time: float) -> FloatArray:
        """The same with what supports exert on plates, and those released, at a load time taken off: zero in balance (theory 5.17)."""
        forces = self.gathered(forces, positions)
        for plate in self.plates:
            exerted = [plate.force[k] for k in plate.pressed] + [plate.moment / plate.length for _ in plate.across[:1]]
            forces.ravel()[plate.slots] -= self.factor(plate, time) * np.array(exerted)
        return forces if self._released is None else forces - self.fading(time)

    def factor(self, plate: Plate, time: float) -> float:
        """Factor of what a support exerts on a plate at a load time (theory 5.14)."""
        return factor_at(self._problem.stages, self._problem.supports[plate.support].factors, time)

    def fading(self, time: float) -> FloatArray:
        """What is left at a load time of the forces of supports that were released, shape (control points, 3) (theory 5.23)."""
        return np.zeros_like(self._numbering.reference) if self._released is None else self._remaining(time) * self._released

    def spread(self, solution: FloatArray, positions: FloatArray) -> FloatArray:
        """A field of control points, shape (control points, 3), from its values by equation, zero where it is prescribed (theory 5.17)."""
        values, free = np.zeros(len(self.equation)), self.equation >= 0
        values[free] = solution[self.equation[free]]
        field: FloatArray = values.reshape(-1, 3)
        if self._turning:
            angles = self.unknowns[len(self.equation) :].reshape(-1, 3)
            turned = np.where(angles >= 0, solution[angles], 0.0)
            np.add.at(field, self.copies, self.slopes(positions)[0] * turned)
        return field

    def seen(self, pattern: Pattern, square: bool) -> Seen:
        """A matrix of control points, or one with such columns, as plates see it that turn; the same one for the same pattern."""
        if pattern not in self._seen:
            self._seen[pattern] = seen(pattern, self.copies, self._numbering.count, square)
        return self._seen[pattern]

    def longest_increment(self, step: int) -> float:
        """The largest share of a recorded load step in which no support turns by more than LARGEST_TURN (theory 5.2): 1 / n."""
        stage = self._problem.stage_of(step)
        turns = [abs(support.motions[stage].rotate) / self._problem.stages[stage].steps for support in self._problem.supports]
        return 1.0 / max(1, int(np.ceil(max(turns, default=0.0) / constants.LARGEST_TURN)))

    def moved(self, time: float) -> BoolArray:
        """Prescribed components that their supports have moved, or move, by a load time, shape (control points, 3)."""
        moved = np.zeros_like(self.held)
        begun = int(np.count_nonzero(progress(self._problem.stages, time) > 0.0))
        for k in self.present:
            support, points = self._problem.supports[k], self.points[k]
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
        plate = self._plate_of(support)
        if plate is not None and positions is not None:
            own = list(plate.pressed)
            way[own] += (positions - self.place(time, positions))[plate.points[0], own]
        return way

    def angle(self, support: Support, time: float, positions: FloatArray | None = None) -> float:
        """By how many degrees a support has turned: by its motions, or where positions are given by its moment, from -180 to 180."""
        _, angle = moved_by(support, progress(self._problem.stages, time))
        plate = self._plate_of(support)
        if plate is not None and plate.across and positions is not None:
            return float(np.degrees(plate.angle(positions)))
        return float(angle)

    def _plate_of(self, support: Support) -> Plate | None:
        """The plate of a support that holds; None where it has none."""
        return next((plate for plate in self.plates if self._problem.supports[plate.support] is support), None)

    def increment(self, positions: FloatArray, time: float) -> FloatArray:
        """What prescribed positions lack to where supports put them, and plates of their shape; zero elsewhere, (control points, 3)."""
        lacking = np.zeros_like(positions)
        lacking.ravel()[self.prescribed] = (self.place(time) - positions).ravel()[self.prescribed]
        for plate in self.plates:  # where these turn; else they are in shape
            if plate.across or self._problem.supports[plate.support].turns:
                for k in {*plate.pressed, *plate.across}:
                    lacking[plate.points, k] = (self.placed(positions, time) - positions)[plate.points, k]
        return lacking

    def placed(self, positions: FloatArray, time: float) -> FloatArray:
        """Positions with the prescribed ones in their places, and plates in shape with their first control point (theory 5.17, 5.20)."""
        places = self.place(time, positions)
        placed = np.where(self.held, places, positions)
        for plate in self.plates:
            points = plate.points
            for k in plate.across:
                placed[points, k] = places[points, k]
            for k in plate.pressed:
                placed[points, k] = positions[points[0], k] + (places[points, k] - places[points[0], k])
        return placed

    def place(self, time: float, positions: FloatArray | None = None) -> FloatArray:
        """Positions of all control points with the prescribed ones where their supports put them at a load time (theory 5.2).

        Parameters
        ----------
        time : float
        positions : ndarray, shape (control points, 3), optional
            Where plates have turned to by their moments; without them they have not.

        Returns
        -------
        ndarray, shape (control points, 3)
            Rows of control points without support hold their reference positions; those of plates are as if no force had moved them.
        """
        found, shares = self._numbering.reference.copy(), progress(self._problem.stages, time)
        for k in self.present:
            support, points = self._problem.supports[k], self.points[k]
            shift, angle = moved_by(support, shares)
            arms = self._shapes[k] - np.asarray(support.centre)
            turned = rotation(unit(support.axis), np.radians(angle if positions is None else self.angle(support, time, positions)))
            target = np.asarray(support.centre, dtype=np.float64) + shift + arms @ turned.T
            for component in support.carried:
                found[points, component] = target[:, component]
        return found
