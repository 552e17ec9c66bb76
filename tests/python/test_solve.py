"""Load steps: both methods find the same solution, keep the contact conditions, and say what goes wrong."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import get_args

import numpy as np
import pytest

from isomortar.errors import ConvergenceError
from isomortar.march.simulation import Simulation
from isomortar.model import constants
from isomortar.model.entities import Motion, Problem, Stage
from isomortar.model.settings import Measure
from isomortar.scene import Scene
from isomortar.solve import bordered, monolithic
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.newton import KEPT_FACTORS
from isomortar.solve.record import AugmentationRecord, IterationRecord, Observer, StepResult
from isomortar.told.during.unstable import FORCES

TWO_BODIES = [
    "bodies.slave.mesh.elements=[2,2,1]",
    "bodies.master.mesh.elements=[3,3,1]",
    "bodies.master.mesh.order=[2,2,1]",
    "stages.press.steps=8",
    "solver.newton_tolerance=1e-11",
]


class Listener(Observer):
    """Keeps warnings and cuts, how many load steps there are and the first one that is computed."""

    def __init__(self) -> None:
        self.begun = (0, 0)
        self.warnings: list[str] = []
        self.cuts: list[str] = []
        self.tried_next: list[tuple[int, float, float]] = []

    def started(self, total_steps: int, first_step: int) -> None:
        self.begun = (total_steps, first_step)

    def warned(self, message: str) -> None:
        self.warnings.append(message)

    def cut(self, step: int, time: float, increment: float, reason: str) -> None:
        self.cuts.append(reason)
        self.tried_next.append((step, time, increment))


class Told(Observer):
    """Keeps when iterations and augmentations were told of."""

    def __init__(self) -> None:
        self.iterations: list[tuple[int, float, int]] = []
        self.augmentations: list[tuple[int, float, int]] = []

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:
        self.iterations.append((step, time, augmentation))

    def augmented(self, step: int, time: float, record: AugmentationRecord) -> None:
        self.augmentations.append((step, time, record.augmentation))


def small_iron(**settings: object) -> Problem:
    """Iron on coarse meshes: eight steps down, three along, one back."""
    problem = Scene.load("iron", [*TWO_BODIES, "stages.drag.steps=3"]).problem()
    forth = replace(problem.supports[0], motions=(Motion((0.0, 0.0, -0.4)), Motion((0.3, 0.0, 0.0)), Motion((-0.1, 0.0, 0.0))))
    bottom = replace(problem.supports[1], motions=(Motion(), Motion(), Motion()))
    stages = (*problem.stages, Stage("back", 1))
    names = [support.name for support in problem.supports]
    supports = (forth, bottom) if names.index("top") == 0 else (bottom, forth)
    return replace(problem, stages=stages, supports=supports, settings=replace(problem.settings, **settings))


def run(problem: Problem, observer: Observer | None = None) -> list[StepResult]:
    return list(Simulation(problem, observer).run())


@pytest.mark.parametrize("slip_sum", ["local", "paper"])
def test_both_methods_find_the_same_solution(slip_sum: str) -> None:
    monolithic = run(small_iron(method="monolithic", slip_sum=slip_sum))
    softly = {"penalty_normal": 20.0, "penalty_tangential": 2.0, "augmentation_tolerance": 1e-9, "max_augmentations": 200}
    uzawa = run(small_iron(method="uzawa", slip_sum=slip_sum, **softly))
    assert max(result.contacts[0].slip for result in monolithic) > 0
    assert sum(result.cuts for result in (*monolithic, *uzawa)) == 0  # a cut is another path, with friction another solution
    for a, b in zip(monolithic, uzawa, strict=True):
        scale = np.linalg.norm(monolithic[-1].reactions[0].force)
        np.testing.assert_allclose(a.reactions[0].force, b.reactions[0].force, atol=1e-7 * scale)
        np.testing.assert_allclose(a.state.positions, b.state.positions, atol=1e-7)


@pytest.mark.parametrize("left_out", [*get_args(Measure), "nothing"])
def test_measures_on_the_way_do_not_change_the_solution(left_out: str) -> None:
    everything = small_iron()
    kept = tuple(m for m in everything.settings.measures if m != left_out)
    a, b = run(everything)[-1], run(replace(everything, settings=replace(everything.settings, measures=kept)))[-1]
    np.testing.assert_allclose(a.state.positions, b.state.positions, atol=1e-9)


def iterations_by_kept_factors(results: list[StepResult]) -> Iterator[tuple[int, IterationRecord, IterationRecord]]:
    """Number of the augmentation, iteration before, iteration by kept factors."""
    for augmentation in (a for result in results for a in result.augmentations):
        for before, now in pairwise(augmentation.iterations):
            if KEPT_FACTORS in now.notes:
                yield augmentation.augmentation, before, now


@pytest.mark.parametrize("method", ["monolithic", "uzawa"])
def test_factors_are_kept_while_they_serve(method: str) -> None:
    keeping = small_iron(method=method, penalty_normal=20.0, penalty_tangential=2.0)
    others = tuple(measure for measure in keeping.settings.measures if measure != "keeping")
    afresh = replace(keeping, settings=replace(keeping.settings, measures=others))
    one, other = run(keeping), run(afresh)
    asked = {int(end): len(keeping.deformable) * FORCES for end in np.cumsum([stage.steps for stage in keeping.stages])}  # of stability
    assert all(r.counters["solves"] == r.counters["factorisations"] + asked.get(r.step, 0) for r in other)
    assert not any("kept factors" in i.notes for r in other for a in r.augmentations for i in a.iterations)
    assert any("kept factors" in i.notes for r in one for a in r.augmentations for i in a.iterations)
    factors = [sum(r.counters["factorisations"] for r in results) for results in (one, other)]
    assert factors[0] < 0.8 * factors[1]
    for augmentation, before, now in iterations_by_kept_factors(one):
        assert now.residual <= constants.KEPT_SHARE * before.residual, "after a change of penalties, or of states, others are made"
        assert augmentation > 1 or now.iteration > 1, "an increment begins with a tangent of its own"
        assert method == "uzawa" or (before.active, before.slip) == (now.active, now.slip)
    assert sum(result.cuts for result in (*one, *other)) == 0  # a cut is another path, with friction another solution
    np.testing.assert_allclose(one[-1].state.positions, other[-1].state.positions, atol=1e-8)


@pytest.mark.parametrize("method", ["monolithic", "uzawa"])
def test_iterations_by_kept_factors_do_not_count_as_tangents(method: str) -> None:
    plain = run(small_iron(method=method))
    loops = [a.iterations[1:] for r in plain for a in r.augmentations if r.cuts == 0]
    needed = max(sum("kept factors" not in i.notes for i in loop) for loop in loops)
    assert any(len(loop) > needed for loop in loops)
    limited = run(small_iron(method=method, max_iterations=needed))
    assert [r.cuts for r in limited] == [r.cuts for r in plain]


class Factors:
    """Stands between the monolithic method and its linear solves: what was factorised, and how often it served again."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.made_of: object = None
        self.borders: object = None
        self.increment = self.again = 0
        begin = Equilibrium.begin
        monkeypatch.setattr(monolithic, "solve_bordered", self.solved)
        monkeypatch.setattr(monolithic, "solve_with_kept_factors", self.kept)
        monkeypatch.setattr(Equilibrium, "begin", lambda equilibrium, *start: (self.begun(), begin(equilibrium, *start))[1])

    def begun(self) -> None:
        self.increment += 1

    def solved(self, equilibrium, balance, laws, targets, prescribed, keep_bodies):
        self.made_of = self.increment, [target.state.tobytes() for target in targets]
        correction, self.borders = bordered.solve_bordered(equilibrium, balance, laws, targets, prescribed, keep_bodies)
        return correction, self.borders

    def kept(self, equilibrium, balance, targets, borders):
        self.again += 1
        assert self.made_of == (self.increment, [target.state.tobytes() for target in targets])
        assert borders is self.borders
        return bordered.solve_with_kept_factors(equilibrium, balance, targets, borders)


