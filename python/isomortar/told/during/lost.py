"""Bodies whose forces are lost in round-off: they deform, and what they are out of balance by counts beside what they bear."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.glue import named
from isomortar.model.rigid import deformation
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.record import StepResult

#: Share of what a body bears that the sum of its unbalanced forces may be: what forces miss was up to twice as much on eighty thin beams.
LOST = 0.005
#: Places at which a body is looked at, each its size times so much from the one before: round-off is thrown anew there.
THROWS, APART = 4, (1.3e-3, 1.7e-3, 1.9e-3)
#: Share of a body's size above which displacements that no rigid motion explains are no round-off.
DEFORMED = 1e-10


class LostDigits:
    """Warnings of forces that are nothing but round-off; each is given once a body, or bodies that are glued."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._told = set[int]()

    def after_step(self, balance: Balance, result: StepResult) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to."""
        equilibrium = self._equilibrium
        measures, problem = equilibrium.measures, equilibrium.problem
        sizes = measures.sizes(balance.internal, balance.total, balance.unbalanced)
        by_round_off = measures.free_norms(balance.unbalanced) > problem.settings.newton_tolerance * sizes
        for number in [k for k, so in enumerate(by_round_off) if so and k not in self._told]:
            own, piece = equilibrium.numbering.piece_points(number), equilibrium.numbering.pieces[number]
            bodies = {body.name for body in piece}
            if not (self._loaded(bodies, result) or _deforms(equilibrium.numbering.reference[own], balance.positions[own])):
                continue
            size = float(np.ptp(equilibrium.numbering.reference[own], axis=0).max())
            left, borne = problem.images * self._left(balance, own, size), self._borne(bodies, size, result)
            if left > LOST * borne:
                self._told.add(number)
                yield (
                    f"{named(piece, piece[0].name)}, load step {result.step}: its forces are lost in round-off: {left:.2g} is out of "
                    f"balance where supports and contacts bear {borne:.2g}. It is too thin or too stiff for so small a load: take larger "
                    "motions or loads, or a thicker or softer body; or are the units not the same?"
                )

    def _loaded(self, bodies: set[str], result: StepResult) -> bool:
        """Whether forces are given on bodies that are one: these are to be borne, however little they deform."""
        problem = self._equilibrium.problem
        given = [found.force for load, found in zip(problem.loads, result.loads, strict=True) if load.body in bodies]
        given += [r.force for s, r in zip(problem.supports, result.reactions, strict=True) if s.pressed and s.place.body in bodies]
        return bool(np.any(given))

    def _left(self, balance: Balance, own: slice, size: float) -> float:
        """The largest sum of a body's unbalanced forces, where it is and moved as it stands: one alone may be small by chance."""
        free = ~self._equilibrium.supports.held[own]
        moved = (self._equilibrium.solid.forces(balance.positions + k * size * np.array(APART)) for k in range(1, THROWS))
        thrown = [balance.unbalanced, *(balance.unbalanced - balance.internal + forces for forces in moved)]
        return float(np.max([np.linalg.norm((forces[own] * free).sum(axis=0)) for forces in thrown]))

    def _borne(self, bodies: set[str], size: float, result: StepResult) -> float:
        """The largest force of a support, load or contact on bodies that are one, or moment of a support over their size."""
        problem = self._equilibrium.problem
        reactions = [r for s, r in zip(problem.supports, result.reactions, strict=True) if s.place.body in bodies]
        vectors = [v for r in reactions for v in (r.force, r.moment / size)]
        vectors += [found.force for load, found in zip(problem.loads, result.loads, strict=True) if load.body in bodies]
        for contact, found in zip(problem.contacts, result.contacts, strict=True):
            vectors += [found.force_slave] if bodies & contact.bodies else []
        return float(np.max([np.linalg.norm(vector) for vector in vectors], initial=0.0))


def _deforms(reference: FloatArray, positions: FloatArray) -> bool:
    """Whether displacements are more than a rigid motion."""
    return bool(np.abs(deformation(reference, positions)).max() > DEFORMED * np.ptp(reference, axis=0).max())
