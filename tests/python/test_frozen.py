"""Records of `frozen` are what frozen dataclasses of the standard library are, in all that anyone can ask of them."""

from __future__ import annotations

import inspect
import pickle
from collections.abc import Callable
from copy import copy, deepcopy
from dataclasses import FrozenInstanceError, asdict, dataclass, field, fields, replace
from functools import cached_property
from typing import Any, ClassVar

import pytest

from isomortar._frozen import frozen
from isomortar.model.settings import SolverSettings


def family(freeze: Callable[..., Any]) -> dict[str, Any]:
    """Classes with all that fields can have, made frozen by one way or the other."""

    @freeze
    class Base:
        """Base."""

        count: int
        names: list[str] = field(default_factory=list)
        kinds: ClassVar[int] = 3

    @freeze
    class Derived(Base):
        """Derived."""

        size: float = 2.0
        area: float = field(init=False)

        def __post_init__(self) -> None:
            object.__setattr__(self, "area", self.size**2)

        @cached_property
        def twice(self) -> float:
            return 2 * self.size

    @freeze
    class Plain:
        """Plain."""

        a: int
        b: tuple[int, ...] = ()

    @freeze(eq=False)
    class Single:
        """Single."""

        a: int

        def __repr__(self) -> str:
            return "one of its kind"

    return {kind.__name__: kind for kind in (Base, Derived, Plain, Single)}


def standard(kind: type | None = None, *, eq: bool = True) -> Any:
    return dataclass(frozen=True, eq=eq) if kind is None else dataclass(frozen=True)(kind)


OURS, STANDARD = family(frozen), family(standard)
GIVEN: list[tuple[str, tuple[Any, ...], dict[str, Any]]] = [
    ("Base", (1,), {}),
    ("Base", (1, ["x"]), {}),
    ("Base", (), {"names": ["y"], "count": 2}),
    ("Derived", (1,), {"size": 3.0}),
    ("Derived", (1, [], 4.0), {}),
    ("Plain", (1, (2, 3)), {}),
    ("Plain", (), {"a": 1}),
    ("Single", (5,), {}),
]


@pytest.mark.parametrize(("name", "given", "named"), GIVEN)
def test_records_are_those_of_the_standard_library(name: str, given: tuple[Any, ...], named: dict[str, Any]) -> None:
    ours, theirs = OURS[name](*given, **named), STANDARD[name](*given, **named)
    assert repr(ours) == repr(theirs)
    assert asdict(ours) == asdict(theirs)
    assert list(vars(ours)) == list(vars(theirs))
    assert [f.name for f in fields(ours)] == [f.name for f in fields(theirs)]
    assert vars(copy(ours)) == vars(deepcopy(ours)) == vars(theirs)
    again = (OURS[name](*given, **named), STANDARD[name](*given, **named))
    assert (ours == again[0]) == (theirs == again[1]) == (name != "Single")
    assert ours != theirs
    changed = {fields(ours)[0].name: 7}
    assert asdict(replace(ours, **changed)) == asdict(replace(theirs, **changed))


@pytest.mark.parametrize("name", OURS)
def test_signatures_and_places_are_those_of_the_standard_library(name: str) -> None:
    ours, theirs = (list(inspect.signature(kinds[name]).parameters.values()) for kinds in (OURS, STANDARD))
    assert [(p.name, p.kind, p.annotation) for p in ours] == [(p.name, p.kind, p.annotation) for p in theirs]
    assert [p.default is p.empty for p in ours] == [p.default is p.empty for p in theirs]
    assert OURS[name].__match_args__ == STANDARD[name].__match_args__
    assert OURS[name].__doc__ == STANDARD[name].__doc__


def test_hashes_are_of_what_is_equal() -> None:
    for kinds in (OURS, STANDARD):
        assert hash(kinds["Plain"](1, (2,))) == hash(kinds["Plain"](1, (2,))) != hash(kinds["Plain"](1, (3,)))
        assert len({kinds["Single"](1), kinds["Single"](1)}) == 2
        with pytest.raises(TypeError, match="unhashable"):
            hash(kinds["Base"](1))


def test_each_record_has_its_own_defaults() -> None:
    first, second = OURS["Base"](1), OURS["Base"](1)
    first.names.append("x")
    assert second.names == []


@pytest.mark.parametrize(
    ("given", "named", "words"),
    [((), {}, "'a'"), ((1, (), 3), {}, "too many"), ((1,), {"a": 1}, "multiple values"), ((1,), {"c": 1}, "unexpected keyword argument")],
)
def test_what_does_not_fit_is_refused(given: tuple[Any, ...], named: dict[str, Any], words: str) -> None:
    with pytest.raises(TypeError, match=words):
        OURS["Plain"](*given, **named)
    with pytest.raises(TypeError):
        STANDARD["Plain"](*given, **named)


def test_a_record_does_not_change_but_for_what_it_keeps() -> None:
    record = OURS["Derived"](1)
    for change in (lambda: setattr(record, "size", 1.0), lambda: setattr(record, "other", 1.0), lambda: delattr(record, "size")):
        with pytest.raises(FrozenInstanceError, match=r"Derived\.\w+ does not change"):
            change()
    assert (record.size, record.twice, record.twice) == (2.0, 4.0, 4.0)


def test_records_go_from_process_to_process() -> None:
    record = SolverSettings(max_cuts=3)
    assert pickle.loads(pickle.dumps(record)) == record
