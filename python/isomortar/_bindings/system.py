"""The linear system: its sources, and where their entries go."""

from __future__ import annotations

import numpy as np

from isomortar import _arguments as check
from isomortar._arguments import FloatArray, IntArray, LongArray
from isomortar._arrays import Pattern
from isomortar._bindings import handles
from isomortar._bindings.statuses import raise_status
from isomortar._codes import Status
from isomortar._compiled import kernel as _kernel
from isomortar.errors import KernelError


def find_places(
    pattern: Pattern, row_of: IntArray, column_of: IntArray, transposed: bool, system_start: LongArray, system_column: LongArray
) -> LongArray:
    """Where each entry of a blocked source goes in a compressed system (from 1; 0: dropped), shape (blocks, 3, 3).

    Raises
    ------
    KernelError
        The system lacks an entry of the source.
    """
    check.kind("pattern", pattern, Pattern)
    rows, columns = 3 * (len(pattern.start) - 1), 3 * (pattern.highest + 1)
    unknowns = len(check.array("system_start", system_start, np.int64, None)) - 1
    check.array("system_column", system_column, np.int64, None)
    check.compressed("system_start", system_start, len(system_column))
    check.within("system_column", system_column, 0, unknowns - 1)
    check.within("row_of", check.array("row_of", row_of, np.int32, rows), -1, unknowns - 1)
    check.within("column_of", check.array("column_of", column_of, np.int32, None), -1, unknowns - 1)
    check.below("pattern.column", columns - 1, len(column_of), "unknown")
    places, status = _kernel.find_places(
        handles.pattern("pattern", pattern), len(pattern.column), row_of, column_of, check.flag("transposed", transposed), system_start,
        system_column,
    )  # fmt: skip
    if status == Status.PATTERN:
        raise KernelError("the pattern of the linear system lacks an entry of one of its sources")
    if status:
        raise_status(status, -1)
    return places.T


def add_values(places: LongArray, source: FloatArray, values: FloatArray) -> None:
    """values[places - 1] += source, where places > 0."""
    check.array("places", places, np.int64, None, 3, 3)
    check.array("source", source, np.float64, len(places), 3, 3)
    check.array("values", values, np.float64, None)
    check.within("places", places, 0, len(values))
    _kernel.add_values(places.reshape(-1), source.reshape(-1), values)


def squares_times(pattern: Pattern, values: FloatArray, scale: float, vector: FloatArray) -> FloatArray:
    """Product of the squares of a matrix's entries, scaled before, with a vector of its columns, shape (rows of blocks, 3)."""
    check.kind("pattern", pattern, Pattern)
    check.array("values", values, np.float64, len(pattern.column), 3, 3)
    check.array("vector", vector, np.float64, None, 3)
    check.below("pattern.column", pattern.highest, len(vector), "control point")
    rows = len(pattern.start) - 1
    scale = check.real("scale", scale, lambda value: value > 0.0, "a positive number")
    product, status = _kernel.squares_times(handles.pattern("pattern", pattern), values.T, scale, vector.T, rows)
    if status:
        raise_status(status, -1)
    return product.T