def test_kept_factors_are_those_of_the_same_increment_and_states(monkeypatch: pytest.MonkeyPatch) -> None:
    """The right-hand side has the rows that were factorised: with others its solution is that of no system.

    Factors are kept here as long as they gain anything, or changes of state would hide behind poor gains.
    """
    monkeypatch.setattr(constants, "KEPT_SHARE", 0.95)
    factors = Factors(monkeypatch)
    run(small_iron())
    assert factors.again > 10


def test_contact_conditions_after_every_step() -> None:
    problem = small_iron()
    for result in run(problem):
        contact, state = result.contacts[0], result.state.contacts[0]
        friction = problem.contacts[0].friction
        largest = max(float(state.pressure.max()), 1e-12)
        assert np.all(state.pressure >= 0)
        assert np.all(contact.traction_norm <= friction * state.pressure + 1e-8 * friction * largest)
        sliding = contact.status == 2
        np.testing.assert_allclose(contact.traction_norm[sliding], friction * state.pressure[sliding], rtol=1e-7)
        assert np.all(np.abs(contact.gap[contact.status > 0]) < 1e-8)
        assert np.all(contact.gap[contact.status == 0] <= 0)
        assert result.cuts == 0


def test_momentum_balance_at_the_interface() -> None:
    for result in run(small_iron()):
        contact = result.contacts[0]
        scale = max(float(np.linalg.norm(contact.force_slave)), 1e-9)
        assert np.linalg.norm(contact.force_slave + contact.force_master) <= 1e-12 * scale
        assert np.linalg.norm(contact.moment_slave + contact.moment_master) <= 1e-12 * scale * 3.0


