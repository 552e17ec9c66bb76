"""A fault: one change of one source file; and the faults that are planted by hand."""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Mapping
from pathlib import Path

from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.harness.mutants.layers import LAYERS

_SUFFIXES = tuple(layer.suffix for layer in LAYERS.values())


@frozen
class Fault:
    """`old` at character `position` of `file` becomes `new`; `name` and `why` are those of a fault planted by hand."""

    file: str
    position: int
    old: str
    new: str
    line: int
    key: str
    name: str = ""
    why: str = ""

    @property
    def folder(self) -> str:
        """The folder of the sources that it is in."""
        return self.file.partition("/")[0]

    @property
    def place(self) -> str:
        """File and line."""
        return f"{self.file}:{self.line}"

    @property
    def lines(self) -> range:
        """Numbers of the lines that it changes."""
        return range(self.line, self.line + self.old.count("\n") + 1)

    def applied(self, text: str) -> str:
        """The text of its file with the fault in it."""
        return text[: self.position] + self.new + text[self.position + len(self.old) :]


def fault_at(file: str, text: str, position: int, old: str, new: str, name: str = "", why: str = "") -> Fault:
    """A fault with its key: file, change, and which of several like places; lines above may move."""
    like = text[:position].count(old)
    key = hashlib.sha256("\0".join((file, old.strip(), new.strip(), str(like))).encode()).hexdigest()[:10]
    return Fault(file, position, old, new, text[:position].count("\n") + 1, key, name, why)


def read_planted(path: Path, sources: Mapping[str, str], suffix: str) -> list[Fault]:
    """The faults planted by hand in sources of one suffix: a TOML file of ``[[fault]]`` with name, file, old, new, why.

    Raises
    ------
    InputError
        There is none, an entry is missing, or its text does not stand exactly once in its file.
    """
    try:
        entries = tomllib.loads(path.read_text())["fault"]
    except (OSError, tomllib.TOMLDecodeError, KeyError) as error:
        raise InputError(f"is no list of [[fault]]: {error}", str(path)) from None
    if not entries:
        raise InputError("holds no [[fault]]: a gate that meets no fault catches all of them", str(path))
    wheres = [f"{path}: {entry.get('name', f'fault {i + 1}')}" for i, entry in enumerate(entries)]
    for entry, where in zip(entries, wheres, strict=True):
        if set(entry) != {"name", "file", "old", "new", "why"}:
            raise InputError(f"has {', '.join(sorted(entry))}; needs name, file, old, new, why", where)
        if Path(entry["file"]).suffix not in _SUFFIXES:
            raise InputError(f"{entry['file']} is no source: {', '.join(_SUFFIXES)}", where)
    names = [entry["name"] for entry in entries]
    if len(set(names)) < len(names):
        raise InputError(f"two faults have one name: {', '.join(sorted({n for n in names if names.count(n) > 1}))}", str(path))
    return [_planted(entry, sources, where) for entry, where in zip(entries, wheres, strict=True) if entry["file"].endswith(suffix)]


def _planted(entry: Mapping[str, str], sources: Mapping[str, str], where: str) -> Fault:
    if entry["file"] not in sources:
        raise InputError(f"there is no source {entry['file']} that faults are put into", where)
    text, old = sources[entry["file"]], entry["old"].strip("\n")
    if text.count(old) != 1:
        raise InputError(f"stands {text.count(old)} times in {entry['file']}, must stand exactly once:\n{old}", where)
    return fault_at(entry["file"], text, text.index(old), old, entry["new"].strip("\n"), entry["name"], entry["why"])
