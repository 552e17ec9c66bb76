"""Studies: runs of scenes that are compared with each other, and the page that says what comes of it.

A study stands in ``FOLDER/<name>/study.py``; what it runs, measures and draws stands beside it. A family of cases may have a page too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from types import ModuleType
from typing import Protocol

from isomortar.errors import InputError
from isomortar.harness.cases import Cell
from isomortar.harness.collection import module_at
from isomortar.harness.measurement import Measurement
from isomortar.harness.runner import Result


@dataclass(frozen=True)
class Conclusion:
    """What a study came to: its page, how many runs failed, whether it is complete, and what it says in a line (empty: nothing)."""

    page: Path
    failed: int
    complete: bool
    summary: str = ""


class Study(Protocol):
    """What a command runs and concludes from."""

    def cells(self, folder: Path) -> list[Cell]:
        """A cell a run. Scene files go to the folder, to be run by anyone.

        Raises
        ------
        InputError
            A scene is wrong.
        """

    def conclude(self, folder: Path, measurements: Sequence[Measurement], started: datetime) -> Conclusion:
        """Compare the runs, of which there is a measurement a cell, and write the page into the folder."""


def family_pages(cases: Path, folder: Path, results: Sequence[Result]) -> Iterator[Path]:
    """Write the pages of families that have one of their own, by the function ``write`` of ``FOLDER/<family>/page.py``; yields paths."""
    for family in sorted({result.cell.case.family for result in results}):
        source, path = cases / family / "page.py", folder / f"{family}.html"
        if source.is_file() and module_at(source).write(path, [result for result in results if result.cell.case.family == family]):
            yield path


def study_module(cases: Path, name: str) -> ModuleType:
    """The module of a study.

    Raises
    ------
    InputError
        It is not there: the program is not run in a checkout.
    """
    path = cases / name / "study.py"
    if not path.is_file():
        raise InputError(f"there is no {path}: studies are run in a checkout, from its folder; or give the folder with --cases", "cases")
    return module_at(path)
