"""Where a scene comes from: a file or a bundled scene, and overrides of single values."""

from __future__ import annotations

import re
import shlex
import tomllib
from collections.abc import Iterable, Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from isomortar._arguments import kind
from isomortar.errors import InputError
from isomortar.scene.text import read_text
from isomortar.scene.types import listed

_BUNDLED = resources.files("isomortar.scene") / "bundled"

#: Overrides of single values: ``KEY=VALUE`` each, or values by path.
SceneChanges = Iterable[str] | Mapping[str, Any]

#: What the name of a scene has none of (`SceneName`).
_NO_NAME = re.compile(r"[\x00-,./:-@\[-^`{-\xa0]")
_PATH = re.compile(r"[\w-]+(\.[\w-]+)*")

#: Characters of a line that are shown of a scene that is no TOML.
_SHOWN = 60
#: What a message of TOML's reader may want, by words of it.
_HINTS = {
    "Unclosed array": ". A list has commas between its entries and ends at a ], and numbers have digits on both sides of a point",
    "Unclosed inline table": ". Texts stand in quotes, numbers have digits on both sides of a point, and a table in braces one line",
    "value pair.*says [^=]*[^\x00-\x7f][^=]*=": ". Names have letters from a to z, digits, _ and -",
    "Invalid value|newline|value pair": ". Texts stand in quotes, numbers have digits on both sides of a point, and a key has = behind it",
    "character '.n'|Expected \"'|Unterminated": ". A text ends at quotes as those that begin it: on the same line, unless they are three",
    "key part.*says.*{": ". A table in braces stands on one line, and has no comma at its end",
    "overwrite|twice": ". Each key of a table, and each [table], stands once",
}

#: Tables whose entries have names of their own: an override cannot add one.
_NAMED = ("materials", "bodies", "contacts", "supports")
#: One whose entries an override can add whole, `loads.wind={ ... }`, but not key by key: a name by mistake would be a load of its own.
_ADDED = "loads"


def bundled_scenes() -> tuple[str, ...]:
    """Names of the scenes that come with the package."""
    return tuple(sorted(entry.name.removesuffix(".toml") for entry in _BUNDLED.iterdir() if entry.name.endswith(".toml")))


def read_source(source: str | Path) -> tuple[str, str, Path]:
    """Text, short name and folder of a scene file or of a bundled scene; in the name _ stands for what names of scenes cannot have.

    Raises
    ------
    InputError
        Neither a file nor the name of a bundled scene, or no text in UTF-8.
    """
    names = bundled_scenes()
    if str(source) in names:
        return (_BUNDLED / f"{source}.toml").read_text(encoding="utf-8"), str(source), Path()
    path = Path(source)
    if not path.is_file():
        raise InputError(f"there is no scene file {str(source)!r}, and the bundled scenes are: {listed(str(source), names)}")
    stem = path.stem.encode(errors="replace").decode()  # half a character, which is no text, becomes "?"
    return read_text(path), _NO_NAME.sub("_", stem), path.parent


