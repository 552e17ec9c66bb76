"""What memory a problem will take, before any of it is taken: at Gauss points, for the tangent, for its factors by nested dissection."""

from __future__ import annotations

import re
import resource
from contextlib import suppress
from functools import cache, lru_cache
from pathlib import Path

import numpy as np

from isomortar.geometry.patch import Direction, Patch
from isomortar.model.entities import Problem

#: Bytes of each 3x3 block of the tangent: its values, the compressed matrix, the places that gather it, and what sorts them meanwhile
#: (measured: 850 to 1000 at orders 4 and 5).
BLOCK_BYTES = 900.0
#: Bytes of each entry of the factors, fronts included (measured: 11 to 24).
FACTOR_BYTES = 16.0
#: Bytes of what the kernel keeps of the reference configuration at each Gauss point: 23 numbers, 19 where all weights are the same.
POINT_BYTES = 184.0
#: Files that tell what the machine could give at once, and all of what a control group may have; how they do, and in how many bytes.
_LIMITS = (("/proc/meminfo", "MemAvailable: +([0-9]+)", 1024.0), ("/sys/fs/cgroup/memory.max", "^([0-9]+)", 1.0))


def memory_needed(problem: Problem) -> float:
    """Bytes that tangents and factors of deformable bodies will take, within a factor of two; contact comes on top (theory 9.3)."""
    return sum(
        BLOCK_BYTES * blocks(body.patch) + FACTOR_BYTES * factor_entries(body.patch) + POINT_BYTES * body.points
        for body in problem.deformable
    )


def memory_of_machine() -> float:
    """Bytes that a process may take: of what the machine has free, its group's limit, and its own; infinite where none is told."""
    own, _ = resource.getrlimit(resource.RLIMIT_AS)
    limits = [float(own) if own != resource.RLIM_INFINITY else np.inf]
    for path, told, unit in _LIMITS:
        with suppress(OSError):
            limits += [unit * float(number) for number in re.findall(told, Path(path).read_text(encoding="utf-8"))]
    return min(limits)


def blocks(patch: Patch) -> int:
    """Pairs of control points that share an element."""
    return int(np.prod([float(_neighbours(direction).sum()) for direction in patch.directions]))


def _neighbours(direction: Direction) -> np.ndarray:
    """For each control point along a direction, how many share an element with it."""
    starts = direction.first_points
    points = np.arange(direction.count)
    first = np.searchsorted(starts + direction.order, points)
    last = np.searchsorted(starts, points, side="right") - 1
    return starts[last] + direction.order - starts[first] + 1


def factor_entries(patch: Patch) -> float:
    """Entries of both factors, were the unknowns eliminated by nested dissection of the grid of control points (theory 9.3)."""
    return _factor_entries(patch.shape, tuple(1 if d.family == "L" else d.order for d in patch.directions))


@lru_cache(maxsize=64)
def _factor_entries(shape: tuple[int, ...], widths: tuple[int, ...]) -> float:
    """The same, by numbers of control points and by how many of them keep the two sides of a separator apart."""

    @cache
    def entries(size: tuple[int, ...], cut: tuple[int, ...]) -> float:
        """Of a box of the grid with so many of its two sides in each direction cut off by separators."""
        sides = sum(cut[k] * widths[k] * np.prod(size) / size[k] for k in range(3))
        axis = int(np.argmax([n / w for n, w in zip(size, widths, strict=True)]))
        left = size[axis] - widths[axis]
        if left < 2 * max(widths[axis], 1):
            return _front(float(np.prod(size)), sides)
        halves = 0.0
        ends = tuple((c + 1) / 2 if k == axis else c for k, c in enumerate(cut))
        for half in (left // 2, left - left // 2):
            halves += entries(tuple(half if k == axis else n for k, n in enumerate(size)), ends)
        separator = np.prod(size) / size[axis] * widths[axis]
        return halves + _front(separator, sides)

    return entries(shape, (0, 0, 0))


def _front(points: float, border: float) -> float:
    """Entries of the factors in a dense front of so many points, with those that it borders on."""
    own, other = 3.0 * points, 3.0 * border
    return own * own + 2.0 * own * other
