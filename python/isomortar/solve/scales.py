"""What forces are measured against, body by body: a stiff or large body must not hide what goes on in another one.

Bodies that are glued are one here: next to no force acts on one that nothing else bears on.
"""

from __future__ import annotations

import numpy as np

from isomortar import _bindings
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.numbering import Numbering
from isomortar.model.solid import Solid
from isomortar.model.supports import Supports


@frozen
class Scales:
    """Stiffness and round-off of every piece at the start of a load increment.

    Parameters
    ----------
    stiffness : ndarray, shape (pieces,)
        Largest diagonal entry of each piece's tangent, force per length.
    round_off : ndarray, shape (pieces,)
        Norm of the forces at the free unknowns of each piece that no iteration can remove.
    """

    stiffness: FloatArray
    round_off: FloatArray


class PieceMeasures:
    """Norms over the control points of each body, with all that is glued to it."""

    def __init__(self, numbering: Numbering, supports: Supports, solid: Solid) -> None:
        self._numbering, self._solid = numbering, solid
        self._starts, self._components = numbering.starts, 3 * numbering.starts
        self._free = supports.balanced
        self._rigid = np.array([piece[0].rigid for piece in numbering.pieces])

    def norms(self, forces: FloatArray) -> FloatArray:
        """Norm of the forces, shape (control points, 3), on each piece, shape (pieces,)."""
        least, most = constants.SQUARED
        with np.errstate(over="ignore"):
            squares = self._squares(forces)
        if np.all((least < squares) & (squares < most)):
            return np.sqrt(squares)
        size = _power_of_two(forces)
        return np.sqrt(self._squares(forces / size)) * size

    def _squares(self, forces: FloatArray) -> FloatArray:
        """The sum of all components squared, of each piece."""
        return np.add.reduceat(np.square(forces).ravel(), self._components)

    def free_norms(self, forces: FloatArray) -> FloatArray:
        """The same over the free unknowns."""
        return self.norms(np.where(self._free, forces, 0.0))

    def sizes(self, internal: FloatArray, total: FloatArray, left: FloatArray) -> FloatArray:
        """What forces `left` out of balance are measured against: those inside, on a rigid piece all; shape (pieces,) (theory 5.6)."""
        inside = self.norms(internal)
        if not self._rigid.any():
            return inside
        return np.where(self._rigid, np.maximum(self.norms(total), self.free_norms(left)), inside)

    def scales(self, positions: FloatArray) -> Scales:
        """Scales at given positions (theory 5.5).

        Positions are known to their last bits. What these make of the forces, sum over j of K_ij^2 (last bit of x_j)^2 for the
        square of each, is the least residual that Newton's method can be asked for: while a body moves rigidly its internal forces are
        nothing else, and in a thin one it is far less than stiffness times size.
        """
        _, tangent = self._solid.forces_and_tangent(positions)
        diagonal = np.einsum("kii->ki", tangent[self._solid.diagonal])
        last_bits = np.spacing(np.maximum(np.abs(positions), np.abs(self._numbering.reference)))
        size, length = _power_of_two(diagonal), _power_of_two(last_bits)
        shares = _bindings.squares_times(self._solid.pattern, tangent, 1.0 / size, (last_bits / length) ** 2)
        round_off = constants.ROUND_OFF * self.free_norms(np.sqrt(shares) * (size * length))
        return Scales(np.maximum.reduceat(diagonal.max(axis=1), self._starts), round_off)


def _power_of_two(values: FloatArray) -> float:
    """The power of two next to the largest value: divided by it, squares neither vanish nor overflow, and no bit changes."""
    return float(np.ldexp(1.0, np.frexp(np.max(np.abs(values), initial=0.0))[1]))
