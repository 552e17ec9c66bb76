"""Checks of what is handed to the kernel, which itself believes what it is told: each raises an error that names the argument."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from isomortar.errors import InputError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int32]
LongArray = NDArray[np.int64]

#: Largest orders by family of a direction: 1 NURBS, 2 Lagrange.
MAX_ORDERS = {1: 10, 2: 4}
#: Largest number of a control point: the unknowns, three of each, are counted in 32 bits.
MAX_POINT = np.iinfo(np.int32).max // 3 - 1
#: Largest number of Gauss points per direction: more is taken for a mistake.
MAX_GAUSS = 64
_LARGEST = float(np.finfo(np.float64).max)


def kind(name: str, value: Any, *allowed: type, way: str = "") -> None:
    """Refuse what is not of an allowed type; `way` says how one is had."""
    if not isinstance(value, allowed):
        raise InputError(f"is {value!r:.60}; allowed: {' or '.join(one.__name__ for one in allowed)}{way}", name)


def place(name: str, value: Any) -> Path:
    """A path, if it is one."""
    kind(name, value, str, os.PathLike)
    return Path(value)


def array(name: str, value: Any, dtype: type, *shape: int | None) -> NDArray[Any]:
    """The array, if it has the type, the shape (None: any length) and the memory order that the kernel reads without a copy."""
    known = isinstance(value, np.ndarray)
    if known and value.dtype == dtype and value.flags.c_contiguous and (value.shape == shape or _fits(value.shape, shape)):
        return value
    found = f"{value.dtype}{value.shape}" if known else type(value).__name__
    wanted = ", ".join("any" if n is None else str(n) for n in shape)
    raise InputError(f"is {found}; the kernel needs contiguous {np.dtype(dtype).name}({wanted})", name)


def _fits(shape: tuple[int, ...], wanted: tuple[int | None, ...]) -> bool:
    return len(shape) == len(wanted) and all(n is None or n == m for n, m in zip(wanted, shape, strict=True))


def finite(name: str, value: FloatArray) -> FloatArray:
    """The array, if all of it is finite."""
    if not np.isfinite(value).all():
        raise InputError("holds a value that is not finite", name)
    return value


def within(name: str, value: NDArray[Any], low: int, high: int) -> None:
    """Refuse an array of integers with one outside of `low` to `high`."""
    if value.size and not low <= value.min() <= value.max() <= high:
        raise InputError(f"holds {value.min()} to {value.max()}; allowed: {low} to {high}", name)


def whole(name: str, value: Any, low: int, high: int) -> int:
    """The whole number, if it is one from `low` to `high`."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | np.integer) or not low <= value <= high:
        raise InputError(f"is {value!r:.60}; allowed: a whole number from {low} to {high}", name)
    return int(value)


def real(name: str, value: Any, allowed: Callable[[float], bool], sentence: str) -> float:
    """The number, if it is finite and allowed; `sentence` says what is."""
    known = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    if not known or not abs(value) <= _LARGEST or not allowed(float(value)):
        raise InputError(f"is {value!r:.60}; allowed: {sentence}", name)
    return float(value)


def flag(name: str, value: Any) -> int:
    """1 or 0 for a truth value."""
    if not isinstance(value, bool | np.bool_):
        raise InputError(f"is {value!r:.60}; allowed: True, False", name)
    return int(value)


def gauss(name: str, value: Any, directions: int) -> IntArray:
    """Numbers of Gauss points by direction, as the kernel reads them."""
    if not isinstance(value, tuple | list | np.ndarray) or len(value) != directions:
        raise InputError(f"is {value!r:.60}; allowed: {directions} numbers of points", name)
    return np.array([whole(name, points, 1, MAX_GAUSS) for points in value], dtype=np.int32)


def patch(families: Any, orders: Any, counts: Any, knots: Any, point: Any, weight: Any) -> None:
    """Refuse the flat arrays of a patch (`PatchArrays`) that do not fit together."""
    for name, numbers in (("families", families), ("orders", orders), ("counts", counts)):
        array(name, numbers, np.int32, 3)
    array("knots", knots, np.float64, None)
    first = 0
    for family, order, count in zip(families.tolist(), orders.tolist(), counts.tolist(), strict=True):
        whole("families", family, 1, 2)
        whole("orders", order, 1, MAX_ORDERS[family])
        if count <= order or (family == 2 and (count - 1) % order):
            raise InputError(f"has {count} control points for order {order} along a direction", "counts")
        last = first + (count + order + 1 if family == 1 else (count - 1) // order + 1)
        _knots(knots[first:last], last - first, order if family == 1 else 0)
        first = last
    array("knots", knots, np.float64, first)
    points = int(np.prod(counts, dtype=np.int64))
    array("point", point, np.int32, points)
    within("point", point, 0, MAX_POINT)
    array("weight", weight, np.float64, points)
    if not (finite("weight", weight) > 0).all():
        raise InputError("holds a weight that is not positive", "weight")


def face(axis: Any, side: Any) -> None:
    """Refuse what names no face of a patch: the axis across it, 1 to 3, and its end there, 0 or 1."""
    whole("axis", axis, 1, 3)
    whole("side", side, 0, 1)


def _knots(knots: FloatArray, count: int, order: int) -> None:
    """Refuse a direction's knots where they do not rise, or not from an end repeated order + 1 times to the other; 0: boundaries."""
    rise = np.diff(finite("knots", knots))
    if len(knots) != count or (rise < 0).any() or not knots[-1] > knots[0]:
        raise InputError("must rise, as many for each direction as its layout asks for", "knots")
    ends = (rise[:order] == 0).all() and (rise[count - 1 - order :] == 0).all()
    if not ends or (order == 0 and not (rise > 0).all()):
        raise InputError("must rise strictly (Lagrange), or begin and end with order + 1 equal values (NURBS)", "knots")


def rows(start: Any, column: Any) -> None:
    """Refuse compressed rows of blocks that do not rise from 0 to the number of blocks, or with columns that are no control points."""
    array("start", start, np.int32, None)
    array("column", column, np.int32, None)
    compressed("start", start, len(column))
    within("column", column, 0, MAX_POINT)


def compressed(name: str, start: NDArray[Any], entries: int) -> None:
    """Refuse where the rows of something compressed begin, if that does not rise from 0 to the number of entries."""
    if not len(start) or start[0] != 0 or start[-1] != entries or (np.diff(start) < 0).any():
        raise InputError(f"must rise from 0 to the number of entries, {entries}", name)


def highest(*arrays: NDArray[Any]) -> int:
    """The largest of some arrays of integers; -1 of none."""
    return max((int(entries.max()) for entries in arrays if entries.size), default=-1)


def below(name: str, number: int, count: int, what: str) -> None:
    """Refuse an argument that names more than there is: control points, columns."""
    if number >= count:
        raise InputError(f"names {what} {number}; there are {count}", name)
