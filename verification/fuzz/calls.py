"""Fuzzed calls of the kernel: wrong sizes, layouts, types, ranges and numbers end in an exception that names the argument."""

from __future__ import annotations

import copy
import functools
import random
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from fuzz.child import Ending, Wrong, tally, tried

from isomortar import _bindings
from isomortar._condensed import CondensedFactors, SymmetricPattern
from isomortar._sparse import SparseLU
from isomortar.errors import InputError, IsomortarError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Those of factors.
_FACTORS = ("analyse", "factorise", "solve", "order", "condense", "factorise_condensed", "renew_condensed", "solve_condensed")
#: Every routine of the kernel's interface.
ROUTINES = (
    *("add_body", "material_stress", "surface_functions", "slave_tables", "project_points", "control_quantities", "augmented_multipliers"),
    *("friction_radius", "contact_forces", "contact_blocks", "multiplier_rows", "condense_multipliers", "find_places", "add_values"),
    "squares_times",
    *_FACTORS,
)
#: Tiny scenes that call them all but `surface_functions`, for each kind of master, and slip sums: condensed multipliers are
#: Uzawa's, the paper's sum has neighbours. As few iterations as there may be: under valgrind each is a third of a second.
_SCENE = """
format = 1
bodies.upper.geometry = {{ kind = "box", lower = [0.2, 0.2, 0], upper = [0.8, 0.8, 0.5] }}
bodies.upper.mesh = {{ elements = [2, 2, 1], order = [2, 2, 1] }}
{lower}
contacts.interface = {{ slave = "upper.w0", {master}, friction = 0.3, quadrature = [3, 3] }}
supports.top.face = "upper.w1"
stages = [{{ name = "press", steps = 1, motions.top.translate = [0.001, 0.002, -0.005] }}]
solver = {{ method = "uzawa", slip_sum = "{slip_sum}", augmentation_tolerance = 0.1 }}
"""
_LOWER = """
bodies.lower.geometry = {{ kind = "box", lower = [0, 0, -0.5], upper = [1, 1, 0] }}
bodies.lower.mesh = {{ elements = [3, 3, 1], family = "{}", order = [{}, {}, 1] }}
supports.base.face = "lower.w0"
"""
MASTERS = {
    "plane": ("", "plane = { point = [0, 0, 0] }", "paper"),
    "closest": (_LOWER.format("N", 2, 2), 'master = "lower.w1"', "local"),
    "averaged": (_LOWER.format("L", 1, 1), 'master = "lower.w1", projection = "averaged"', "local"),
}
_INTEGERS = (-1, 0, 1, 2, 7, 63, 65, 1000, 2**31 - 1, -(2**31), 2**40)
_REALS = (0.0, -1.0, 1.0, 1e300, -1e300, 5e-324, float("nan"), float("inf"), float("-inf"))
#: What no argument is: nothing, text, containers, numbers that are none or of another kind.
STRANGERS: tuple[Any, ...] = (None, "x", [], (), {}, 2.5, True, 1j, -1, 0, 10**30, float("nan"), float("inf"), 1e300)


@functools.cache
def sound(master: str) -> dict[str, tuple[Callable[..., Any], dict[str, Any]]]:
    """Each routine with arguments as a run on a kind of master gives them, those of its last call with all of them."""
    heard: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {}
    with ExitStack() as stack:
        for name in ROUTINES[: -len(_FACTORS)]:
            stack.enter_context(patch.object(_bindings, name, _listener(name, heard)))
        lower, place, slip_sum = MASTERS[master]
        last = list(Simulation(Scene.from_toml(_SCENE.format(lower=lower, master=place, slip_sum=slip_sum)).problem()).run())[-1]
        assert last.contacts[0].active > 0
    face = heard["slave_tables"][1]
    points = np.random.default_rng(1).random((5, 2))
    heard["surface_functions"] = _bindings.surface_functions, {"patch": face["patch"], "axis": 3, "side": 0, "xi": points}
    gradients = 0.1 * np.random.default_rng(2).standard_normal((4, 3, 3))
    heard["material_stress"] = _bindings.material_stress, {"material": heard["add_body"][1]["material"], "gradient": gradients}
    heard |= _sparse() | _condensed()
    assert heard.keys() == {*ROUTINES}
    return heard


