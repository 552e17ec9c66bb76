"""Write what a results file holds into docs/results.md: ``python tools/document_results.py``."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import h5py

import isomortar
from isomortar.solve.timing import COUNTERS

PAGE = Path(__file__).parent.parent / "docs" / "results.md"
_BEGIN, _END = "<!-- tables: python tools/document_results.py -->\n", "<!-- end of the tables -->\n"
#: Friction, so that all there is of contact is written; two steps, so that there are rates; few elements, so that systems are general.
_SCENE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0], normal = [0, 0, 1] }, friction = 0.5 }
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.1] }]
"""
#: Names that a scene gives.
_GIVEN = {"top": "SUPPORT", "floor": "CONTACT", "0": "BODY"}


def tables() -> str:
    """A table for each group of a results file in alphabetical order: datasets with type, unit and meaning."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "results.h5"
        isomortar.run(isomortar.Scene.from_toml(_SCENE), path)
        with h5py.File(path) as file:
            rows: dict[str, dict[str, str]] = {}
            file.visititems(lambda name, entry: _note(rows, name, entry))
    rows["counters"] = {name: rows["counters"][name] for name in COUNTERS}  # they explain each other
    heads = "| dataset | type, or columns | unit | what |", "|---|---|---|---|"
    return "\n".join("\n".join([f"### `/{group}`", "", *heads, *rows[group].values(), ""]) for group in sorted(rows))


def _note(rows: dict[str, dict[str, str]], name: str, entry: h5py.Group | h5py.Dataset) -> None:
    if not isinstance(entry, h5py.Dataset):
        return
    *groups, last = name.split("/")
    group = "/".join(_GIVEN.get(part, part) for part in groups)
    last = "NUMBER" if last.isdigit() else last
    what = COUNTERS[last] if group == "counters" else entry.attrs["description"]  # a file has one sentence for all that is counted
    rows.setdefault(group, {})[last] = f"| `{last}` | {_type(entry)} | {entry.attrs['unit']} | {what} |"


def _type(entry: h5py.Dataset) -> str:
    """Type of an entry, and of vectors how long they are; of tables their columns."""
    if entry.dtype.names:
        return ", ".join(f"`{name}`" for name in entry.dtype.names)
    kind = "text" if entry.dtype.kind in "OS" else str(entry.dtype)
    return kind + "".join(f" x {size}" for size in entry.shape[1:] if size in (2, 3))


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
        place = f"(?s){re.escape(self.begin)}.*{re.escape(self.end)}"
        made, places = re.subn(place, lambda _: f"{self.begin}\n{self.tables()}\n{self.end}", text)
        if places != 1:
            raise ValueError(
                f"{self.path.name} has {places} places for tables; allowed: one, between {self.begin.strip()} and {self.end.strip()}"
            )
        return made

    def write(self) -> None:
        """Make its tables anew."""
        self.path.write_text(self.renewed(self.path.read_text()))


page = Page(PAGE, _BEGIN, _END, tables)

if __name__ == "__main__":
    page.write()
