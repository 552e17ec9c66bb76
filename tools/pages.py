"""Pages of the documentation with tables that the program makes."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Page:
    """A page of the documentation, the lines between which it has tables, and what makes these."""

    path: Path
    begin: str
    end: str
    tables: Callable[[], str]

    def renewed(self, text: str) -> str:
        """The page's text with tables as they are now.

        Raises
        ------
        ValueError
            It has no place for them.
        """
        place = f"(?s){re.escape(self.begin)}.*?{re.escape(self.end)}"
        made, places = re.subn(place, lambda _: f"{self.begin}\n{self.tables()}\n{self.end}", text)
        if places != 1:
            raise ValueError(
                f"{self.path.name} has {places} places for tables; allowed: one, between {self.begin.strip()} and {self.end.strip()}"
            )
        return made

    def write(self) -> None:
        """Make its tables anew."""
        self.path.write_text(self.renewed(self.path.read_text()))
