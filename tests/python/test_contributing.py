"""The table of what to touch names files that are there, and as many as it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
TABLE = TEXT[TEXT.index("## What to touch") : TEXT.index("## A new Fortran file")]
ROWS = re.findall(r"^\| ([^|]+) \| (\d+) \| (.+) \|$", TABLE, re.MULTILINE)
#: What is beside the count of a row: what it says after "for GetFEM", say.
PATH = re.compile(r"`((?:fortran|python|verification|tests|docs)/[\w./-]+)`")


def test_the_table_has_all_that_a_person_may_want_to_add() -> None:
    wanted = ("material", "friction law", "gap map", "scene", "case", "statement", "paper", "foreign kernel", "program", "solver setting")
    assert [name for name in wanted if not any(name in what for what, _, _ in ROWS)] == []


@pytest.mark.parametrize(("what", "which"), [(what, which) for what, _, which in ROWS], ids=[what for what, _, _ in ROWS])
def test_the_files_that_a_row_names_are_there(what: str, which: str) -> None:
    """A new one stands beside others of its kind."""
    for path in PATH.findall(which):
        new = re.search(r"\b(NAME|FAMILY|SCENE)\b", path)
        pattern = re.sub(r"\b(NAME|FAMILY|SCENE)\b", "*", path)
        assert list(ROOT.glob(pattern)), f"{what}: there is no {path}"
        assert new or (ROOT / path).exists()


@pytest.mark.parametrize("row", ROWS, ids=[what for what, _, _ in ROWS])
def test_a_row_counts_the_files_that_it_names(row: tuple[str, str, str]) -> None:
    """Sentences after the first are of what needs no change; alternatives, as of a statement, are one file."""
    what, count, which = row
    needed = re.split(r"\. (?=[A-Z])|; a scene of|; the extremes", which)[0]
    named = set(PATH.findall(needed))
    assert int(count) == (1 if "statement" in what else len(named))
