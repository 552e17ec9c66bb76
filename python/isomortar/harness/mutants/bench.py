"""Where cells are measured on programs with a fault: a copy of the package, and a process that runs it."""

from __future__ import annotations

import compileall
import importlib.util
import shutil
import sys
from pathlib import Path
from types import TracebackType

import isomortar
from isomortar.errors import IsomortarError
from isomortar.harness.cases import Cell
from isomortar.harness.measurement import Measurement
from isomortar.harness.worker import Worker, task_of
from isomortar.program.process import Limits

#: Most memory of a measuring process, bytes: a fault in a size must not take the machine down.
_MEMORY = 8 << 30
#: Starts a worker on the package of a bench. With `-S`: the import hook of an editable install would come first.
_START = """
import runpy, sys
sys.dont_write_bytecode = True  # two faults of one second and size would be taken for one
sys.path.insert(0, {package!r})
sys.path.extend({installed!r})
sys.argv[1:] = [{package!r} + "/isomortar"]
runpy.run_module({module!r}, run_name="__main__")
"""
_PACKAGE = Path(isomortar.__file__).parent.resolve()
#: Compiled kernels too: `_kernel_avx2`, where it stands beside the sources, would be taken for a `_kernel` with a fault.
_HIDDEN = shutil.ignore_patterns("__pycache__", "*.so")


def freeze(cases: Path, folder: Path) -> tuple[Path, Path]:
    """Copy the package with the compiled kernels, and the cases: what is edited during a campaign does not touch it.

    Returns
    -------
    package, cases : Path
        The copies.
    """
    shutil.rmtree(folder, ignore_errors=True)
    package = Path(shutil.copytree(_PACKAGE, folder / "isomortar", ignore=_HIDDEN))
    for module in ("isomortar._kernel", "isomortar._extended"):
        found = importlib.util.find_spec(module)
        if found is None or found.origin is None:
            raise IsomortarError(f"{module} is not built: `make setup` builds it")
        shutil.copy2(found.origin, package)
    compileall.compile_dir(package, quiet=2)
    return package, Path(shutil.copytree(cases, folder / "cases", ignore=_HIDDEN))


class Bench:
    """A place to measure cells on any program, one at a time. A context manager.

    Parameters
    ----------
    package, cases : Path
        What `freeze` made. The package is copied once more, for this bench's programs.
    folder : Path
        Where to work.
    module : str
        The measuring program.
    """

    def __init__(self, package: Path, cases: Path, folder: Path, module: str = "isomortar.harness.worker") -> None:
        self._frozen, self._cases, self._folder = package, cases.resolve(), folder.resolve()
        self._program: Path | None = None
        self._laid: list[Path] = []
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(package, folder / "isomortar")
        start = _START.format(package=str(self._folder), installed=[path for path in sys.path if path], module=module)
        self._worker = Worker((sys.executable, "-S", "-c", start), Limits(memory=_MEMORY))

    def __enter__(self) -> Bench:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self._worker.__exit__(kind, value, trace)

    def measure(self, program: Path, cell: Cell, seconds: float) -> Measurement:
        """Measure a cell on a program, a folder of files that take the place of the package's, within a time.

        Raises
        ------
        IsomortarError
            The bench was closed meanwhile: that its process died then says nothing about the program.
        """
        if program != self._program:
            self._lay_out(program)
        return self._worker.measure(task_of(cell) | {"path": str(self._copy_of(cell.case.path)), "seconds": seconds})

    def _copy_of(self, path: Path) -> Path:
        """The frozen copy of a case's file; a case of the package stands in the bench's own."""
        if path.is_relative_to(_PACKAGE):
            return self._folder / "isomortar" / path.relative_to(_PACKAGE)
        return self._cases / path.parent.name / path.name

    def _lay_out(self, program: Path) -> None:
        """Let a program be the one that is measured; the files of the one before are replaced by sound ones."""
        self._worker.restart()
        for file in self._laid:
            self._lay(self._frozen, file)
        self._laid = [path.relative_to(program) for path in program.rglob("*") if path.is_file()]
        for file in self._laid:
            self._lay(program, file)
        self._program = program

    def _lay(self, program: Path, file: Path) -> None:
        """Put a file of a program into the package."""
        part = Path(shutil.copy2(program / file, self._folder / "file.part"))
        part.replace(self._folder / "isomortar" / file)
