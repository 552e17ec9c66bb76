"""The project's tests as cells: of Python around the kernel they claim what no case does."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from isomortar.errors import InputError
from isomortar.harness.cases import Bound, Cell, case

#: What tests of the harness, and of what is above and just below it, and of studies import: no fault is put there.
_HARNESS = re.compile(r"isomortar\.(accuracy|harness|trade)\b|^from (measures|orders|paper|sampling)\b", re.MULTILINE)


@case(
    claim="The tests of a file, or folder, pass.",
    grid={"of": ["tests/python"]},
    bounds={"status": Bound(at_most=0, reason="definition: pytest ends with status 0 when all that it ran passed, and something was run")},
)
def passed(of: str) -> dict[str, int]:
    """Pytest's status, run in this process up to the first failure."""
    import pytest  # not of the program

    return {"status": int(pytest.main(["-q", "-x", "-p", "no:cacheprovider", of]))}


def cells_of_tests(folder: Path) -> list[Cell]:
    """A cell for each file of tests, but those of the harness.

    Raises
    ------
    InputError
        There are no tests in the folder.
    """
    others = [path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts]
    helpers = sorted(path for path in others if path.parent != folder or not path.name.startswith("test_"))
    files = [path for path in sorted(folder.glob("test_*.py")) if not _HARNESS.search(path.read_text())]
    if not files:
        raise InputError(f"there are none in {folder}", "tests")
    return [Cell(replace(passed, files=(path, *_imported(path), *helpers, *_pages(path))), {"of": path.as_posix()}) for path in files]


def _imported(path: Path) -> list[Path]:
    """Other files of tests that one takes things from."""
    return [
        other for other in sorted(path.parent.glob("test_*.py")) if re.search(rf"^(from|import) {other.stem}\b", path.read_text(), re.M)
    ]


def _pages(path: Path) -> list[Path]:
    """Files of other folders of the checkout, where a test names the folder."""
    root, text = path.parent.parent.parent, path.read_text()
    found = [other for name in ("docs", "tools") if f'"{name}"' in text for other in (root / name).glob("*")]
    return sorted(other for other in found if other.is_file())
