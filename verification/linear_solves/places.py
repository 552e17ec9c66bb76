"""Where the entries of blocked sources go in a compressed system, and what they add up to there, against dense matrices."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from isomortar import _bindings
from isomortar._bindings import Pattern
from isomortar.errors import KernelError
from isomortar.harness import Bound, case

#: Block rows and columns of a source, and unknowns of the system; some of the rows and columns are dropped.
SHAPE, UNKNOWNS = (9, 7), 40


def source(random: np.random.Generator) -> tuple[Pattern, np.ndarray, np.ndarray, np.ndarray]:
    """A pattern, numbers of its rows and columns in the system (-1: dropped), and values."""
    filled = random.random(SHAPE) < 0.4
    filled[:, -1] |= ~filled.any(axis=1)
    start = np.append(0, np.cumsum(filled.sum(axis=1))).astype(np.int32)
    pattern = Pattern(start, np.nonzero(filled)[1].astype(np.int32))
    row_of, column_of = (np.where(random.random(3 * n) < 0.2, -1, random.permutation(UNKNOWNS)[: 3 * n]).astype(np.int32) for n in SHAPE)
    return pattern, row_of, column_of, random.standard_normal((len(pattern.column), 3, 3))


def dense(pattern: Pattern, row_of: np.ndarray, column_of: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The source in the system's numbering."""
    matrix = np.zeros((UNKNOWNS, UNKNOWNS))
    for block, (i, j) in enumerate(zip(np.repeat(np.arange(SHAPE[0]), np.diff(pattern.start)), pattern.column, strict=True)):
        for r, c in np.ndindex(3, 3):
            row, column = row_of[3 * i + r], column_of[3 * j + c]
            if row >= 0 and column >= 0:
                matrix[row, column] += values[block, r, c]
    return matrix


@case(
    claim="Entries of a source, or of its transpose, add up where they belong, and a system that lacks one of them is refused.",
    tier="gate",
    grid={"transposed": (False, True)},
    bounds={
        "error": Bound(at_most=0.0, reason="definition: every sum has one term, or none"),
        "unnoticed": Bound(0.0, 0.0, "definition: systems that lack an entry and are not refused"),
    },
)
def places(transposed: bool) -> dict[str, float]:
    """Largest error of the sums over random sources in random systems; entries that may be left out without a word."""
    random, error, unnoticed = np.random.default_rng(13), 0.0, 0
    for beside in 10 * [0.0, 0.2]:  # with no other entries there are rows of one
        pattern, row_of, column_of, values = source(random)
        exact = dense(pattern, row_of, column_of, values)
        exact = exact.T if transposed else exact
        system = sparse.csr_array((exact != 0.0) | (random.random(exact.shape) < beside))
        start, column = system.indptr.astype(np.int64), system.indices.astype(np.int64)
        sums = np.zeros(len(column))
        _bindings.add_values(_bindings.find_places(pattern, row_of, column_of, transposed, start, column), values, sums)
        error = float(np.maximum(error, np.abs(sparse.csr_array((sums, column, start), shape=exact.shape).toarray() - exact).max()))
        for row, gone in random.permutation(np.argwhere(exact))[:5]:
            kept = ~((np.repeat(np.arange(UNKNOWNS), np.diff(start)) == row) & (column == gone))
            shorter = start - (np.arange(len(start)) > row)
            try:
                _bindings.find_places(pattern, row_of, column_of, transposed, shorter, column[kept])
                unnoticed += 1
            except KernelError:
                pass
    return {"error": error, "unnoticed": float(unnoticed)}


@case(
    claim="A system that lacks any one entry of a source is refused, whatever the rows before it hold.",
    tier="gate",
    grid={"transposed": (False, True), "dropped": (0, 1, 2)},
    bounds={
        "unnoticed": Bound(0.0, 0.0, "definition: entries that may be left out without a word"),
        "whole": Bound(0.0, 0.0, "definition: whether the system that lacks none is refused"),
    },
)
def each_entry(transposed: bool, dropped: int) -> dict[str, float]:
    """How many, of those of a full system of two block rows and two block columns, of which so many unknowns are dropped."""
    pattern = Pattern(np.array([0, 2, 4], dtype=np.int32), np.array([0, 1, 0, 1], dtype=np.int32))
    number = np.concatenate([np.full(dropped, -1), np.arange(6 - dropped)]).astype(np.int32)
    count = 6 - dropped

    def refused(gone: int) -> bool:
        kept = np.arange(count**2) != gone
        start = np.append(0, np.cumsum(kept.reshape(count, count).sum(axis=1))).astype(np.int64)
        try:
            _bindings.find_places(pattern, number, number, transposed, start, np.tile(np.arange(count), count)[kept].astype(np.int64))
        except KernelError:
            return True
        return False

    return {"unnoticed": float(sum(not refused(gone) for gone in range(count**2))), "whole": float(refused(-1))}
