"""Settings of the process: what all of it is told where it is isomortar's own, and what becomes of its memory."""

from __future__ import annotations

import ctypes
import gc
import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Timer, main_thread

# Parameters of glibc's mallopt, with the variables of the environment that set them too.
_KEPT = {"MALLOC_MMAP_MAX_": (-4, 0), "MALLOC_TRIM_THRESHOLD_": (-1, -1)}
#: Variables of the environment that numerical libraries read while they are loaded. One thread for the linear algebra: more do not make
#: the solves faster, and get in the way of the assembly's.
_ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1"}
#: Threads of the assembly that wait look so many times before they sleep, some microseconds, as the next pass often comes at once. If they
#: did so without end two runs on the same cores would hold each other up tenfold.
_BRIEF_WAIT, _WAIT = {"GOMP_SPINCOUNT": "3000"}, "OMP_WAIT_POLICY"


def own_process() -> None:
    """Set up a process before it loads any library; what the user's environment says stands.

    Ctrl-C that comes where Python drops what is raised (destructors, callbacks of weak references) comes again. NumPy's linear algebra is
    told what the kernel's is. And Pydantic does not look through all that is installed for plugins of its own, which would have nothing to
    do here.
    """
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    os.environ.update(for_libraries())
    sys.unraisablehook = _heard_again


def for_libraries() -> dict[str, str]:
    """What the environment should say to numerical libraries while they are loaded, and the user's does not."""
    said = _ONE_THREAD if _WAIT in os.environ else _ONE_THREAD | _BRIEF_WAIT
    return {variable: value for variable, value in said.items() if variable not in os.environ}


def keep_memory() -> None:
    """Let memory that is freed stay with the process, where the C library is glibc and the user's environment does not say otherwise.

    Factors and matrices come and go, and pages that the system has to find and clear anew each time are up to a quarter of a
    factorisation. The process grows by some per cent for it.
    """
    library = ctypes.CDLL(None)
    if hasattr(library, "mallopt"):
        for variable, (parameter, value) in _KEPT.items():
            if variable not in os.environ:
                library.mallopt(parameter, value)


@contextmanager
def loading() -> Iterator[None]:
    """Look for no garbage while modules load: what they make stays, and to look through it time and again is a twentieth of a small run.

    What is there at the end is left out of later looks as well.
    """
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


@contextmanager
def numpy_as_loaded() -> Iterator[None]:
    """Show of NumPy what is loaded, to libraries that load meanwhile.

    SciPy copies all that NumPy says it has, which makes NumPy load what it would when asked for: test tools, a builder of extensions,
    classes with old names. That is a tenth of what a run takes before its first load step.
    """
    import numpy as np  # within: there are commands that do without

    names = vars(np)
    kept = {name: names[name] for name in ("__all__", "__dir__")}
    names.update(__all__=[name for name in kept["__all__"] if name in names], __dir__=lambda: list(names))
    try:
        yield
    finally:
        names.update(kept)


def _heard_again(dropped: sys.UnraisableHookArgs) -> None:
    """Interrupt once more a moment later, out of what was being destroyed."""
    if dropped.exc_type is KeyboardInterrupt:
        Timer(0.01, signal.pthread_kill, [main_thread().ident, signal.SIGINT]).start()
    else:
        sys.__unraisablehook__(dropped)


def give_back_memory() -> None:
    """Return what is freed to the system, where the C library is glibc."""
    library = ctypes.CDLL(None)
    if hasattr(library, "malloc_trim"):
        library.malloc_trim(0)
