"""Entries on disk as they come: histories of runs, and what is known already, so that a run that was killed goes on from there."""

from __future__ import annotations

import contextlib
import json
import os
import threading
from pathlib import Path
from typing import Any


class Journal:
    """A file of JSON, an entry a line. What a crash cut short is left out, and takes no other entry with it.

    Attributes
    ----------
    entries : list of dict
        Oldest first.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = threading.Lock()
        self.entries = _read(path)
        self._by_key = {entry["key"]: entry for entry in self.entries if "key" in entry}

    def add(self, entry: dict[str, Any]) -> None:
        """Keep an entry, on a line of its own also where the one before was cut short."""
        with self._lock:
            self.entries.append(entry)
            self._path.parent.mkdir(parents=True, exist_ok=True)
            with self._path.open("a+b") as file:
                file.seek(-min(1, file.tell()), os.SEEK_CUR)
                torn = file.read() not in (b"", b"\n")
                file.write(b"\n" * torn + json.dumps(entry).encode() + b"\n")

    def put(self, key: str, entry: dict[str, Any]) -> None:
        """Keep an entry under a key, in the place of an earlier one."""
        self._by_key[key] = {"key": key, **entry}
        self.add(self._by_key[key])

    def get(self, key: str) -> dict[str, Any] | None:
        """The last entry of a key, if there is one."""
        return self._by_key.get(key)


def _read(path: Path) -> list[dict[str, Any]]:
    entries = []
    for line in path.read_bytes().splitlines() if path.exists() else ():
        with contextlib.suppress(ValueError):  # a character that is cut in two is one as well
            entries.append(json.loads(line))
    return [entry for entry in entries if isinstance(entry, dict)]
