"""Bodies keep their tangent within a Newton loop as long as it misses little (theory 5.24), and their factors with it."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from isomortar._condensed import CondensedFactors, SymmetricPattern
from isomortar.errors import FoldedElementError, SingularSystemError
from isomortar.geometry.patch import FloatArray
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve import newton as newton_module
from isomortar.solve.condensed import Bodies
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.newton import KEPT_BODIES, Newton, _may_leave
from isomortar.solve.record import IterationRecord, StepResult
from isomortar.solve.system import entries
from isomortar.solve.timing import Ledger
from isomortar.solve.uzawa import _PositionNewton

METHODS = ["monolithic", "uzawa"]
#: A pad between a floor and a plate that a force presses down.
PLATE = """
format = 1
bodies.pad.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }
bodies.pad.mesh = { elements = [5, 5, 3], order = [2, 2, 2] }
materials.soft = { young = 1.0, poisson = 0.3 }
bodies.pad.material = "soft"
contacts.floor = { slave = "pad.w0", plane = { point = [0, 0, 0.01] } }
supports.top = { face = "pad.w1", force = { z = -0.3 } }
supports.side = { face = "pad.u0", components = ["x"] }
stages = [{ name = "press", steps = 1 }]
"""


def pressed(*more: str) -> Problem:
    """A block that is pressed onto a plane: of its face more and more is in contact."""
    return Scene.load("press", ["bodies.block.mesh.elements=[6,6,3]", "stages.press.steps=2", *more]).problem()


def loops(results: list[StepResult]) -> Iterator[tuple[IterationRecord, ...]]:
    """The iterations of every Newton loop."""
    for result in results:
        for augmentation in result.augmentations:
            yield augmentation.iterations


class Watched:
    """How often bodies were kept: where they missed a share at most of what was out of balance, and the whole factors were not refused."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.missed, self.share, self.wanting, self.kept, self.refused = np.inf, 0.0, False, 0, 0
        solve, tangent, kept, measured = Newton.solve, Newton._by_tangent, Newton._by_kept_factors, Equilibrium.left_by_bodies

        def solving(*arguments: Any) -> Any:
            self.missed = np.inf  # a loop begins with a tangent of its own
            return solve(*arguments)

        def by_tangent(newton: Any, iterate: Any, prescribed: Any, iteration: int, keep_bodies: bool) -> Any:
            assert keep_bodies == (self.missed <= self.share and not self.wanting)
            self.missed, self.wanting, self.kept = np.inf, False, self.kept + keep_bodies
            return tangent(newton, iterate, prescribed, iteration, keep_bodies)

        def by_kept(*arguments: Any) -> Any:
            found = kept(*arguments)
            self.wanting = found is None
            self.refused += self.wanting
            return found

        def left(equilibrium: Equilibrium, before: Balance, after: Balance) -> float:
            self.missed = measured(equilibrium, before, after)
            return self.missed

        def share(*iterates: Any) -> float:
            self.share = _may_leave(*iterates)
            return self.share

        monkeypatch.setattr(newton_module, "_may_leave", share)
        monkeypatch.setattr(Newton, "solve", solving)
        monkeypatch.setattr(Newton, "_by_tangent", by_tangent)
        monkeypatch.setattr(Newton, "_by_kept_factors", by_kept)
        monkeypatch.setattr(Equilibrium, "left_by_bodies", left)


@pytest.mark.parametrize(("left", "after", "share"), [(0.1, b"a", 0.7), (0.11, b"a", 0.2), (0.01, b"b", 0.2)])
def test_more_may_be_left_near_a_solution_where_states_stay(left: float, after: bytes, share: float) -> None:
    before, following = (SimpleNamespace(merit=left, states=states) for states in (b"a", after))
    assert _may_leave(before, following) == share  # type: ignore[arg-type]


