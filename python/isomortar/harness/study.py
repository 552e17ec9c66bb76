"""Studies: runs of scenes that are compared with each other, and the page that says what comes of it.

A study stands in ``FOLDER/<name>/study.py``, whose function ``study`` makes it of the options of a command; what it runs, measures and
draws stands beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import field, replace
from datetime import datetime
from pathlib import Path
from types import ModuleType

from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.harness.cases import Case, Cell, Settings
from isomortar.harness.collection import module_at
from isomortar.harness.runner import Result
from isomortar.harness.store import Store
from isomortar.results.files import write_whole
from isomortar.scene.scene import Scene


@frozen
class Conclusion:
    """What a study came to: its page, how many runs failed, whether it is complete, and what it says in a line (empty: nothing)."""

    page: Path
    failed: int
    complete: bool
    summary: str = ""


@frozen
class Run:
    """A scene under a name of its own, and what measures it.

    Parameters
    ----------
    name : str
        Also of its scene file.
    scene : Scene
        With all that the run changes.
    case : Case
        Made by `measured`: a function of ``scene``, the path of the scene file, and of the settings.
    settings : dict
        Others of the case.
    leaves : callable, optional
        From the scene file to the results file that is needed besides the numbers.
    """

    name: str
    scene: Scene
    case: Case
    settings: Settings = field(default_factory=dict)
    leaves: Callable[[Path], Path] | None = None

    def cell(self, folder: Path) -> Cell:
        """Its cell; the scene file goes to the folder, to be run by anyone."""
        path = folder / f"{self.name}.toml"
        write_whole(path, self.scene.to_toml())
        return Cell(replace(self.case, files=(*self.case.files, path.absolute())), {"scene": str(path), **self.settings})


@frozen
class Study:
    """Runs that are compared with each other.

    Parameters
    ----------
    runs : tuple of Run or Cell
        A cell where the case makes its scenes of its settings.
    page : callable
        From the folder, the results of the runs in their order, and the time of the start: compares them, judges what is stated of them
        and writes the page.
    """

    runs: tuple[Run | Cell, ...]
    page: Callable[[Path, Sequence[Result], datetime], Conclusion]

    def cells(self, folder: Path) -> list[Cell]:
        """A cell a run.

        Raises
        ------
        InputError
            The results file of a run that was measured is gone.
        """
        cells, store = [run.cell(folder / "scenes") if isinstance(run, Run) else run for run in self.runs], Store(folder / "cells")
        for run, cell in zip(self.runs, cells, strict=True):
            left = run.leaves(Path(cell.settings["scene"])) if isinstance(run, Run) and run.leaves else None
            if left and store.get(cell) and not left.exists():
                raise InputError(f"{left} is gone; remove {store.folder} too, and what is missing is run again")
        return cells


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
