"""What pydantic found wrong, as one `InputError` that names the key of the scene file and what it allows."""

from __future__ import annotations

import re
import reprlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import date, time
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from isomortar.errors import InputError


def input_error(error: ValidationError, data: Any) -> InputError:
    """The first fault as an `InputError`, further ones as lines of its message.

    Parameters
    ----------
    error : ValidationError
    data : dict
        What was validated.
    """
    found = error.errors()
    inside = {fault["loc"][:depth] for fault in found for depth in range(len(fault["loc"]))}
    found = [fault for fault in found if fault["type"] != "too_short" or fault["loc"] not in inside]  # of entries that are wrong
    faults = list(dict.fromkeys((_field(fault, data), _sentence(fault)) for fault in found))  # one value, three directions
    field, message = faults[0]
    return InputError("\n".join([message, *(f"{path}: {sentence}" for path, sentence in faults[1:])]), field)


@contextmanager
def located(path: str) -> Iterator[None]:
    """Puts `path` before the field that an `InputError` from inside names."""
    try:
        yield
    except InputError as error:
        raise InputError(error.message, f"{path}.{error.field}" if error.field else path) from error


def _field(fault: ErrorDetails, data: Any) -> str:
    """Dotted path of the key, list entries by their name where they have one."""
    location = list(fault["loc"])
    if fault["type"] == "unknown_key":
        location.append(fault["ctx"]["key"])
    elif fault["type"].startswith("union_tag"):
        location.append(fault["ctx"]["discriminator"].strip("'"))
    parts: list[str] = []
    for depth, key in enumerate(location):
        if isinstance(data, dict) and (key in data or depth == len(location) - 1) and key != "[key]":
            parts.append(str(key))
            data = data.get(key)
        elif isinstance(data, Sequence) and not isinstance(data, str) and isinstance(key, int) and key < len(data):
            data = data[key]
            name = data.get("name") if isinstance(data, dict) else None
            parts.append(name if isinstance(name, str) else str(key))
        elif isinstance(data, Sequence) and fault["type"] == "missing":
            parts.append(str(key))
        # What is left over are pydantic's own labels (a union's tag) and places in a value given once for all directions.
    return ".".join(parts)


#: What Pydantic's types are called in a scene file.
_KINDS = {
    "dict_type": "a table",
    "model_type": "a table",
    "model_attributes_type": "a table",
    "dataclass_type": "a table",
    "tuple_type": "a list",
    "list_type": "a list",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "float_type": "a number",
    "bool_type": "true or false",
    "string_type": "a text, in quotes",
}
#: Texts that TOML takes for a number or a truth value where they have no quotes.
_WITHOUT_QUOTES = re.compile(r"true|false|[+-]?\d+(\.\d+)?([eE][+-]?\d+)?")


#: Keys of lists that hold tables, and of tables that hold others by name, as a scene file writes these.
_WRITTEN = {("stages",): "[[stages]]", ("record", "curves"): "[[record.curves]]"} | {
    (name,): f"[{name}.NAME]" for name in ("materials", "bodies", "contacts", "supports", "loads")
}

#: Tables that are easily taken for something else, as a scene file writes them in one line, by their keys.
IN_BRACES = {
    "plane": "{ point = [0, 0, 0], normal = [0, 0, 1] }",
    "force": "{ z = -10 }",
    "mesh": "{ order = 2, elements = [4, 4, 2] }",
    "geometry": '{ kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }',
    "motion": "{ translate = [0, 0, -0.1], rotate = 10 }",
}


#: Names of things that are easily put in their place, or in a list, by their keys.
NAMES = {
    "material": 'a name, as "rubber" of a table [materials.rubber]',
    "slave": 'a face, as "block.w0", or a list of them',
    "master": 'a face, as "block.w0", or a list of them',
    "face": 'a face, as "block.w0"',
}


def _allowed(kind: str, place: tuple[int | str, ...]) -> str:
    """What may stand at a place, and how it is written where it is easily taken for something else."""
    key = "motion" if place[-2:-1] == ("motions",) else str(place[-1]) if len(place) > 2 else ""  # bodies.mesh is a name
    if kind != "a table":
        return NAMES.get(key, kind)
    return f"{kind}, as {IN_BRACES[key]}" if key in IN_BRACES else kind


def _given(value: Any) -> str:
    """A value as a scene file has it, not too much of it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list) and value and all(isinstance(entry, dict) for entry in value):
        return "a list of tables"
    return value.isoformat() if isinstance(value, date | time) else reprlib.repr(value)


def _sentence(fault: ErrorDetails) -> str:
    given, message = _given(fault["input"]), fault["msg"]
    match fault["type"]:
        case kind if kind in _KINDS:
            quoted = isinstance(fault["input"], str) and _WITHOUT_QUOTES.fullmatch(fault["input"])
            written = _WRITTEN.get(tuple(map(str, fault["loc"]))) if given in ("a table", "a list of tables") else None
            tables = f": each of its tables begins with {written}" if written else ""
            if quoted or tables:
                return f"is {given}; allowed: {_KINDS[kind]}{tables or ', without quotes'}"
            return f"is {given}; allowed: {_allowed(_KINDS[kind], fault['loc'])}"
        case "missing" | "union_tag_not_found":
            return "is missing, but must be given"
        case "union_tag_invalid":
            return f"is {fault['ctx']['tag']!r}; allowed: {fault['ctx']['expected_tags']}"
        case "string_pattern_mismatch":
            letters = "letters" if fault["loc"] == ("name",) else "letters from a to z"
            return f"name {given} has other characters than are allowed: {letters}, digits, _ and -"
        case "too_short" | "too_long":
            return f"has {fault['ctx']['actual_length']} entries; allowed: " + message.split(" should have ")[1].split(" after")[0]
    if message.startswith("Input should be "):
        allowed = re.sub(r"\d{16,}", lambda digits: f"{int(digits[0]):g}", message.removeprefix("Input should be "))
        return f"is {given}; allowed: {allowed}"
    return message
