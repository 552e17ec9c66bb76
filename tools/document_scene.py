"""Write the keys of a scene file into docs/scene.md: ``python tools/document_scene.py``."""

from __future__ import annotations

import re
from pathlib import Path
from string import ascii_lowercase
from typing import Any

from pages import Page

from isomortar.model.entities import PLACES
from isomortar.scene import json_schema

PAGE = Path(__file__).parent.parent / "docs" / "scene.md"
_BEGIN, _END = "<!-- tables: python tools/document_scene.py -->\n", "<!-- end of the tables -->\n"
#: Headings of the tables, in the order of the page.
_HEADINGS = {
    "Material": "materials.NAME", "BodyTable": "bodies.NAME", "BoxTable": 'geometry, kind = "box"', "BowlTable": 'geometry, kind = "bowl"',
    "CapTable": 'geometry, kind = "cap"', "WedgeTable": 'geometry, kind = "wedge"', "RingTable": 'geometry, kind = "ring"',
    "SphereTable": 'geometry, kind = "sphere"', "TorusTable": 'geometry, kind = "torus"',
    "PatchTable": "bodies.NAME.patch", "MeshTable": "bodies.NAME.mesh",
    "ContactTable": "contacts.NAME", "PlaneTable": "contacts.NAME.plane", "SupportTable": "supports.NAME",
    "ForceTable": "supports.NAME.force",
    "LoadTable": "loads.NAME", "StageTable": "stages",
    "Motion": "stages.NAME.motions.SUPPORT", "SolverSettings": "solver", "RecordTable": "record", "CurveTable": "record.curves",
}  # fmt: skip


def tables() -> str:
    """A table for each table of a scene file: keys with what is allowed, the default, and the meaning."""
    schema = json_schema()
    found = schema["$defs"]
    if found.keys() != _HEADINGS.keys():
        raise ValueError(f"tables without a heading, or headings without a table: {sorted(found.keys() ^ _HEADINGS.keys())}")
    parts = [_table("The whole file", schema), *(_table(f"`{heading}`", found[name]) for name, heading in _HEADINGS.items())]
    return "\n".join(parts)


def _table(heading: str, table: dict[str, Any]) -> str:
    needed = table.get("required", ())
    rows = [
        f"| `{key}` | {_allowed(entry)} | {_default(key, entry, needed)} | {_text(entry)} |" for key, entry in table["properties"].items()
    ]
    return "\n".join(
        [f"### {heading}", "", table.get("description", ""), "", "| key | allowed | default | what |", "|---|---|---|---|", *rows, ""]
    )


def _text(entry: dict[str, Any]) -> str:
    return entry.get("description", "").replace("|", "\\|")


def _default(key: str, entry: dict[str, Any], needed: Any) -> str:
    if key in needed:
        return "must be given"
    default = entry.get("default")
    return "" if default is None or isinstance(default, dict) else f"`{_value(default)}`"


def _value(value: Any) -> str:
    """As a scene file writes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return f'"{value}"' if isinstance(value, str) else f"{value:g}"


def _allowed(entry: dict[str, Any]) -> str:
    """What may stand there, in words."""
    if "$ref" in entry:
        return f"table, [{_heading(entry)}]({_anchor(_heading(entry))})"
    if "const" in entry:
        return f"`{_value(entry['const'])}`"
    if "enum" in entry:
        return ", ".join(f"`{_value(value)}`" for value in entry["enum"])
    if "anyOf" in entry or "oneOf" in entry:
        kinds = [_allowed(kind) for kind in entry.get("anyOf") or entry["oneOf"]]
        return " or ".join(dict.fromkeys(kind for kind in kinds if kind))
    return {"array": _array, "object": _object}.get(entry.get("type", ""), _single)(entry)


def _single(entry: dict[str, Any]) -> str:
    kind = {"number": "number", "integer": "whole number", "boolean": "`true`, `false`", "string": "text"}.get(
        entry.get("type", ""), "one for all"
    )
    if "pattern" in entry:
        ends = re.search(r"\[uvw\]\[01\]\)?(?:\{(\d)\})?", entry["pattern"])
        kind = PLACES[int(ends[1] or 1) - 1] if ends else "name"
    limits = {"minimum": "at least", "exclusiveMinimum": "more than", "exclusiveMaximum": "less than", "maximum": "at most"}
    return ", ".join([kind, *(f"{words} {entry[limit]:g}" for limit, words in limits.items() if limit in entry)])


def _array(entry: dict[str, Any]) -> str:
    places = entry.get("prefixItems", [])
    if places:
        return f"list of {len(places)}" + (f" {_plural(_allowed(places[0]))}" if places[0] else "")
    few = f"{entry['minItems']} " if entry.get("minItems") == entry.get("maxItems") is not None else ""
    return f"list of {few}{_plural(_allowed(entry['items']))}"


def _plural(words: str) -> str:
    """Of a noun that stands first, with what follows it; quoted values have none."""
    rest = words.lstrip(ascii_lowercase)
    noun = words.removesuffix(rest)
    return f"{noun}s{rest}" if noun else words


def _object(entry: dict[str, Any]) -> str:
    entries = [*entry.get("patternProperties", {}).values(), entry.get("additionalProperties")]
    return (
        f"by name: {_allowed(entries[0])}"
        if "propertyNames" not in entry
        else f"{_allowed(entry['propertyNames'])}: {_allowed(entries[0])}"
    )


def _heading(entry: dict[str, Any]) -> str:
    return _HEADINGS[entry["$ref"].rpartition("/")[2]]


def _anchor(heading: str) -> str:
    """As the pages of a forge link to headings."""
    kept = "".join(letter for letter in heading.lower() if letter.isalnum() or letter in " -_")
    return "#" + kept.replace(" ", "-")


page = Page(PAGE, _BEGIN, _END, tables)

if __name__ == "__main__":
    page.write()
