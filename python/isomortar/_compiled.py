"""The compiled kernel, loaded with settings of its libraries that suit it; nobody has to know of them.

Libraries read the settings from the environment while they are loaded, and there they stand no longer than that: what the
user has set stands, and what the program around us does with libraries of its own is left to it.

- Debian's OpenBLAS takes a processor that is younger than itself for a very old one: matrix products, and with them assembly and
  factorisation, are then two to ten times slower. The right choice follows from the processor's flags.
- One thread for OpenBLAS, and threads of the assembly that wait for a moment, then sleep; one in a process that is forked off.
- Memory that is freed stays with the process (`keep_memory`), that of the program around us too.

Another kernel with the same interface takes its place where the environment names one (docs/programs.md).
"""

from __future__ import annotations

import ctypes
import importlib
import importlib.util
import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import ModuleType

from isomortar._process import for_libraries, keep_memory
from isomortar.errors import InputError

#: Variable of the environment that names the file of another kernel, for this process and those that it starts.
KERNEL = "ISOMORTAR_KERNEL"


def processor_kind(flags: frozenset[str]) -> str | None:
    """OpenBLAS's name for the best routines that a processor with these flags can run; None: leave it to OpenBLAS."""
    if {"avx512f", "avx512dq", "avx512bw", "avx512vl"} <= flags:
        return "SkylakeX"
    if {"avx2", "fma"} <= flags:
        return "Haswell"
    return None


@cache
def _processor_flags() -> frozenset[str]:
    """Flags of the first processor, from the system; empty where the system does not tell."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return frozenset()
    return frozenset(next((line for line in lines if line.startswith("flags")), "").split())


def kernel_at(path: Path, own: ModuleType) -> ModuleType:
    """The kernel of a file, a compiled module or one of Python, with all routines that the own one has.

    Raises
    ------
    InputError
        There is no such file, it is no module of that name, or routines are missing.
    """
    name = path.name.partition(".")[0]
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None or not path.is_file():
        raise InputError(f"{path} is no file of a module: name a compiled one (.so), or one of Python (.py)", "kernel")
    try:
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    except (ImportError, SyntaxError) as error:
        raise InputError(f"{path} cannot be imported: {error}", "kernel") from error
    missing = [routine for routine in dir(own) if not routine.startswith("_") and not callable(getattr(module, routine, None))]
    if missing:
        raise InputError(f"{path} has no {', '.join(missing)}: a kernel has all routines of fortran/api", "kernel")
    return module


@contextmanager
def _settings() -> Iterator[None]:
    """Say what libraries should read while they are loaded, where the user has not."""
    kind = processor_kind(_processor_flags())
    ours = for_libraries()
    if kind and "OPENBLAS_CORETYPE" not in os.environ:
        ours["OPENBLAS_CORETYPE"] = kind
    os.environ.update(ours)
    try:
        yield
    finally:
        for variable in ours:
            del os.environ[variable]


def _alone() -> None:
    """Take one thread for the assembly: in a process that is forked off those of its parent are missing, and would be waited for."""
    ctypes.CDLL(_own).omp_set_num_threads(1)


def suited_kernel() -> ModuleType:
    """The package's kernel: as it was compiled for AVX2, where the processor has that and the build made one; both give the same bits."""
    wide = "isomortar._kernel_avx2"
    has_wide = "avx2" in _processor_flags() and importlib.util.find_spec(wide)
    return importlib.import_module(wide if has_wide else "isomortar._kernel")


keep_memory()
with _settings():
    kernel = suited_kernel()
    _own = kernel.__file__
    os.register_at_fork(after_in_child=_alone)
    if KERNEL in os.environ:
        kernel = kernel_at(Path(os.environ[KERNEL]), kernel)


@cache
def mumps() -> ModuleType:
    """The extension of the engine mumps, which brings MPI: loaded where it is asked for, and not before."""
    with _settings():
        from isomortar import _mumps
    return _mumps


__all__ = ["KERNEL", "kernel", "kernel_at", "mumps", "processor_kind"]
