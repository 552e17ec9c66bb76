"""Records of the kernel's interface: none is made of an array of another size, rank, type or layout, or of what is no number."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np
from fuzz.calls import MASTERS, sound

from isomortar.errors import IsomortarError
from isomortar.harness import Bound, case

#: What is taken as it is: tables that have a size of their own; coordinates and slips of points without a foot, which mean nothing.
TAKEN = {
    *("Pattern.start longer", "FunctionArrays.nodes longer", "FunctionArrays.values longer", "FrictionArrays.parameters longer"),
    *("Projections.xi not a number", "Projections.slip not a number"),
}
#: Records of iterates, which may end in no number: that is looked at in the balance.
ITERATES = ("Control", "Law", "Response")


def records(value: Any) -> Iterator[Any]:
    """All records among some values, those within others too."""
    if isinstance(value, dict):
        for entry in value.values():
            yield from records(entry)
    elif is_dataclass(value):
        yield value
        for field in fields(value):
            yield from records(getattr(value, field.name))


def spoiled(array: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """What an array must not be."""
    yield "longer", np.concatenate([array, array[-1:]])
    yield "of another type", array.astype(np.float32 if array.dtype == np.float64 else np.int64)
    yield "of another rank", array[None].copy()
    if array.dtype == np.float64 and array.size:
        other = array.copy()
        other.flat[other.size // 2] = np.nan
        yield "not a number", other


@case(
    claim="No routine of the kernel's interface takes a record with an array that is longer than its others say, of another type or rank, "
    "or, but for iterates, that holds what is no number: it is refused when it is made, or when it is given to the routine.",
    tier="gate",
    grid={"master": list(MASTERS)},
    bounds={
        "taken": Bound(0.0, 0.0, "definition: arrays that are taken"),
        "tried": Bound(at_least=150.0, reason="definition: or nothing is tried"),
    },
)
def arrays(master: str) -> dict[str, float]:
    """How many of all arrays of all records that a run gives to routines."""
    tried, taken = set[str](), set[str]()
    for routine, arguments in sound(master).values():
        for name, value in arguments.items():
            for record in records(value):
                for field, how, other in spoiled_fields(record):
                    said = f"{type(record).__name__}.{field} {how}"
                    tried.add(said)
                    try:
                        made = replace(record, **{field: other})
                        if record is value:
                            routine(**(copy.deepcopy(arguments) | {name: made}))
                        taken.add(said)
                    except IsomortarError:
                        pass
    beyond = {said for said in taken - TAKEN if not (said.startswith(ITERATES) and said.endswith("not a number"))}
    return {"taken": float(len(beyond)), "tried": float(len(tried))}


def spoiled_fields(record: Any) -> Iterator[tuple[str, str, np.ndarray]]:
    """Of each array of a record what it must not be: its name, how it is spoiled, and the array."""
    for field in fields(record):
        array = getattr(record, field.name)
        if isinstance(array, np.ndarray) and array.size:
            for how, other in spoiled(array):
                yield field.name, how, other
