"""Every argument of the kernel's routines, and every part of one, with something strange in its place: by list, not by chance."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from functools import partial
from typing import Any

from fuzz.calls import MASTERS, sound
from fuzz.child import Wrong

from isomortar.errors import InputError
from isomortar.harness import Bound, case

#: Nothing, text, containers, numbers that are none or of another kind.
_STRANGERS: tuple[Any, ...] = (None, "x", [], (), {}, 2.5, True, 1j, float("nan"), float("inf"), 1e300)


def parts(place: str, value: Any) -> Iterator[tuple[str, Callable[[Any], Any]]]:
    """What a value consists of, itself last: where each part is, and what makes the value with another in its place."""
    if is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            for inner, made in parts(f"{place}.{field.name}", getattr(value, field.name)):
                yield inner, partial(_with, value, field.name, made)
    yield place, lambda stranger: stranger


def _with(value: Any, name: str, made: Callable[[Any], Any], stranger: Any) -> Any:
    return replace(value, **{name: made(stranger)})


def ending(routine: Callable[..., Any], arguments: dict[str, Any], name: str, made: Callable[[Any], Any], stranger: Any) -> str:
    """How a call ends with a stranger in an argument: `refused` by a sentence that names the argument, or `right`, as it is none."""
    given = copy.deepcopy(arguments)
    try:
        routine(**given | {name: made(stranger)})
    except InputError as error:
        if not error.field:
            raise Wrong(f"{routine.__name__}, {stranger!r}: names no argument: {error}") from error
        return "refused"
    return "right"


@case(
    claim="No argument of the kernel's routines, and no part of one, takes a value of another kind: each is refused by name.",
    grid={"master": tuple(MASTERS)},
    bounds={"refused": Bound(at_least=0.97, at_most=1.0, reason="definition: flags take True, real numbers whole ones and large ones")},
)
def strangers(master: str) -> dict[str, float]:
    """Share of the strangers that are refused; one that ends otherwise is an error that names the routine, the part and the stranger."""
    counts: Counter[str] = Counter()
    for routine, arguments in sound(master).values():
        for name, value in arguments.items():
            for place, made in parts(name, value):
                for stranger in _STRANGERS:
                    try:
                        counts[ending(routine, arguments, name, made, stranger)] += 1
                    except Exception as error:
                        raise Wrong(f"{routine.__name__}, {place} = {stranger!r}: {type(error).__name__}: {error}") from error
    return {"refused": counts["refused"] / counts.total()}
