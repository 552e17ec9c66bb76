"""Uzawa's method: Newton's method for the positions inside a loop of augmentations (theory 7)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from isomortar._bindings import NO_FRICTION, Law, Response
from isomortar.errors import ConvergenceError
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.solve.contact import Kinematics, PairMechanics
from isomortar.solve.distances import apart, largest, off_conditions, ratio, round_off
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.method import Increment, Method, augmentation_record
from isomortar.solve.metric import median
from isomortar.solve.newton import Converged, Iterate, Newton
from isomortar.solve.record import IterationRecord, State
from isomortar.solve.scales import Scales
from isomortar.solve.secants import Secants


class _PositionNewton(Newton[Iterate, FloatArray]):
    """Newton's method for the positions, with the multipliers of one augmentation held."""

    def __init__(self, equilibrium: Equilibrium, start: State, scales: Scales, seeks_hold: bool) -> None:
        super().__init__(equilibrium, start, scales, seeks_hold)
        self._closes = False  # whether the first iterate has constraints closed whatever they bear
        self._secants = Secants()

    def held(self, laws: Sequence[Law], positions: FloatArray) -> Iterate:
        """The first iterate with these laws, where the last augmentation ended."""
        self._laws, self._closes, self._loads_closed = laws, False, []
        self._secants.leave()
        return self._evaluate(positions)

    def first(self, laws: Sequence[Law], positions: FloatArray) -> Iterate:
        """The same at the start of an increment, with that closed which loads close first."""
        self._laws = laws
        self._secants.leave()
        return self._closing(positions, frictionless=False)

    def _closing(self, positions: FloatArray, frictionless: bool) -> Iterate:
        """An iterate in which that is closed, whatever it bears, which loads close first (theory 6.8)."""
        nearest = self._nearest(positions, [float(law.penalties[0]) for law in self._laws])
        self._closes = any(self._loads_closed)
        if not self._closes:
            return self._evaluate(positions)

        def respond(k: int, kinematics: Kinematics) -> Response:
            pair, law, pressure = self._equilibrium.pairs[k], self._laws[k], nearest[k]
            if pressure is None:
                return pair.respond(kinematics, law)
            friction = NO_FRICTION if frictionless else law.friction
            closed = pair.respond(kinematics, replace(law, pressure=law.pressure + pressure, friction=friction))
            return replace(closed, pressure=closed.pressure - np.where(closed.state > 0, pressure, 0.0))

        balance = self._equilibrium.forces(positions, self._start, respond)
        return Iterate(balance, self._residual(balance))

    def _closed_anew(self, iterate: Iterate) -> Iterate:
        return self._closing(iterate.balance.positions, frictionless=True)

    def _evaluate(self, positions: FloatArray) -> Iterate:
        balance = self._equilibrium.balance(positions, self._start, self._laws)
        return Iterate(balance, self._residual(balance))

    def _given_up(self, iterate: Iterate, log: tuple[IterationRecord, ...]) -> Converged[Iterate]:
        """An iterate that is out of balance by round-off, which penalties multiply, is what it comes to (theory 7.7)."""
        if self._residual(iterate.balance, self._multiplied(iterate.balance)) <= self._settings.newton_tolerance:
            self._have_factors(iterate)
            return Converged(iterate, log, float("nan"))
        return super()._given_up(iterate, log)

    def _multiplied(self, balance: Balance) -> FloatArray:
        """Norm of what the last bits of positions make of the gaps and slips that penalties multiply, shape (pieces,) (theory 7.7)."""
        norms = np.zeros_like(self._scales.round_off)
        for pair, law, kinematics, response in zip(self._equilibrium.pairs, self._laws, balance.kinematics, balance.responses, strict=True):
            if not pair.rests(kinematics, law.pressure, law.traction):
                normal, tangential = round_off(pair, balance.positions, law, response)
                weight = kinematics.control.weight[response.state > 0]
                mean = float(np.linalg.norm(weight)) / max(len(weight), 1) ** 0.5
                norms[pair.pair.pieces] += constants.ROUND_OFF * max(normal, tangential) * mean
        return norms

    def _moved(self, iterate: Iterate, correction: FloatArray, share: float) -> Iterate:
        return self._evaluate(self._equilibrium.moved(iterate.balance.positions, share * correction))

    def _correct(self, iterate: Iterate, prescribed: FloatArray | None, keep_bodies: bool) -> tuple[Iterate, FloatArray, tuple[str, ...]]:
        moves = prescribed is not None and bool(np.any(prescribed))
        increment = prescribed if prescribed is not None else np.zeros_like(iterate.balance.positions)
        correction = self._equilibrium.correction(iterate.balance, self._laws, increment, keep_bodies)
        self._secants = Secants()
        if not moves and not self._closes:  # else it is not of these laws' forces alone
            self._secants.reach(iterate.balance.positions, correction)
        self._closes = False
        return iterate, correction, ()

    def _correct_again(self, iterate: Iterate) -> FloatArray:
        correction = self._equilibrium.kept_correction(iterate.balance)
        self._secants.reach(iterate.balance.positions, correction)
        return self._secants.improved(correction)

    def _update(self, iterate: Iterate, correction: FloatArray, iteration: int) -> tuple[Iterate, tuple[str, ...]]:
        """The full update; late, where that leaves more of the residual than before, one halved until it leaves less.

        A narrow cone is next to a kink: full updates go from one side of it to the other and back. If halving does not help either, the
        full update it is.
        """
        whole = self._moved(iterate, correction, 1.0)
        late = iteration >= constants.ACTIVE_SET_ITERATIONS and "halving" in self._settings.measures
        if not late or whole.residual < iterate.residual:
            return whole, ()
        for halving in range(1, constants.MAX_HALVINGS + 1):
            following = self._moved(iterate, correction, 0.5**halving)
            if following.residual < iterate.residual:
                return following, (f"halved {halving} times: residual",)
        return whole, ()


