"""Measurements on disk, one file a cell, keyed by all that the numbers depend on."""

from __future__ import annotations

import ast
import functools
import hashlib
import importlib.metadata
import importlib.util
import json
import os
import platform
import re
import subprocess
from collections.abc import Iterable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

from isomortar._compiled import KERNEL
from isomortar.harness.cases import Case, Cell
from isomortar.harness.measurement import Measurement
from isomortar.results.files import write_whole

_PACKAGE = Path(__file__).parent.parent
#: Names what cases declare themselves with.
_ENTRANCE = _PACKAGE / "harness" / "__init__.py"
#: What of the package does not touch the numbers of a case that does not import it.
_ASIDE = tuple(_PACKAGE / name for name in ("accuracy", "cli", "harness", "program", "trade", "__main__.py"))


class Store:
    """A folder of measurements. Files are written whole or not at all, so that a killed run can go on."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def get(self, cell: Cell) -> Measurement | None:
        """The measurement of a cell as it is now; None when there is none, or the file is not what was written."""
        try:
            content = json.loads(self._path(cell).read_text(encoding="utf-8"))
            if content["cell"] != cell.name or content["hash"] != _content_hash(content["measurement"]):
                return None
            return Measurement(**content["measurement"])
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def put(self, cell: Cell, measurement: Measurement) -> None:
        """Keep what was measured, and that a scene does not converge: what lasts."""
        if measurement.lasts:
            plain = asdict(measurement)
            content = {"cell": cell.name, **identity(), "hash": _content_hash(plain), "measurement": plain}
            write_whole(self._path(cell), json.dumps(content, indent=1))

    def _path(self, cell: Cell) -> Path:
        return self.folder / cell.case.family / f"{cell.case.function.__name__}-{cell_key(cell)[:20]}.json"


def cell_key(cell: Cell, program: str | None = None) -> str:
    """Hash of all that a cell's numbers depend on: the program (None: this one), its case's files, its settings."""
    settings = json.dumps(cell.settings, sort_keys=True)
    return _hash(
        [(program or program_hash()).encode(), _case_hash(cell.case.path, cell.case.files).encode(), cell.name.encode(), settings.encode()]
    )


def sources_hash(case: Case) -> str:
    """Hash of what a process measures a case with: the program, and the case's file with what it imports."""
    return _hash([program_hash().encode(), _case_hash(case.path, ()).encode()])


@functools.cache
def kernel_hash() -> str:
    """Hash of the compiled kernel, its extended-precision twin, and what takes the kernel's place."""
    return _hash(path.read_bytes() for path in _kernel_files())


@functools.cache
def program_hash() -> str:
    """Hash of the kernel, of the package's own sources, and of the libraries that both run with."""
    return _hash([kernel_hash().encode(), package_hash().encode()])


@functools.cache
def package_hash() -> str:
    """Hash of the package's own sources, bundled scenes included, but for those aside, and of the libraries it runs with."""
    sources = sorted(p for p in _PACKAGE.rglob("*") if p.suffix in (".py", ".toml") and not any(p.is_relative_to(a) for a in _ASIDE))
    return _hash([*(path.read_bytes() for path in sources), *(path.read_bytes() for path in linked()), json.dumps(versions()).encode()])


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that this one requires (NumPy, SciPy, splinepy, ...)."""
    required = [re.match(r"[\w.-]+", line) for line in importlib.metadata.requires("isomortar") or () if "extra ==" not in line]
    names = sorted(found.group() for found in required if found)
    return {"Python": platform.python_version(), **{name: importlib.metadata.version(name) for name in names}}


def linked() -> list[Path]:
    """The shared libraries that the kernel is linked with, directly or not: UMFPACK, OpenBLAS, METIS, the compiler's own."""
    binaries = [path for path in _kernel_files() if path.suffix != ".py"]
    said = [subprocess.run(["ldd", str(path)], capture_output=True, text=True, check=True).stdout for path in binaries]
    return sorted({Path(found) for found in re.findall(r"=> (/\S+)", "".join(said))})


@functools.cache
def identity() -> dict[str, Any]:
    """What measures: hashes of program and kernel, the compiler, and versions of Python, of packages and of the kernel's libraries."""
    shared = {path.name.partition(".so")[0]: path.resolve().name for path in linked()}
    return {"program": program_hash(), "kernel": kernel_hash(), "compiler": _compiler(), "libraries": versions() | shared}


def _compiler() -> str:
    """The compiler that made the kernel, as it signed the binary."""
    signature = re.search(rb"GCC: \([^)]*\) [\d.]+", next(_kernel_files()).read_bytes())
    return signature.group().decode() if signature else "unknown"


def _kernel_files() -> Iterator[Path]:
    """The compiled kernels, the extended-precision twin, and the kernel that takes their place, if one does."""
    if KERNEL in os.environ:
        yield Path(os.environ[KERNEL])
    for module in ("isomortar._kernel", "isomortar._kernel_avx2", "isomortar._extended"):
        found = importlib.util.find_spec(module)
        if found and found.origin:
            yield Path(found.origin)


@functools.cache
def _case_hash(path: Path, files: tuple[Path, ...]) -> str:
    return _hash(file.read_bytes() for file in [*_sources(path), *files])


@functools.cache
def _sources(path: Path) -> list[Path]:
    """A case's file and all that it imports, and so on: those in the folder of cases, and those of this package.

    Looked for once, as a study has many runs of one case, each with a scene file of its own. Other packages count by their versions; an
    installed program has them beside itself.
    """
    found, left = {path}, [path]
    while left:
        new = _imports_of(left.pop(), path.parent.parent) - found
        found |= new
        left += new
    return sorted(found)


@functools.cache
def _imports_of(path: Path, cases: Path) -> set[Path]:
    """What a file imports itself. Read once, as many cases import the same."""
    files: set[Path] = set()
    for node in _statements(ast.parse(path.read_text(encoding="utf-8"))):
        names: list[str] = []
        within = [cases, _PACKAGE.parent]
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [".".join(filter(None, (node.module, name))) for name in ("", *(alias.name for alias in node.names))]
            within = [path.parents[node.level - 1]] if node.level else within
        bases = [root.joinpath(*name.split(".")) for name in names for root in within]
        files |= {file for base in bases for file in (base.with_suffix(".py"), base / "__init__.py") if file.is_file()}
    return {file for file in files if (file.is_relative_to(cases) or file.is_relative_to(_PACKAGE)) and file != _ENTRANCE}


def _statements(node: ast.AST) -> Iterator[ast.AST]:
    """What stands below a node, but for expressions, which import nothing and are most of a file."""
    for below in ast.iter_child_nodes(node):
        if not isinstance(below, ast.expr):
            yield below
            yield from _statements(below)


def _content_hash(measurement: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(measurement, sort_keys=True).encode()).hexdigest()


def _hash(parts: Iterable[bytes]) -> str:
    """One hash of several contents; where one ends and the next begins counts."""
    total = hashlib.sha256()
    for part in parts:
        total.update(hashlib.sha256(part).digest())
    return total.hexdigest()
