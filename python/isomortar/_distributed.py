"""The engine mumps: factors of the bodies on several ranks (MUMPS, MPI), by an extension that not every build has."""

from __future__ import annotations

import atexit
import importlib.util
import os
import threading
import weakref
from collections import deque
from functools import cache
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from isomortar._codes import Status
from isomortar._compiled import mumps
from isomortar._condensed import BodyFactors, SymmetricPattern
from isomortar._sparse import FloatArray, LongArray
from isomortar.errors import InputError, KernelError, SingularSystemError

#: Variable of the environment by which Open MPI's mpirun says how many programs it has started, as ``A : B``.
PROGRAMS = "OMPI_NUM_APP_CTX"
#: Ranks that wait leave their core to others: on a machine that is shared, runs are up to ten times slower where they spin.
YIELDING = "OMPI_MCA_mpi_yield_when_idle"
#: What a run on several ranks is started by.
STARTED_BY = "mpirun -n 1 isomortar run SCENE : -n 7 isomortar-factor"

#: All ranks do the same at the same time: one task after another.
_one_task = threading.Lock()
#: Handles of objects that are gone; a collection of garbage may come in the middle of a task.
_left: deque[int] = deque()


def is_built() -> bool:
    """Whether this build has the engine."""
    return importlib.util.find_spec("isomortar._mumps") is not None


def refuse_unbuilt() -> None:
    """Refuse the engine where this build does not have it.

    Raises
    ------
    InputError
    """
    if not is_built():
        raise InputError(
            'is "mumps", which this build does not have; build it in with `bash tools/setup.sh --mumps` (docs/engines.md), or take "own"',
            "solver.engine",
        )


@cache
def ranks() -> int:
    """How many processes factorise together, this one, the first, among them; from here on they listen.

    Raises
    ------
    InputError
        This process is not the first one, or the build does not have the engine.
    KernelError
        MPI has ended.
    """
    count, rank = _kernel().mumps_join()
    if count == 0:
        raise KernelError("MPI has ended in this process, and can not begin again")
    if rank > 0:
        raise InputError(f"is of the first rank, and this is rank {rank}: {STARTED_BY}", "solver.engine")
    atexit.register(_end)
    return int(count)


def serve() -> int:
    """Do what the first rank sets, until it ends; the number of this rank, from 0: on the first one nothing is done.

    Raises
    ------
    InputError
        The build does not have the engine.
    """
    return int(_kernel().mumps_serve())


def _kernel() -> ModuleType:
    """The extension, before MPI begins."""
    refuse_unbuilt()
    os.environ.setdefault(YIELDING, "1")
    return mumps()


def refuse_idle(engine: str) -> None:
    """Refuse to run alone where ranks were started beside this process: they would wait for it for ever.

    Raises
    ------
    InputError
    """
    if engine == "own" and _has_company():
        raise InputError(
            f'is "own", and ranks were started beside this run, which would wait for it; take "mumps", as in {STARTED_BY}, or run it alone',
            "solver.engine",
        )


def dismiss() -> None:
    """Let ranks that were started beside this process end with it, where nothing was to be factorised."""
    if _has_company():
        ranks()


def _has_company() -> bool:
    return int(os.environ.get(PROGRAMS, "1")) > 1


def _end() -> None:
    """End the other ranks with this process."""
    with _one_task:
        mumps().mumps_end()


def _forget(handle: int) -> None:
    """Have a handle released, now or before the next task."""
    _left.append(handle)
    if _one_task.acquire(blocking=False):
        try:
            _release_left(mumps())
        finally:
            _one_task.release()


def _release_left(kernel: ModuleType) -> None:
    while _left:
        kernel.mumps_release(_left.popleft())


class DistributedFactors(BodyFactors):
    """Factors of bodies with what contact adds on their faces, K by MUMPS on all ranks; the dense part is in this process.

    Parameters
    ----------
    pattern, on_face, order
        As in `BodyFactors`.
    compression : float
        Bound of what blocks of low rank leave out, of a matrix with a unit diagonal; 0: nothing.

    Raises
    ------
    InputError
        The faces or the order are not as above, or there are no ranks (`ranks`).
    KernelError
        Memory ran out, or MUMPS failed.
    """

    def __init__(self, pattern: SymmetricPattern, on_face: NDArray[np.bool_], order: LongArray, compression: float = 0.0) -> None:
        super().__init__(pattern, on_face, order)
        ranks()
        self._kernel, self.factor_entries, self.compression = mumps(), 0, compression
        with _one_task:
            _release_left(self._kernel)
            self._handle, place, status = self._kernel.mumps_analyse(
                pattern.indptr, pattern.indices, on_face.astype(np.int32), order, compression
            )
        _check_status(status, place)
        release = weakref.finalize(self, _forget, self._handle)
        release.atexit = False  # all that is left goes with the ranks

    def _eliminate(self, values: FloatArray, added: FloatArray, rcond_min: float) -> None:
        with _one_task:
            _release_left(self._kernel)
            self.rcond, entries, place, status = self._kernel.mumps_factorise(self._handle, values, added, rcond_min)
        _check_status(status, place)
        self.factor_entries = int(entries)

    def _eliminate_faces(self, added: FloatArray, rcond_min: float) -> None:
        with _one_task:
            self.rcond, status = self._kernel.mumps_renew(self._handle, added, rcond_min)
        _check_status(status, -1)

    def _substitute(self, b: FloatArray) -> FloatArray:
        with _one_task:
            x, place, status = self._kernel.mumps_solve(self._handle, b)
        _check_status(status, place)
        return np.asarray(x)


def _check_status(status: int, place: int) -> None:
    """Raise the sentence of a status code."""
    if status == Status.SINGULAR:
        raise SingularSystemError("the stiffness of the bodies is not definite, or what is left on their faces is singular", -1)
    if status == Status.OUT_OF_MEMORY:
        raise KernelError(
            f"too many factorisations are alive: the ranks hold {place} of them; let some go"
            if place >= 0
            else "memory ran out on one of the ranks: start more of them, on more machines, or take fewer elements"
        )
    if status == Status.STALE_HANDLE:
        raise KernelError("the factorisation was released before, or never made")
    if status != Status.OK:
        raise KernelError(f"MUMPS failed with its code {place}")
