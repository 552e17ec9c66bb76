"""Plates that turn by a moment and supports of some stages: what cannot be meant is refused; all linear systems take them; runs resume."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from told.wrong.plates import ELSEWHERE, GOOD, HALVED, ROLLS, WRONG

from isomortar import run
from isomortar.cli.check import lines
from isomortar.errors import ConvergenceError, InputError
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.model.rank import rigid_rank
from isomortar.program.getfem import GetFEM
from isomortar.results.comparison import is_longer
from isomortar.results.reader import Results
from isomortar.scene import Scene
from isomortar.solve.condensed import CondensedSystem
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.system import LinearSystem
from isomortar.solve.timing import Ledger
from stopped_runs import Stopped


@pytest.mark.parametrize(("old", "new", "field", "text"), WRONG.values(), ids=list(WRONG))
def test_what_cannot_be_meant_is_refused(old: str, new: str, field: str, text: str) -> None:
    assert GOOD.count(old) == 1
    with pytest.raises(InputError) as raised:
        Scene.from_toml(GOOD.replace(old, new)).problem()
    assert raised.value.field == field
    assert text in str(raised.value)


@pytest.mark.parametrize(("text", "field", "words"), ELSEWHERE.values(), ids=list(ELSEWHERE))
def test_so_is_what_cannot_be_meant_elsewhere(text: str, field: str, words: str) -> None:
    with pytest.raises(InputError) as raised:
        Scene.from_toml(text).problem()
    assert raised.value.field == field
    assert words in str(raised.value)


def test_other_programs_are_not_told_of_stages_and_moments() -> None:
    with pytest.raises(InputError, match="is not told of forces of supports"):
        GetFEM().run(Scene.from_toml(HALVED.replace("force.z = 0.1, ", "").replace("order = 2", "order = 1")).problem())
    staged = HALVED.replace("force.z = 0.1, moment = 0.2", 'stages = ["bend"]').replace("order = 2", "order = 1")
    with pytest.raises(InputError, match="is not told of supports of some stages"):
        GetFEM().run(Scene.from_toml(staged).problem())


def test_a_moment_is_that_of_the_whole() -> None:
    whole, half = (list(Simulation(Scene.from_toml(HALVED + more).problem()).run())[-1] for more in ("", "symmetry = { y = 0.0 }\n"))
    for one, other in zip(whole.reactions, half.reactions[:2], strict=True):
        np.testing.assert_allclose(one.force, other.force, atol=1e-9)
        np.testing.assert_allclose(one.moment, other.moment, atol=1e-9)
        np.testing.assert_allclose(one.rotation, other.rotation, atol=1e-7)
    np.testing.assert_allclose(whole.reactions[1].moment[1], 0.2, rtol=1e-8)
    assert abs(whole.reactions[1].rotation) > 1.0


def test_what_rolls_away_is_told_with_what_held_it() -> None:
    with pytest.raises(
        ConvergenceError, match=r"body 'pipe' can move along .* freely since support 'hold' was released; hold it by a support"
    ):
        list(Simulation(Scene.from_toml(ROLLS).problem()).run())


def test_plates_leave_a_body_what_they_go_along_with() -> None:
    problem = Scene.from_toml(GOOD).problem()
    assert [rigid_rank(problem, (problem.body("pad"),), stage) for stage in (0, 1)] == [6, 4]


def test_all_linear_systems_see_plates_alike() -> None:
    """By parts and as a whole: the same solution."""
    given = Scene.from_toml(GOOD, overrides=["bodies.pad.mesh.elements=[8,8,4]"]).problem()
    simulation = Simulation(replace(given, settings=replace(given.settings, method="uzawa")))
    results = list(simulation.run())
    equilibrium = simulation.equilibrium
    system = equilibrium.systems.in_use
    assert isinstance(system, CondensedSystem)
    assert system.ordering is None  # no general factors took its place
    assert len(equilibrium.supports.copies) == 100
    right = np.random.default_rng(0).standard_normal(len(equilibrium.supports.free))
    general = system._make_general()
    assert isinstance(general, LinearSystem)
    pairs = zip(equilibrium.pairs, results[-1].state.contacts, strict=True)
    laws = [pair.law(np.array([1e3, 1e2]), contact.pressure, contact.traction) for pair, contact in pairs]
    balance = equilibrium.balance(results[-1].state.positions, results[-1].state, laws)
    _, values = equilibrium.seen(*equilibrium.tangents(balance, laws), balance)
    for each in (system, general):
        each.factorise(values)
    one, other = system.solve(right), general.solve(right)
    np.testing.assert_allclose(one, other, atol=1e-9 * np.abs(other).max())


def test_a_stage_without_changes_keeps_its_systems() -> None:
    equilibrium = Equilibrium(Scene.from_toml(GOOD).problem(), Ledger())
    supports = equilibrium.supports
    assert equilibrium.standing(2) is supports
    assert equilibrium.standing(3) is not supports


@pytest.mark.parametrize("after", [2, 3, 4])
def test_runs_go_on_to_the_last_bit(tmp_path: Path, after: int) -> None:
    scene = Scene.from_toml(GOOD)
    run(scene, tmp_path / "whole.h5")
    with pytest.raises(KeyboardInterrupt):
        run(scene, tmp_path / "parts.h5", observer=Stopped(after))
    run(scene, tmp_path / "parts.h5", resume=True)
    with Results(tmp_path / "whole.h5") as one, Results(tmp_path / "parts.h5") as other:
        np.testing.assert_array_equal(one.step(5).state.positions, other.step(5).state.positions)
        for quantity in ("force", "moment", "displacement", "rotation"):
            for support in ("top", "beside"):
                np.testing.assert_array_equal(one.curve(quantity, support=support), other.curve(quantity, support=support))
        before = one.curve("force", support="beside", component="z")[1]  # goes on in the plate, and fades there
        borne = one.curve("force", support="top", component="z")[2:]
        np.testing.assert_allclose(borne, before * np.array([2.0, 1.0, 0.0]) / 3.0 - [0.1, 0.2, 0.3], atol=1e-8)
        np.testing.assert_allclose(one.curve("moment", support="top", component="y")[-1], 0.02, atol=1e-9)
        assert one.problem.supports[0].moment == 0.02
        assert one.problem.supports[1].stages == (0,)


def test_more_load_steps_go_on_as_the_last_stage() -> None:
    stored, given = (Scene.from_toml(GOOD).with_more_steps(*counts).problem() for counts in ((), (2, 1)))
    assert [support.stages for support in given.supports] == [(1, 2, 3), (0,)]
    assert given.supports[0].factors == (0.0, 1.0, 1.0, 1.0)
    assert is_longer(stored, given)
    assert not is_longer(given, stored)


def test_a_look_at_a_scene_tells_of_moments_and_stages() -> None:
    said = list(lines(outlook(Scene.from_toml(GOOD).problem())))
    assert "support top: prescribes x, y of pad.w1; goes 0.01 and presses z by -0.3 and turns by a moment of 0.02; in press alone" in said
    assert "support beside: prescribes x, y, z of pad.w1; goes 0.01; in before alone" in said


#: A block above another one, which a moment turns about an edge of its top; and a body that a moment twists.
TURNED = """
format = 1
[bodies.upper]
geometry = { kind = "box", lower = [-0.4, -0.4, 0.1], upper = [0.4, 0.4, 0.7] }
[bodies.lower]
geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }
mesh = { elements = [2, 2, 1] }
[bodies.aside]
geometry = { kind = "box", lower = [3, 3, 0], upper = [4, 4, 1] }
[contacts.pair]
slave = "upper.w0"
master = "lower.w1"
[supports]
top = { face = "upper.w1", moment = 0.1, axis = [0, 1, 0], centre = [-0.4, 0, 0.7] }
lower = { face = "lower.w0" }
foot = { face = "aside.w0" }
aside = { face = "aside.w1", moment = 0.1, centre = [3.5, 3.5, 1] }
[[stages]]
name = "turn"
steps = 1
motions.top.translate = [0, 0, -0.01]
"""


@pytest.mark.parametrize("slave", ["w0", "u0"])
def test_what_moments_do_is_no_doubt(slave: str) -> None:
    said = "\n".join(Simulation(Scene.from_toml(TURNED.replace("upper.w0", f"upper.{slave}")).problem()).doubts())
    for wrong in ("cannot close", "nothing in the scene turns it", "nothing moves or loads it"):
        assert wrong not in said
