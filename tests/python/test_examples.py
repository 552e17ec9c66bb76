"""The examples do what the program does."""

from __future__ import annotations

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np

from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.simulation import Simulation
from isomortar.solve.timing import Ledger

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_contact_from_scratch_finds_the_forces_of_the_program() -> None:
    """In fewer than 80 lines, by augmentations; the program's other method, to which they converge, is its judge."""
    path = EXAMPLES / "contact_from_scratch.py"
    assert len(path.read_text().splitlines()) < 80
    example = runpy.run_path(str(path))
    problem = example["problem"]()
    forces = np.array(list(example["forces"](Equilibrium(problem, Ledger()))))
    monolithic = replace(problem, settings=replace(problem.settings, method="monolithic"))
    expected = np.array([result.contacts[0].force_slave for result in Simulation(monolithic).run()])
    assert np.abs(forces - expected).max() <= 1e-4 * np.abs(expected).max()
    assert np.abs(forces[-1, 0]) > 0.1
