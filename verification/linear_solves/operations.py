"""What factors take, told before there are any: by this the cheapest way is chosen, and memory expected (theory 5.13)."""

from __future__ import annotations

import numpy as np
from linear_solves.by_parts import factors, pattern_of
from numpy.typing import NDArray
from scipy import sparse

from isomortar._arguments import LongArray
from isomortar.harness import Bound, case


def plate() -> sparse.csr_array:
    """A grid of springs of two unknowns a node."""
    across, along = (sparse.diags_array([2.0, -1.0, -1.0], offsets=[0, 1, -1], shape=(n, n)) for n in (9, 11))
    matrix = sparse.csr_array(sparse.kron(sparse.kronsum(across, along), np.ones((2, 2)) + np.eye(2)))
    matrix.sort_indices()
    return matrix


def eliminated(matrix: sparse.csr_array, order: LongArray) -> tuple[int, int]:
    """Entries of a Cholesky factor, and its operations, by eliminating the unknowns one after the other."""
    there = matrix.toarray()[np.ix_(order, order)] != 0
    entries = operations = 0
    for k in range(len(order)):
        below = k + 1 + np.flatnonzero(there[k + 1 :, k])
        there[np.ix_(below, below)] = True
        entries, operations = entries + len(below) + 1, operations + (len(below) + 1) ** 2
    return entries, operations


def last(on_face: NDArray[np.bool_], order: LongArray) -> LongArray:
    """The order with unknowns of faces last."""
    return np.concatenate([order[~on_face[order]], np.flatnonzero(on_face)])


@case(
    claim="Entries and operations of a body's factors are told before there are any, with faces last or none.",
    tier="gate",
    grid={"ordering": ("metis", "amd"), "faces": (0, 1, 7, 40)},
    bounds={
        name: Bound(0.0, 0.0, "definition: the same counts, by eliminating one unknown after the other")
        for name in ("entries", "operations", "operations by the order alone")
    },
)
def operations_of_bodies(ordering: str, faces: int) -> dict[str, float]:
    """By how much they are off."""
    matrix = plate()
    on_face = np.random.default_rng(3).permutation(np.arange(matrix.shape[0]) < faces)
    order, alone = pattern_of(matrix).fill_reducing(ordering)  # type: ignore[arg-type]
    found = factors(matrix, on_face, ordering)
    entries, operations = eliminated(matrix, last(on_face, order))
    return {
        "entries": float(found.factor_entries - entries),
        "operations": found.flops - operations,
        "operations by the order alone": alone - eliminated(matrix, order)[1],
    }
