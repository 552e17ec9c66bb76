"""The monolithic method: positions and multipliers in one semismooth Newton loop (theory 6)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property, partial

import numpy as np

from isomortar._bindings import NO_FRICTION, Law, Response
from isomortar._codes import PointState
from isomortar._frozen import frozen
from isomortar.errors import FoldedElementError, LostProjectionError
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.solve.bordered import Border, Correction, from_lengths, in_lengths, solve_bordered, solve_with_kept_factors
from isomortar.solve.contact import Kinematics, Multipliers
from isomortar.solve.distances import apart, largest, round_off
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.extrapolation import multipliers_ahead, positions_ahead
from isomortar.solve.method import FAILURES, Increment, Method, augmentation_record
from isomortar.solve.metric import contravariant
from isomortar.solve.newton import Converged, Iterate, Newton
from isomortar.solve.record import IterationRecord, State
from isomortar.solve.scales import Scales
from isomortar.solve.secants import Secants

#: Note of an iteration whose positions and multipliers went on from the last increment.
EXTRAPOLATION = "extrapolation"


class Monolithic(Method):
    """Solves load increments for positions, control pressures and control tractions at once."""

    def advance(self, start: State, time: float, step: int) -> Increment:
        """Solve the increment; see `Method.advance`."""
        observe = partial(self._observer.iteration, step, time, 1)
        newton, found = self._from_ahead(start, time, observe) or self._seeking_hold(start, partial(self._from_start, start, time, observe))
        last = found.iterate
        self._equilibrium.complete(last.balance)
        record = augmentation_record(1, newton.settled(last), (last.gap_pressure, last.gap_traction), found.log)
        return Increment(last.balance, (record,), (found.order,))

    def _from_start(self, start: State, time: float, observe: Callable[[IterationRecord], None], seeks_hold: bool) -> _Solved:
        """The solution from the start, with the prescribed increment in the first solve."""
        prescribed, scales = self._equilibrium.begin(start, time)
        newton = _BorderedNewton(self._equilibrium, start, scales, seeks_hold)
        return newton, newton.solve(newton.first(), prescribed, observe)

    def _from_ahead(self, start: State, time: float, observe: Callable[[IterationRecord], None]) -> _Solved | None:
        """The solution from where all goes on as in the last increment; None where that is not known, or leads nowhere (theory 6.7)."""
        if start.rates is None:
            return None
        positions = positions_ahead(start, start.rates, self._equilibrium.supports, time)
        try:
            _, scales = self._equilibrium.begin(start, time, positions)
            newton = _BorderedNewton(self._equilibrium, start, scales)
            return newton, newton.solve(newton.ahead(positions, time - start.rates.time), None, observe, (EXTRAPOLATION,))
        except FAILURES:
            return None


@frozen
class _BorderedIterate(Iterate):
    """Positions and multipliers with all that follows from them.

    `balance.responses` hold the current multipliers and the states; `targets` what the contact conditions make of them.
    """

    laws: tuple[Law, ...]
    targets: tuple[Response, ...]
    gap_pressure: float
    gap_traction: float

    @cached_property
    def merit(self) -> float:
        """What an update should make smaller (theory 6.6)."""
        return float(np.max([self.residual, self.gap_pressure, self.gap_traction]))  # not a number where one is not: `max` drops it

    @property
    def left(self) -> str:
        """What is left to solve, in words."""
        return f"{super().left} and {np.max([self.gap_pressure, self.gap_traction]):.2e} off the contact conditions"

    @property
    def left_by_setting(self) -> dict[str, float]:
        """What is left to solve, by the setting that says how much may be (theory 6.6)."""
        return super().left_by_setting | {"complementarity_tolerance": float(np.max([self.gap_pressure, self.gap_traction]))}

    @property
    def multipliers(self) -> list[Multipliers]:
        """Control pressures and tractions, by pair."""
        return [(law.pressure, law.traction) for law in self.laws]


class _BorderedNewton(Newton[_BorderedIterate, Correction]):
    """Newton's method for positions and multipliers."""

    def __init__(self, equilibrium: Equilibrium, start: State, scales: Scales, seeks_hold: bool = False) -> None:
        super().__init__(equilibrium, start, scales, seeks_hold)
        self._margin = constants.SLIP_MARGIN if "margin" in self._settings.measures else 0.0
        self._borders: list[Border | None] = []
        self._secants = Secants()

    def first(self) -> _BorderedIterate:
        """The converged state of the last increment as the first iterate (theory 6.5).

        What supports push along a plane slides; what they keep still there sticks, or its traction would grow with the pressure.
        """
        parts = zip(self._equilibrium.pairs, self._start.contacts, strict=True)
        return self._begun(
            self._start.positions, [(contact.pressure, pair.sliding(contact)) for pair, contact in parts], frictionless=False
        )

    def _begun(self, positions: FloatArray, multipliers: Sequence[Multipliers], frictionless: bool) -> _BorderedIterate:
        """An iterate in which that is closed which loads close first (theory 6.8)."""
        pairs = self._equilibrium.pairs
        closed = self._nearest(positions, [self._scales] * len(pairs))
        given = [(p if p_closed is None else p_closed, t) for (p, t), p_closed in zip(multipliers, closed, strict=True)]
        still = [pair.held.still for pair in pairs]
        return self._evaluate(positions, given, self._margin, still, self._loads_closed if frictionless else None)

    def _closed_anew(self, iterate: _BorderedIterate) -> _BorderedIterate:
        return self._begun(iterate.balance.positions, iterate.multipliers, frictionless=True)

    def ahead(self, positions: FloatArray, length: float) -> _BorderedIterate:
        """The first iterate at positions ahead of the start, with multipliers that went on by a length at their rates (theory 6.7)."""
        rates = self._start.rates
        assert rates is not None
        parts = zip(self._equilibrium.pairs, self._start.contacts, rates.contacts, strict=True)
        multipliers = [multipliers_ahead(pair, contact, rate, length) for pair, contact, rate in parts]
        return self._evaluate(positions, multipliers, self._margin, [pair.held.still for pair in self._equilibrium.pairs])

    def settled(self, iterate: _BorderedIterate) -> list[Law]:
        """The laws of a converged iterate, with the parameters of pairs that rest."""
        pairs = zip(self._equilibrium.pairs, iterate.balance.kinematics, iterate.laws, strict=True)
        return [
            replace(law, penalties=pair.parameters(k.control, self._scales)) if pair.rests(k, law.pressure, law.traction) else law
            for pair, k, law in pairs
        ]

    def _evaluate(
        self,
        positions: FloatArray,
        multipliers: Sequence[Multipliers],
        margin: float = 0.0,
        held: Sequence[np.ndarray] | None = None,
        frictionless: Sequence[bool] | None = None,
    ) -> _BorderedIterate:
        """An iterate; multipliers of constraints that turn out inactive are set to zero (theory 6.2).

        Pairs that are `frictionless` have no friction in it.
        """
        laws, targets = list[Law](), list[Response]()

        def respond(k: int, kinematics: Kinematics) -> Response:
            pair, (pressure, traction) = self._equilibrium.pairs[k], multipliers[k]
            rests = pair.rests(kinematics, pressure, traction)
            law = pair.law(np.zeros(2) if rests else pair.parameters(kinematics.control, self._scales), pressure, traction)
            law = replace(
                law, slip_margin=margin, forgiving="forgiving" in self._settings.measures, held=law.held if held is None else held[k]
            )
            if frictionless is not None and frictionless[k]:
                law = replace(law, friction=NO_FRICTION)
            target = pair.respond(kinematics, law)
            active = target.state > 0
            law = replace(law, pressure=np.where(active, pressure, 0.0), traction=np.where(active[:, None], traction, 0.0))
            laws.append(law)
            targets.append(target)
            return replace(target, pressure=law.pressure, traction=law.traction)

        balance = self._equilibrium.forces(positions, self._start, respond)
        return _BorderedIterate(balance, self._residual(balance), tuple(laws), tuple(targets), *self._gaps(balance, laws, targets))

    def _gaps(self, balance: Balance, laws: Sequence[Law], targets: Sequence[Response]) -> tuple[float, float]:
        """Relative distance of pressures and tractions from the contact conditions, of the pair where it is largest (theory 6.6)."""
        pairs = zip(self._equilibrium.pairs, balance.kinematics, balance.responses, laws, targets, strict=True)
        return largest(
            apart(pair, k.control, (now.pressure, now.traction), (to.pressure, to.traction), round_off(pair, balance.positions, law, to))
            for pair, k, now, law, to in pairs
            if not pair.rests(k, law.pressure, law.traction)
        )

    def _reopened(self, iterate: _BorderedIterate) -> _BorderedIterate:
        return self._evaluate(iterate.balance.positions, iterate.multipliers) if self._equilibrium.bear(iterate.balance) else iterate

    def _correct(
        self, iterate: _BorderedIterate, prescribed: FloatArray | None, keep_bodies: bool
    ) -> tuple[_BorderedIterate, Correction, tuple[str, ...]]:
        """The first solve has the prescribed increment; slips that would reverse stick instead, and it is repeated (theory 6.5)."""
        correction = self._solved(iterate, prescribed, keep_bodies)
        if prescribed is None or "reversal" not in self._settings.measures:
            return iterate, correction, ()
        held, notes = [law.held for law in iterate.laws], tuple[str, ...]()
        for _ in range(constants.MAX_REVERSALS):
            reversed_ = [self._reversals(k, iterate, correction) for k in range(len(held))]
            if not any(r.any() for r in reversed_):
                break
            held = [np.maximum(h, r.astype(np.int32)) for h, r in zip(held, reversed_, strict=True)]
            iterate = self._evaluate(iterate.balance.positions, iterate.multipliers, self._margin, held)
            correction = self._solved(iterate, prescribed, True)
            notes = (f"reversal of {sum(int(h.sum()) for h in held)}",)
        return iterate, correction, notes

    def _solved(self, iterate: _BorderedIterate, prescribed: FloatArray | None, keep_bodies: bool) -> Correction:
        solved = solve_bordered(self._equilibrium, iterate.balance, iterate.laws, iterate.targets, prescribed, keep_bodies)
        correction, self._borders = solved
        self._secants = Secants()
        return correction

    def _correct_again(self, iterate: _BorderedIterate) -> Correction:
        """Correction by the factors of the last tangent, by what the steps since then tell of others (theory 7.6)."""
        correction = solve_with_kept_factors(self._equilibrium, iterate.balance, iterate.targets, self._borders)
        here = in_lengths(iterate.balance.positions, [np.column_stack(m) for m in iterate.multipliers], self._borders)
        lengths = in_lengths(correction.positions, correction.multipliers, self._borders)
        self._secants.reach(here, lengths)
        return from_lengths(self._secants.improved(lengths), correction, self._borders)

    def _serve(self, iterate: _BorderedIterate, following: _BorderedIterate) -> bool:
        return following.states == iterate.states and super()._serve(iterate, following)

    def _moved(self, iterate: _BorderedIterate, correction: Correction, share: float) -> _BorderedIterate:
        changes = zip(iterate.multipliers, correction.multipliers, strict=True)
        multipliers = [(pressure + share * change[:, 0], traction + share * change[:, 1:]) for (pressure, traction), change in changes]
        return self._evaluate(self._equilibrium.moved(iterate.balance.positions, share * correction.positions), multipliers)

    def _reversals(self, k: int, iterate: _BorderedIterate, correction: Correction) -> np.ndarray:
        """Slipping constraints whose predicted trial change opposes their traction: t^a Dt_a < 0 (theory 6.5); elastic ones any."""
        target, border = iterate.targets[k], self._borders[k]
        if border is None or not self._equilibrium.pairs[k].friction.acts:
            return np.zeros(len(target.state), dtype=bool)
        elastic = self._equilibrium.pairs[k].elastic
        change = border.trial_change(correction.positions) + (0.0 if elastic else correction.multipliers[k][:, 1:])
        raised = contravariant(iterate.balance.kinematics[k].control, iterate.laws[k].traction)
        slipping = target.state > 0 if elastic else target.state == PointState.SLIP
        return slipping & (np.einsum("ia,ia->i", raised, change) < 0.0)

    def _update(self, iterate: _BorderedIterate, correction: Correction, iteration: int) -> tuple[_BorderedIterate, tuple[str, ...]]:
        """The next iterate: the full update, or one halved until it is admissible (theory 6)."""
        halvings = constants.MAX_HALVINGS if "halving" in self._settings.measures and iteration > 0 else 0
        reason = ""
        for halving in range(halvings + 1):
            try:
                following = self._moved(iterate, correction, 0.5**halving)
            except (FoldedElementError, LostProjectionError) as error:
                if halving == halvings:
                    raise
                reason = "folded element" if isinstance(error, FoldedElementError) else "lost projection"
            else:
                objection = self._objection(iterate, following, iteration, halving) if halving < halvings else ""
                if not objection:
                    break
                reason = objection
        return following, (f"halved {halving} times: {reason}",) if reason else ()

    def _objection(self, iterate: _BorderedIterate, following: _BorderedIterate, iteration: int, halving: int) -> str:
        """What is said against an update after the iterations that find the active set; empty: nothing."""
        if iteration < constants.ACTIVE_SET_ITERATIONS:
            return ""
        if following.states != iterate.states and following.states in self._trail.states and halving == 0:
            return "cycle"
        return "" if following.merit <= constants.MERIT_GROWTH * iterate.merit else "merit"


#: A Newton loop that has converged, with what it came to.
_Solved = tuple[_BorderedNewton, Converged[_BorderedIterate]]
