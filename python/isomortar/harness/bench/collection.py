"""Finding benchmarks: the Python files of the folder ``performance`` beside the families of cases."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from pathlib import Path

from isomortar.errors import InputError
from isomortar.harness.bench.declaration import Benchmark

#: Folder of the benchmarks, below that of the cases.
FOLDER = "performance"


def collect(root: Path) -> list[Benchmark]:
    """All benchmarks of a folder of cases, sorted by name.

    Raises
    ------
    InputError
        There are none, or two of one name.
    """
    found = [one for path in sorted((root / FOLDER).glob("*.py")) for one in benchmarks_of(path)]
    if not found:
        raise InputError(f"no benchmarks: they stand in {root / FOLDER}/*.py; give the folder above with --cases", "bench")
    names = [one.name for one in found]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError(f"two benchmarks are called {', '.join(twice)}: a benchmark is known by its function", "bench")
    return sorted(found, key=lambda one: one.name)


def benchmarks_of(path: Path) -> list[Benchmark]:
    """The benchmarks that a file defines, in its order.

    Raises
    ------
    InputError
        Another file of that name came first on the import path.
    """
    path = path.resolve()
    root = str(path.parent.parent)
    if root not in sys.path:
        sys.path.insert(0, root)
    module = importlib.import_module(f"{path.parent.name}.{path.stem}")
    if Path(module.__file__ or "").resolve() != path:
        raise InputError(f"is taken from {module.__file__}, not from {path}: give the folder or the file another name", path.stem)
    return [value for value in vars(module).values() if isinstance(value, Benchmark) and value.path == path]


def select(benchmarks: Sequence[Benchmark], names: Sequence[str]) -> list[Benchmark]:
    """Those of the given names, in the order of `benchmarks`; all where no name is given.

    Raises
    ------
    InputError
        A name that is none.
    """
    known = [one.name for one in benchmarks]
    unknown = [name for name in names if name not in known]
    if unknown:
        raise InputError(f"there is no {', '.join(map(repr, unknown))}; allowed: {', '.join(known)}", "bench")
    return [one for one in benchmarks if not names or one.name in names]
