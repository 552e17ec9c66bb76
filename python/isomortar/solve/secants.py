"""What iterations with kept factors tell of the tangent that these factors are not of."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model import constants


class Secants:
    """The last steps between iterates, and by how much each changed the correction by kept factors (theory 7.6)."""

    def __init__(self) -> None:
        self._last: tuple[FloatArray, FloatArray] | None = None  # an iterate, and its correction
        self._known: list[tuple[FloatArray, FloatArray]] = []  # changes, of length one, and what steps are more, the last one first
        self._products = np.zeros((0, 0))  # of the changes with each other
        self._chosen: list[int] = []  # changes that are no combination of later ones

    def leave(self) -> None:
        """The next iterate is not a step from the last one: other forces are balanced there."""
        self._last = None

    def reach(self, iterate: FloatArray, correction: FloatArray) -> None:
        """Come to an iterate with its correction by the factors; the step to it from the last one is taken in."""
        if self._last is not None:
            before, its_correction = self._last
            self.learn(iterate - before, its_correction - correction)
        self._last = iterate, correction

    def learn(self, step: FloatArray, change: FloatArray) -> None:
        """Take in a step, and the correction before it less the one after it, both of any one shape."""
        length = np.sqrt(_product(change, change))
        if length == 0.0:
            return
        self._known = [(change / length, (step - change) / length), *self._known[: constants.MAX_SECANTS - 1]]
        earlier = len(self._known) - 1
        first = np.array(self._along(self._known[0][0]))
        self._products = np.block([[first[:1, None], first[None, 1:]], [first[1:, None], self._products[:earlier, :earlier]]])
        self._choose()

    def _choose(self) -> None:
        """Leave out changes that are next to a combination of later ones."""
        across, self._chosen = self._products.copy(), []  # of what is across the changes that were chosen
        for k in range(len(across)):
            if across[k, k] > constants.NEW_DIRECTION**2:
                self._chosen.append(k)
                across -= np.outer(across[k], across[k]) / across[k, k]

    def improved(self, correction: FloatArray) -> FloatArray:
        """A correction by kept factors, with steps in place of the changes that it is made of (theory 7.6)."""
        along, chosen = np.array(self._along(correction)), self._chosen
        shares = np.linalg.solve(self._products[np.ix_(chosen, chosen)], along[chosen])
        return correction + sum(share * self._known[k][1] for k, share in zip(chosen, shares, strict=True))

    def _along(self, vector: FloatArray) -> list[float]:
        return [_product(change, vector) for change, _ in self._known]


def _product(a: FloatArray, b: FloatArray) -> float:
    """Inner product, not by a library whose threads would change its last bits."""
    return float(np.einsum("i,i->", a.ravel(), b.ravel()))
