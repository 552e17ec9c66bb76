"""Sparse LU of the kernel (UMFPACK) as an object: a pattern analysed once, factorised many times."""

from __future__ import annotations

import threading
import weakref
from typing import Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray

from isomortar import _arguments as check
from isomortar._codes import Status
from isomortar._compiled import kernel as _kernel
from isomortar._frozen import frozen
from isomortar.errors import InputError, KernelError, SingularSystemError

FloatArray = NDArray[np.float64]
LongArray = NDArray[np.int64]

#: UMFPACK's code where METIS or AMD gave up, which they do for want of memory.
_ORDERING_FAILED = -18

#: A factorisation that is estimated to take at most so many bytes (matrix, fronts and factors) gets indices of 32 bits, a tenth to an
#: eighth faster. These can address 2 GiB; what the estimate misses, `factorise` repeats with 64.
NARROW_LIMIT = 0.9 * 2.0**31

#: Most steps of iterative refinement that anyone can want: more is taken for a mistake.
MAX_REFINEMENT = 1000
#: Orderings on offer: METIS's nested dissection wins on large solids, approximate minimum degree on small contact-heavy systems.
Ordering = Literal["metis", "amd"]
ORDERINGS: tuple[Ordering, ...] = get_args(Ordering)


@frozen
class FactorStatistics:
    """What the last factorisation cost.

    Parameters
    ----------
    unknowns, entries : int
        Rows of the matrix and entries of its pattern.
    factor_entries : int
        Entries of L and U, both diagonals counted.
    flops : float
        Floating-point operations.
    peak_bytes : int
        Most memory in use at a time, analysis included.
    """

    unknowns: int
    entries: int
    factor_entries: int
    flops: float
    peak_bytes: int


class SparseLU:
    """LU factorisation of unsymmetric sparse matrices of one pattern.

    The pattern is ordered and analysed here, once; `factorise` and `solve` use the analysis again and again. The kernel keeps a copy
    of the pattern, in 32-bit indices where the factorisation is small enough for them. Values are taken as they are, never copied,
    and must not change while the object is in use. Different objects may work in different threads at the same time (the kernel
    runs without Python's lock); calls on one object wait for each other.

    Parameters
    ----------
    indptr : ndarray of int64, shape (n + 1,)
        Start of each row in `indices` (compressed rows).
    indices : ndarray of int64, shape (nnz,)
        Columns, strictly increasing within each row.
    ordering : {"metis", "amd"}
        How the unknowns are ordered.

    Raises
    ------
    InputError
        The pattern is not a square compressed-row pattern as above.
    KernelError
        Memory ran out, or UMFPACK failed.

    Attributes
    ----------
    ordering : str
    index_bits : {32, 64}
        Width of the indices in use.
    rcond : float
        Estimate of the reciprocal condition (smallest over largest pivot) of the last matrix; NaN before the first.
    statistics : FactorStatistics or None
        What the last successful factorisation cost.
    """

    def __init__(self, indptr: LongArray, indices: LongArray, *, ordering: Ordering = "metis") -> None:
        check_pattern(indptr, indices)
        if ordering not in ORDERINGS:
            raise InputError(f"is {ordering!r}; allowed: {', '.join(ORDERINGS)}", "ordering")
        self.ordering = ordering
        self.rcond = float("nan")
        self.statistics: FactorStatistics | None = None
        self._indptr, self._indices = indptr, indices
        self._values: FloatArray | None = None
        self._lock = threading.Lock()
        self._analyse(NARROW_LIMIT)

    def _analyse(self, narrow_limit: float) -> None:
        """Order and analyse the pattern, and own what comes of it."""
        self._handle, narrow, place, status = _kernel.sparse_analyse(self._indptr, self._indices, self.ordering == "metis", narrow_limit)
        _check_status(status, place)
        self.index_bits = 32 if narrow else 64
        self._release = weakref.finalize(self, _kernel.sparse_release, self._handle)
        self._release.atexit = False  # a thread may still be at work, and the memory goes with the process

    @property
    def flops(self) -> float:
        """Floating-point operations of the last successful factorisation; infinite before the first."""
        return self.statistics.flops if self.statistics else float("inf")

    @property
    def unknowns(self) -> int:
        """Number of unknowns n."""
        return len(self._indptr) - 1

    def factorise(self, values: FloatArray, *, rcond_min: float = 1e-13) -> Self:
        """Factorise a matrix of the pattern; its factors take the place of the last ones.

        Parameters
        ----------
        values : ndarray of float64, shape (nnz,)
            Entries of the matrix in the order of `indices`. Kept by reference for the refinement in `solve`.
        rcond_min : float
            Smallest reciprocal condition that passes for regular: a matrix that is singular but for round-off has pivots.

        Returns
        -------
        SparseLU
            This object.

        Raises
        ------
        SingularSystemError
            The matrix is singular or `rcond` below `rcond_min`; `place` is the unknown that is determined least, one of those that
            nothing holds.
        KernelError
            An entry is not finite (`place`: its row), memory ran out, or UMFPACK failed.
        InputError
            Wrong type or shape of `values`.
        """
        check.array("values", values, np.float64, len(self._indices))
        check.real("rcond_min", rcond_min, lambda value: 0 <= value < 1, "a number from 0 to below 1")
        check_finite(values, self._indptr)
        with self._lock:
            self._values = None
            found = _kernel.sparse_factorise(self._handle, values, rcond_min)
            if found[-1] == Status.OUT_OF_MEMORY and self.index_bits == 32:
                self._release()
                self._analyse(0.0)
                found = _kernel.sparse_factorise(self._handle, values, rcond_min)
            self.rcond, flops, peak_bytes, factor_entries, place, status = found
            if status == Status.SINGULAR:
                raise SingularSystemError(
                    f"the linear system is singular: reciprocal condition {self.rcond:.1e}, least determined is unknown {place}. "
                    "Something is not held by supports or contact, or constraints repeat each other",
                    place,
                )
            _check_status(status, place)
            self._values = values
            self.statistics = FactorStatistics(self.unknowns, len(self._indices), int(factor_entries), flops, int(peak_bytes))
        return self

    def solve(self, b: FloatArray, *, refine: int = 2) -> FloatArray:
        """Solve A x = b with the factors of the last `factorise`.

        Parameters
        ----------
        b : ndarray, shape (n,) or (n, k)
            Right-hand side, or k of them.
        refine : int
            Most steps of iterative refinement for each; the steps end when they gain nothing. 0: none.

        Returns
        -------
        ndarray, shape of `b`
            The solution.

        Raises
        ------
        KernelError
            Nothing is factorised, an entry of `b` is not finite (`place`: its row), or UMFPACK failed.
        InputError
            Wrong type or shape of `b`, or `refine` negative.
        """
        b = np.asarray(b)
        if b.dtype.kind not in "iuf":
            raise InputError(f"is of type {b.dtype}; allowed: real numbers", "b")
        b = b.astype(np.float64, copy=False)
        if b.ndim not in (1, 2) or len(b) != self.unknowns:
            raise InputError(f"has shape {b.shape}; allowed: ({self.unknowns},) or ({self.unknowns}, k)", "b")
        check.whole("refine", refine, 0, MAX_REFINEMENT)
        columns = b.reshape(self.unknowns, -1)
        finite = np.isfinite(columns).all(axis=1)
        if not finite.all():
            row = int(np.argmin(finite))
            raise KernelError(f"the right-hand side is not finite in row {row}", row)
        with self._lock:
            if self._values is None:
                raise KernelError("no matrix is factorised: the last one was refused, or there was none")
            x, place, status = _kernel.sparse_solve(self._handle, self._values, np.asfortranarray(columns), refine)
            _check_status(status, place)
        return np.asarray(x).reshape(b.shape)