class Uzawa(Method):
    """Solves load increments by augmentations of control pressures and tractions."""

    def advance(self, start: State, time: float, step: int) -> Increment:
        """Solve the increment; see `Method.advance`."""
        return self._seeking_hold(start, partial(self._augmented, start, time, step))

    def _augmented(self, start: State, time: float, step: int, seeks_hold: bool) -> Increment:
        """Augment until multipliers and positions are those of each other (theory 7.1, 7.2)."""
        equilibrium = self._equilibrium
        prescribed, scales = equilibrium.begin(start, time)
        factors = np.array([self._settings.penalty_normal, self._settings.penalty_tangential])
        base = [factors * pair.stiffness(scales) / pair.penalty_area for pair in equilibrium.pairs]
        laws = [pair.law(b, s.pressure, s.traction) for pair, b, s in zip(equilibrium.pairs, base, start.contacts, strict=True)]

        newton = _PositionNewton(equilibrium, start, scales, seeks_hold)
        positions, records, orders, growth = start.positions, [], [], 1.0
        for augmentation in range(1, self._settings.max_augmentations + 1):
            first = newton.first(laws, positions) if augmentation == 1 else newton.held(laws, positions)
            found = newton.solve(first, prescribed, partial(self._observer.iteration, step, time, augmentation))
            orders.append(found.order)
            balance = found.iterate.balance
            changes, distances = self._changes(laws, balance), self._distances(laws, balance, scales)
            records.append(augmentation_record(augmentation, laws, changes, found.log))
            self._observer.augmented(step, time, records[-1])
            off = np.array(distances) / constants.DISTANCE_ALLOWED[self._settings.augmentation_norm]
            if np.max([*changes, *off]) <= self._settings.augmentation_tolerance and not equilibrium.bear(balance):
                equilibrium.complete(balance)
                return Increment(balance, tuple(records), tuple(orders))
            growth = min(growth * self._settings.penalty_growth, max(self._settings.penalty_growth_max, 1.0))
            laws = [
                replace(law, penalties=growth * b, pressure=r.pressure, traction=pair.resting(s, k, r.pressure, r.traction))
                for pair, law, b, s, k, r in zip(
                    equilibrium.pairs, laws, base, start.contacts, balance.kinematics, balance.responses, strict=True
                )
            ]
            positions, prescribed = balance.positions, np.zeros_like(prescribed)
        raise ConvergenceError(
            f"{self._settings.max_augmentations} augmentations left a relative change of the multipliers of {np.max(changes):.2e} and "
            f"{np.max(distances):.2e} off the contact conditions (solver.augmentation_tolerance is "
            f"{self._settings.augmentation_tolerance:g}; larger penalties need fewer augmentations)"
        )

    def _changes(self, laws: list[Law], balance: Balance) -> tuple[float, float]:
        """Relative change of pressures and of tractions by the last augmentation (theory 7.3; the paper's mixed norm: twice the same).

        Of the pair where it is largest: a heavily loaded pair must not hide another one.
        """
        changes = []
        for pair, law, kinematics, response in zip(self._equilibrium.pairs, laws, balance.kinematics, balance.responses, strict=True):
            if pair.rests(kinematics, law.pressure, law.traction):
                continue
            if self._settings.augmentation_norm == "paper":
                new_p, new_t = response.pressure - law.pressure, response.traction - law.traction
                mixed = ratio(float(np.sum(new_p**2) + np.sum(new_t**2)), float(np.sum(law.pressure**2) + np.sum(law.traction**2)))
                changes.append((mixed, mixed))
            else:
                changes.append(
                    apart(
                        pair,
                        kinematics.control,
                        (response.pressure, response.traction),
                        (law.pressure, law.traction),
                        round_off(pair, balance.positions, law, response, self._unbalanced(pair, kinematics, balance)),
                    )
                )
        return largest(changes)

    def _distances(self, laws: list[Law], balance: Balance, scales: Scales) -> tuple[float, float]:
        """Relative distance of pressures and tractions from the contact conditions, of the pair where it is largest (theory 7.4)."""
        pairs = zip(self._equilibrium.pairs, laws, balance.kinematics, balance.responses, strict=True)
        return largest(
            off_conditions(pair, balance.positions, kinematics, law, response, scales, self._unbalanced(pair, kinematics, balance))
            for pair, law, kinematics, response in pairs
            if not pair.rests(kinematics, law.pressure, law.traction)
        )

    def _unbalanced(self, pair: PairMechanics, kinematics: Kinematics, balance: Balance) -> float:
        """What forces that balance to `newton_tolerance` leave open of a pair's multipliers: norm over median weight (theory 7.5).

        Friction of a thousandth and less makes tractions that are no more than that; augmentations would go on for ever.
        """
        present = kinematics.control.weight[kinematics.control.weight > 0]
        if not present.size:
            return 0.0
        forces = float(self._equilibrium.measures.norms(balance.internal)[pair.pair.pieces].max())
        return constants.LEFT_OPEN * self._settings.newton_tolerance * forces / median(present)
