"""What is known already, one line of JSON an entry: a run that was killed goes on from here."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

from isomortar.harness.store import append_line, read_lines


class Journal:
    """Entries by key, on disk as they come. A later entry of a key takes the place of an earlier one."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._entries = {entry.pop("key"): entry for entry in read_lines(path)}

    def get(self, key: str) -> dict[str, Any] | None:
        """The entry of a key, if there is one."""
        return self._entries.get(key)

    def put(self, key: str, entry: dict[str, Any]) -> None:
        """Keep an entry."""
        with self._lock:
            self._entries[key] = entry
            append_line(self._path, {"key": key, **entry})
