"""Scenes are written as TOML that the standard library reads back as it was."""

from __future__ import annotations

import math
import tomllib
from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as some

from isomortar.scene.toml_text import dump, in_a_line

VALUES = some.recursive(
    some.text() | some.booleans() | some.integers(-(2**63), 2**63 - 1) | some.floats(allow_nan=False),
    lambda inner: some.lists(inner, max_size=3) | some.dictionaries(some.text(), inner, max_size=3),
    max_leaves=12,
)


def whole(value: Any) -> bool:
    """Whether all texts of a value are of whole letters: half ones (surrogates) are no text that a file could hold."""
    return not any("\ud800" <= letter <= "\udfff" for letter in str(value))


def kinds(value: Any) -> Any:
    """A value with what kind each part of it is, as 1, 1.0 and True are equal, and so are both zeros."""
    if isinstance(value, dict):
        return {name: kinds(entry) for name, entry in value.items()}
    if isinstance(value, list):
        return [kinds(entry) for entry in value]
    return type(value), value, math.copysign(1.0, value) if isinstance(value, float) else None


@given(some.dictionaries(some.text(), VALUES, max_size=4).filter(whole))
def test_what_is_written_is_read_back(data: dict[str, Any]) -> None:
    assert kinds(tomllib.loads(dump(data))) == kinds(data)
    assert kinds(tomllib.loads(f"x = {in_a_line(data)}")) == {"x": kinds(data)}
    assert "\n" not in in_a_line(data)


def test_numbers_of_numpy_are_numbers() -> None:
    assert tomllib.loads(dump({"x": np.float64(1e-7)})) == {"x": 1e-7}


def test_what_is_no_number_is_read_back() -> None:
    assert math.isnan(tomllib.loads(dump({"x": math.nan}))["x"])


def test_text_is_as_people_write_it() -> None:
    data = {
        "name": "a",
        "bodies": {"b": {"mesh": {"order": [2, 2]}}},
        "stages": [{"steps": 5}, {"steps": 1, "motions": {"top": {"turn": 1.5}}}],
    }
    assert dump(data).split("\n\n") == [
        'name = "a"',
        "[bodies.b.mesh]\norder = [2, 2]",
        "[[stages]]\nsteps = 5",
        "[[stages]]\nsteps = 1",
        "[stages.motions.top]\nturn = 1.5\n",
    ]
