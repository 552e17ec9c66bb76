"""Corrections by kept factors learn from the iterations before, and change what they cost alone."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from isomortar.geometry.patch import FloatArray
from isomortar.march.simulation import Simulation
from isomortar.model.constants import MAX_SECANTS
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve import monolithic
from isomortar.solve.bordered import Correction, from_lengths, in_lengths
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import StepResult
from isomortar.solve.secants import Secants
from isomortar.solve.uzawa import _PositionNewton

RANDOM = np.random.default_rng(7)
SIZE = MAX_SECANTS + 4
TANGENT = np.diag(np.arange(1.0, SIZE + 1.0)) + 0.1 * RANDOM.standard_normal((SIZE, SIZE))
KEPT = np.linalg.inv(TANGENT + 0.1 * RANDOM.standard_normal((SIZE, SIZE)))


def loaded(count: int) -> np.ndarray:
    """Some right-hand sides."""
    return np.random.default_rng(3).standard_normal((count, SIZE))


def taught(loads: np.ndarray) -> Secants:
    """What is known after these loads, one after the other."""
    secants = Secants()
    for load in loads:
        secants.learn(np.linalg.solve(TANGENT, load), KEPT @ load)
    return secants


@pytest.mark.parametrize("count", [1, 3, MAX_SECANTS])
def test_a_load_made_of_the_last_ones_is_solved_whole(count: int) -> None:
    loads = loaded(count)
    load = np.linspace(1.0, 2.0, count) @ loads
    np.testing.assert_allclose(taught(loads).improved(KEPT @ load), np.linalg.solve(TANGENT, load), rtol=1e-10)


def test_what_is_across_all_that_is_known_is_left_as_it_is() -> None:
    loads = loaded(3)
    basis = np.linalg.svd((KEPT @ loads.T).T)[2]
    np.testing.assert_allclose(taught(loads).improved(basis[5]), basis[5], atol=1e-14)


def test_the_oldest_of_too_many_is_forgotten() -> None:
    loads = loaded(MAX_SECANTS + 1)
    np.testing.assert_array_equal(taught(loads).improved(KEPT @ loads[0]), taught(loads[1:]).improved(KEPT @ loads[0]))
    assert np.abs(taught(loads).improved(KEPT @ loads[0]) - np.linalg.solve(TANGENT, loads[0])).max() > 1e-3


def test_of_what_is_known_twice_the_last_one_counts() -> None:
    first, secants = loaded(1)[0], Secants()
    secants.learn(first, first)
    secants.learn(2.0 * first, (1.0 + 1e-9) * first)
    np.testing.assert_allclose(secants.improved(first), 2.0 * first, rtol=1e-8)


def test_nothing_is_learnt_of_nothing() -> None:
    secants = Secants()
    secants.learn(np.zeros((2, 3)), np.zeros((2, 3)))
    np.testing.assert_array_equal(secants.improved(np.ones((2, 3))), np.ones((2, 3)))


@pytest.mark.parametrize("active", [True, False])
def test_a_correction_in_lengths_is_the_same_again(active: bool) -> None:
    scale, random = np.array([2.0, 30.0, 0.04]), np.random.default_rng(5)
    correction = Correction(random.random((4, 3)), (random.random((5, 3)),))
    borders: Any = [SimpleNamespace(column_scale=scale) if active else None]
    lengths = in_lengths(correction.positions, correction.multipliers, borders)
    np.testing.assert_allclose(lengths[12:15] * (scale if active else 1.0), correction.multipliers[0][0])
    again = from_lengths(lengths, correction, borders)
    np.testing.assert_array_equal(again.positions, correction.positions)
    np.testing.assert_allclose(again.multipliers[0], correction.multipliers[0], rtol=1e-15)


def pressed() -> Problem:
    """A block that is pressed onto a plane in two load steps of many augmentations."""
    changes = ["bodies.block.mesh.elements=[3,3,2]", "stages.press.steps=2", 'solver.method="uzawa"', "solver.penalty_growth=1.0"]
    return Scene.load("press", [*changes, "solver.augmentation_tolerance=1e-4"]).problem()


def summed(results: list[StepResult], name: str) -> int:
    """Of all load steps."""
    return sum(result.counters[name] for result in results)


def test_iterations_need_fewer_solves_and_come_to_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    one = list(Simulation(pressed()).run())
    monkeypatch.setattr(Secants, "improved", lambda _, correction: correction)
    other = list(Simulation(pressed()).run())
    assert summed(one, "solves") < 0.8 * summed(other, "solves")
    np.testing.assert_allclose(one[-1].state.positions, other[-1].state.positions, atol=1e-7)


def test_an_augmentation_begins_with_the_forces_that_the_last_one_ended_with() -> None:
    problem = pressed()
    results, (body,) = list(Simulation(problem).run()), problem.deformable
    augmentations = sum(len(result.augmentations) for result in results)
    assert augmentations > 20
    computed = summed(results, "solid points") / body.points - summed(results, "solid tangents")
    assert computed <= summed(results, "solid residuals") - augmentations + 2 * len(results)


def test_what_is_known_of_one_tangent_is_not_used_with_another(monkeypatch: pytest.MonkeyPatch) -> None:
    """Corrections are the same in the end, whatever is known: solves alone would be more, or fewer."""
    since, most = [0], [0]
    factorised, learnt, used = Equilibrium.correction, Secants.learn, Secants.improved

    def correction(*arguments: Any) -> FloatArray:
        since[0] = 0
        return factorised(*arguments)

    def learn(secants: Secants, way: FloatArray, correction: FloatArray) -> None:
        since[0] += 1
        learnt(secants, way, correction)

    def improved(secants: Secants, correction: FloatArray) -> FloatArray:
        assert len(secants._known) == min(since[0], MAX_SECANTS)
        most[0] = max(most[0], since[0])
        return used(secants, correction)

    monkeypatch.setattr(Equilibrium, "correction", correction)
    monkeypatch.setattr(Secants, "learn", learn)
    monkeypatch.setattr(Secants, "improved", improved)
    results = list(Simulation(pressed()).run())
    assert most[0] > MAX_SECANTS
    assert summed(results, "factorisations") > len(results)


def test_the_step_by_a_tangent_is_learnt_where_supports_stood(monkeypatch: pytest.MonkeyPatch) -> None:
    """Within one augmentation: of a correction that has a motion of supports in it forces are not made."""
    events: list[str] = []
    tangent, kept, learn, held = Equilibrium.correction, Equilibrium.kept_correction, Secants.learn, _PositionNewton.held

    def corrected(equilibrium: Equilibrium, balance: Any, laws: Any, prescribed: FloatArray, *more: Any) -> FloatArray:
        events.append("moved" if np.any(prescribed) else "tangent")
        return tangent(equilibrium, balance, laws, prescribed, *more)

    def heard(name: str, function: Any) -> Any:
        return lambda *arguments: (events.append(name), function(*arguments))[1]

    monkeypatch.setattr(Equilibrium, "correction", corrected)
    monkeypatch.setattr(Equilibrium, "kept_correction", heard("kept", kept))
    monkeypatch.setattr(Secants, "learn", heard("learn", learn))
    monkeypatch.setattr(_PositionNewton, "held", heard("held", held))
    list(Simulation(pressed()).run())
    said = " ".join(events)
    assert "tangent kept learn" in said
    assert "moved tangent" in said
    assert "moved kept learn" not in said
    assert "tangent kept kept" not in said
    assert "held kept learn" not in said


def test_other_factors_are_taught_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """What steps by earlier ones told is of these."""
    monkeypatch.setattr(monolithic, "solve_bordered", lambda *_: (None, None))
    newton = SimpleNamespace(_equilibrium=None, _secants=(before := Secants()))
    iterate = SimpleNamespace(balance=None, laws=None, targets=None)
    monolithic._BorderedNewton._solved(newton, iterate, None, True)  # type: ignore[arg-type]
    assert newton._secants is not before
