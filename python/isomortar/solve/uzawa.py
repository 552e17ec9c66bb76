"""Uzawa's method: Newton's method for the positions inside a loop of augmentations (formulation.md Section 5)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar._bindings import Law
from isomortar.errors import ConvergenceError
from isomortar.solve.equilibrium import Balance
from isomortar.solve.method import Increment, Method
from isomortar.solve.newton import PositionSolver, observed_order, residual_round_off
from isomortar.solve.record import AugmentationRecord, IterationRecord, State


class Uzawa(Method):
    """Solves load increments by augmentations of control pressures and tractions."""

    def advance(self, start: State, time: float, step: int) -> Increment:
        """Solve the increment; see `Method.advance`."""
        equilibrium = self._equilibrium
        prescribed, stiffness = self._begin(start, time)
        base = np.array([self._settings.penalty_normal, self._settings.penalty_tangential]) * stiffness
        laws = [
            pair.law(base / pair.penalty_area, s.pressure, s.traction) for pair, s in zip(equilibrium.pairs, start.contacts, strict=True)
        ]

        newton = PositionSolver(equilibrium, start, stiffness)
        positions, records, orders, growth = start.positions, [], [], 1.0
        for augmentation in range(1, self._settings.max_augmentations + 1):
            log: list[IterationRecord] = []

            def report(record: IterationRecord, log: list[IterationRecord] = log, number: int = augmentation) -> None:
                log.append(record)
                self._observer.iteration(step, time, number, record)

            balance = newton.solve(positions, prescribed, laws, report)
            orders.append(observed_order(log, residual_round_off(equilibrium, balance, stiffness)))
            changes = self._changes(laws, balance)
            normal, tangential = (float(penalty) for penalty in growth * base)
            record = AugmentationRecord(augmentation, normal, tangential, changes[0], changes[1], tuple(log))
            records.append(record)
            self._observer.augmented(step, time, record)
            if max(changes) <= self._settings.augmentation_tolerance and not self._bear(balance):
                return Increment(balance, tuple(records), tuple(orders))
            growth = min(growth * self._settings.penalty_growth, max(self._settings.penalty_growth_max, 1.0))
            laws = [
                replace(law, penalties=growth * base / pair.penalty_area, pressure=r.pressure, traction=r.traction)
                for law, pair, r in zip(laws, equilibrium.pairs, balance.responses, strict=True)
            ]
            positions, prescribed = balance.positions, np.zeros_like(prescribed)
        raise ConvergenceError(
            f"{self._settings.max_augmentations} augmentations left a relative change of the multipliers of {max(changes):.2e} "
            f"(solver.augmentation_tolerance is {self._settings.augmentation_tolerance:g})"
        )

    def _changes(self, laws: list[Law], balance: Balance) -> tuple[float, float]:
        """Relative change of pressures and of tractions by the last augmentation (the paper's mixed norm: twice the same)."""
        pressure, traction, mixed = np.zeros(2), np.zeros(2), np.zeros(2)
        floor = 0.0
        for pair, law, kinematics, response in zip(self._equilibrium.pairs, laws, balance.kinematics, balance.responses, strict=True):
            new_p, new_t = response.pressure - law.pressure, response.traction - law.traction
            pressure += [np.sum(new_p**2), np.sum(law.pressure**2)]
            norms = pair.traction_norms(kinematics.control, new_t), pair.traction_norms(kinematics.control, law.traction)
            traction += [np.sum(norms[0] ** 2), np.sum(norms[1] ** 2)]
            mixed += [np.sum(new_p**2) + np.sum(new_t**2), np.sum(law.pressure**2) + np.sum(law.traction**2)]
            floor += (0.01 * pair.friction) ** 2 * float(np.sum(law.pressure**2))
        if self._settings.augmentation_norm == "paper":
            return _ratio(*mixed), _ratio(*mixed)
        return _ratio(*pressure), _ratio(traction[0], max(traction[1], floor))


def _ratio(change: float, size: float) -> float:
    """Square root of a ratio of squares; 0 where nothing changes, infinite where there was nothing before."""
    if change <= 0.0:
        return 0.0
    return float(np.sqrt(change / size)) if size > 0.0 else float("inf")
