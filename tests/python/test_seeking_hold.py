"""Bodies that seek what holds them: tried once the way without help has failed, where contact may hold, and it is that way that is told."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from isomortar.errors import FoldedElementError, IsomortarError, LostProjectionError
from isomortar.model.constants import STEADY
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.method import FAILURES, Increment, Method
from isomortar.solve.record import Observer, State

START = State(np.zeros((1, 3)), ())


class Way(Method):
    """Calls what it is given, and notes with what."""

    def __init__(self, may_hold: bool) -> None:
        problem = SimpleNamespace(settings=None)
        super().__init__(SimpleNamespace(problem=problem, contact_may_hold=lambda _: may_hold), Observer())  # type: ignore[arg-type]
        self.called: list[bool] = []

    def advance(self, start: State, time: float, step: int) -> Increment:
        raise NotImplementedError

    def seek(self, without: Exception | None, with_help: Exception | None) -> bool:
        def solve(helped: bool) -> bool:
            self.called.append(helped)
            error = with_help if helped else without
            if error is not None:
                raise error
            return helped

        return self._seeking_hold(START, solve)


def failure(kind: type[IsomortarError], words: str) -> IsomortarError:
    return kind(words, 0) if kind is not FAILURES[0] else kind(words)


def test_what_needs_no_help_has_none() -> None:
    way = Way(True)
    assert not way.seek(None, None)
    assert way.called == [False]


@pytest.mark.parametrize("kind", FAILURES)
def test_any_failure_seeks_help_where_contact_may_hold(kind: type[IsomortarError]) -> None:
    way = Way(True)
    assert way.seek(failure(kind, "without"), None)
    assert way.called == [False, True]
    way = Way(False)
    with pytest.raises(kind, match="without"):
        way.seek(failure(kind, "without"), None)
    assert way.called == [False]


@pytest.mark.parametrize("other", FAILURES)
@pytest.mark.parametrize("kind", FAILURES)
def test_what_fails_with_help_as_well_is_told_as_it_was_without(kind: type[IsomortarError], other: type[IsomortarError]) -> None:
    with pytest.raises(kind, match=r"^without$"):
        Way(True).seek(failure(kind, "without"), failure(other, "with"))


def test_mistakes_are_no_failures() -> None:
    with pytest.raises(ValueError, match=r"^with$"):
        Way(True).seek(LostProjectionError("without", 0), ValueError("with"))
    with pytest.raises(ValueError, match=r"^without$"):
        Way(True).seek(ValueError("without"), FoldedElementError("with", 0))


@pytest.mark.parametrize("moduli", [(1.0, 1e6), (1e6, 1.0), (0.0, 5.0)])
def test_each_loose_body_is_held_a_little_by_its_own_stiffness(moduli: tuple[float, float]) -> None:
    """A rigid one, which has none, by that of the others; the tangent that is given stays as it is."""
    points = {"one": np.arange(2), "two": np.arange(2, 5)}
    stiffness = np.random.default_rng(1).uniform(0.1, 1.0, (5, 3, 3)) * np.repeat(moduli, [2, 3])[:, None, None]
    given = stiffness.copy()
    equilibrium = SimpleNamespace(
        loose=[[SimpleNamespace(name=name)] for name in points],
        solid=SimpleNamespace(diagonal=np.arange(5)),
        numbering=SimpleNamespace(points=points),
    )
    added = Equilibrium._steadied(equilibrium, stiffness) - given  # type: ignore[arg-type]
    assert np.array_equal(stiffness, given)
    for own in points.values():
        largest = given[own].max() or given.max()
        np.testing.assert_allclose(added[own], np.tile(STEADY * largest * np.eye(3), (len(own), 1, 1)), rtol=1e-6)
