"""Products of the squares of a matrix's entries with a vector, beside a dense one."""

from __future__ import annotations

import numpy as np
from linear_solves.places import SHAPE, source
from scipy import sparse

from isomortar import _bindings
from isomortar.harness import Bound, case


@case(
    claim="The squares of a matrix's entries times a vector are what they are for the dense matrix, whatever the matrix is measured in.",
    tier="gate",
    grid={"unit": (1e-200, 1.0, 1e200)},
    bounds={"error": Bound(at_most=2e-15, reason="round-off: sums of at most 21 terms, none of them negative, each of three roundings")},
)
def squares(unit: float) -> dict[str, float]:
    """Largest error of an entry of the product over random matrices, relative to the entry."""
    random, error = np.random.default_rng(29), 0.0
    for _ in range(20):
        pattern, _, _, values = source(random)
        vector = random.random((SHAPE[1], 3))
        matrix = sparse.bsr_array((values, pattern.column, pattern.start), shape=(3 * SHAPE[0], 3 * SHAPE[1])).toarray()
        exact = (0.5 * matrix) ** 2 @ vector.ravel()
        found = _bindings.squares_times(pattern, unit * values, 0.5 / unit, vector).ravel()
        apart = np.abs(found - exact)[exact > 0.0] / exact[exact > 0.0]
        error = float(np.max([error, *apart, *found[exact == 0.0]]))
    return {"error": error}
