"""The monolithic method: positions and multipliers in one semismooth Newton loop (theory 6)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import count

import numpy as np

from isomortar._bindings import Law, Response
from isomortar.errors import ConvergenceError, FoldedElementError, LostProjectionError
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.solve.bordered import Border, Correction, solve_bordered, solve_with_kept_factors
from isomortar.solve.contact import largest
from isomortar.solve.equilibrium import Balance
from isomortar.solve.feet import beside_poles
from isomortar.solve.method import Increment, Method
from isomortar.solve.newton import (
    CYCLE_FREE,
    KEPT_FACTORS,
    KEPT_SHARE,
    MAX_HALVINGS,
    observed_order,
    relative_residual,
    residual_round_off,
)
from isomortar.solve.record import AugmentationRecord, IterationRecord, State
from isomortar.solve.scales import Scales

#: Share of the cone within which a trial counts as slip at the start of an increment (theory 6.5).
SLIP_MARGIN = 1e-6
#: How often the predictor is solved again with reversed slips held.
MAX_REVERSALS = 2


@dataclass(frozen=True)
class Iterate:
    """Positions and multipliers with all that follows from them.

    `balance.responses` hold the current multipliers and the states; `targets` what the contact conditions make of them.
    """

    balance: Balance
    laws: tuple[Law, ...]
    targets: tuple[Response, ...]
    residual: float
    gap_pressure: float
    gap_traction: float

    @property
    def merit(self) -> float:
        """What an update should make smaller (theory 6.6)."""
        return float(np.max([self.residual, self.gap_pressure, self.gap_traction]))  # not a number where one is not: `max` drops it

    @property
    def states(self) -> bytes:
        """The states of all control points, to compare with."""
        return b"".join(response.state.tobytes() for response in self.targets)

    @property
    def elements(self) -> IntArray:
        """Master elements and fixed coordinates of the slave quadrature points, shape (points of all pairs, 4)."""
        places = [np.hstack([k.projections.element, k.projections.fixed]) for k in self.balance.kinematics]
        return np.concatenate(places or [np.zeros((0, 4), dtype=np.int32)])


class Monolithic(Method):
    """Solves load increments for positions, control pressures and control tractions at once."""

    def advance(self, start: State, time: float, step: int) -> Increment:
        """Solve the increment; see `Method.advance`."""
        prescribed, scales = self._equilibrium.begin(start, time)
        iterate = self._first(start, scales)
        moves = bool(np.any(prescribed))
        log: list[IterationRecord] = []
        seen = [iterate.states]
        visited = [iterate.elements]
        notes: tuple[str, ...] = ()
        borders: Sequence[Border | None] = ()
        keep, tangents = False, 0
        for iteration in count():
            record = self._record(iteration, iterate, notes)
            log.append(record)
            self._observer.iteration(step, time, 1, record)
            if self._converged(iterate) and not (moves and iteration == 0):
                if not self._bear(iterate.balance):
                    return self._increment(iterate, log, scales)
                multipliers = [(law.pressure, law.traction) for law in iterate.laws]
                iterate, keep = self._evaluate(iterate.balance.positions, multipliers, start, scales), False
            last, following = iterate, self._by_kept_factors(iterate, start, scales, borders) if keep else None
            if following is not None:
                iterate, notes = following, (KEPT_FACTORS,)
            elif tangents == self._settings.max_iterations or not np.isfinite(iterate.merit):
                break
            else:
                tangents += 1
                if iteration == 0:
                    last, correction, borders, notes = self._predict(iterate, start, scales, prescribed)
                else:
                    correction, borders = solve_bordered(self._equilibrium, iterate.balance, iterate.laws, iterate.targets, None)
                    notes = ()
                iterate, halved = self._update(last, correction, start, scales, seen if iteration >= CYCLE_FREE else [], iteration)
                notes += halved
            keep = iterate.states == last.states and iterate.merit <= KEPT_SHARE * last.merit and "keeping" in self._settings.measures
            seen.append(iterate.states)
            visited.append(iterate.elements)
        raise ConvergenceError(
            f"Newton's method stopped at a relative residual of {iterate.residual:.2e} and "
            f"{max(iterate.gap_pressure, iterate.gap_traction):.2e} off the contact conditions after {iteration} iterations"
            + _toggling(seen, visited, self._beside_poles(iterate), self._settings.slip_sum == "paper")
        )

    def _beside_poles(self, iterate: Iterate) -> np.ndarray:
        """Which slave quadrature points, of all pairs, have their feet in elements of the master that end at a pole."""
        pairs = zip(self._equilibrium.pairs, iterate.balance.kinematics, strict=True)
        return np.concatenate(
            [beside_poles(pair.pair, kinematics.projections) for pair, kinematics in pairs] or [np.zeros(0, dtype=np.bool_)]
        )

    def _first(self, start: State, scales: Scales) -> Iterate:
        """The converged state of the last increment as the first iterate; what supports push along a plane slides (theory 6.5)."""
        pairs = zip(self._equilibrium.pairs, start.contacts, strict=True)
        multipliers = [(contact.pressure, pair.sliding(contact)) for pair, contact in pairs]
        margin = SLIP_MARGIN if "margin" in self._settings.measures else 0.0
        return self._evaluate(start.positions, multipliers, start, scales, margin)

    def _evaluate(
        self,
        positions: FloatArray,
        multipliers: Sequence[tuple[FloatArray, FloatArray]],
        start: State,
        scales: Scales,
        margin: float = 0.0,
        held: Sequence[np.ndarray] | None = None,
    ) -> Iterate:
        """An iterate; multipliers of control points that turn out inactive are set to zero (theory 6.2)."""
        equilibrium = self._equilibrium
        forgiving = "forgiving" in self._settings.measures
        with equilibrium.ledger.phase("solid"):
            internal = equilibrium.solid.forces(positions)
        total = internal.copy()
        kinematics, laws, targets, currents = [], [], [], []
        for k, (pair, (pressure, traction)) in enumerate(zip(equilibrium.pairs, multipliers, strict=True)):
            kinematics.append(pair.kinematics(positions, start.contacts[k]))
            law = pair.law(pair.parameters(kinematics[-1].control, scales), pressure, traction)
            law = replace(law, slip_margin=margin, forgiving=forgiving, held=law.held if held is None else held[k])
            targets.append(pair.respond(kinematics[-1], law))
            active = targets[-1].state > 0
            laws.append(replace(law, pressure=np.where(active, pressure, 0.0), traction=np.where(active[:, None], traction, 0.0)))
            currents.append(replace(targets[-1], pressure=laws[-1].pressure, traction=laws[-1].traction))
            pair.add_forces(positions, kinematics[-1], currents[-1], total)
        balance = Balance(positions, internal, total, tuple(kinematics), tuple(currents))
        residual = relative_residual(equilibrium, balance, scales)
        return Iterate(balance, tuple(laws), tuple(targets), residual, *self._gaps(balance, laws, targets))

    def _gaps(self, balance: Balance, laws: Sequence[Law], targets: Sequence[Response]) -> tuple[float, float]:
        """Relative distance of pressures and tractions from the contact conditions, of the pair where it is largest (theory 6.6)."""
        pairs = zip(self._equilibrium.pairs, balance.kinematics, balance.responses, laws, targets, strict=True)
        return largest(
            pair.apart(k.control, (now.pressure, now.traction), (to.pressure, to.traction), pair.round_off(balance.positions, law, to))
            for pair, k, now, law, to in pairs
        )

    def _converged(self, iterate: Iterate) -> bool:
        """Whether forces are in balance and the contact conditions are met (theory 5.6, 6.6)."""
        within = self._settings.complementarity_tolerance
        balanced = iterate.residual <= self._settings.newton_tolerance
        return balanced and iterate.gap_pressure <= within and iterate.gap_traction <= within

    def _predict(
        self, iterate: Iterate, start: State, scales: Scales, prescribed: FloatArray
    ) -> tuple[Iterate, Correction, list[Border | None], tuple[str, ...]]:
        """The first solve, with the prescribed increment; slips that would reverse stick instead, and it is repeated (theory 6.5)."""
        equilibrium = self._equilibrium
        correction, borders = solve_bordered(equilibrium, iterate.balance, iterate.laws, iterate.targets, prescribed)
        if "reversal" not in self._settings.measures:
            return iterate, correction, borders, ()
        held = [law.held for law in iterate.laws]
        notes: tuple[str, ...] = ()
        for _ in range(MAX_REVERSALS):
            reversed_ = [self._reversals(k, iterate, correction, border) for k, border in enumerate(borders)]
            if not any(r.any() for r in reversed_):
                break
            held = [np.maximum(h, r.astype(np.int32)) for h, r in zip(held, reversed_, strict=True)]
            multipliers = [(law.pressure, law.traction) for law in iterate.laws]
            margin = SLIP_MARGIN if "margin" in self._settings.measures else 0.0
            iterate = self._evaluate(start.positions, multipliers, start, scales, margin, held)
            correction, borders = solve_bordered(equilibrium, iterate.balance, iterate.laws, iterate.targets, prescribed)
            notes = (f"reversal of {sum(int(h.sum()) for h in held)}",)
        return iterate, correction, borders, notes

    def _by_kept_factors(self, iterate: Iterate, start: State, scales: Scales, borders: Sequence[Border | None]) -> Iterate | None:
        """The next iterate with the factors of an earlier tangent; None if these leave too much of the merit, or states change."""
        correction = solve_with_kept_factors(self._equilibrium, iterate.balance, iterate.targets, borders)
        try:
            following = self._evaluate(*_moved(iterate, correction, 1.0), start, scales)
        except (FoldedElementError, LostProjectionError):
            return None
        return following if following.states == iterate.states and following.merit <= KEPT_SHARE * iterate.merit else None

    def _reversals(self, k: int, iterate: Iterate, correction: Correction, border: Border | None) -> np.ndarray:
        """Slipping control points whose predicted trial change opposes their traction: t^a Dt_a < 0 (theory 6.5)."""
        target = iterate.targets[k]
        if border is None or not self._equilibrium.pairs[k].friction.acts:
            return np.zeros(len(target.state), dtype=bool)
        change = correction.tractions[k] + border.trial_change(correction.positions)
        raised = self._equilibrium.pairs[k].contravariant(iterate.balance.kinematics[k].control, iterate.laws[k].traction)
        return (target.state == 2) & (np.einsum("ia,ia->i", raised, change) < 0.0)

    def _update(
        self, iterate: Iterate, correction: Correction, start: State, scales: Scales, seen: list[bytes], iteration: int
    ) -> tuple[Iterate, tuple[str, ...]]:
        """The next iterate: the full update, or one halved until it is admissible (theory 6)."""
        halvings = MAX_HALVINGS if "halving" in self._settings.measures else 0
        reason, share = "", 1.0
        for halving in range(halvings + 1):
            last = halving == halvings
            try:
                following = self._evaluate(*_moved(iterate, correction, share), start, scales)
            except (FoldedElementError, LostProjectionError) as error:
                if last or iteration == 0:
                    raise
                reason = "folded element" if isinstance(error, FoldedElementError) else "lost projection"
            else:
                cycles = following.states != iterate.states and following.states in seen and halving == 0
                doubles = iteration >= CYCLE_FREE and not following.merit <= 2.0 * iterate.merit
                if last or iteration == 0 or not (cycles or doubles):
                    break
                reason = "cycle" if cycles else "merit"
            share *= 0.5
        return following, (f"halved {halving} times: {reason}",) if reason else ()

    def _record(self, iteration: int, iterate: Iterate, notes: tuple[str, ...]) -> IterationRecord:
        active, slip = iterate.balance.active, iterate.balance.slipping
        return IterationRecord(iteration, iterate.merit, active, active - slip, slip, notes)

    def _increment(self, iterate: Iterate, log: list[IterationRecord], scales: Scales) -> Increment:
        parameters = iterate.laws[0].penalties if iterate.laws else np.zeros(2)
        record = AugmentationRecord(1, float(parameters[0]), float(parameters[1]), iterate.gap_pressure, iterate.gap_traction, tuple(log))
        round_off = residual_round_off(self._equilibrium, iterate.balance, scales)
        return Increment(iterate.balance, (record,), (observed_order(log, round_off),))


def _moved(iterate: Iterate, correction: Correction, share: float) -> tuple[FloatArray, list[tuple[FloatArray, FloatArray]]]:
    """Positions and multipliers of an iterate with a share of a correction."""
    changes = zip(iterate.laws, correction.pressures, correction.tractions, strict=True)
    multipliers = [(law.pressure + share * dp, law.traction + share * dt) for law, dp, dt in changes]
    return iterate.balance.positions + share * correction.positions, multipliers


def _toggling(seen: Sequence[bytes], visited: Sequence[IntArray], by_poles: np.ndarray, summed: bool) -> str:
    """What changed to and fro in the last iterations, as a part of a sentence."""
    states = np.array([np.frombuffer(s, dtype=np.int32) for s in seen[-6:]])
    points = np.flatnonzero(np.any(states != states[0], axis=0))
    if points.size:
        hint = ' (solver.slip_sum = "local" has no jump where a neighbour becomes active)' if summed else ""
        return f"; slave control points {_first_few(points)} change their states from iteration to iteration{hint}"
    elements = np.array(visited[-6:])
    crossing = np.flatnonzero(np.any(elements != elements[0], axis=(0, 2)))
    about = crossing[by_poles[crossing]]
    if about.size:
        return (
            f"; nearest points of slave quadrature points {_first_few(about)} go round a pole of the master: pressed in, it is a hollow "
            "vertex, and what is above one has no nearest point of its own. Press beside it, or take a mesh without a pole there"
        )
    if crossing.size:
        return (
            f"; slave quadrature points {_first_few(crossing)} cross a knot line of the master from iteration to iteration, where a master "
            "of order 1 or of Lagrange elements has a kink, and the curvature of one of order 2 jumps (not so NURBS of order 3 and more)"
        )
    return ""


def _first_few(numbers: np.ndarray) -> str:
    return ", ".join(str(int(i)) for i in numbers[:10]) + (", ..." if len(numbers) > 10 else "")
