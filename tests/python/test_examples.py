"""The examples do what the program does."""

from __future__ import annotations

import ast
import re
import runpy
from dataclasses import replace
from pathlib import Path

import nbclient
import nbformat
import numpy as np

from isomortar.march.simulation import Simulation
from isomortar.solve.equilibrium import Equilibrium
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


def test_the_notebook_runs(tmp_path: Path) -> None:
    """From its first cell to the last; the bar is full at the end, and friction makes the block stiffer."""
    notebook = nbformat.read(EXAMPLES / "friction.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "is kept without what it prints"
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [output for cell in notebook.cells for output in cell.get("outputs", ())]
    bars = [data["text/html"] for output in shown if "<progress" in (data := output.get("data", {})).get("text/html", "")]
    assert len(bars) == 1
    assert '<progress value="5" max="5">' in bars[0]
    forces = ast.literal_eval(re.sub(r"np\.float64\(([^)]*)\)", r"\1", shown[-1]["data"]["text/plain"]))
    assert list(forces) == [0.0, 0.02, 0.3]
    assert 0.0 > forces[0.0] > forces[0.02] > forces[0.3]
