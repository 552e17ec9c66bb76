"""Finding benchmarks: the Python files of the folder ``performance`` beside the families of cases."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from isomortar.errors import InputError
from isomortar.harness.bench.declaration import Benchmark
from isomortar.harness.collection import module_at

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
        raise InputError(f"no benchmarks in {root / FOLDER}: run it from a checkout's folder, or give that above with --cases", "bench")
    names = [one.name for one in found]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError(f"two benchmarks are called {', '.join(twice)}: a benchmark is known by its function", "bench")
    return sorted(found, key=lambda one: one.name)


def benchmarks_of(path: Path) -> list[Benchmark]:
    """The benchmarks that a file defines, in its order."""
    return [value for value in vars(module_at(path)).values() if isinstance(value, Benchmark) and value.path == path.resolve()]


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
