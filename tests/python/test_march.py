"""The march through the load steps: what follows a cut, a hard increment, a resumed run; and the names of stages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, is_dataclass, replace

import numpy as np
import pytest

from isomortar import run
from isomortar.errors import ConvergenceError, InputError
from isomortar.march.simulation import Simulation
from isomortar.model import constants
from isomortar.model.constants import EASY_ITERATIONS, HARD_TANGENTS
from isomortar.model.entities import Motion, Problem, Stage
from isomortar.scene import Scene
from isomortar.solve.method import Increment
from isomortar.solve.record import AugmentationRecord, IterationRecord, State, StepResult
from stopped_runs import Stopped

SCENE = """
format = 1
name = "dragged"
[bodies.block]
geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.8, 0.5] }
mesh = { order = [2, 2, 1], elements = [3, 2, 1] }
[contacts.floor]
slave = "block.w0"
plane = { point = [0, 0, 0], normal = [0.02, 0.01, 1] }
friction = 0.3
[supports.top]
face = "block.w1"
[[stages]]
name = "press"
steps = 1
motions.top = { translate = [0, 0, -0.06] }
[[stages]]
name = "drag"
steps = 2
motions.top = { translate = [0.06, 0.04, 0], rotate = 10 }
[[stages]]
name = "wait"
steps = 1
[solver]
newton_tolerance = 1e-12
complementarity_tolerance = 1e-12
"""
#: Linear solves and tangents of an increment by how it went.
COSTS = {
    "easy": (EASY_ITERATIONS, EASY_ITERATIONS),
    "middle": (EASY_ITERATIONS + 1, HARD_TANGENTS - 1),
    "hard": (HARD_TANGENTS, HARD_TANGENTS),
}


def problem() -> Problem:
    return Scene.from_toml(SCENE).problem()


@dataclass
class Went:
    """An increment that says how hard it was."""

    real: Increment
    iterations: int
    tangents: int
    orders: tuple[float, ...] = (2.0, float("nan"))

    @property
    def balance(self):
        return self.real.balance

    @property
    def augmentations(self):
        return (AugmentationRecord(1, 1.0, 1.0, 0.0, 0.0, (IterationRecord(self.iterations, 0.0, 0, 0, 0),)),)


class Scripted:
    """A method whose increments go as a script says: each is solved, also those that then fail; notes where they began and ended."""

    def __init__(self, simulation: Simulation, script: Sequence[str]) -> None:
        self.real, self.script = simulation._method, iter(script)
        self.tried: list[tuple[State, float, str]] = []
        self.ends: list[np.ndarray] = []

    def advance(self, start: State, time: float, step: int):
        how = next(self.script)
        self.tried.append((start, time, how))
        increment = self.real.advance(start, time, step)
        self.ends.append(increment.balance.positions)
        if how == "fail":
            raise ConvergenceError("as the script says")
        return Went(increment, *COSTS[how])


def scripted(script: Sequence[str], resume_from: StepResult | None = None) -> tuple[Simulation, Scripted]:
    simulation = Simulation(problem(), resume_from=resume_from)
    simulation._method = method = Scripted(simulation, script)
    return simulation, method


#: How increments go, where each begins and ends, and the increment that comes after: halved when they fail, doubled when they were easy,
#: halved when they were hard, as they are in between; a recorded step ends where it ends.
MARCH = [
    ("fail", 0.0, 1.0, 0.5),
    ("fail", 0.0, 0.5, 0.25),
    ("easy", 0.0, 0.25, 0.5),
    ("middle", 0.25, 0.75, 0.5),
    ("easy", 0.75, 1.0, 0.5),  # 0.25 long
    ("hard", 1.0, 1.5, 0.25),
    ("fail", 1.5, 1.75, 0.125),
    ("middle", 1.5, 1.625, 0.125),
    ("easy", 1.625, 1.75, 0.25),
    ("hard", 1.75, 2.0, 0.125),
    ("easy", 2.0, 2.125, 0.25),
    ("easy", 2.125, 2.375, 0.5),
    ("middle", 2.375, 2.875, 0.5),
    ("middle", 2.875, 3.0, 0.5),  # shortened to the step's end: no reason for shorter ones
    ("easy", 3.0, 3.5, 1.0),
    ("middle", 3.5, 4.0, 1.0),
]


def test_increments_are_cut_and_grow_back_as_documented():
    simulation, method = scripted([how for how, *_ in MARCH])
    results = list(simulation.run())
    assert [(how, time) for _, time, how in method.tried] == [(how, end) for how, _, end, _ in MARCH]
    state, reached = simulation.equilibrium.initial_state().positions, 0.0
    for (how, begin, end, _), (start, _, _), found in zip(MARCH, method.tried, method.ends, strict=True):
        assert reached == begin
        assert np.array_equal(start.positions, state), f"the increment to {end} does not begin where the last one ended"
        if how != "fail":
            state, reached = found, end
    for result in results:
        mine = [(how, after) for how, begin, _, after in MARCH if result.step - 1 <= begin < result.step]
        assert result.cuts == sum(how == "fail" for how, _ in mine)
        assert result.substeps == sum(how != "fail" for how, _ in mine)
        assert result.next_increment == mine[-1][1]
        assert [a.iterations[0].iteration for a in result.augmentations] == [COSTS[how][0] for how, _ in mine if how != "fail"]
        assert result.newton_order == 2.0


@pytest.mark.parametrize("step", [1, 2, 3])
def test_a_resumed_run_goes_on_with_the_increment_that_came_next(step):
    whole = list(scripted([how for how, *_ in MARCH])[0].run())
    rest = [row for row in MARCH if row[1] >= step]
    simulation, method = scripted([how for how, *_ in rest], whole[step - 1])
    again = list(simulation.run())
    assert [time for _, time, _ in method.tried] == [end for _, _, end, _ in rest]
    for one, other in zip(whole[step:], again, strict=True):
        np.testing.assert_allclose(one.state.positions, other.state.positions, atol=1e-11)
        assert (one.cuts, one.substeps, one.next_increment, one.stage) == (other.cuts, other.substeps, other.next_increment, other.stage)


#: Settings by which increments of the scene, on a coarse mesh, are cut for reasons of its own, and grow back.
CUTTING = {
    "monolithic": ["solver.max_iterations=4"],
    "uzawa": ["solver.max_iterations=3", "solver.method=uzawa", "contacts.floor.friction=0.5"],
}
COARSE = ["bodies.block.mesh.order=[1,1,1]", "bodies.block.mesh.elements=[2,2,1]", "solver.newton_tolerance=1e-9"]


def apart(one: object, other: object) -> float:
    """Largest relative difference of results of a load step; all that is not an array of numbers is the same. Not what it cost."""
    if isinstance(one, np.ndarray) and one.dtype.kind == "f":
        return float(np.abs(one - other).max(initial=0.0) / max(np.abs(one).max(initial=0.0), 1e-12))
    if isinstance(one, np.ndarray):
        assert np.array_equal(one, other)
        return 0.0
    if isinstance(one, tuple):
        return max([apart(a, b) for a, b in zip(one, other, strict=True)], default=0.0)
    if is_dataclass(one):
        told = [f.name for f in fields(one) if f.name not in ("timings", "counters", "augmentations", "newton_order")]
        return max(apart(getattr(one, name), getattr(other, name)) for name in told)
    assert one == other
    return 0.0


@pytest.mark.parametrize("method", list(CUTTING))
def test_a_run_that_was_stopped_after_cuts_goes_on_from_its_file_as_if_it_had_not_been(tmp_path, method):
    scene, path = Scene.from_toml(SCENE, overrides=[*COARSE, *CUTTING[method]]), tmp_path / "stopped.h5"
    with run(scene, tmp_path / "whole.h5") as whole:
        expected = [whole.step(int(number)) for number in whole.steps]
    assert expected[1].cuts > 0
    assert max(result.substeps for result in expected) > 1 == expected[3].substeps
    with pytest.raises(KeyboardInterrupt):
        run(scene, path, Stopped(2))
    with run(scene, path, resume=True) as resumed:
        assert list(resumed.steps) == [1, 2, 3, 4]
        found = [resumed.step(int(number)) for number in resumed.steps]
    assert max(apart(one, other) for one, other in zip(expected, found, strict=True)) <= 1e-11


#: A bowl dragged over a block: slave points go from element to element of their master, and in and out of contact.
TWO_BODIES = """
format = 1
[bodies.slave]
geometry = { kind = "bowl", half_width = 0.375, bottom = 0.02, rise = 0.2, top = 0.75 }
mesh.elements = [3, 3, 2]
[bodies.master]
geometry = { kind = "box", lower = [-0.75, -0.75, -0.75], upper = [0.75, 0.75, 0] }
mesh.elements = [4, 4, 2]
[contacts.interface]
slave = "slave.w0"
master = "master.w1"
[supports]
top.face = "slave.w1"
base.face = "master.w0"
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0, 0, -0.25]
[[stages]]
name = "drag"
steps = 3
motions.top.translate = [0.2, 0.1, 0]
"""


@pytest.mark.parametrize("settings", [[], ["solver.method=uzawa"], ["solver.slip_sum=paper"], ["solver.max_iterations=4"]])
def test_resumed_at_any_step_a_run_comes_to_the_same_bits(settings):
    """What a load step starts from is in its record, all of it: nothing that an earlier one needed is left over."""
    problem = Scene.from_toml(TWO_BODIES, overrides=settings).problem()
    whole = list(Simulation(problem).run())
    for before in whole[:-1]:
        again = list(Simulation(problem, resume_from=before).run())
        assert [apart(one, other) for one, other in zip(whole[before.step :], again, strict=True)] == [0.0] * len(again)


@pytest.mark.parametrize("settings", [[], ["solver.method=uzawa"]])
def test_resumed_with_the_orderings_that_were_chosen_a_run_comes_to_the_same_bits(tmp_path, monkeypatch, settings):
    """Both are tried on the first matrix alone; that of a later load step might choose the other."""
    monkeypatch.setattr(constants, "UNDOUBTED", (0, 10**9))
    scene, path = Scene.from_toml(TWO_BODIES, overrides=settings), tmp_path / "parts.h5"
    with pytest.raises(KeyboardInterrupt):
        run(scene, path, Stopped(1))
    with run(scene, tmp_path / "whole.h5") as whole, run(scene, path, resume=True) as resumed:
        pairs = [(whole.step(int(number)), resumed.step(int(number))) for number in whole.steps]
    assert [apart(one, other) for one, other in pairs] == [0.0] * 5


def test_what_failed_leaves_no_trace():
    """Every increment fails once when it has been solved: the same as twice the load steps, with none that fail."""
    plain = problem()
    halves = replace(plain, stages=tuple(Stage(stage.name, 2 * stage.steps) for stage in plain.stages))
    simulation = Simulation(plain)
    simulation._method = Scripted(simulation, ["fail", "easy", "middle"] * 4)
    one, other = list(simulation.run()), list(Simulation(halves).run())
    assert [result.cuts for result in one] == [1] * 4
    for result, reference in zip(one, other[1::2], strict=True):
        assert result.contacts[0].slip == reference.contacts[0].slip
        np.testing.assert_allclose(result.state.positions, reference.state.positions, atol=1e-9)
        np.testing.assert_allclose(result.state.contacts[0].traction, reference.state.contacts[0].traction, atol=1e-6)
    assert max(result.contacts[0].slip for result in one) > 0


def test_a_path_tolerance_takes_halves_one_after_the_other():
    toleranced = problem()
    simulation = Simulation(replace(toleranced, settings=replace(toleranced.settings, path_tolerance=1.0)))
    simulation._method = method = Scripted(simulation, ["easy"] * 12)
    results = list(simulation.run())
    assert [time for _, time, _ in method.tried] == [t for step in range(1, 5) for t in (step, step - 0.5, step)]
    for k in range(0, 12, 3):
        (whole, _, _), (first, _, _), (second, _, _) = method.tried[k : k + 3]
        assert whole is first
        assert np.array_equal(second.positions, method.ends[k + 1])
        assert np.array_equal(results[k // 3].state.positions, method.ends[k + 2])


@pytest.mark.parametrize("other", [Scene.from_toml(SCENE), SCENE, None])
def test_what_is_no_problem_is_refused_by_name(other):
    """A scene is not one, but gives it."""
    with pytest.raises(InputError, match=r"problem: is .*; allowed: Problem, of a scene: scene\.problem\(\)$"):
        Simulation(other)


def test_every_step_bears_the_name_of_its_stage():
    results = list(Simulation(problem()).run())
    assert [result.stage for result in results] == ["press", "drag", "drag", "wait"]
    assert [(result.step, result.time) for result in results] == [(1, 1.0), (2, 2.0), (3, 3.0), (4, 4.0)]


@pytest.mark.parametrize(("step", "name"), [(1, "press"), (2, "drag"), (3, "drag"), (4, "wait")])
def test_a_step_that_fails_is_named_with_its_stage_and_the_least_increment(step, name):
    limited = problem()
    simulation = Simulation(replace(limited, settings=replace(limited.settings, max_cuts=2)))
    simulation._method = Scripted(simulation, ["easy"] * (step - 1) + ["fail"] * 3)
    words = rf"load step {step} \(stage '{name}'\) does not converge at load time {step - 0.75:g}, even with an increment of 1/4 step"
    with pytest.raises(ConvergenceError, match=words):
        list(simulation.run())


def test_supports_are_where_their_stages_put_them_at_any_time():
    """Translations and rotations grow linearly over a stage, one stage after the other."""
    supports = Simulation(problem()).equilibrium.supports
    (support,) = problem().supports
    reference = supports.place(0.0)
    press, drag = (0.0, 0.0, -0.06), (0.06, 0.04, -0.06)
    places = [(0.5, (0.0, 0.0, -0.03), 0.0), (1.0, press, 0.0), (1.5, (0.015, 0.01, -0.06), 2.5), (3.0, drag, 10.0), (4.0, drag, 10.0)]
    for time, shift, angle in places:
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        points = supports.points[0]
        np.testing.assert_allclose(supports.place(time)[points], reference[points] @ turn.T + shift, atol=1e-15)
        np.testing.assert_allclose(supports.centre(support, time), shift, atol=1e-16)
    assert list(support.motions) == [Motion((0, 0, -0.06)), Motion((0.06, 0.04, 0), 10), Motion()]
