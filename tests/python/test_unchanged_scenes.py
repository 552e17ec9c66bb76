"""The scenes that are held as they came out leave no key of a scene file out."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from isomortar.scene import schema

SCENES = Path(__file__).parents[2] / "verification" / "unchanged" / "scenes"
#: Of solvers that are not built in everywhere.
ELSEWHERE = {"engine", "compression"}


def keys(part: Any) -> Iterator[str]:
    """All keys of a table and of what is in it."""
    entries = part.items() if isinstance(part, dict) else enumerate(part) if isinstance(part, list) else ()
    for key, value in entries:
        yield str(key)
        yield from keys(value)


def test_every_key_is_in_one_of_them() -> None:
    used = {key for path in SCENES.rglob("*.toml") for key in keys(tomllib.loads(path.read_text()))}
    tables = [table for table in vars(schema).values() if isinstance(table, type) and issubclass(table, BaseModel)]
    assert sorted({field for table in tables for field in table.model_fields} - used - ELSEWHERE) == []