def check_pattern(indptr: LongArray, indices: LongArray) -> None:
    """Refuse what is not a square pattern in compressed rows with sorted columns."""
    check.array("indptr", indptr, np.int64, None)
    check.array("indices", indices, np.int64, None)
    n = len(indptr) - 1
    if n < 1:
        raise InputError("has no rows; a matrix needs one at least", "indptr")
    check.compressed("indptr", indptr, len(indices))
    if len(indices) and not 0 <= indices.min() <= indices.max() < n:
        raise InputError(f"has columns outside 0 to {n - 1}", "indices")
    rising = np.diff(indices, append=n) > 0
    rising[indptr[1:][indptr[1:] > 0] - 1] = True  # the step from one row to the next may fall
    if not rising.all():
        row = int(np.searchsorted(indptr, np.argmin(rising), side="right")) - 1
        raise InputError(f"must increase strictly within each row; they do not in row {row}", "indices")


def check_finite(values: FloatArray, indptr: LongArray) -> None:
    """Refuse a matrix with NaN or infinity: its factorisation would end as singular and name the wrong unknown."""
    finite = np.isfinite(values)
    if not finite.all():
        row = int(np.searchsorted(indptr, np.argmin(finite), side="right")) - 1
        raise KernelError(f"the matrix is not finite in row {row}", row)


def _check_status(status: int, place: int) -> None:
    """Raise the sentence of a status code; what is singular has its own above."""
    if status == Status.OUT_OF_MEMORY:
        raise KernelError(
            f"too many factorisations are alive: the kernel holds {place} of them; let some go"
            if place >= 0
            else "memory ran out in the sparse LU: take fewer elements or a lower order"
        )
    if status == Status.LIBRARY and place == _ORDERING_FAILED:
        raise KernelError("the sparse LU could not order the unknowns: most likely memory ran out; take fewer elements or a lower order")
    if status == Status.STALE_HANDLE:
        raise KernelError("the factorisation was released before, or never made")
    if status != Status.OK:
        raise KernelError(f"UMFPACK failed with its code {place}")
