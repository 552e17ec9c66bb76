"""Bodies that turn or deform by more than their law is for: small strains leave out the squares of displacement gradients."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body
from isomortar.model.pattern import element_points
from isomortar.solve.equilibrium import Balance, Equilibrium

#: Strain above which what the law leaves out is told: that of a turn by 5.7 degrees, or of a stretch by a tenth.
LEFT_OUT = 0.005


class SmallStrains:
    """Warnings of what the law of small strains leaves out; each is given once a body."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._told = set[str]()

    def after_step(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to."""
        for body in self._equilibrium.problem.deformable:
            if body.material.law != "linear-elastic" or body.name in self._told:
                continue
            strain = left_out(body, self._equilibrium.numbering.of_patch(body.name, balance.positions))
            if strain > LEFT_OUT:
                self._told.add(body.name)
                yield (
                    f"body {body.name!r}, load step {step}: its law, linear-elastic, is for small turns and strains: it leaves out the "
                    f'squares of displacement gradients, a strain of {strain:.2g} here. Take law = "neo-hookean" or '
                    '"neo-hookean-j", or smaller motions'
                )


def left_out(body: Body, positions: FloatArray) -> float:
    """The largest principal value of (F - 1)^T (F - 1) / 2, Green's strain without that of small strains, by element.

    F of an element is that of the affine motion nearest to its control points. 1 - cos(angle) of a turn.

    Parameters
    ----------
    body : Body
    positions : ndarray, shape (control points of the patch, 3)
    """
    elements = element_points(body.patch, np.arange(len(positions), dtype=np.int32))
    before, moved = body.patch.control_points[elements], (positions - body.patch.control_points)[elements]
    before, moved = (points - points.mean(axis=1, keepdims=True) for points in (before, moved))
    gradients = np.linalg.pinv(before) @ moved
    return float(0.5 * np.square(np.linalg.norm(gradients, ord=2, axis=(1, 2))).max())
