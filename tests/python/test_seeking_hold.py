"""Bodies that seek what holds them: tried once the way without help has failed, where contact may hold, and it is that way that is told."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from isomortar.errors import FoldedElementError, IsomortarError, LostProjectionError
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
