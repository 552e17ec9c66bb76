"""What is made of a problem is made once, and goes with it."""

import gc
import weakref

import pytest

import isomortar
from isomortar.errors import InputError
from isomortar.model.entities import Face, Problem
from isomortar.model.remembered import remembered
from isomortar.model.sheet import Sheet


def test_each_part_of_each_problem_is_looked_at_once() -> None:
    seen: list[tuple[str, str]] = []

    @remembered
    def words(problem: Problem, part: str) -> str:
        seen.append((problem.name, part))
        return f"{problem.name} {part}"

    problems = [isomortar.Scene.load(name).problem() for name in ("press", "twist")]
    for _ in range(2):
        assert [words(problem, part) for problem in problems for part in "ab"] == ["press a", "press b", "twist a", "twist b"]
    assert len(seen) == 4


def test_sides_are_forgotten_with_their_problem() -> None:
    problem = isomortar.Scene.load("press").problem()
    side = problem.contacts[0].slave
    assert Sheet.of(problem, side) is Sheet.of(problem, side)
    kept = weakref.ref(problem)
    del problem
    gc.collect()
    assert kept() is None


def test_errors_are_raised_every_time() -> None:
    @remembered
    def fails(problem: Problem, place: Face) -> None:
        raise InputError(f"{problem.name}, {place.words}: no")

    problem = isomortar.Scene.load("press").problem()
    for _ in range(2):
        with pytest.raises(InputError, match=r"press, block\.u0: no"):
            fails(problem, Face("block", "u0"))
