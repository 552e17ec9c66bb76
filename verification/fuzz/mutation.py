"""Scenes that a number makes: a tiny scene with a few of its values changed, moderately, to extremes, or to what makes no sense."""

from __future__ import annotations

import copy
import random
import tomllib
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

from fuzz.base_scenes import TEXTS

from isomortar.scene.toml_text import dump

#: Where a value stands: the table or list that holds it, and its key or number there.
Place = tuple[Any, Any]
#: What would only make a sound scene long is kept small; beyond these sizes the program must refuse, or it is a moderate number.
MOST = {"steps": (3, None), "max_iterations": (60, None), "max_augmentations": (60, None), "elements": (4, 2000), "order": (3, 11)}
EXTREMES: tuple[Any, ...] = (
    *(0, -1, 1, 64, 65, 10_000_000, 2**31, 2**53 + 1, 2**63 - 1, -(2**63), 10**30),
    *(0.0, -0.0, 0.5, -1.0, 0.4999999, 1e-12, 1e6, 1e12, 1e20, 1e-160, 1e156, 5e-324, 1e-300, 1e300, -1e300),
    *(float("nan"), float("inf"), float("-inf")),
)
STRANGERS: tuple[Any, ...] = (
    *(
        "",
        "x",
        ".",
        "nan",
        "ä\u2028\u202e",
        "a" * 5000,
        "../../etc",
        "block.w0",
        "bowl.w1",
        "block.q7",
        "uzawa",
        "paper",
        "L",
        "N",
        "every",
    ),
    *(True, False, [], [[]], ["x"], ["x", "x"], ["x", "y", "z"], {}, {"x": 1}, {"a": {"b": []}}),
    *([1.0], [0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 2.0, 3.0, 4.0]),
)


def mutated(number: int) -> bytes:
    """The scene file of a number."""
    chance = random.Random(number)
    data = tomllib.loads(chance.choice(TEXTS))
    for _ in range(chance.choice((1, 1, 2, 3))):
        with suppress(AttributeError, IndexError, KeyError, TypeError):  # what was to be changed is no longer there
            chance.choices(MUTATIONS, WEIGHTS)[0](data, chance)
    _limit(data)
    text = dump(data).encode()
    return text if chance.random() > 0.03 else _garbled(text, chance)


def numbers(data: Any) -> Iterator[Place]:
    """Places of all numbers."""
    return (place for place in _places(data) if isinstance(_at(place), int | float) and not isinstance(_at(place), bool))


def _places(data: Any) -> Iterator[Place]:
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        yield data, key
        yield from _places(value)


def _at(place: Place) -> Any:
    return place[0][place[1]]


def _put(place: Place, value: Any) -> None:
    place[0][place[1]] = value


def _any(data: Any, chance: random.Random) -> Place:
    return chance.choice(list(_places(data)))


def _moderate(data: Any, chance: random.Random) -> None:
    """A number by some decades, or a little."""
    place = chance.choice([p for p in numbers(data) if p[1] != "format"])
    value, decades = _at(place), chance.choice((0.1, 0.5, 3.0))
    changed = value * 10.0 ** chance.uniform(-decades, decades) if value else chance.uniform(-0.5, 0.5) * 10.0 ** chance.uniform(-3, 0)
    _put(place, max(1, round(changed)) if isinstance(value, int) else changed)


def _refined(data: Any, chance: random.Random) -> None:
    """Another order, number of elements or family of a body."""
    mesh = chance.choice(list(data["bodies"].values())).setdefault("mesh", {})
    key = chance.choice(("order", "elements", "family"))
    choices = {"order": (1, 2, 3), "elements": (1, 2, 3, 4), "family": ("N", "L")}[key]
    mesh[key] = [chance.choice(choices) for _ in range(3)]


def _settled(data: Any, chance: random.Random) -> None:
    """Another sound way of solving."""
    table = data.setdefault("solver", {})
    key, values = chance.choice(
        (
            ("method", ("monolithic", "uzawa")),
            ("slip_sum", ("local", "paper")),
            ("penalty_normal", (1.0, 10.0, 1e4, 1e6)),
            ("penalty_tangential", (0.1, 1.0, 1e3)),
            ("newton_tolerance", (1e-12, 1e-10, 1e-6)),
            ("path_tolerance", (0.01, 0.1)),
            ("measures", ([], ["halving"], ["forgiving", "margin"], ["keeping"])),
        )
    )
    table[key] = chance.choice(values)


