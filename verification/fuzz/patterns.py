"""Patterns that lack a block: whichever it is, what is added to it is refused and not lost."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
from fuzz.calls import MASTERS, sound
from numpy.typing import NDArray

from isomortar._bindings import Pattern
from isomortar.errors import KernelError
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case

#: Routines that add blocks to patterns, by name of the pattern and of what is added to it; None: what is returned first.
ADDED = {
    ("add_body", "pattern"): "tangent",
    ("contact_blocks", "row_pattern"): "rows",
    ("contact_blocks", "pattern"): "tangent",
    ("condense_multipliers", "pattern"): "tangent",
    ("multiplier_rows", "wide"): None,
}
#: Most blocks that are left out in turn, spread over the pattern: of those with something in them, and of the others.
MOST = 60


def without(pattern: Pattern, block: int) -> Pattern:
    """A pattern that lacks a block."""
    start = pattern.start - (pattern.start > block).astype(np.int32)
    return Pattern(start, np.ascontiguousarray(np.delete(pattern.column, block)))


def added(master: str, routine: str, name: str | None, given: dict[str, Any]) -> FloatArray:
    """What a call adds to a pattern, by block."""
    arguments = copy.deepcopy(given)
    if name is not None:
        arguments[name] = np.zeros_like(arguments[name])
    returned = sound(master)[routine][0](**arguments)
    blocks: FloatArray = returned[0] if name is None else arguments[name]
    return blocks


def _spread(numbers: NDArray[np.intp]) -> NDArray[np.intp]:
    """At most so many of some numbers, the first and the last among them."""
    return numbers[np.unique(np.linspace(0, len(numbers) - 1, MOST).astype(int))] if len(numbers) else numbers


@case(
    claim="A pattern that lacks a block, whichever, is refused where something belongs into it, and does no harm elsewhere.",
    grid={"master": list(MASTERS), "routine": [f"{routine}, {pattern}" for routine, pattern in ADDED]},
    bounds=lambda master, routine: {
        "lost": Bound(at_most=0.0, reason="definition: what belongs into a block that there is not must not be left out"),
        "changed": Bound(at_most=0.0, reason="round-off: the others are the same sums"),
        "misnamed": Bound(at_most=0.0, reason="definition: refusals that name another row than that of the block"),
        "refused": Bound(
            at_least=float((master, routine) != ("plane", "contact_blocks, pattern")),
            reason="definition: calls of a run in contact fill blocks; a plane has no geometric tangent",
        ),
    },
)
def missing_blocks(master: str, routine: str) -> dict[str, float]:
    """Blocks with something in them that were left out without a word; largest change of others; wants refused, and misnamed."""
    routine, _, pattern = routine.partition(", ")
    name = ADDED[routine, pattern]
    arguments = sound(master)[routine][1]
    whole = added(master, routine, name, arguments)
    lost, refused, misnamed, changed = 0, 0, 0, 0.0
    full = np.any(whole != 0.0, axis=(1, 2))
    for block in np.concatenate([_spread(np.flatnonzero(full)), _spread(np.flatnonzero(~full))]):
        given = arguments | {pattern: without(arguments[pattern], block)}
        if name is not None:
            given[name] = np.delete(whole, block, axis=0)
        try:
            left = added(master, routine, name, given)
        except KernelError as error:
            refused += 1
            row = int(np.searchsorted(arguments[pattern].start, block, side="right")) - 1
            misnamed += f"row {row} " not in str(error) and "row -1 " not in str(error)  # -1: rows of another length
            continue
        lost += int(full[block])
        changed = float(np.maximum(changed, np.abs(left - np.delete(whole, block, axis=0)).max(initial=0.0)))
    return {"lost": lost, "changed": changed, "refused": refused, "misnamed": misnamed}


def elsewhere(pattern: Pattern, block: int) -> Pattern | None:
    """A pattern that has another block of the row in the place of one; none where the row is full."""
    row = int(np.searchsorted(pattern.start, block, side="right")) - 1
    own = slice(pattern.start[row], pattern.start[row + 1])
    free = np.setdiff1d(np.arange(pattern.highest + 1, dtype=np.int32), pattern.column[own])
    if not len(free):
        return None
    column = pattern.column.copy()
    column[block] = free[0]
    column[own] = np.sort(column[own])
    return Pattern(pattern.start, column)


@case(
    claim="A pattern that has another block in the place of one that is filled is refused: rows of the same length are not taken for it.",
    grid={"master": list(MASTERS), "routine": [f"{routine}, {pattern}" for routine, pattern in ADDED]},
    bounds={"lost": Bound(at_most=0.0, reason="definition: what belongs into a block that there is not must not go into another one")},
)
def other_blocks(master: str, routine: str) -> dict[str, float]:
    """Blocks with something in them whose want was not refused."""
    routine, _, pattern = routine.partition(", ")
    name = ADDED[routine, pattern]
    arguments = sound(master)[routine][1]
    full = np.any(added(master, routine, name, arguments) != 0.0, axis=(1, 2))
    lost = 0
    for block in _spread(np.flatnonzero(full)):
        other = elsewhere(arguments[pattern], int(block))
        try:
            added(master, routine, name, arguments | {pattern: other or arguments[pattern]})
        except KernelError:
            continue
        lost += other is not None
    return {"lost": lost}
