"""Rounding: other modes of the processor and sums in another order leave the digits that a result is claimed to have."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from extreme_scenes import changed, loaded
from extremes.endings import digits
from transforms import relabelled

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.scene.toml_text import dump

#: Modes of x86's <fenv.h>.
MODES = {"nearest": 0x000, "downward": 0x400, "upward": 0x800, "toward zero": 0xC00}
_TIGHT = {"solver.newton_tolerance": 1e-12, "solver.complementarity_tolerance": 1e-11}
_BOUNDS = {
    "forces": Bound(at_least=9.0, reason="round-off: sixteen digits, less those that the condition of the system costs, 1e6 here"),
    "moments": Bound(at_least=9.0, reason="round-off: sixteen digits, less those that the condition of the system costs, 1e6 here"),
}


def problem(scene: str) -> Problem:
    """A scene with contact, stick and slip, to round-off."""
    return Scene.from_toml(dump(changed(loaded(scene), _TIGHT))).problem()


@contextmanager
def rounding(mode: str) -> Iterator[None]:
    """Round so in this thread, and as before afterwards."""
    library = ctypes.CDLL(None)
    before = library.fegetround()
    if library.fesetround(MODES[mode]) != 0:
        raise OSError(f"this processor does not round {mode}")
    try:
        yield
    finally:
        library.fesetround(before)


def results(scene: Problem) -> tuple[FloatArray, FloatArray]:
    """Forces and moments of the supports by step and support, sorted by nothing: shape (steps, supports, 3)."""
    done = list(Simulation(scene).run())
    forces = np.array([[reaction.force for reaction in result.reactions] for result in done])
    moments = np.array([[reaction.moment for reaction in result.reactions] for result in done])
    return forces, moments


def agreeing(found: tuple[FloatArray, FloatArray], right: tuple[FloatArray, FloatArray]) -> dict[str, float]:
    """Digits that forces and moments have in common."""
    return {name: digits(a, b) for name, a, b in zip(("forces", "moments"), found, right, strict=True)}


@case(
    claim="The way in which the processor rounds changes no digit that counts.",
    tier=lambda scene, mode: "gate" if (scene, mode) == ("coarse-press", "downward") else "nightly",
    grid={"scene": ("coarse-press", "coarse-bowl"), "mode": tuple(MODES)[1:]},
    bounds=_BOUNDS,
)
def rounding_mode(scene: str, mode: str) -> dict[str, Any]:
    """Kernel, factorisation and Python in another IEEE mode; digits that agree with those rounded to nearest."""
    right = results(problem(scene))
    with rounding(mode):
        found = results(problem(scene))
    return agreeing(found, right)


@case(
    claim="The order of sums changes no digit that counts.",
    tier="nightly",
    grid={"scene": ("coarse-press", "coarse-bowl")},
    bounds=_BOUNDS,
)
def order_of_sums(scene: str) -> dict[str, Any]:
    """Bodies in reverse, directions reversed and called by other names: elements, points and unknowns are counted otherwise."""
    original = problem(scene)
    return agreeing(results(relabelled(original)), results(original))