@pytest.mark.parametrize("method", METHODS)
def test_bodies_are_kept_while_they_miss_little(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    watched = Watched(monkeypatch)
    measures = 'solver.measures=["forgiving","margin","halving","keeping","extrapolation"]'  # a reversal solves twice for an iteration
    results = list(Simulation(pressed(f'solver.method="{method}"', measures)).run())
    assert not any(result.cuts for result in results)
    kept = sum(KEPT_BODIES in iteration.notes for loop in loops(results) for iteration in loop)
    assert watched.kept == kept > 1
    assert watched.refused > 0
    assert sum(result.counters["factorisations"] - result.counters["solid tangents"] for result in results) == kept


@pytest.mark.parametrize("method", METHODS)
def test_they_change_what_it_costs_alone(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    kept = list(Simulation(pressed(f'solver.method="{method}"')).run())
    monkeypatch.setattr(Equilibrium, "left_by_bodies", lambda *_: np.inf)
    never = list(Simulation(pressed(f'solver.method="{method}"')).run())
    assert not any(KEPT_BODIES in iteration.notes for loop in loops(never) for iteration in loop)
    tangents = [sum(result.counters["solid tangents"] for result in results) for results in (kept, never)]
    assert tangents[0] < tangents[1]
    np.testing.assert_allclose(kept[-1].state.positions, never[-1].state.positions, atol=1e-7)


def test_what_bodies_miss_is_measured_at_the_unknowns() -> None:
    """Against the tangent as a dense matrix, with a plate's unknown among them; of a smaller step they miss the square of that."""
    problem = Scene.from_toml(PLATE, overrides=['solver.method="uzawa"']).problem()
    equilibrium = Equilibrium(problem, Ledger())
    start = equilibrium.initial_state()
    equilibrium.begin(start, 1.0)
    (pair,) = equilibrium.pairs
    laws = [pair.law(np.array([100.0, 1.0]), start.contacts[0].pressure, start.contacts[0].traction)]
    before = equilibrium.balance(start.positions, start, laws)
    sources, values = equilibrium.tangents(before, laws)
    correction = equilibrium.correction(before, laws, np.zeros_like(start.positions))
    free, of = equilibrium.supports.free, equilibrium.supports.equation
    dense = np.zeros((len(free) + 1,) * 2)
    row = np.repeat(np.arange(len(sources[0].pattern.start) - 1), np.diff(sources[0].pattern.start))
    rows, columns = of.reshape(-1, 3)[row], of.reshape(-1, 3)[sources[0].pattern.column]
    np.add.at(dense, (rows[:, :, None], columns[:, None, :]), values[0])  # prescribed ones to the last row and column
    found = []
    for length in (1.0, 0.5):
        after = equilibrium.balance(before.positions + length * correction, start, laws)
        step = (after.positions - before.positions).ravel()[free]
        change = np.zeros(len(free) + 1)
        np.add.at(change, of, (after.internal - before.internal).ravel())
        missed = np.linalg.norm(change[:-1] - dense[:-1, :-1] @ step)
        found.append(equilibrium.left_by_bodies(before, after))
        assert found[-1] == pytest.approx(missed / np.linalg.norm(before.unbalanced.ravel()[free]), rel=1e-9)
        assert found[-1] > 1e-4
    assert 3.0 < found[0] / found[1] < 5.0


def test_where_bodies_have_no_factors_of_their_own_they_keep_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Bodies, "condense", lambda *_: False)
    results = list(Simulation(pressed('solver.method="uzawa"')).run())
    assert not any(KEPT_BODIES in iteration.notes for loop in loops(results) for iteration in loop)
    assert all(result.counters["factorisations"] == result.counters["solid tangents"] for result in results)


def test_kept_bodies_that_lead_nowhere_are_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same iteration with a tangent of its own, and no load increment cut."""
    corrected, tried = _PositionNewton._correct, [0]

    def correct(newton: Any, iterate: Any, prescribed: FloatArray | None, keep_bodies: bool) -> Any:
        if keep_bodies:
            tried[0] += 1
            raise FoldedElementError("element 1 is folded", 1)
        return corrected(newton, iterate, prescribed, keep_bodies)

    monkeypatch.setattr(_PositionNewton, "_correct", correct)
    results = list(Simulation(pressed('solver.method="uzawa"', "bodies.block.mesh.elements=[7,7,3]")).run())
    assert tried[0] > 2
    assert not any(result.cuts for result in results)
    assert not any(KEPT_BODIES in iteration.notes for loop in loops(results) for iteration in loop)


class Counted(CondensedFactors):
    """Counts factors of bodies, and of faces alone."""

    made: list[str]

    def _eliminate(self, values: FloatArray, added: FloatArray, rcond_min: float) -> None:
        self.made.append("bodies")
        super()._eliminate(values, added, rcond_min)

    def _eliminate_faces(self, added: FloatArray, rcond_min: float) -> None:
        self.made.append("faces")
        super()._eliminate_faces(added, rcond_min)


def counted(bodies: list[str]) -> Bodies:
    """The bodies of a pressed block, the factors of which are counted."""
    equilibrium = Equilibrium(pressed(), Ledger())
    source = equilibrium.solid_source

    def engine(pattern: SymmetricPattern, on_face: Any, order: Any) -> Counted:
        factors = Counted(pattern, on_face, order)
        factors.made = bodies
        return factors

    found = Bodies(source, entries([source], len(equilibrium.supports.free)), Ledger(), engine)
    found.blocks = equilibrium.solid.forces_and_tangent(equilibrium.numbering.reference)[1]  # type: ignore[attr-defined]
    return found


def test_factors_stay_where_the_stiffness_is_the_same_array() -> None:
    made: list[str] = []
    bodies = counted(made)
    blocks, size = bodies.blocks, len(bodies.pattern)  # type: ignore[attr-defined]
    some = np.arange(size) < 30
    for on_face, given, expected in (
        (some, blocks, "bodies"),
        (some, blocks, "faces"),
        (some, 2.0 * blocks, "bodies"),
        (~some, blocks, "bodies"),
        (~some, blocks, "faces"),
        (some, blocks, "bodies"),  # analysed anew
    ):
        bodies.act_on(on_face if on_face is some else np.roll(some, 5))
        bodies.factorise(given, np.eye(30, order="F"))
        assert made.pop() == expected
        assert not made
    vector = np.random.default_rng(1).standard_normal(size)
    bodies.factorise(2.0 * blocks, np.eye(30, order="F"))
    twice = bodies.product(vector)
    bodies.factorise(blocks, np.eye(30, order="F"))
    np.testing.assert_array_equal(2.0 * bodies.product(vector), twice)


def test_factors_that_were_refused_do_not_stay() -> None:
    made: list[str] = []
    bodies = counted(made)
    bodies.act_on(np.arange(len(bodies.pattern)) < 30)
    blocks = -bodies.blocks  # type: ignore[attr-defined]
    for _ in range(2):
        with pytest.raises(SingularSystemError):
            bodies.factorise(blocks, np.eye(30, order="F"))
    assert made == ["bodies", "bodies"]


@pytest.mark.parametrize("method", METHODS)
def test_kept_factors_that_are_no_good_are_followed_by_a_tangent(monkeypatch: pytest.MonkeyPatch, method: str) -> None:
    settings = (f'solver.method="{method}"',)
    (*_, sound) = Simulation(pressed(*settings)).run()

    def useless(*_: Any) -> FloatArray:
        raise SingularSystemError("digits are lost", -1)

    monkeypatch.setattr(Equilibrium, "solve_again", useless)
    (*_, found) = Simulation(pressed(*settings)).run()
    assert found.cuts == 0
    assert np.abs(found.state.positions - sound.state.positions).max() < 1e-6