def _listener(name: str, heard: dict[str, tuple[Callable[..., Any], dict[str, Any]]]) -> Callable[..., Any]:
    routine = getattr(_bindings, name)
    names = routine.__code__.co_varnames[: routine.__code__.co_argcount]

    def call(*given: Any) -> Any:
        arguments = {name: value for name, value in zip(names, given, strict=False) if value is not None}
        if name not in heard or len(arguments) >= len(heard[name][1]):  # with a tangent, where there are calls without
            heard[name] = routine, copy.deepcopy(arguments)
        return routine(*given)

    return call


def _sparse() -> dict[str, tuple[Callable[..., Any], dict[str, Any]]]:
    start, column = np.array([0, 2, 4, 5], dtype=np.int64), np.array([0, 1, 0, 1, 2], dtype=np.int64)
    values = np.array([2.0, 1.0, 1.0, 3.0, 4.0])

    def analyse(indptr: Any, indices: Any, ordering: Any) -> Any:
        return SparseLU(indptr, indices, ordering=ordering).factorise(values).solve(np.ones(3))

    def factorise(values: Any, rcond_min: Any) -> Any:
        return SparseLU(start, column).factorise(values, rcond_min=rcond_min).solve(np.ones(3))

    def solve(b: Any, refine: Any) -> Any:
        return SparseLU(start, column).factorise(values).solve(b, refine=refine)

    return {
        "analyse": (analyse, {"indptr": start, "indices": column, "ordering": "amd"}),
        "factorise": (factorise, {"values": values, "rcond_min": 1e-13}),
        "solve": (solve, {"b": np.ones((3, 2)), "refine": 2}),
    }


def _condensed() -> dict[str, tuple[Callable[..., Any], dict[str, Any]]]:
    start, column = np.array([0, 2, 4, 5], dtype=np.int64), np.array([0, 1, 0, 1, 2], dtype=np.int64)
    values, on_face, rows = np.array([2.0, 1.0, 1.0, 3.0, 4.0]), np.array([False, True, False]), np.arange(3, dtype=np.int64)
    added = np.asfortranarray([[1.0, 2.0], [-2.0, 1.0]])

    def order(indptr: Any, indices: Any, ordering: Any) -> Any:
        return SymmetricPattern(indptr, indices).fill_reducing(ordering)

    def condense(indptr: Any, indices: Any, on_face: Any, order: Any) -> Any:
        return CondensedFactors(SymmetricPattern(indptr, indices), on_face, order)

    def factorise_condensed(values: Any, added: Any, rcond_min: Any) -> Any:
        return condense(start, column, on_face, rows).factorise(values, added, rcond_min=rcond_min)

    def renew_condensed(added: Any, rcond_min: Any) -> Any:
        factors = condense(start, column, on_face, rows)
        factors.factorise(values, np.eye(2, order="F"))
        return factors.renew(added, rcond_min=rcond_min)

    def solve_condensed(b: Any) -> Any:
        factors = condense(start, column, on_face, rows)
        factors.factorise(values, added)
        return factors.solve(b)

    return {
        "order": (order, {"indptr": start, "indices": column, "ordering": "amd"}),
        "condense": (condense, {"indptr": start, "indices": column, "on_face": on_face, "order": rows}),
        "factorise_condensed": (factorise_condensed, {"values": values, "added": added, "rcond_min": 1e-13}),
        "renew_condensed": (renew_condensed, {"added": added, "rcond_min": 1e-13}),
        "solve_condensed": (solve_condensed, {"b": np.ones(4)}),
    }


