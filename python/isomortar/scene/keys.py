"""Keys of a scene, as paths that an override can set: from the schema, with the names that the scene has."""

from __future__ import annotations

import json
from collections.abc import Iterator
from importlib import resources
from typing import Any

from isomortar.scene.source import parse, read_source

#: Part of a JSON schema.
Schema = dict[str, Any]


def settable_keys(source: str | None) -> Iterator[tuple[str, str]]:
    """Path and meaning of every value that an override of a scene can set.

    Parameters
    ----------
    source : str or None
        A scene file, or the name of a bundled scene; None: keys that any scene has.

    Raises
    ------
    InputError
        There is none, or it is no TOML.
    """
    text = read_source(source)[0] if source else ""
    schema = json.loads((resources.files("isomortar.scene") / "scene.schema.json").read_text(encoding="utf-8"))
    yield from _below(schema, schema["$defs"], parse(text, source or ""), ())


def _below(schema: Schema, tables: dict[str, Schema], content: Any, path: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Those of a table and its parts, or the single value itself."""
    table = _resolved(schema, tables, content)
    if isinstance(content, list) and _is_table(_resolved(table.get("items", {}), tables, {})):
        parts = [(str(entry.get("name", number)), table["items"], entry) for number, entry in enumerate(content)]
    elif _is_table(table):
        parts = list(_parts(table, content if isinstance(content, dict) else {}, tables))
    else:
        yield ".".join(path), schema.get("description", "")
        return
    for name, part, entry in parts:
        yield from _below(part, tables, entry, (*path, name))


def _parts(table: Schema, content: dict[str, Any], tables: dict[str, Schema]) -> Iterator[tuple[str, Schema, Any]]:
    """Name, schema and content of each part of a table; tables that are left out are parts where they have a default."""
    for key, part in table.get("properties", {}).items():
        if key in content or "default" in part or not _is_table(_resolved(part, tables, {})):
            yield key, part, content.get(key)
    for part in (*table.get("patternProperties", {}).values(), table.get("additionalProperties")):
        if isinstance(part, dict):
            yield from ((name, part, entry) for name, entry in content.items())


def _resolved(schema: Schema, tables: dict[str, Schema], content: Any) -> Schema:
    """The schema itself, or the table that it refers to: of several kinds the one that the content is of."""
    kinds = schema.get("discriminator", {}).get("mapping", {})
    kind = content.get("kind") if isinstance(content, dict) else None
    reference = kinds.get(kind, next(iter(kinds.values()), None)) or schema.get("$ref")
    return tables[reference.removeprefix("#/$defs/")] if reference else schema


def _is_table(schema: Schema) -> bool:
    return schema.get("type") == "object"
