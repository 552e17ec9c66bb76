"""Write what a results file holds into docs/results.md: ``python tools/document_results.py``."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import h5py
from pages import Page

import isomortar
from isomortar.solve.timing import COUNTERS

PAGE = Path(__file__).parent.parent / "docs" / "results.md"
_BEGIN, _END = "<!-- tables: python tools/document_results.py -->\n", "<!-- end of the tables -->\n"
#: Friction, so that all there is of contact is written; two steps, for rates; one element of order 1, so that systems are general.
_SCENE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
bodies.block.mesh = { order = [1, 1, 1] }
contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0], normal = [0, 0, 1] }, friction = 0.5 }
supports.top.face = "block.w1"
loads.own = { body = "block", weight = [0, 0, -0.1] }
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.1] }]
"""
#: Names that a scene gives.
_GIVEN = {"top": "SUPPORT", "floor": "CONTACT", "own": "LOAD", "0": "BODY"}


def tables() -> str:
    """A table for each group of a results file in alphabetical order: datasets with type, unit and meaning."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "results.h5"
        isomortar.run(isomortar.Scene.from_toml(_SCENE), path, isomortar.Observer())
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


page = Page(PAGE, _BEGIN, _END, tables)

if __name__ == "__main__":
    page.write()