def test_path_tolerance_makes_increments_smaller() -> None:
    plain, controlled = run(small_iron()), run(small_iron(path_tolerance=0.05))
    assert sum(r.substeps for r in controlled) > sum(r.substeps for r in plain)
    assert [r.step for r in controlled] == [r.step for r in plain]


def test_unconverged_step_is_cut_and_then_named() -> None:
    listener = Listener()
    with pytest.raises(ConvergenceError, match=r"load step 4 \(stage 'press'\) does not converge"):
        run(small_iron(max_iterations=1, max_cuts=2), listener)
    assert len(listener.cuts) == 2
    assert listener.tried_next == [(4, 4.0, 0.5), (4, 3.5, 0.25)]


@pytest.mark.parametrize(("method", "which"), [("monolithic", "5, 9"), ("uzawa", "5, 6, 9, 10")])
def test_a_loop_that_ends_too_early_says_which_states_change(method: str, which: str) -> None:
    with pytest.raises(ConvergenceError, match=f"after 2 iterations; constraints {which} change their states"):
        run(small_iron(method=method, max_iterations=2, max_cuts=0))


def test_cuts_end_where_time_no_longer_moves() -> None:
    """Where supports turn far in a load step, increments are short to begin with."""
    simulation = Simulation(small_iron(max_cuts=30))
    simulation._cut(4, simulation.state, 3.5, 2.0**-40, 2.0**-30, ConvergenceError("no"), [])
    with pytest.raises(ConvergenceError, match="does not converge"):
        simulation._cut(4, simulation.state, 3.5, 2.0**-52, 2.0**-30, ConvergenceError("no"), [])


@pytest.mark.parametrize(("modulus", "times"), [(1000.0, "100 times"), (1.23456e10, "1.23e+09 times")])
def test_stiff_and_fine_slave_is_warned_about(modulus: float, times: str) -> None:
    problem = Scene.load(
        "iron", [*TWO_BODIES, "bodies.slave.mesh.elements=[6,6,1]", "stages.press.steps=1", "stages.drag.steps=1"]
    ).problem()
    stiff = [replace(b, material=replace(b.material, young=modulus)) if b.name == "slave" else b for b in problem.bodies]
    listener = Listener()
    next(Simulation(replace(problem, bodies=tuple(stiff)), listener).run())
    assert any(f"is {times} stiffer" in warning for warning in listener.warnings)


