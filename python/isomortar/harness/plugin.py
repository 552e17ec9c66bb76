"""pytest plugin: cells of verification cases as test items, each marked with its tier: ``pytest verification -m gate``.

Loaded by pytest wherever isomortar is installed; it collects the files of a folder that hold cases, so that a project which
verifies a kernel of its own needs no more than cases. The selected cells of a file are measured in processes of their own, as many
at a time as ``--verification-jobs`` says, and kept in ``results/verification`` below pytest's root, as by ``isomortar verify``.
With pytest-xdist, ``pytest -n 2 --dist loadfile``, each of its workers measures the files that it is given.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from isomortar.harness.cases import Cell
    from isomortar.harness.runner import Measuring, Result, Submit
    from isomortar.harness.store import Store


def pytest_addoption(parser: pytest.Parser) -> None:
    """The plugin's options."""
    group = parser.getgroup("verification cases")
    beside_others = "PYTEST_XDIST_WORKER" in os.environ
    group.addoption(
        "--verification-jobs",
        type=int,
        default=1 if beside_others else 2,
        help="verification cells measured at the same time (default: 2; 1 by each worker of pytest-xdist)",
    )
    group.addoption("--verification-references", default="reference_data", help="folder of references, below the root directory")


def pytest_configure(config: pytest.Config) -> None:
    """Tiers are marks."""
    for tier, cost in (("gate", "seconds"), ("nightly", "minutes"), ("weekly", "hours")):
        config.addinivalue_line("markers", f"{tier}: verification cells of {cost}")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Files that hold cases: `verification/<family>/*.py`."""
    if file_path.suffix != ".py" or file_path.name.startswith(("test_", "conftest")):
        return None
    from isomortar.harness.collection import holds_cases

    return CaseFile.from_parent(parent, path=file_path) if holds_cases(file_path) else None


class CaseFile(pytest.File):
    """A file of cases."""

    def collect(self) -> Iterator[pytest.Item]:
        """An item a cell."""
        from isomortar.harness.collection import cases_of

        for case in cases_of(self.path):
            for cell in case.cells:
                yield CellItem.from_parent(self, name=cell.name.partition("/")[2], cell=cell)


class CellItem(pytest.Item):
    """A cell. Fails unless it passes."""

    def __init__(self, *, cell: Cell, **other: Any) -> None:
        super().__init__(**other)
        self.cell = cell
        self.add_marker(cell.tier)

    def runtest(self) -> None:
        """Wait for the cell's measurement, and judge it."""
        from isomortar.harness.report import sentence

        result = self.session.stash[_SESSION].result(self)
        if result.state != "passed":
            checks = [sentence(check) for check in result.checks if check.state != "passed"]
            pytest.fail("\n".join([result.cell.case.claim, *checks, result.measurement.message]).rstrip(), pytrace=False)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Where pytest says that it stands."""
        return self.path, None, self.cell.name


class _Session:
    """Measurements of the selected cells: those of a file begin when the first of them is asked for."""

    def __init__(self, session: pytest.Session) -> None:
        self._session = session
        self._stack = ExitStack()
        self._submit: Submit | None = None
        self._started: dict[str, Measuring] = {}

    def result(self, item: CellItem) -> Result:
        """The result of an item's cell; waits for it."""
        from isomortar.harness.references import finder
        from isomortar.harness.store import Store

        config = self._session.config
        store = Store(config.rootpath / "results/verification/cells")
        if item.cell.name not in self._started:
            self._start(item.path, store)
        references = finder(config.rootpath / config.getoption("--verification-references"))
        return self._started[item.cell.name].result(references, store)

    def _start(self, path: Path, store: Store) -> None:
        from isomortar.harness.runner import local_processes, start

        if self._submit is None:
            self._submit = self._stack.enter_context(local_processes(self._session.config.getoption("--verification-jobs")))
        cells = [item.cell for item in self._session.items if isinstance(item, CellItem) and item.path == path]
        self._started |= {measuring.cell.name: measuring for measuring in start(cells, store, self._submit)}

    def close(self) -> None:
        """Drop what nobody waits for, and what is being measured."""
        self._stack.__exit__(pytest.exit.Exception, pytest.exit.Exception(), None)


_SESSION: pytest.StashKey[_Session] = pytest.StashKey()


def pytest_sessionstart(session: pytest.Session) -> None:
    """Nothing is measured before it is asked for."""
    session.stash[_SESSION] = _Session(session)


def pytest_sessionfinish(session: pytest.Session) -> None:
    """End the measuring processes."""
    session.stash[_SESSION].close()