def parse(text: str, name: str) -> dict[str, Any]:
    """TOML text as a dictionary; `name` says in errors what it is."""
    try:
        return _read(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{name} is not valid TOML: {error}{_line(text, str(error))}") from error


def _line(text: str, message: str) -> str:
    """The line that a message is about, of a long one what is round the place, and what it may want."""
    lines, found = text.rstrip(" \t\r\n").split("\n"), re.search(r"\(at (?:line (\d+)|end of)", message)
    number = _unclosed(text, message) if found and not found[1] else int(found[1]) - 1 if found else 0
    column = re.search(r"column (\d+)", message)
    line = lines[number].rstrip()
    begin = max(0, min(int(column[1]) - _SHOWN // 2, len(line) - _SHOWN)) if column and int(column[1]) > _SHOWN else 0
    said = f", where it says {line[begin:].strip()[:_SHOWN]!r}" if found else ""
    return said + next((words for what, words in _HINTS.items() if re.search(what, message + said)), "")


def _unclosed(text: str, message: str) -> int:
    """Number of the line, from 0, on which what goes on to the end begins: a text at the last of its quotes; else the last line."""
    single = re.search('Expected "(\'+)"', message)
    quotes = single[1] if single else '"""' if text.count('"""') % 2 else ""
    return text.count("\n", 0, text.rindex(quotes) if quotes else len(text.rstrip()))


def _read(text: str) -> dict[str, Any]:
    """TOML text as a dictionary; what the reader has no words of its own for is no TOML either."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError as error:
        raise tomllib.TOMLDecodeError("lists or tables within each other without end") from error
    except ValueError as error:
        raise tomllib.TOMLDecodeError("a number of more digits, or a date of others, than there are") from error


def apply_overrides(data: dict[str, Any], overrides: SceneChanges) -> None:
    """Change single values in place.

    Parameters
    ----------
    data : dict
        A scene file's content.
    overrides : iterable of str, or mapping of str to value
        ``KEY=VALUE`` each, one alone without a list, too: a dotted path (stages by name or number) and a TOML value; a bare word is
        taken as text. A mapping has values of Python by path.

    Raises
    ------
    InputError
        Not of that form, or no such body, stage, ... (unknown keys are found by the validation that follows).
    """
    if isinstance(overrides, Mapping):
        for path, value in overrides.items():
            if not isinstance(path, str) or not _PATH.fullmatch(path):
                raise InputError(f"override {path!r} is no path of keys, e.g. solver.max_cuts")
            _set(data, path, _without_end(value, path))
        return
    kind("overrides", overrides, Iterable, way=" of texts KEY=VALUE, or a mapping of values by path")
    for override in [overrides] if isinstance(overrides, str) else overrides:
        kind("overrides", override, str, way=" of the form KEY=VALUE")
        path, equals, value = (part.strip() for part in override.partition("="))
        if not equals or not _PATH.fullmatch(path):
            raise InputError(f"override {override!r} is not of the form KEY=VALUE, e.g. solver.max_cuts=4")
        _set(data, path, _value(value, override))


def as_options(overrides: Iterable[str]) -> str:
    """Overrides as the options of a command, in a line that a shell takes as it stands."""
    return shlex.join(word for override in overrides for word in ("--set", override))


def _without_end(value: Any, path: str) -> Any:
    """A value as a scene file can hold it, if it ends."""
    try:
        return _plain(value, path)
    except RecursionError as error:
        raise InputError("has lists or tables within each other without end", path) from error


def _plain(value: Any, path: str) -> Any:
    """A value as a scene file can hold it: lists for arrays and tuples, Python's numbers for NumPy's."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Mapping):
        return {str(key): _plain(entry, path) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry, path) for entry in value]
    if not isinstance(value, str | bool | int | float):
        raise InputError(f"is {value!r:.60}; allowed: what a scene file can hold, numbers, texts, truth values, lists and tables", path)
    return value


def _value(text: str, override: str) -> Any:
    try:
        if "\n" in text:
            raise tomllib.TOMLDecodeError("more than one line")
        return _read(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError as error:
        if re.fullmatch(r"[A-Za-z][\w./-]*", text):
            return text
        raise InputError(f'value of override {override!r} is not a TOML value (number, [list], true, "text"): {error}') from error


def _set(data: dict[str, Any], path: str, value: Any) -> None:
    parts = path.split(".")
    node: Any = data
    for depth, part in enumerate(parts):
        here = ".".join(parts[: depth + 1])
        key: str | int = part
        if isinstance(node, list):
            key = _index(node, part, here)
        elif not isinstance(node, dict):
            raise InputError(f"cannot be set: {'.'.join(parts[:depth])} is the single value {node!r}", path)
        elif depth == 1 and part not in node and (parts[0] in _NAMED or (parts[0] == _ADDED and len(parts) > 2)):
            raise InputError(f"an override changes what the scene has; {parts[0]} there: {listed(part, node)}", here)
        elif part not in node:
            node[part] = {}
        if depth == len(parts) - 1:
            node[key] = value
        node = node[key]


def _index(entries: list[Any], part: str, path: str) -> int:
    names = [entry.get("name", "") if isinstance(entry, dict) else "" for entry in entries]
    if part in names:
        return names.index(part)
    if part.isdecimal() and int(part) < len(entries):
        return int(part)
    raise InputError(f"no such entry; allowed: 0 to {len(entries) - 1}" + (f", {listed(part, names)}" if any(names) else ""), path)
