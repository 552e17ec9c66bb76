"""Uzawa's method: Newton's method for the positions inside a loop of augmentations (theory 7)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar._bindings import Law
from isomortar.errors import ConvergenceError
from isomortar.solve.contact import Kinematics, PairMechanics, largest, median, ratio
from isomortar.solve.equilibrium import Balance
from isomortar.solve.method import Increment, Method
from isomortar.solve.newton import PositionSolver, observed_order, residual_round_off
from isomortar.solve.record import AugmentationRecord, IterationRecord, State
from isomortar.solve.scales import Scales

#: How far from the contact conditions augmentations may end, in their tolerance, by the norm of their changes: the paper's mixes
#: units and hides the tangential part, which at 0.01 is some per cent off. Its answer stays the paper's, but for what is grossly wrong.
DISTANCE_ALLOWED = {"separate": 1.0, "paper": 10.0}
#: How much more of the multipliers than forces of just `newton_tolerance` change from one augmentation to the next (0.5 to 2.5 were seen).
LEFT_OPEN = 4.0


class Uzawa(Method):
    """Solves load increments by augmentations of control pressures and tractions."""

    def advance(self, start: State, time: float, step: int) -> Increment:
        """Solve the increment; see `Method.advance` (theory 7.1, 7.2)."""
        equilibrium = self._equilibrium
        prescribed, scales = equilibrium.begin(start, time)
        factors = np.array([self._settings.penalty_normal, self._settings.penalty_tangential])
        base = [factors * pair.stiffness(scales) / pair.penalty_area for pair in equilibrium.pairs]
        laws = [pair.law(b, s.pressure, s.traction) for pair, b, s in zip(equilibrium.pairs, base, start.contacts, strict=True)]

        newton = PositionSolver(equilibrium, start, scales)
        positions, records, orders, growth = start.positions, [], [], 1.0
        for augmentation in range(1, self._settings.max_augmentations + 1):
            log: list[IterationRecord] = []

            def report(record: IterationRecord, log: list[IterationRecord] = log, number: int = augmentation) -> None:
                log.append(record)
                self._observer.iteration(step, time, number, record)

            balance = newton.solve(positions, prescribed, laws, report)
            orders.append(observed_order(log, residual_round_off(equilibrium, balance, scales)))
            changes, distances = self._changes(laws, balance), self._distances(laws, balance, scales)
            penalties = laws[0].penalties if laws else np.zeros(2)
            record = AugmentationRecord(augmentation, float(penalties[0]), float(penalties[1]), changes[0], changes[1], tuple(log))
            records.append(record)
            self._observer.augmented(step, time, record)
            off = np.array(distances) / DISTANCE_ALLOWED[self._settings.augmentation_norm]
            if np.max([*changes, *off]) <= self._settings.augmentation_tolerance and not self._bear(balance):
                return Increment(balance, tuple(records), tuple(orders))
            growth = min(growth * self._settings.penalty_growth, max(self._settings.penalty_growth_max, 1.0))
            laws = [
                replace(law, penalties=growth * b, pressure=r.pressure, traction=r.traction)
                for law, b, r in zip(laws, base, balance.responses, strict=True)
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
            if self._settings.augmentation_norm == "paper":
                new_p, new_t = response.pressure - law.pressure, response.traction - law.traction
                mixed = ratio(float(np.sum(new_p**2) + np.sum(new_t**2)), float(np.sum(law.pressure**2) + np.sum(law.traction**2)))
                changes.append((mixed, mixed))
            else:
                changes.append(
                    pair.apart(
                        kinematics.control,
                        (response.pressure, response.traction),
                        (law.pressure, law.traction),
                        pair.round_off(balance.positions, law, response, self._unbalanced(pair, kinematics, balance)),
                    )
                )
        return largest(changes)

    def _distances(self, laws: list[Law], balance: Balance, scales: Scales) -> tuple[float, float]:
        """Relative distance of pressures and tractions from the contact conditions, of the pair where it is largest (theory 7.4)."""
        pairs = zip(self._equilibrium.pairs, laws, balance.kinematics, balance.responses, strict=True)
        return largest(
            pair.off_conditions(balance.positions, kinematics, law, response, scales, self._unbalanced(pair, kinematics, balance))
            for pair, law, kinematics, response in pairs
        )

    def _unbalanced(self, pair: PairMechanics, kinematics: Kinematics, balance: Balance) -> float:
        """What forces that balance to `newton_tolerance` leave open of a pair's multipliers: norm over median weight (theory 7.5).

        Friction of a thousandth and less makes tractions that are no more than that; augmentations would go on for ever.
        """
        present = kinematics.control.weight[kinematics.control.weight > 0]
        if not present.size:
            return 0.0
        forces = float(self._equilibrium.measures.norms(balance.internal)[pair.pair.bodies].max())
        return LEFT_OPEN * self._settings.newton_tolerance * forces / median(present)
