"""Every argument of the kernel's routines, and every part of one, with something strange in its place: by list, not by chance."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import partial
from math import isfinite
from typing import Any

from fuzz.calls import MASTERS, STRANGERS, sound
from fuzz.child import Wrong

from isomortar.errors import InputError
from isomortar.harness import Bound, case


@dataclass(frozen=True)
class Part:
    """An argument or a part of one: where it is, its annotation, and what makes the argument with something else in its place."""

    place: str
    kind: str
    made: Callable[[Any], Any]

    def takes(self, stranger: Any) -> bool:
        """Whether a stranger is none here: nothing where there may be nothing, a truth value, a number."""
        if stranger is None:
            return "None" in self.kind
        if isinstance(stranger, bool):
            return self.kind == "bool"
        return self.kind == "float" and isinstance(stranger, int | float) and isfinite(stranger)


def parts(place: str, kind: str, value: Any) -> Iterator[Part]:
    """What a value consists of, itself last."""
    if is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            for inner in parts(f"{place}.{field.name}", str(field.type), getattr(value, field.name)):
                yield Part(inner.place, inner.kind, partial(_with, value, field.name, inner.made))
    yield Part(place, kind, lambda stranger: stranger)


def _with(value: Any, name: str, made: Callable[[Any], Any], stranger: Any) -> Any:
    return replace(value, **{name: made(stranger)})


def refused(routine: Callable[..., Any], arguments: dict[str, Any], part: Part, stranger: Any) -> bool:
    """Whether a call with a stranger is refused by a sentence that names the argument."""
    name, given = part.place.partition(".")[0], copy.deepcopy(arguments)
    try:
        routine(**given | {name: part.made(stranger)})
    except InputError as error:
        if not error.field:
            raise Wrong(f"{routine.__name__}, {part.place} = {stranger!r}: names no argument: {error}") from error
        return True
    except Exception as error:
        raise Wrong(f"{routine.__name__}, {part.place} = {stranger!r}: {type(error).__name__}: {error}") from error
    return False


@case(
    claim="No argument of the kernel's routines, and no part of one, takes a value of another kind: each is refused by name.",
    grid={"master": tuple(MASTERS)},
    bounds={
        "taken": Bound(0.0, 0.0, "definition: strangers that are taken for what they are not"),
        "tried": Bound(at_least=2000, reason="definition: each part of each argument was looked at"),
    },
)
def strangers(master: str) -> dict[str, float]:
    """How many there are; one whose call ends otherwise is an error that names the routine, the part and the stranger."""
    taken = tried = 0
    for routine, arguments in sound(master).values():
        for name, value in arguments.items():
            for part in parts(name, str(routine.__annotations__[name]), value):
                for stranger in STRANGERS:
                    if not part.takes(stranger) and not _is_whole(stranger):
                        tried += 1
                        taken += not refused(routine, arguments, part, stranger)
    return {"taken": float(taken), "tried": float(tried)}


def _is_whole(stranger: Any) -> bool:
    """Whole numbers are numbers of elements and of places, too: these are for chance."""
    return isinstance(stranger, int) and not isinstance(stranger, bool)
