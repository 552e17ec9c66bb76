"""What every program does for the benchmark `bulk`, and how it says what it found. Needs nothing but NumPy: other interpreters read it."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from statistics import median
from time import process_time
from typing import Any

import numpy as np

#: Work of fewer CPU seconds is done three times.
SHORT, REPEATS = 10.0, 3


def multilinear(coefficients: Any, points: Any) -> Any:
    """Vectors at points, both of shape (n, 3): the sum of coefficients, shape (3, 7), times x, y, z, xy, yz, zx, xyz.

    Such a field is in the space of every program, whatever its order and basis; at the nodes, or Greville points, these are its unknowns.
    """
    x, y, z = np.asarray(points).T
    return np.stack([x, y, z, x * y, y * z, z * x, x * y * z], axis=1) @ np.asarray(coefficients).T


def seconds(work: Callable[[], Any]) -> float:
    """Median CPU seconds of the work."""
    spent: list[float] = []
    while not spent or (spent[0] < SHORT and len(spent) < REPEATS):
        start = process_time()
        work()
        spent.append(process_time() - start)
    return median(spent)


def answer(assembly: float, solve: float, direction: Any, vectors: dict[str, Any], points: Any = None) -> dict[str, Any]:
    """What a program found, for others to compare: numbers that hold in every basis, and with `points` vectors at nodes.

    Parameters
    ----------
    assembly, solve : float
        CPU seconds.
    direction : array_like, shape (n, 3)
        Unknowns of the direction field.
    vectors : dict
        Forces, the tangent's product with the direction, Newton's correction (zero at the support), shape (n, 3) each.
    points : array_like, shape (n, 3), optional
        Where the unknowns are values.
    """
    forces, action, correction = vectors["forces"], vectors["action"], vectors["correction"]
    numbers = {
        "work": np.vdot(forces, direction),
        "second variation": np.vdot(action, direction),
        "decrement": np.vdot(forces, correction),
    }
    found = {"assembly": assembly, "solve": solve, "numbers": {name: float(value) for name, value in numbers.items()}}
    if points is None:
        return found
    nodes = np.lexsort(np.round(np.asarray(points), 9).T)
    return {**found, "nodes": {name: np.asarray(vector)[nodes].tolist() for name, vector in vectors.items()}}


def main(program: Callable[[dict[str, Any]], dict[str, Any]]) -> None:
    """Read the problem from the standard input, and print the answer as its last line."""
    print(json.dumps(program(json.load(sys.stdin))))
