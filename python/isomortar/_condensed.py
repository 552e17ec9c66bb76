"""Factors of the bodies' symmetric stiffness with what contact adds on its faces (CHOLMOD, LAPACK), of the kernel, as an object."""

from __future__ import annotations

import threading
import weakref
from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from isomortar import _arguments as check
from isomortar._codes import Status
from isomortar._compiled import kernel as _kernel
from isomortar._frozen import frozen
from isomortar._sparse import ORDERINGS, FloatArray, LongArray, Ordering, check_finite, check_pattern
from isomortar.errors import InputError, KernelError, SingularSystemError


@frozen(eq=False)
class SymmetricPattern:
    """Where a symmetric matrix has entries: checked here, once, for all that is made of it.

    Parameters
    ----------
    indptr : ndarray of int64, shape (n + 1,)
        Start of each row in `indices` (compressed rows).
    indices : ndarray of int64, shape (nnz,)
        Columns, strictly increasing within each row; both halves, with the whole diagonal.

    Raises
    ------
    InputError
        The pattern is not as above.
    """

    indptr: LongArray
    indices: LongArray

    def __post_init__(self) -> None:
        check_pattern(self.indptr, self.indices)
        pattern = sparse.csr_array((np.ones(len(self.indices), dtype=bool), self.indices, self.indptr), shape=(len(self),) * 2)
        mirrored = pattern.tocsc()
        if not (np.array_equal(mirrored.indptr, self.indptr) and np.array_equal(mirrored.indices, self.indices)):
            raise InputError("is not symmetric: an entry has no mirror image", "indices")
        if not pattern.diagonal().all():
            raise InputError("has no entry on the diagonal in some row", "indices")

    def __len__(self) -> int:
        """Rows."""
        return len(self.indptr) - 1

    def fill_reducing(self, ordering: Ordering) -> tuple[LongArray, float]:
        """Order the rows for little fill.

        Parameters
        ----------
        ordering : {"metis", "amd"}

        Returns
        -------
        ndarray of int64, shape (n,)
            The rows in their order.
        float
            Floating-point operations of a Cholesky factorisation by it.

        Raises
        ------
        InputError
            There is no such ordering.
        KernelError
            Memory ran out, or CHOLMOD failed.
        """
        if ordering not in ORDERINGS:
            raise InputError(f"is {ordering!r}; allowed: {', '.join(ORDERINGS)}", "ordering")
        order, flops, status = _kernel.condensed_order(self.indptr, self.indices, ordering == "metis")
        _check_status(status, -1)
        return order, flops


