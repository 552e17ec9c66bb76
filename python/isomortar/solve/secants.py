"""What whole augmentations tell of a tangent by whose factors they were not solved."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model import constants


class Secants:
    """Ways to balance, and the first corrections by kept factors where they began, of the last augmentations (theory 7.6)."""

    def __init__(self) -> None:
        self._known: list[tuple[FloatArray, FloatArray]] = []
        self._basis: list[tuple[FloatArray, FloatArray]] = []  # directions of corrections, orthonormal; what corrections along them lack

    def learn(self, way: FloatArray, correction: FloatArray) -> None:
        """Take in a way to balance, and the correction where it began, both of any one shape."""
        self._known = [(way, correction), *self._known[: constants.MAX_SECANTS - 1]]
        self._basis = []
        for its_way, begun in self._known:
            along, missing = begun, its_way - begun
            for unit, its_missing in self._basis:
                share = _product(unit, along)
                along, missing = along - share * unit, missing - share * its_missing
            length = np.sqrt(_product(along, along))
            if length > constants.NEW_DIRECTION * np.sqrt(_product(begun, begun)):
                self._basis.append((along / length, missing / length))

    def improved(self, correction: FloatArray) -> FloatArray:
        """A correction by kept factors, with ways in place of the corrections that it is made of (theory 7.6)."""
        return correction + sum(_product(unit, correction) * missing for unit, missing in self._basis)


def _product(a: FloatArray, b: FloatArray) -> float:
    """Inner product, not by a library whose threads would change its last bits."""
    return float(np.einsum("i,i->", a.ravel(), b.ravel()))
