"""Finding cases: every Python file of every family folder that uses this package."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

from isomortar.errors import InputError
from isomortar.harness.cases import Case

_MARK = "isomortar.harness"


def holds_cases(path: Path) -> bool:
    """Whether a file is one to look for cases in."""
    return path.suffix == ".py" and path.name != "conftest.py" and not path.name.startswith("test_") and _MARK in path.read_text()


def collect(root: Path) -> list[Case]:
    """All cases below a folder of families, sorted by name.

    The folder itself is put on the import path: files at its top are shared helpers, ``from family.module import ...`` works too.

    Raises
    ------
    InputError
        No such folder, no cases, or two of one name.
    """
    if not root.is_dir():
        raise InputError(f"there is no folder {root}", "cases")
    cases = [found for path in sorted(root.glob("*/*.py")) if holds_cases(path) for found in cases_of(path)]
    if not cases:
        raise InputError(f"no cases below {root}: they stand in {root}/<family>/*.py", "cases")
    names = [found.name for found in cases]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError(f"two cases are called {', '.join(twice)}: a case is known by its family and function", "cases")
    return sorted(cases, key=lambda found: found.name)


def cases_of(path: Path) -> list[Case]:
    """The cases that a file defines, in its order. It is known as family and file, in a package by its full name."""
    root = path.resolve().parent.parent
    while (root / "__init__.py").is_file():
        root = root.parent
    if str(root) not in sys.path:
        sys.path.insert(0, str(root))
    module = importlib.import_module(".".join(path.resolve().relative_to(root).with_suffix("").parts))
    if Path(module.__file__ or "").resolve() != path.resolve():
        raise InputError(f"is taken from {module.__file__}, not from {path}: give the folder or the file another name", path.stem)
    return [value for value in vars(module).values() if isinstance(value, Case) and value.path == path.resolve()]


def find(root: Path, name: str) -> Case:
    """One case by its name, family and function."""
    matching = [found for found in collect(root) if found.name == name]
    if not matching:
        raise InputError(f"there is no case {name!r} below {root}", "case")
    return matching[0]