class BodyFactors(ABC):
    """Factors of ``K + C``: K symmetric and sparse, C dense, on some unknowns of K, the faces, and on others that are not of K.

    K is factorised with the faces last, what is left on these, with C, by LU. Different objects may work in different threads at the same
    time; calls on one object wait for each other.

    Parameters
    ----------
    pattern : SymmetricPattern
        That of K.
    on_face : ndarray of bool, shape (n,)
        Which unknowns are faces'.
    order : ndarray of int64, shape (n,)
        That of the others: all unknowns, by `SymmetricPattern.fill_reducing`.

    Raises
    ------
    InputError
        The faces or the order are not as above.

    Attributes
    ----------
    faces : int
        Number of unknowns of faces.
    factor_entries : int
        Entries of the factor of K.
    rcond : float
        Estimate of the reciprocal condition of the last matrix; NaN before the first.
    compression : float
        What the factor of K may leave out; 0: nothing.
    """

    factor_entries: int
    compression: float = 0.0

    def __init__(self, pattern: SymmetricPattern, on_face: NDArray[np.bool_], order: LongArray) -> None:
        n = len(pattern)
        check.array("on_face", on_face, np.bool_, n)
        if not np.array_equal(np.sort(check.array("order", order, np.int64, n)), np.arange(n)):
            raise InputError(f"is no order of the unknowns 0 to {n - 1}", "order")
        self.faces, self.rcond = int(np.count_nonzero(on_face)), float("nan")
        self._pattern, self._others = pattern, -1
        self._lock = threading.Lock()

    @abstractmethod
    def _eliminate(self, values: FloatArray, added: FloatArray, rcond_min: float) -> None:
        """Factorise what is checked."""

    @abstractmethod
    def _eliminate_faces(self, added: FloatArray, rcond_min: float) -> None:
        """Factorise another C that is checked, with the K of before."""

    @abstractmethod
    def _substitute(self, b: FloatArray) -> FloatArray:
        """Solve for a right-hand side that is checked."""

    def factorise(self, values: FloatArray, added: FloatArray, *, rcond_min: float = 1e-13) -> None:
        """Factorise ``K + C``; its factors take the place of the last ones.

        Parameters
        ----------
        values : ndarray of float64, shape (nnz,)
            Entries of K in the order of its pattern. Of the two halves one counts.
        added : ndarray of float64, shape (t, t), Fortran order
            C on the unknowns of faces, by their numbers, and on the others after them.
        rcond_min : float
            Smallest reciprocal condition that passes for regular.

        Raises
        ------
        SingularSystemError
            K is not definite within, or `rcond` is below `rcond_min`: what is so may be regular, and is for `SparseLU` to judge. `place`
            is -1.
        KernelError
            An entry is not finite (`place`: its row), memory ran out, or the library failed.
        InputError
            Wrong type or shape of an argument.
        """
        check.array("values", values, np.float64, len(self._pattern.indices))
        self._check_added(added, rcond_min)
        check_finite(values, self._pattern.indptr)
        with self._lock:
            self._others = -1
            self._eliminate(values, added, rcond_min)
            self._others = len(added) - self.faces

    def renew(self, added: FloatArray, *, rcond_min: float = 1e-13) -> None:
        """Factorise ``K + C`` for another C, with the K of the last `factorise`, whose factors stay.

        Parameters
        ----------
        added, rcond_min
            As there; others may be more or fewer.

        Raises
        ------
        SingularSystemError, KernelError, InputError
            As there; KernelError also where nothing is factorised.
        """
        self._check_added(added, rcond_min)
        with self._lock:
            self._check_factorised()
            self._others = -1
            self._eliminate_faces(added, rcond_min)
            self._others = len(added) - self.faces

    def _check_factorised(self) -> None:
        if self._others < 0:
            raise KernelError("no matrix is factorised: the last one was refused, or there was none")

    def _check_added(self, added: FloatArray, rcond_min: float) -> None:
        check.array("added", added.T if isinstance(added, np.ndarray) else added, np.float64, None, None)
        if added.shape[0] != added.shape[1] or len(added) < self.faces:
            raise InputError(f"has shape {added.shape}; allowed: square, of {self.faces} unknowns of faces and others", "added")
        check.real("rcond_min", rcond_min, lambda value: 0 <= value < 1, "a number from 0 to below 1")
        if not np.isfinite(added).all():
            raise KernelError("what is added to the matrix is not finite", -1)

    def solve(self, b: FloatArray) -> FloatArray:
        """Solve ``(K + C) x = b`` with the factors of the last `factorise` or `renew`.

        Parameters
        ----------
        b : ndarray of float64, shape (n + others,)

        Returns
        -------
        ndarray, shape (n + others,)

        Raises
        ------
        KernelError
            Nothing is factorised, or an entry of `b` is not finite (`place`: its row).
        InputError
            Wrong type or shape of `b`.
        """
        with self._lock:
            self._check_factorised()
            check.array("b", b, np.float64, len(self._pattern) + self._others)
            finite = np.isfinite(b)
            if not finite.all():
                row = int(np.argmin(finite))
                raise KernelError(f"the right-hand side is not finite in row {row}", row)
            return self._substitute(b)


class CondensedFactors(BodyFactors):
    """The same by Cholesky (CHOLMOD) in this process; the diagonals of faces are doubled meanwhile.

    The pattern of K is analysed here, once.

    Parameters
    ----------
    pattern, on_face, order
        As above.

    Raises
    ------
    InputError
        The faces or the order are not as above.
    KernelError
        Memory ran out, or CHOLMOD failed.

    Attributes
    ----------
    flops : float
        Floating-point operations of a factorisation of K.
    """

    def __init__(self, pattern: SymmetricPattern, on_face: NDArray[np.bool_], order: LongArray) -> None:
        super().__init__(pattern, on_face, order)
        self._handle, self.flops, entries, place, status = _kernel.condensed_analyse(
            pattern.indptr, pattern.indices, on_face.astype(np.int32), order
        )
        _check_status(status, place)
        self.factor_entries = int(entries)
        release = weakref.finalize(self, _kernel.sparse_release, self._handle)
        release.atexit = False  # a thread may still be at work, and the memory goes with the process

    def _eliminate(self, values: FloatArray, added: FloatArray, rcond_min: float) -> None:
        self.rcond, status = _kernel.condensed_factorise(self._handle, values, added, rcond_min)
        _check_status(status, -1)

    def _eliminate_faces(self, added: FloatArray, rcond_min: float) -> None:
        self.rcond, status = _kernel.condensed_renew(self._handle, added, rcond_min)
        _check_status(status, -1)

    def _substitute(self, b: FloatArray) -> FloatArray:
        x, status = _kernel.condensed_solve(self._handle, b)
        _check_status(status, -1)
        return np.asarray(x)


def _check_status(status: int, place: int) -> None:
    """Raise the sentence of a status code."""
    if status == Status.SINGULAR:
        raise SingularSystemError("the stiffness of the bodies is not definite, or what is left on their faces is singular", -1)
    if status == Status.OUT_OF_MEMORY:
        raise KernelError(
            f"too many factorisations are alive: the kernel holds {place} of them; let some go"
            if place >= 0
            else "memory ran out in the Cholesky factors: take fewer elements or a lower order"
        )
    if status == Status.STALE_HANDLE:
        raise KernelError("the factorisation was released before, or never made")
    if status != Status.OK:
        raise KernelError("CHOLMOD failed: most likely memory ran out; take fewer elements or a lower order")
