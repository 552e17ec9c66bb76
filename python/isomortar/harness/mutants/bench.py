"""Where cells are measured on other kernels: a copy of the package, and a process that takes its kernel from there."""

from __future__ import annotations

import importlib.util
import shutil
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from types import TracebackType

import isomortar
from isomortar.errors import IsomortarError
from isomortar.harness.cases import Cell
from isomortar.harness.measurement import Measurement
from isomortar.harness.worker import Worker, task_of

#: Most memory of a measuring process, bytes: a fault in a size must not take the machine down.
_MEMORY = 8 << 30
#: Starts a worker on the package of a bench. With `-S`: the import hook of an editable install would come first.
_START = """
import os, resource, runpy, sys
resource.setrlimit(resource.RLIMIT_AS, ({memory}, {memory}))
resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, {package!r})
sys.path.extend({installed!r})
runpy.run_module("isomortar.harness.worker", run_name="__main__")
"""
_HIDDEN = shutil.ignore_patterns("__pycache__")


def freeze(cases: Path, folder: Path) -> tuple[Path, Path]:
    """Copy the package with the extended-precision twin, and the cases: what is edited during a campaign does not touch it.

    Returns
    -------
    package, cases : Path
        The copies.
    """
    twin = importlib.util.find_spec("isomortar._extended")
    if twin is None or twin.origin is None:
        raise IsomortarError("the extended-precision twin is not built: `make setup` builds it")
    shutil.rmtree(folder, ignore_errors=True)
    package = Path(shutil.copytree(Path(isomortar.__file__).parent, folder / "isomortar", ignore=_HIDDEN))
    shutil.copy2(twin.origin, package)
    return package, Path(shutil.copytree(cases, folder / "cases", ignore=_HIDDEN))


class Bench:
    """A place to measure cells on any kernel, one kernel at a time. A context manager.

    Parameters
    ----------
    package, cases : Path
        What `freeze` made. The package is copied once more, for this bench's kernels.
    folder : Path
        Where to work.
    """

    def __init__(self, package: Path, cases: Path, folder: Path) -> None:
        self._cases, self._folder = cases.resolve(), folder.resolve()
        self._kernel: Path | None = None
        self._worker: Worker | None = None
        self._closed = False
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(package, folder / "isomortar")

    def __enter__(self) -> Bench:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self._closed = True
        self._end()

    def measure(self, kernel: Path, cell: Cell, seconds: float) -> Measurement:
        """Measure a cell on a kernel within a time.

        Raises
        ------
        IsomortarError
            The bench was closed meanwhile: that its process died then says nothing about the kernel.
        """
        if self._worker is None or kernel != self._kernel:
            self._worker, self._kernel = self._started(kernel), kernel
        path = cell.case.path
        task = task_of(cell) | {"path": str(self._cases / path.parent.name / path.name), "seconds": seconds}
        measurement = self._worker.measure(task)
        if self._closed:
            raise IsomortarError("the measurement was given up")
        return measurement

    def _end(self) -> None:
        if self._worker:
            self._worker.__exit__(None, None, None)

    def _started(self, kernel: Path) -> Worker:
        """A worker with a kernel; the one before is ended."""
        self._end()
        part = Path(shutil.copy2(kernel, self._folder / "kernel.part"))
        part.replace(self._folder / "isomortar" / f"_kernel{EXTENSION_SUFFIXES[0]}")
        installed = [path for path in sys.path if path]
        start = _START.format(memory=_MEMORY, package=str(self._folder), installed=installed)
        return Worker((sys.executable, "-S", "-c", start))
