"""The memory that a scene will take, known before any of it is taken."""

from __future__ import annotations

import gc
import resource
import subprocess
import sys
import time
import weakref
from pathlib import Path

import numpy as np
import pytest

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction
from isomortar.march.simulation import Simulation
from isomortar.model import checks, memory
from isomortar.scene import Scene
from isomortar.solve.condensed import CondensedSystem
from isomortar.solve.system import LinearSystem
from isomortar.told.before import doubts as doubting


def scene(family: str, order: int, elements: str) -> Scene:
    mesh = {"family": family, "order": order, "elements": elements}
    return Scene.load("press", [f"bodies.block.mesh.{key}={value}" for key, value in mesh.items()])


@pytest.mark.parametrize(
    ("family", "order", "elements"),
    [("N", 2, "[5,4,3]"), ("N", 2, "[12,12,6]"), ("N", 4, "[5,5,3]"), ("L", 1, "[6,4,4]"), ("L", 3, "[3,3,2]")],
)
def test_blocks_are_counted_and_factors_estimated(family: str, order: int, elements: str) -> None:
    problem = scene(family, order, elements).problem()
    simulation = Simulation(problem)
    equilibrium = simulation.equilibrium
    patch = problem.bodies[0].patch
    assert memory.blocks(patch) == len(equilibrium.solid.pattern.column)
    system = LinearSystem(len(equilibrium.supports.free), [equilibrium.solid_source], simulation.ledger, ordering="metis")
    system.factorise([equilibrium.solid.forces_and_tangent(simulation.state.positions)[1]])
    statistics = system._rivals[0].statistics
    assert statistics is not None
    assert 0.4 < memory.factor_entries(patch) / statistics.factor_entries < 2.5


def test_repeated_knots_and_single_elements_are_counted() -> None:
    knots = np.array([0, 0, 0, 0.5, 0.5, 1, 1, 1.0])
    assert memory._neighbours(Direction("N", 2, knots)).tolist() == [3, 3, 5, 3, 3]
    assert memory._neighbours(Direction("L", 2, np.array([0, 0.5, 1.0]))).tolist() == [3, 3, 5, 3, 3]
    assert memory._neighbours(Direction("N", 3, np.repeat([0.0, 1.0], 4))).tolist() == [4, 4, 4, 4]


def test_what_cannot_fit_is_refused_before_any_work(monkeypatch: pytest.MonkeyPatch) -> None:
    start = time.monotonic()
    with pytest.raises(InputError, match="GB of memory, and there are") as refused:
        scene("N", 10, "[50,50,50]").problem()
    assert refused.value.field == "bodies.block.mesh"
    assert time.monotonic() - start < 60
    small = scene("N", 2, "[12,12,6]")
    problem = small.problem()
    needed = memory.memory_needed(problem)
    state = Simulation(problem).state
    for there, refuses, told in ((0.4 * needed, True, True), (0.6 * needed, False, True), (3.0 * needed, False, False)):
        for module in (checks, doubting):
            monkeypatch.setattr(module, "memory_of_machine", lambda there=there: there)
        if refuses:
            with pytest.raises(InputError, match="GB of memory"):
                small.problem()
        else:
            small.problem()
        assert any("GB of memory" in said for said in doubting.doubts(problem, state)) == told


def test_the_limit_of_the_process_counts(tmp_path: Path) -> None:
    limit = 2 * 2**30
    words = ["run", "press", "--output", "run.h5", "--set", "bodies.block.mesh.order=6", "--set", "bodies.block.mesh.elements=12"]
    done = subprocess.run(
        [sys.executable, "-m", "isomortar", *words],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)),
    )
    assert done.returncode == 2
    assert "bodies.block.mesh: Gauss points, tangent and factors would take about" in done.stderr
    assert "there are 2.15 GB" in done.stderr


def test_factors_go_with_their_simulation() -> None:
    """And do not wait for Python to look for cycles: it sees none of the kernel's memory."""
    simulation = Simulation(Scene.load("press", ["bodies.block.mesh.elements=[6,6,3]", "stages.press.steps=1"]).problem())
    assert [result.step for result in simulation.run()] == [1]
    assert isinstance(simulation.equilibrium.systems.in_use, CondensedSystem)
    gone = weakref.ref(simulation.equilibrium)
    gc.disable()
    try:
        del simulation
        assert gone() is None
    finally:
        gc.enable()
