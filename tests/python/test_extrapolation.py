"""The first guess of a load increment, on from the last one: what it saves, where it is taken, and that it decides nothing."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from isomortar.errors import ConvergenceError
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve import monolithic
from isomortar.solve.extrapolation import multipliers_ahead, positions_ahead, with_rates
from isomortar.solve.monolithic import EXTRAPOLATION
from isomortar.solve.record import ContactRates, ContactState, State, StepResult
from isomortar.told.during.unstable import FORCES

#: Bodies touch in the second of four steps, and slide on in four more.
OVERRIDES = (
    *("bodies.slave.mesh.elements=[2,2,1]", "bodies.master.mesh.elements=[3,3,1]"),
    *("stages.press.steps=4", "stages.press.motions.top.translate=[0,0,-0.08]", "stages.slide.steps=4"),
)


def block(*overrides: str) -> Problem:
    return Scene.load("block", [*OVERRIDES, *overrides]).problem()


def without(problem: Problem) -> Problem:
    measures = tuple(measure for measure in problem.settings.measures if measure != EXTRAPOLATION)
    return replace(problem, settings=replace(problem.settings, measures=measures))


def extrapolated(results: list[StepResult]) -> list[int]:
    """Load steps whose iteration began with an extrapolation."""
    return [r.step for r in results if any(EXTRAPOLATION in a.iterations[0].notes for a in r.augmentations)]


def test_a_stage_that_goes_on_takes_fewer_tangents_and_comes_to_the_same() -> None:
    one, other = (list(Simulation(problem).run()) for problem in (block(), without(block())))
    assert [r.contacts[0].active > 0 for r in one] == [False, *[True] * 7]
    assert extrapolated(one) == [2, 4, 6, 7, 8], "not where a stage or a contact has just begun"
    assert extrapolated(other) == []
    tangents = [sum(r.counters["factorisations"] for r in results[2:]) for results in (one, other)]
    assert tangents[0] <= 0.9 * tangents[1]
    for a, b in zip(one, other, strict=True):
        np.testing.assert_allclose(a.state.positions, b.state.positions, atol=1e-8)


def test_what_goes_on_as_it_did_needs_no_solve_at_all() -> None:
    """Bodies that are apart: one of them goes on. At the end of the stage it is asked whether they are stable, by a tangent of there."""
    problem = block("stages.press.motions.top.translate=[0,0,-0.02]")
    results = list(Simulation(problem).run())
    assert [r.counters["solves"] for r in results[:4]] == [1, 0, 0, 1 + len(problem.deformable) * FORCES]


@pytest.mark.parametrize("wrong", ["folded", "not converged"])
def test_a_guess_that_leads_nowhere_is_given_up(monkeypatch: pytest.MonkeyPatch, wrong: str) -> None:
    """The increment is solved from its start then, as if nothing had been tried."""
    reference = list(Simulation(without(block())).run())
    if wrong == "folded":
        monkeypatch.setattr(monolithic, "positions_ahead", lambda start, *_: np.zeros_like(start.positions))
    else:

        def ahead(*_: object) -> None:
            raise ConvergenceError("as the test says")

        monkeypatch.setattr(monolithic._BorderedNewton, "ahead", ahead)
    results = list(Simulation(block()).run())
    assert extrapolated(results) == []
    for a, b in zip(results, reference, strict=True):
        assert (a.cuts, a.state.positions.tobytes()) == (b.cuts, b.state.positions.tobytes())


def some_state(positions: float, pressure: float) -> State:
    nowhere = np.zeros((0, 2)), np.zeros(0, dtype=np.int32)
    return State(np.full((2, 3), positions), (ContactState(np.full(3, pressure), np.full((3, 2), -pressure), *nowhere),))


def test_rates_are_changes_by_length() -> None:
    after = with_rates(some_state(1.0, 2.0), some_state(1.5, 3.0), 4.25, 0.25)
    assert after.rates is not None
    assert after.rates.time == 4.25
    assert np.array_equal(after.rates.positions, np.full((2, 3), 2.0))
    assert np.array_equal(after.rates.contacts[0].pressure, np.full(3, 4.0))
    assert np.array_equal(after.rates.contacts[0].traction, np.full((3, 2), -4.0))
    held = np.array([[True, False, False], [False, False, False]])
    supports = SimpleNamespace(placed=lambda positions, time: np.where(held, 10.0 * time, positions))
    ahead = positions_ahead(after, after.rates, supports, 4.75)  # type: ignore[arg-type]
    assert np.array_equal(ahead, [[47.5, 2.5, 2.5], [2.5, 2.5, 2.5]])


@pytest.mark.parametrize(("before", "after"), [(0.0, 1.0), (1.0, 0.0)])
def test_a_contact_that_begins_or_ends_has_no_rates(before: float, after: float) -> None:
    assert with_rates(some_state(0.0, before), some_state(1.0, after), 1.0, 1.0).rates is None


def test_multipliers_that_no_condition_tells_stay() -> None:
    """And no pressure pulls."""
    start = some_state(0.0, 1.0).contacts[0]
    loose = np.array([[False, False, False], [True, False, False], [False, True, True]])
    pair = SimpleNamespace(loose=lambda _: loose, sliding=lambda _: np.full((3, 2), 7.0))
    rates = ContactRates(np.array([-4.0, 1.0, 1.0]), np.ones((3, 2)))
    pressure, traction = multipliers_ahead(pair, start, rates, 0.5)  # type: ignore[arg-type]
    assert np.array_equal(pressure, [0.0, 1.0, 1.5])
    assert np.array_equal(traction, [[-0.5, -0.5], [-0.5, -0.5], [7.0, 7.0]])


@pytest.mark.parametrize(("before", "after"), [((0.0, 1.0, 1.0), (1.0, 1.0, 1.0)), ((1.0, 2.0, 0.0), (0.0, 0.0, 3.0)), ((0.0,) * 3,) * 2])
def test_a_front_that_moves_is_no_beginning(before: tuple[float, ...], after: tuple[float, ...]) -> None:
    """Constraints close and open all along a contact's way; nor does one begin that is open before and after."""
    old, new = (
        replace(state, contacts=(replace(state.contacts[0], pressure=np.array(pressure)),))
        for state, pressure in ((some_state(0.0, 0.0), before), (some_state(1.0, 0.0), after))
    )
    rates = with_rates(old, new, 1.0, 0.5).rates
    assert rates is not None
    assert np.array_equal(rates.contacts[0].pressure, 2.0 * (np.array(after) - before))


@pytest.mark.parametrize("first", [True, False])
def test_one_contact_of_two_that_begins_is_enough(first: bool) -> None:
    (goes_on,), (begins,) = some_state(0.0, 1.0).contacts, some_state(0.0, 0.0).contacts
    before = replace(some_state(0.0, 1.0), contacts=(begins, goes_on) if first else (goes_on, begins))
    assert with_rates(before, replace(some_state(1.0, 1.0), contacts=(goes_on, goes_on)), 1.0, 1.0).rates is None