def called(number: int, _: Path) -> Ending:
    """Call a routine with one of its arguments changed, or a field of one."""
    chance = random.Random(number)
    master = list(MASTERS)[number // len(ROUTINES) % len(MASTERS)]
    routine, arguments = copy.deepcopy(sound(master)[ROUTINES[number % len(ROUTINES)]])
    name = chance.choice(list(arguments))
    place = name
    try:
        place, arguments[name] = _changed_part(name, arguments[name], chance)
        routine(**arguments)
    except InputError as error:
        if not error.field:
            raise Wrong(f"{routine.__name__}, {place}: names no argument: {error}") from error
        return Ending("refused", f"{routine.__name__}, {place}: {error}")
    except IsomortarError as error:
        return Ending("stopped", f"{routine.__name__}, {place}: {error}")
    except Exception as error:
        raise Wrong(f"{routine.__name__}, {place}: {type(error).__name__}: {error}") from error
    return Ending("right", f"{routine.__name__}, {place}")


def _changed_part(place: str, value: Any, chance: random.Random) -> tuple[str, Any]:
    """The value with a part of it changed, and what that part is called; a dataclass is a stranger now and then."""
    if not is_dataclass(value) or isinstance(value, type) or chance.random() < 0.05:
        return place, _changed(value, chance)
    part = chance.choice(fields(value)).name
    place, changed = _changed_part(f"{place}.{part}", getattr(value, part), chance)
    return place, replace(value, **{part: changed})


def _changed(value: Any, chance: random.Random) -> Any:
    if isinstance(value, np.ndarray) and chance.random() < 0.9:
        return chance.choice((_retyped, _reshaped, _resized, _rearranged, _other_entry, _other_entry, _other_entry, _shuffled))(
            value, chance
        )
    return chance.choice(STRANGERS)


def _retyped(value: Any, chance: random.Random) -> Any:
    return value.astype(chance.choice((np.float32, np.float64, np.int16, np.int32, np.int64, np.uint64, np.complex128, bool, object, "S3")))


def _reshaped(value: Any, chance: random.Random) -> Any:
    return chance.choice((value.ravel(), value[None], value[..., None], np.swapaxes(value, 0, -1), value.reshape(-1, 1)))


def _resized(value: Any, chance: random.Random) -> Any:
    axis, more = chance.randrange(value.ndim), np.zeros(value.shape, value.dtype)
    fewer = np.ascontiguousarray(np.take(value, range(chance.randrange(value.shape[axis] + 1)), axis=axis))
    return chance.choice((fewer, np.concatenate([value, more], axis=axis), np.concatenate([value, value[:1]])))


def _rearranged(value: Any, chance: random.Random) -> Any:
    doubled = np.repeat(value, 2, axis=-1)
    return chance.choice((np.asfortranarray(value), doubled[..., ::2], value[::-1], value.byteswap().view(value.dtype.newbyteorder())))


def _other_entry(value: Any, chance: random.Random) -> Any:
    if value.size and value.dtype.kind == "b":
        value.flat[chance.randrange(value.size)] ^= True
    elif value.size:
        numbers: tuple[Any, ...] = _INTEGERS if value.dtype.kind == "i" else _REALS
        limits = np.iinfo(value.dtype) if value.dtype.kind == "i" else np.finfo(value.dtype)
        number = chance.choice(numbers)
        value.flat[chance.randrange(value.size)] = np.clip(number, limits.min, limits.max) if value.dtype.kind == "i" else number
    return value


def _shuffled(value: Any, chance: random.Random) -> Any:
    order = list(range(len(value)))
    chance.shuffle(order)
    return np.ascontiguousarray(value[order])


def endings(first: int, count: int) -> Iterator[tuple[int, Ending]]:
    """How the calls of some numbers end."""
    for master in MASTERS:
        sound(master)
    for number in range(first, first + count):
        yield number, tried(functools.partial(called, number))


@case(
    claim="Calls of the kernel with a wrong size, rank, layout or type, with numbers that are none or too large, with places that do not "
    "exist end in an exception that names the argument: no signal, no exception of another kind.",
    tier=lambda count: "gate" if count < 1000 else "nightly",
    grid={"count": (150, 6000)},
    bounds={
        "right": Bound(at_least=0.05, at_most=0.7, reason="definition: some changes are sound, such as other knots"),
        "refused": Bound(at_least=0.3, at_most=1.0, reason="definition: most changes make no sense"),
        "stopped": Bound(at_most=0.2, reason="definition: a matrix or positions that are none"),
    },
)
def calls(count: int) -> dict[str, float]:
    """Shares of the endings; one that is wrong is an error that names its number."""
    return tally(endings(0, count), "python verification/fuzz_at_length.py calls")
