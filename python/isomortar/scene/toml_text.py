"""Scenes as TOML text: the standard library reads it and does not write it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

_BARE = re.compile("[A-Za-z0-9_-]+")


def dump(data: Mapping[str, Any]) -> str:
    """A dictionary as TOML text: tables and lists of tables with headings of their own, all else in a line each."""
    return "\n".join(_lines(data, "")) + "\n"


def in_a_line(value: Any) -> str:
    """A value as TOML text in one line, as the value of an override: text, number, truth value, list or table."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(name)} = {in_a_line(entry)}" for name, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(in_a_line, value)) + "]"
    if isinstance(value, float):
        return repr(float(value))  # NumPy's as well; "inf" and "nan" are TOML's, too
    return json.dumps(value, ensure_ascii=False).replace("\x7f", r"\u007f")


def _lines(table: Mapping[str, Any], path: str) -> Iterator[str]:
    """Lines of a table whose heading is written: its values first, as what stands below a heading belongs to that."""
    tables = {name: value for name, value in table.items() if isinstance(value, Mapping) or _are_tables(value)}
    yield from (f"{_key(name)} = {in_a_line(value)}" for name, value in table.items() if name not in tables)
    for name, value in tables.items():
        inner = path + _key(name)
        for entry in value if isinstance(value, list) else [value]:
            lines = [*_lines(entry, f"{inner}.")]
            if isinstance(value, list) or not lines or lines[0]:  # a table of tables needs no heading
                yield from ("", f"[[{inner}]]" if isinstance(value, list) else f"[{inner}]")
            yield from lines


def _are_tables(value: Any) -> bool:
    """Whether a value is a list of tables, and has some."""
    return isinstance(value, list) and bool(value) and all(isinstance(entry, Mapping) for entry in value)


def _key(name: str) -> str:
    """A key as TOML has it: between quotes where it is not letters and digits alone."""
    return name if _BARE.fullmatch(name) else in_a_line(name)
