"""Finding what stands in files below a folder of families: cases, and whatever else a family has."""

from __future__ import annotations

import ast
import importlib
import re
import sys
from pathlib import Path
from types import ModuleType

from isomortar.errors import InputError
from isomortar.harness.cases import Case

_MARK = re.compile(r"isomortar\.harness|from isomortar import[^\n]*\bharness\b")


def holds_cases(path: Path) -> bool:
    """Whether a file is one to look for cases in."""
    named = path.suffix == ".py" and path.name != "conftest.py" and not path.name.startswith("test_")
    return named and _MARK.search(path.read_text()) is not None


def collect(root: Path) -> list[Case]:
    """All cases below a folder of families, sorted by name.

    The folder itself is put on the import path: files at its top are shared helpers, ``from family.module import ...`` works too.

    Raises
    ------
    InputError
        No such folder, no cases, or two of one name.
    """
    if not root.is_dir():
        raise InputError(f"there is no folder {root}: verify in a checkout, from its folder; or give the folder with --cases", "cases")
    cases = [found for path in sorted(root.glob("*/*.py")) if holds_cases(path) for found in cases_of(path) if found.cells]
    if not cases:
        raise InputError(f"no cases below {root}: they stand in {root}/<family>/*.py", "cases")
    names = [found.name for found in cases]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError(f"two cases are called {', '.join(twice)}: a case is known by its family and function", "cases")
    return sorted(cases, key=lambda found: found.name)


def cases_of(path: Path) -> list[Case]:
    """The cases that a file defines, in its order.

    Raises
    ------
    InputError
        A case of the file would be lost: its name is given twice, or its function stands in no family.
    """
    functions = [node.name for node in ast.parse(path.read_text()).body if isinstance(node, ast.FunctionDef)]
    twice = sorted({name for name in functions if functions.count(name) > 1})
    if twice:
        raise InputError(f"defines {', '.join(twice)} twice: the first is lost", str(path))
    cases = {name: value for name, value in vars(module_at(path)).items() if isinstance(value, Case)}
    strangers = [name for name, value in cases.items() if value.path.parent.parent != path.resolve().parent.parent]
    if strangers:
        raise InputError(f"the functions of {', '.join(strangers)} stand in no family: define them in the file itself", str(path))
    return [value for value in cases.values() if value.path == path.resolve()]


def module_at(path: Path) -> ModuleType:
    """The module of a file of a family. It is known as family and file, in a package by its full name.

    Raises
    ------
    InputError
        Another file of that name came first on the import path.
    """
    root = path.resolve().parent.parent
    while (root / "__init__.py").is_file():
        root = root.parent
    if str(root) not in sys.path:
        sys.path.insert(0, str(root))
    module = importlib.import_module(".".join(path.resolve().relative_to(root).with_suffix("").parts))
    if Path(module.__file__ or "").resolve() != path.resolve():
        raise InputError(f"is taken from {module.__file__}, not from {path}: give the folder or the file another name", path.stem)
    return module


def find(root: Path, name: str) -> Case:
    """One case by its name, family and function."""
    matching = [found for found in collect(root) if found.name == name]
    if not matching:
        raise InputError(f"there is no case {name!r} below {root}", "case")
    return matching[0]
