"""Balance of internal and contact forces at given positions: residual and condensed tangent."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from isomortar._bindings import Law, Response
from isomortar._codes import PointState
from isomortar._frozen import frozen
from isomortar._sparse import Ordering
from isomortar.errors import SingularSystemError
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.entities import Problem
from isomortar.model.loads import Loads
from isomortar.model.numbering import Numbering
from isomortar.model.origin import about, by_near_points, origin_of
from isomortar.model.pairs import Pair
from isomortar.model.rank import motions_left
from isomortar.model.solid import Solid
from isomortar.model.supports import Supports
from isomortar.solve.condensed import engine_of
from isomortar.solve.contact import Kinematics, PairMechanics
from isomortar.solve.record import State
from isomortar.solve.scales import PieceMeasures, Scales
from isomortar.solve.singular import PairConditions, explain
from isomortar.solve.system import Source, add_product
from isomortar.solve.systems import Systems
from isomortar.solve.timing import Ledger
from isomortar.solve.touching import Touching


@frozen
class Balance:
    """Forces at given positions, shape (control points, 3), with the contact kinematics and responses behind them.

    `total`: internal and contact forces, less loads; `unbalanced`: what is left of them at unknowns where nothing bears it.
    """

    positions: FloatArray
    internal: FloatArray
    total: FloatArray
    unbalanced: FloatArray
    kinematics: tuple[Kinematics, ...]
    responses: tuple[Response, ...]

    @property
    def active(self) -> int:
        """Number of active constraints."""
        return sum(int(np.count_nonzero(r.state)) for r in self.responses)

    @property
    def slipping(self) -> int:
        """Number of slipping constraints."""
        return sum(int(np.count_nonzero(r.state == PointState.SLIP)) for r in self.responses)


class Equilibrium:
    """A problem with its unknowns: everything that load steps and solvers share.

    Attributes
    ----------
    origin : ndarray, shape (3,)
        Where all coordinates in here count from, in those of the problem given: zero unless its bodies are far from the origin.
    problem : Problem
        In coordinates about `origin`.
    time : float
        Load time at the end of the increment that was begun last: loads are those of then.
    orderings : dict
        Orderings of the unknowns that are known, by the number of sources: with each pair that is in contact the matrix differs.
    systems : Systems
        What is solved, while the supports of a stage hold.

    Raises
    ------
    InputError
        Folded elements, rings that do not close.
    """

    def __init__(self, problem: Problem, ledger: Ledger) -> None:
        self.origin = origin_of(problem)
        self.problem = problem = by_near_points(about(problem, self.origin))
        self.ledger = ledger
        self.numbering = Numbering(problem)
        self.solid = Solid(problem, self.numbering, ledger.counts)
        pairs = [Pair(c, problem, self.numbering) for c in problem.contacts]
        self.pairs = [
            PairMechanics(pair, problem.settings, ledger, self.origin, pairs[:k] + pairs[k + 1 :]) for k, pair in enumerate(pairs)
        ]
        self.loads = Loads(problem, self.numbering)
        self.time = 0.0
        self._known: tuple[FloatArray, State, FloatArray, tuple[Kinematics, ...]] | None = None
        self._stiffness = np.zeros((0, 3, 3))
        self._steady = False
        self._engine = engine_of(problem.settings)
        self.orderings: dict[int, Ordering] = {}
        self._stand(0)

    def _stand(self, stage: int) -> None:
        """Let the supports of a stage hold."""
        self.supports = Supports(self.problem, self.numbering, stage)
        self.measures = PieceMeasures(self.numbering, self.supports, self.solid)
        self.solid_source = Source(self.solid.pattern, self.supports.equation, self.supports.equation)
        self.systems = Systems(len(self.supports.free), self.orderings, self.ledger, self._engine)
        self._touching = Touching(self.problem, self.numbering, self.supports, self.loads)
        #: Pieces that supports leave a rigid motion.
        self.loose = [piece for piece in self.numbering.pieces if len(motions_left(self.problem, piece, stage))]

    def standing(self, step: int) -> Supports:
        """The supports of the stage of a load step."""
        stage = self.problem.stage_of(step)
        if stage != self.supports.stage and self._changes:
            self._stand(stage)
        return self.supports

    @property
    def _changes(self) -> bool:
        """Whether supports are released, or added."""
        return any(support.stages is not None for support in self.problem.supports)

    def enter(self, step: int, state: State) -> None:
        """Go into a load step from the state before it; what supports exerted that are released goes on, and fades (theory 5.23)."""
        supports, time = self.standing(step), float(step - 1)
        if not self._changes:
            return
        supports.anchor(state.positions, time)
        supports.release(np.zeros_like(state.positions), time)
        self.begin(state, time)
        left = self.forces(state.positions, state, lambda k, _: self.pairs[k].bearing(state.contacts[k])).unbalanced
        supports.release(left, time)

    def initial_state(self) -> State:
        """The reference configuration without contact."""
        reference = self.numbering.reference
        return State(reference.copy(), tuple(pair.initial(reference) for pair in self.pairs))

    def begin(self, start: State, time: float, first: FloatArray | None = None) -> tuple[FloatArray, Scales]:
        """Begin a load increment from a converged state to a load time.

        Parameters
        ----------
        start : State
        time : float
        first : ndarray, optional
            Positions of the first iterate, where these are not those of the start.

        Returns
        -------
        ndarray, shape (control points, 3)
            Increment of the prescribed positions.
        Scales
            What forces are measured against.
        """
        self.time, self._known = time, None
        if self.systems.in_use:
            self.systems.in_use.begin()
        for pair, contact in zip(self.pairs, start.contacts, strict=True):
            pair.begin(self.supports, start.positions, contact, time)
        with self.ledger.phase("solid"):
            scales = self.measures.scales(start.positions if first is None else first)
        return self.supports.increment(start.positions, time), scales

    @property
    def pulled(self) -> bool:
        """Whether loads act, or supports with a force."""
        return self._touching.pulled

    def contact_may_hold(self, start: State) -> bool:
        """Whether supports leave bodies rigid motions that contact would hold, if it were closed everywhere (theory 6.9)."""
        return bool(self.loose) and self._touching.may_hold(self.pairs, start)

    def closed(self, start: State, penalties: Sequence[float | Scales], rests: bool) -> list[FloatArray | None]:
        """First pressures of the pairs that loads close, of which all is open at the start; see `Touching.closed` (theory 6.8)."""
        return self._touching.closed(self.pairs, start, self.time, penalties, rests)

    def state(self, balance: Balance) -> State:
        """The state that a balance leaves, to go on from."""
        pairs = zip(self.pairs, balance.kinematics, balance.responses, strict=True)
        return State(balance.positions, tuple(pair.state(kinematics, response) for pair, kinematics, response in pairs))

    def complete(self, balance: Balance) -> None:
        """Compute what was put off at the positions of a balance.

        Raises
        ------
        LostProjectionError
        """
        for kinematics in balance.kinematics:
            _ = kinematics.control

    def balance(self, positions: FloatArray, start: State, laws: Sequence[Law]) -> Balance:
        """Forces at given positions with the multipliers that given laws make of them; slips count from `start`.

        Raises
        ------
        FoldedElementError, LostProjectionError
        """
        return self.forces(positions, start, lambda k, kinematics: self.pairs[k].respond(kinematics, laws[k]))

    def forces(self, positions: FloatArray, start: State, respond: Callable[[int, Kinematics], Response]) -> Balance:
        """The same with the response of each pair, by its number and kinematics, given by a function."""
        internal, kinematics = self._without_multipliers(positions, start)
        total = internal.copy()
        with self.ledger.phase("solid"):
            for load in self.loads.forces(positions, self.time):
                total -= load
        responses = []
        for k, (pair, found) in enumerate(zip(self.pairs, kinematics, strict=True)):
            responses.append(respond(k, found))
            pair.add_forces(positions, found, responses[-1], total)
        unbalanced = self.supports.unbalanced(total, positions, self.time)
        return Balance(positions, internal, total, unbalanced, kinematics, tuple(responses))

    def _without_multipliers(self, positions: FloatArray, start: State) -> tuple[FloatArray, tuple[Kinematics, ...]]:
        """Internal forces, and the kinematics of each pair.

        Those of the last positions are kept: an augmentation begins with other multipliers where the last one ended.
        """
        if self._known is None or self._known[0] is not positions or self._known[1] is not start:
            with self.ledger.phase("solid"):
                internal = self.solid.forces(positions)
            kinematics = tuple(pair.kinematics(positions, state) for pair, state in zip(self.pairs, start.contacts, strict=True))
            self._known = positions, start, internal, kinematics
        self.ledger.counts["solid residuals"] += 1
        return self._known[2:]

    def bear(self, balance: Balance) -> bool:
        """Whether constraints that supports hold along the normal are inside their master, and bear on it from now on (theory 4.11)."""
        return any(pair.bear(k) for pair, k in zip(self.pairs, balance.kinematics, strict=True))

    def body_tangents(self, positions: FloatArray, keep_bodies: bool) -> tuple[list[Source], list[FloatArray]]:
        """Tangents of solids and of loads on them, as sources of the system with their values; with `keep_bodies` those of solids stay."""
        if not keep_bodies:
            with self.ledger.phase("solid"):
                self._stiffness = self.solid.forces_and_tangent(positions)[1]
            self.ledger.counts["solid tangents"] += 1
            if self._steady:
                self._stiffness = self._steadied(self._stiffness)
        with self.ledger.phase("solid"):
            of_loads = list(self.loads.tangents(positions, self.time))
        equation = self.supports.equation
        sources = [self.solid_source, *(Source(pattern, equation, equation) for pattern, _ in of_loads)]
        return sources, [self._stiffness, *(-values for _, values in of_loads)]

    @contextmanager
    def steadied(self, steady: bool) -> Iterator[None]:
        """Make tangents in which bodies that supports leave a rigid motion are held a little, if they are to be."""
        self._steady = steady
        try:
            yield
        finally:
            self._steady = False

    def _steadied(self, stiffness: FloatArray) -> FloatArray:
        """The bodies' tangent in which they are held (theory 6.9)."""
        stiffness = stiffness.copy()
        for piece in self.loose:
            diagonal = self.solid.diagonal[np.unique(np.concatenate([self.numbering.points[body.name] for body in piece]))]
            largest = np.max(stiffness[diagonal]) or np.max(stiffness)  # a rigid body has no stiffness of its own
            stiffness[diagonal] += np.eye(3) * (constants.STEADY * largest)
        return stiffness

    def left_by_bodies(self, before: Balance, after: Balance) -> float:
        """What the bodies' tangent of the last solve missed of their forces on the way from one iterate to the next (theory 5.24).

        A share of what was out of balance; infinite where these factors can not stay while others come for contact.
        """
        free, supports = self.supports.free, self.supports
        out = float(np.linalg.norm(before.unbalanced.ravel()[free]))
        if self.systems.in_use is None or len(supports.copies) or out == 0.0:
            return np.inf
        made = self.systems.in_use.by_bodies((after.positions - before.positions).ravel()[free])
        if made is None:
            return np.inf
        change = supports.gathered(after.internal - before.internal, before.positions).ravel()[free]
        return float(np.linalg.norm(change - made)) / out

    def tangents(self, balance: Balance, laws: Sequence[Law], keep_bodies: bool = False) -> tuple[list[Source], list[FloatArray]]:
        """Tangents of solids (the last ones, where bodies are kept), loads and condensed contact, as sources with their values."""
        sources, values = self.body_tangents(balance.positions, keep_bodies)
        for pair, law, kinematics, response in zip(self.pairs, laws, balance.kinematics, balance.responses, strict=True):
            if not np.any(response.state):
                continue
            pattern, tangent = pair.condensed(response, pair.blocks(balance.positions, kinematics, law, response))
            sources.append(Source(pattern, self.supports.equation, self.supports.equation))
            values.append(tangent)
        return sources, values

    def correction(self, balance: Balance, laws: Sequence[Law], prescribed: FloatArray, keep_bodies: bool = False) -> FloatArray:
        """Newton's correction of all positions, with given increments of the prescribed ones, shape (control points, 3) (theory 5.4).

        With `keep_bodies` the bodies' tangent stays as it was.

        Raises
        ------
        SingularSystemError
            Naming a body that nothing holds.
        """
        sources, values = self.tangents(balance, laws, keep_bodies)
        values[0] = self._at_rest(values[0], balance)
        sources, values = self.seen(sources, values, balance)
        right = balance.unbalanced.ravel()[self.supports.free]
        if np.any(prescribed):
            for source, block in zip(sources, values, strict=True):
                add_product(source, block, prescribed, right)
        solution = self.solve(sources, values, right, balance.positions)
        return prescribed - self.supports.spread(solution, balance.positions)

    def _at_rest(self, stiffness: FloatArray, balance: Balance) -> FloatArray:
        """The bodies' tangent, in which rigid ones that nothing acts on stay where they are where all contact is open.

        Nothing holds one that its force has let go, and others have yet to come back from it.
        """
        if balance.active:
            return stiffness
        free = np.any(self.supports.equation.reshape(-1, 3) >= 0, axis=1)
        rigid = [self.numbering.points[body.name] for body in self.problem.bodies if body.rigid]
        still = [points for points in rigid if np.any(free[points]) and not np.any(balance.unbalanced[points])]
        if not still:
            return stiffness
        diagonal = self.solid.diagonal[np.concatenate(still)]
        stiffness = stiffness.copy()
        stiffness[diagonal] = np.eye(3) * np.max(stiffness[self.solid.diagonal])
        return stiffness

    def kept_correction(self, balance: Balance) -> FloatArray:
        """Correction of all positions by the factors of the last tangent, with the prescribed positions as they are."""
        return -self.supports.spread(self.solve_again(balance.unbalanced.ravel()[self.supports.free]), balance.positions)

    def moved(self, positions: FloatArray, step: FloatArray) -> FloatArray:
        """Positions after a step of an iteration, plates that turn in shape again (theory 5.20)."""
        moved = positions + step
        return self.supports.placed(moved, self.time) if len(self.supports.copies) else moved

    def seen(self, sources: list[Source], values: list[FloatArray], balance: Balance) -> tuple[list[Source], list[FloatArray]]:
        """Sources and their values, the first of them the solid's, as unknowns of plates see them that turn (theory 5.21)."""
        supports = self.supports
        if not len(supports.copies):
            return sources, values
        first, second = supports.slopes(balance.positions)
        new, found = list(sources), list(values)
        for number, source in enumerate(sources):
            if source.column_of is not supports.equation:  # of multipliers alone
                continue
            square = source.row_of is supports.equation
            wide = supports.seen(source.pattern, square)
            new[number] = Source(wide.pattern, supports.unknowns if square else source.row_of, supports.unknowns, source.transposed)
            found[number] = wide.values(values[number], first)
            if number == 0:
                found[0][wide.own] += np.einsum("ai,ij->aij", second * balance.total[supports.copies], np.eye(3))
        return new, found

    def solve(
        self,
        sources: list[Source],
        values: list[FloatArray],
        right: FloatArray,
        positions: FloatArray,
        multipliers: Sequence[PairConditions] = (),
    ) -> FloatArray:
        """Solve the system of the given sources; the first is the solid's. Free unknowns come first, multipliers after them.

        Raises
        ------
        SingularSystemError
            Naming a body that nothing holds, contact conditions that repeat each other, or where digits are lost.
        """
        if not len(right):  # every position is prescribed
            return right
        system = self.systems.of(sources, len(right))
        try:
            system.factorise(values)
        except SingularSystemError as error:
            raise explain(system.rcond, system.near_null(), self.supports, positions, self.numbering, multipliers) from error
        self.systems.note_ordering()
        return system.solve(right)

    def solve_again(self, right: FloatArray) -> FloatArray:
        """Solve with the factors of the last `solve`."""
        assert self.systems.in_use, "nothing was solved before"
        return self.systems.in_use.solve_again(right)

    @property
    def ends_stage(self) -> bool:
        """Whether the increment that was begun last ends where a stage does."""
        return bool(np.any(self.time == np.cumsum([stage.steps for stage in self.problem.stages])))

    @property
    def was_solved(self) -> bool:
        """Whether there has been a system to solve since these supports hold."""
        return self.systems.in_use is not None

    def moved_by(self, forces: FloatArray) -> FloatArray | None:
        """What forces on the free unknowns move, by the factors of the last `solve` (theory 5.26); None before there are any."""
        system = self.systems.in_use
        if system is None:
            return None
        right = np.zeros(system.size)
        right[: len(forces)] = forces
        return system.solve_again(right)[: len(forces)]
