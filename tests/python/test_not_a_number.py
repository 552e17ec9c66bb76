"""A number that is not one, wherever it comes from, ends in an error and never in a result."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from isomortar import _bindings
from isomortar._sparse import SparseLU
from isomortar.errors import ConvergenceError, IsomortarError
from isomortar.geometry.patch import FloatArray
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.distances import apart, largest, ratio
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.monolithic import _BorderedIterate
from isomortar.solve.system import CheckedSystem
from isomortar.solve.timing import Ledger

SCENE = """
format = 1
[bodies.block]
geometry = { kind = "bowl", half_width = 0.5, bottom = 0.0, rise = 0.1, top = 0.5 }
mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
[contacts.floor]
slave = "block.w0"
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
[supports.top]
face = "block.w1"
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0.02, 0, -0.05]
[solver]
max_cuts = 1
"""


def spoiled(function: Callable[..., Any], field: str | None, after: int) -> Callable[..., Any]:
    """A function of the kernel whose result, or a field of it, has one entry that is not a number from some call on."""
    calls = 0

    def spoil(array: FloatArray) -> FloatArray:
        copy = np.array(array, dtype=np.float64)
        copy.flat[np.argmax(np.abs(copy))] = np.nan
        return copy

    def call(*arguments: Any, **others: Any) -> Any:
        nonlocal calls
        calls += 1
        found = function(*arguments, **others)
        if calls <= after:
            return found
        return spoil(found) if field is None else replace(found, **{field: spoil(getattr(found, field))})

    return call


@pytest.mark.parametrize("method", ["monolithic", "uzawa"])
@pytest.mark.parametrize("after", [1, 4])
@pytest.mark.parametrize(
    ("name", "field"),
    [
        ("control_quantities", "gap"),
        ("control_quantities", "weight"),
        ("control_quantities", "metric"),
        ("control_quantities", "slip"),
        ("augmented_multipliers", "pressure"),
        ("augmented_multipliers", "traction"),
    ],
)
def test_contact_that_is_not_a_number(monkeypatch: pytest.MonkeyPatch, name: str, field: str, after: int, method: str) -> None:
    problem = Scene.from_toml(SCENE.replace("max_cuts", f'method = "{method}"\nmax_cuts')).problem()
    monkeypatch.setattr(_bindings, name, spoiled(getattr(_bindings, name), field, after))
    with pytest.raises(IsomortarError):
        list(Simulation(problem).run())


@pytest.mark.parametrize("method", ["monolithic", "uzawa"])
def test_solution_that_is_not_a_number(monkeypatch: pytest.MonkeyPatch, method: str) -> None:
    problem = Scene.from_toml(SCENE.replace("max_cuts", f'method = "{method}"\nmax_cuts')).problem()
    monkeypatch.setattr(SparseLU, "solve", spoiled(SparseLU.solve, None, 1))
    with pytest.raises(ConvergenceError, match="leaves nan of its right-hand side"):
        list(Simulation(problem).run())


@pytest.mark.parametrize("method", ["monolithic", "uzawa"])
def test_solution_of_another_system(monkeypatch: pytest.MonkeyPatch, method: str) -> None:
    problem = Scene.from_toml(SCENE.replace("max_cuts", f'method = "{method}"\nmax_cuts')).problem()
    solve = SparseLU.solve
    monkeypatch.setattr(SparseLU, "solve", lambda self, right, **others: 1.5 * solve(self, right, **others))
    with pytest.raises(ConvergenceError, match=r"leaves 5\.0e-01 of its right-hand side"):
        list(Simulation(problem).run())


def test_poor_solutions_are_refined(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = Scene.from_toml(SCENE).problem()
    right = [result.reactions[0].force for result in Simulation(problem).run()]
    solve = SparseLU.solve
    monkeypatch.setattr(SparseLU, "solve", lambda self, b, refine=2: (1.0 if refine else 1.001) * solve(self, b, refine=refine))
    monkeypatch.setattr(CheckedSystem, "_left", spied := Spy(CheckedSystem._left))
    for force, result in zip(right, Simulation(problem).run(), strict=True):
        np.testing.assert_allclose(result.reactions[0].force, force, rtol=1e-9, atol=1e-12)
    assert max(spied.found) > 1e-4 > 1e-9 > min(spied.found)


class Spy:
    """A function that keeps what it returned."""

    def __init__(self, function: Callable[..., float]) -> None:
        self.function, self.found = function, list[float]()

    def __get__(self, system: Any, owner: type) -> Callable[..., float]:
        def call(*arguments: Any) -> float:
            self.found.append(self.function(system, *arguments))
            return self.found[-1]

        return call


def test_measures_of_convergence() -> None:
    nan = float("nan")
    assert np.isnan(ratio(nan, 1.0))
    assert not ratio(1.0, nan) <= 1.0
    assert ratio(0.0, 0.0) == 0.0
    assert ratio(1.0, 0.0) == float("inf")
    for place in range(3):
        distances = [(0.1, 0.2), (0.3, 0.1), (0.2, 0.3)]
        distances[place] = (nan, nan)
        assert np.isnan(largest(distances)).all()
    assert largest([]) == (0.0, 0.0)


@pytest.mark.parametrize(("left", "refused"), [(0.05, False), (0.2, True)])
def test_a_solution_without_a_digit_is_refused(monkeypatch: pytest.MonkeyPatch, left: float, refused: bool) -> None:
    system = Scene.from_toml(SCENE).problem()
    monkeypatch.setattr(CheckedSystem, "_left", lambda *_: left)
    if refused:
        with pytest.raises(IsomortarError):
            list(Simulation(system).run())
    else:
        assert len(list(Simulation(system).run())) == 2


def test_tractions_count_for_no_less_than_a_hundredth_of_what_friction_bears() -> None:
    equilibrium = Equilibrium(Scene.from_toml(SCENE.replace("plane =", "friction = 0.5\nplane =")).problem(), Ledger())
    (pair,), state = equilibrium.pairs, equilibrium.initial_state()
    control = pair.kinematics(state.positions, state.contacts[0]).control
    control = replace(control, square=np.ones_like(control.square), metric=np.tile([1.0, 0.0, 1.0], (len(control.square), 1)))
    pressure = np.linspace(1.0, 2.0, len(control.weight))
    traction = np.column_stack([pressure, -pressure])
    assert apart(pair, control, (pressure, 3.0 * traction), (pressure, traction)) == pytest.approx((0.0, 2.0))
    assert apart(pair, control, (1.5 * pressure, traction), (pressure, traction)) == pytest.approx((0.5, 0.0))
    small = 1e-6 * traction  # friction bears half of the pressures: a hundredth of that counts
    assert apart(pair, control, (pressure, 3.0 * small), (pressure, small))[1] == pytest.approx(2e-6 * 2.0**0.5 / 0.005)


@pytest.mark.parametrize(("pressure", "traction"), [(np.nan, 1.0), (1.0, np.nan)])
def test_what_is_left_of_contact_conditions_is_no_number_where_one_is_none(pressure: float, traction: float) -> None:
    iterate = _BorderedIterate(cast(Balance, None), 0.1, (), (), pressure, traction)
    assert np.isnan(iterate.merit)
    assert "nan off the contact conditions" in iterate.left