def _stiffened(data: Any, chance: random.Random) -> None:
    """A rigid body, or one no longer."""
    body = chance.choice(list(data["bodies"].values()))
    body["rigid"] = not body.get("rigid", False)
    body.pop("material", None)


def _mirrored(data: Any, chance: random.Random) -> None:
    """Only one side of a plane, through the middle of a box most often; elements and motions that go with it, or do not."""
    k, body = chance.randrange(3), chance.choice(list(data["bodies"].values()))
    lower, upper = (body["geometry"].get(end, [0.0, 0.0, 0.0]) for end in ("lower", "upper"))
    place = chance.choice((0.0, *[0.5 * (lower[k] + upper[k])] * 4))
    data.setdefault("symmetry", {})["xyz"[k]] = place
    if chance.random() < 0.8:
        for other in data["bodies"].values():
            other.setdefault("mesh", {}).setdefault("elements", [1, 1, 1])[k : k + 1] = [2]  # an error where it is a table by now
        for stage in data["stages"]:
            for motion in stage.get("motions", {}).values():
                motion.setdefault("translate", [0.0, 0.0, 0.0])[k : k + 1] = [0.0]


def _extreme(data: Any, chance: random.Random) -> None:
    _put(chance.choice(list(numbers(data))), chance.choice(EXTREMES))


def _opposite(data: Any, chance: random.Random) -> None:
    place = chance.choice(list(numbers(data)))
    _put(place, -_at(place))


def _dropped(data: Any, chance: random.Random) -> None:
    table, key = _any(data, chance)
    del table[key]


def _exchanged(data: Any, chance: random.Random) -> None:
    """Two values swapped."""
    one, other = _any(data, chance), _any(data, chance)
    a, b = copy.deepcopy(_at(one)), copy.deepcopy(_at(other))
    _put(one, b)
    _put(other, a)


def _other_type(data: Any, chance: random.Random) -> None:
    place = _any(data, chance)
    value = _at(place)
    _put(place, chance.choice((str(value), [value], chance.choice(STRANGERS), chance.choice(EXTREMES))))


def _doubled(data: Any, chance: random.Random) -> None:
    """An entry once more, in a list or under a name of its own."""
    table, key = _any(data, chance)
    if isinstance(table, list):
        table.insert(key, copy.deepcopy(table[key]))
    else:
        table[chance.choice(("again", key + "2", "ü", "a b", ""))] = copy.deepcopy(table[key])


def _elsewhere(data: Any, chance: random.Random) -> None:
    """Another face of one of the bodies."""
    faces = [f"{body}.{face}" for body in data["bodies"] for face in ("u0", "u1", "v0", "v1", "w0", "w1")]
    places = [p for p in _places(data) if p[1] in ("slave", "master", "face")]
    if places:
        _put(chance.choice(places), chance.choice(faces))


MUTATIONS: tuple[Callable[[Any, random.Random], None], ...] = (
    *(_moderate, _refined, _settled, _stiffened, _mirrored, _extreme, _opposite),
    *(_dropped, _exchanged, _other_type, _doubled, _elsewhere),
)
WEIGHTS = (30, 12, 8, 6, 6, 15, 5, 5, 4, 8, 4, 6)


def _limit(data: Any) -> None:
    """Keep small what would only take long."""
    for table, key in list(_places(data)):
        if isinstance(table, dict) and key in MOST:
            most, refused = MOST[key]
            entries = table[key] if isinstance(table[key], list) else [table[key]]
            kept = [_smaller(value, most, refused) for value in entries]
            table[key] = kept if isinstance(table[key], list) else kept[0]


def _smaller(value: Any, most: int, refused: int | None) -> Any:
    counts = isinstance(value, int) and not isinstance(value, bool) and value > most and (refused is None or value < refused)
    return most if counts else value


def _garbled(text: bytes, chance: random.Random) -> bytes:
    """Bytes changed, taken out, or the end missing."""
    at, what = chance.randrange(len(text)), chance.randrange(3)
    if what == 0:
        return text[:at]
    return text[:at] + (bytes([chance.randrange(256)]) if what == 1 else b"") + text[at + chance.choice((1, 1, 40)) :]
