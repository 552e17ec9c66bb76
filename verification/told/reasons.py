"""What a load step is given up for, on either side of the numbers from which on it is told, and with the other method."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from told.wrong.causes import said, scene

from isomortar.errors import PathError, SingularSystemError
from isomortar.harness import Bound, case

_CUTS, _STEPS = "let increments be halved more often than solver.max_cuts = 8", "or take more load steps"
_OFTEN = "too long for that: "
#: What is changed in a sound scene, what ended its load step (None: nothing converged), and words of what is said; none: nothing is.
REASONS: tuple[tuple[dict[str, Any], Exception | None, str], ...] = (
    ({"METHOD": "uzawa", "PENALTY": 990}, None, ""),
    ({"METHOD": "uzawa", "PENALTY": 1010}, None, "a penalty of 1010"),
    ({"METHOD": "uzawa", "PENALTY": 0.11}, None, ""),
    ({"METHOD": "uzawa", "PENALTY": 0.09}, None, "a penalty of 0.09"),
    ({"PENALTY": 1e4}, None, ""),
    ({"PENALTY": 1e-3}, None, ""),
    ({"POISSON": 0.49994}, None, ""),
    ({"POISSON": 0.49996}, None, "resists compression 12 500 times"),
    ({"HARD": 0.9e11}, None, ""),
    ({"HARD": 1.1e11}, None, "1.1e+10 times as stiff"),
    ({"TOP": 1.000006}, None, ""),
    ({"TOP": 1.000004}, None, "are 4.0e-06 thin and up to 5.0e-01 long"),
    ({"TOP": 1.0006}, SingularSystemError(""), ""),
    ({"TOP": 1.0004}, SingularSystemError(""), "are 4.0e-04 thin and up to 5.0e-01 long"),
    ({"SLIP": 0.0011}, None, ""),
    ({"SLIP": 0.0009}, None, "an elastic slip of 0.0009"),
    ({}, PathError(0.37, 0.01), f"{_OFTEN}take solver.path_tolerance = 0.4 or more, {_CUTS}, {_STEPS}"),
    ({}, PathError(0.031, 0.01), f"{_OFTEN}take solver.path_tolerance = 0.04 or more, {_CUTS}, {_STEPS}"),
    ({}, PathError(1.5, 0.01), f"{_OFTEN}{_CUTS}, {_STEPS}"),
    ({}, PathError(np.inf, 0.01), f"{_OFTEN}{_CUTS}, {_STEPS}"),
    ({}, PathError(np.nan, 0.01), f"{_OFTEN}{_CUTS}, {_STEPS}"),
    ({"PENALTY": "100\nmax_cuts = 30"}, PathError(0.37, 0.01), f"{_OFTEN}take solver.path_tolerance = 0.4 or more, {_STEPS}"),
)


def as_said(told: list[str], words: str) -> bool:
    """Whether one sentence with these words is said, or, where there are none, nothing."""
    return len(told) == bool(words) and all(words in sentence for sentence in told)


def pressed(share: float) -> list[str]:
    """What is said of a lower block that is pressed to a share of its height."""
    simulation = scene()
    positions = simulation.state.positions.copy()
    positions[np.unique(simulation.equilibrium.numbering.points["lower"]), 2] *= share
    simulation.state = replace(simulation.state, positions=positions)
    return [sentence for sentence in said(simulation) if "pressed flat" in sentence]


@case(
    claim="What a load step is given up for is told from a number on, by that alone: penalties of the method that has them, moduli, thin "
    "bodies, slips, bodies that are pressed flat, and increments that are too long with what makes them shorter.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: load steps of which something else is said")},
)
def reasons() -> dict[str, float]:
    """How many."""
    wrong = sum(not as_said(said(scene(**changes), error), words) for changes, error, words in REASONS)
    return {"wrong": float(wrong + (not as_said(pressed(0.11), "")) + (not as_said(pressed(0.09), "down to J = 9.0e-02")))}