def test_resuming_gives_the_same_numbers() -> None:
    problem = small_iron()
    whole = run(problem)
    listener = Listener()
    rest = list(Simulation(problem, listener, resume_from=whole[8]).run())
    np.testing.assert_allclose(rest[-1].state.positions, whole[-1].state.positions, atol=1e-12)
    assert listener.begun == (len(whole), 10)


def test_far_from_the_origin_resuming_gives_the_same_numbers_and_centres_are_the_scenes() -> None:
    problem = small_iron()
    away = np.array([3e6, 0.0, -2e6])
    bodies = tuple(replace(b, patch=replace(b.patch, control_points=b.patch.control_points + away)) for b in problem.bodies)
    problem = replace(problem, bodies=bodies, supports=tuple(replace(s, centre=(3e6, 0.0, -2e6)) for s in problem.supports))
    whole = run(problem)
    rest = list(Simulation(problem, resume_from=whole[8]).run())
    np.testing.assert_allclose(rest[-1].state.positions - away, whole[-1].state.positions - away, atol=1e-12)
    np.testing.assert_allclose(rest[-1].reactions[0].force, whole[-1].reactions[0].force, rtol=1e-12)
    shift = np.sum([motion.translate for motion in problem.supports[0].motions], axis=0)
    np.testing.assert_allclose(whole[-1].reactions[0].centre - away, shift, atol=1e-9)


@pytest.mark.parametrize("exponent", [-6, 6])
def test_units_do_not_make_the_system_singular(exponent: int) -> None:
    problem = Scene.load("press", ["bodies.block.mesh.elements=[3,3,2]"]).problem()
    length, stress = 10.0**exponent, 10.0**-exponent
    first = run(problem)[-1]
    (body,), (contact,) = problem.bodies, problem.contacts
    sized = replace(body.patch, control_points=length * body.patch.control_points)
    bodies = (replace(body, patch=sized, material=replace(body.material, young=stress * body.material.young)),)
    area = None if contact.reference_area is None else length**2 * contact.reference_area
    supports = tuple(
        replace(s, motions=tuple(Motion(tuple(length * u for u in m.translate), m.rotate) for m in s.motions))  # type: ignore[arg-type]
        for s in problem.supports
    )
    other = run(replace(problem, bodies=bodies, supports=supports, contacts=(replace(contact, reference_area=area),)))[-1]
    assert other.reactions[0].force / (stress * length**2) == pytest.approx(first.reactions[0].force, rel=1e-9, abs=1e-9)


def test_observers_are_told_of_the_load_step_the_load_time_and_the_augmentation() -> None:
    told = Told()
    problem = small_iron(method="uzawa", augmentation_tolerance=1e-2)
    problem = replace(problem, stages=(Stage("press", 8),), supports=tuple(replace(s, motions=s.motions[:1]) for s in problem.supports))
    run(problem, told)
    assert sorted(set(told.iterations)) == told.augmentations
    for step, time, augmentation in told.augmentations:
        assert step - 1 < time <= step
        assert augmentation == int(augmentation) >= 1
    assert max(number for *_, number in told.augmentations) > 1


def test_updates_are_halved_from_the_second_iteration_on(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[int, int]] = []

    def objection(_loop: object, _now: object, _next: object, iteration: int, halving: int) -> str:
        asked.append((iteration, halving))
        return "no" if halving < 1 else ""

    monkeypatch.setattr(monolithic._BorderedNewton, "_objection", objection)
    problem = small_iron()
    still = Stage("press", 8)
    run(replace(problem, stages=(still,), supports=tuple(replace(s, motions=s.motions[:1]) for s in problem.supports)))
    assert {(1, 0), (1, 1), (2, 0), (2, 1)} <= set(asked)
    assert min(iteration for iteration, _ in asked) == 1
