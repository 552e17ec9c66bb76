"""What is known already, one line of JSON an entry: a run that was killed goes on from here."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import Any


class Journal:
    """Entries by key, on disk as they come. A later entry of a key takes the place of an earlier one."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._entries: dict[str, dict[str, Any]] = {}
        for line in path.read_text().splitlines() if path.exists() else []:
            try:
                entry = json.loads(line)
                self._entries[entry.pop("key")] = entry
            except (ValueError, KeyError, AttributeError, TypeError):
                continue  # cut short by a crash

    def get(self, key: str) -> dict[str, Any] | None:
        """The entry of a key, if there is one."""
        return self._entries.get(key)

    def put(self, key: str, entry: dict[str, Any]) -> None:
        """Keep an entry."""
        with self._lock:
            self._entries[key] = entry
            self._path.parent.mkdir(parents=True, exist_ok=True)
            with self._path.open("a") as file:
                file.write("\n" * self._cut_short() + json.dumps({"key": key, **entry}) + "\n")

    def _cut_short(self) -> bool:
        """Whether the file ends in the middle of a line."""
        if not self._path.stat().st_size:
            return False
        with self._path.open("rb") as file:
            file.seek(-1, 2)
            return file.read() != b"\n"
