"""Rigid bodies: what cannot be is refused, nothing is computed of them but where they are, and files and programs know of them."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from told.wrong.rigid import GOOD, WRONG

from isomortar import _bindings, export, run
from isomortar.errors import ConvergenceError, InputError
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.model.memory import memory_needed
from isomortar.model.numbering import Numbering
from isomortar.program.getfem import GetFEM
from isomortar.results.comparison import differences
from isomortar.results.definition import read_problem, write_problem
from isomortar.scene import Scene
from isomortar.solve.record import Observer

FREE = GOOD.replace('[supports.die]\nface = "right.w0"\ncentre = [0.5, 0.5, -1]\n', "").replace(
    "motions.die = { translate = [0, 0, 0.04]", "motions.top = { translate = [0, 0, -0.04]"
)


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_is_refused(name: str) -> None:
    old, new, field, said = WRONG[name]
    assert GOOD.count(old) == 1
    with pytest.raises(InputError) as raised:
        Scene.from_toml(GOOD.replace(old, new)).problem()
    assert raised.value.field == field
    assert said in raised.value.message


def changed(problem: Problem, **of_bodies: object) -> Problem:
    """The problem with something else of its rigid bodies."""
    bodies = tuple(replace(body, **of_bodies) if body.rigid else body for body in problem.bodies)  # type: ignore[arg-type]
    return replace(problem, bodies=bodies)


def solved(problem: Problem) -> np.ndarray:
    """Forces of the supports at the end."""
    return np.array([reaction.force for reaction in list(Simulation(problem).run())[-1].reactions])


def test_left_handed_bodies_are_refused() -> None:
    """Their surface would be seen from inside."""
    problem = Scene.from_toml(GOOD).problem()
    bodies = [replace(b, patch=replace(b.patch, control_points=b.patch.control_points * [1, 1, -1])) for b in problem.bodies if b.rigid]
    with pytest.raises(InputError, match=r"body 'left' is left-handed"):
        Simulation(replace(problem, bodies=(problem.bodies[0], *bodies), contacts=()))


def test_without_a_support_a_rigid_body_stands_still() -> None:
    problem = Scene.from_toml(FREE).problem()
    numbering = Numbering(problem)
    results = list(Simulation(replace(problem, settings=replace(problem.settings, newton_tolerance=1e-12))).run())
    die = numbering.whole(problem.body("left"))
    assert len(die) == 2 * 3 * (2 + 3) - 2 * 3
    np.testing.assert_array_equal(results[-1].state.positions[die], numbering.reference[die])
    np.testing.assert_allclose(results[-1].reactions[0].force, results[-1].contacts[0].force_master, atol=1e-9)
    assert results[-1].contacts[0].active > 0


def test_a_support_carries_all_that_is_glued(monkeypatch: pytest.MonkeyPatch) -> None:
    """As it stands in the scene, on the other body, on another face: it is the same die. Its solid is looked at once, before the start."""
    called: list[int] = []
    add_body = _bindings.add_body

    def counted(*arguments: object) -> float:
        called.append(len(arguments[0].patch.point))  # type: ignore[attr-defined]
        return add_body(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(_bindings, "add_body", counted)
    here, there = (Scene.from_toml(GOOD.replace("right.w0", face)).problem() for face in ("right.w0", "left.v1"))
    simulation = Simulation(here)
    assert len(called) == 3
    called.clear()
    result = list(simulation.run())[-1]
    assert len(here.bodies[0].patch.weights) in called
    assert not {len(body.patch.weights) for body in here.bodies[1:]} & set(called)
    np.testing.assert_array_equal([r.force for r in result.reactions], solved(there))
    numbering = Numbering(here)
    die = numbering.whole(here.body("left"))
    np.testing.assert_allclose(result.state.positions[die, 2], numbering.reference[die, 2] + 0.04, rtol=1e-15)


def test_nothing_but_the_surface_counts() -> None:
    """Neither what it is made of nor its Gauss points; and memory is that of what deforms."""
    problem = Scene.from_toml(GOOD).problem()
    other = changed(problem, material=replace(problem.bodies[0].material, young=1e9, poisson=0.49999), quadrature=(7, 7, 7))
    np.testing.assert_array_equal(solved(problem), solved(other))
    assert memory_needed(problem) == memory_needed(replace(problem, bodies=problem.deformable))


def test_lines_of_a_rigid_body_are_no_kinks_to_come() -> None:
    """Those that are there are."""
    assert Scene.from_toml(GOOD).problem().contacts[0].projection == "closest"
    bent = GOOD.replace("rigid = true", 'material = "cork"')
    assert Scene.from_toml(bent).problem().contacts[0].projection == "averaged"
    roof = """
        format = 1
        bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] } }
        bodies.roof.rigid = true
        bodies.roof.patch = { order = 1, knots = [[0, 0, 1, 2, 2], [0, 0, 1, 1], [0, 0, 1, 1]], control_points = [
          [-1, -1, -2], [0.5, -1, -2], [2, -1, -2], [-1, 2, -2], [0.5, 2, -2], [2, 2, -2],
          [-1, -1, -1], [0.5, -1, 0], [2, -1, -1], [-1, 2, -1], [0.5, 2, 0], [2, 2, -1]] }
        contacts.roof = { slave = "block.w0", master = "roof.w1" }
        supports.top = { face = "block.w1" }
        stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.1] }]
    """
    assert Scene.from_toml(roof).problem().contacts[0].projection == "averaged"


def test_results_know_of_it(tmp_path: Path) -> None:
    problem = Scene.from_toml(GOOD).problem()
    with h5py.File(tmp_path / "problem.h5", "w") as file:
        write_problem(file, problem)
        assert differences(read_problem(file), problem) == []
        assert differences(read_problem(file), changed(problem, rigid=False))[0].startswith("bodies.left.rigid: True in the file, False")
        for body in file["bodies"].values():
            del body.attrs["rigid"]
        assert not any(body.rigid for body in read_problem(file).bodies)  # a file from before


def test_runs_are_resumed_and_exported(tmp_path: Path) -> None:
    problem, path = Scene.from_toml(GOOD).problem(), tmp_path / "die.h5"
    first, last = Simulation(problem).run()
    (again,) = Simulation(problem, resume_from=first).run()
    np.testing.assert_array_equal(again.state.positions, last.state.positions)
    with run(Scene.from_toml(GOOD), path) as results:
        np.testing.assert_array_equal(results.curve("force", support="die")[-1], last.reactions[1].force)
    assert export(path, tmp_path / "paraview").is_file()


def test_a_rigid_slave_that_is_finer_is_warned_of() -> None:
    text = """
        format = 1
        bodies.punch = { rigid = true, geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { elements = [4, 4, 1] } }
        bodies.base = { geometry = { kind = "box", lower = [-1, -1, -1], upper = [2, 2, 0] }, mesh = { elements = [4, 4, 1] } }
        contacts.c = { slave = "punch.w0", master = "base.w1", friction = 0 }
        supports.punch.face = "punch.w1"
        supports.base.face = "base.w0"
        stages = [{ name = "press", steps = 1, motions.punch.translate = [0, 0, -0.01] }]
    """
    heard: list[str] = []

    class Heard(Observer):
        def warned(self, message: str) -> None:
            heard.append(message)

    with suppress(ConvergenceError):
        list(Simulation(Scene.from_toml(text).problem(), Heard()).run())
    assert any("the slave 'punch' is rigid and its elements are 9 times smaller than the master's" in said for said in heard)


def test_other_programs_refuse_it() -> None:
    with pytest.raises(InputError, match="GetFEM is not told of rigid bodies") as raised:
        GetFEM().run(
            Scene.from_toml(
                GOOD.replace('glue = [["left.u1", "right.u0"]]', "").replace('["left.w1", "right.w1"]', '"right.w1"'),
                overrides=["bodies.block.mesh.family=L"],
            ).problem()
        )
    assert raised.value.field == "bodies.left.rigid"
