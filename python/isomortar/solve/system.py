"""The linear system: blocked sources gathered into one compressed matrix, its factors, its solution."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence

import numpy as np
from scipy import sparse

from isomortar import _bindings
from isomortar._bindings import Pattern
from isomortar._frozen import frozen
from isomortar._sparse import Ordering, SparseLU
from isomortar.errors import KernelError, SingularSystemError
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.solve.timing import Ledger


def orderings(size: int) -> tuple[Ordering, ...]:
    """Orderings to try for a system of so many unknowns."""
    return (*(("amd",) if size <= constants.UNDOUBTED[1] else ()), *(("metis",) if size >= constants.UNDOUBTED[0] else ()))


@frozen(eq=False)
class Source:
    """A matrix of 3x3 blocks and where its rows and columns stand in the system (-1: dropped)."""

    pattern: Pattern
    row_of: IntArray
    column_of: IntArray
    transposed: bool = False

    def places(self) -> tuple[IntArray, IntArray]:
        """Rows and columns of the entries in the numbering of the system, without those that are dropped."""
        rows, columns = self.row_of.reshape(-1, 3), self.column_of.reshape(-1, 3)
        block_row = np.repeat(np.arange(len(rows)), np.diff(self.pattern.start))
        row = np.broadcast_to(rows[block_row][:, :, None], (len(block_row), 3, 3)).ravel()
        column = np.broadcast_to(columns[self.pattern.column][:, None, :], (len(block_row), 3, 3)).ravel()
        kept = (row >= 0) & (column >= 0)
        return (column[kept], row[kept]) if self.transposed else (row[kept], column[kept])


def entries(sources: Sequence[Source], size: int) -> sparse.csr_array:
    """Pattern of ones of several sources together, in the numbering of the system."""
    places = [source.places() for source in sources]
    row, column = (np.concatenate([place[k] for place in places]) for k in range(2))
    pattern = sparse.csr_array((np.ones(len(row), dtype=np.int8), (row, column)), shape=(size, size))
    pattern.data[:] = 1  # however often an entry is met
    return pattern


class CheckedSystem(ABC):
    """A linear system with a fixed pattern that is factorised and solved many times; the first solution by any factors is checked.

    Attributes
    ----------
    size : int
        How many unknowns it has.
    """

    def __init__(self, size: int, ledger: Ledger) -> None:
        self.size, self._ledger = size, ledger
        self._refines = False

    @abstractmethod
    def begin(self) -> None:
        """Begin a load increment: what it does follows from the state that it starts from, and not from increments before."""

    @property
    @abstractmethod
    def rcond(self) -> float:
        """Estimate of the reciprocal condition of the last factors."""

    @abstractmethod
    def factorise(self, sources: Sequence[FloatArray]) -> None:
        """Gather the values of all sources and factorise.

        Raises
        ------
        SingularSystemError
            `place` is an equation that nothing holds.
        """

    def by_bodies(self, step: FloatArray) -> FloatArray | None:  # noqa: ARG002
        """The bodies' stiffness that was factorised last times a step of their unknowns; None where its factors can not stay alone."""
        return None

    @property
    @abstractmethod
    def ordering(self) -> Ordering | None:
        """The ordering that general factors have kept, after the first ones."""

    @abstractmethod
    def near_null(self) -> FloatArray:
        """A direction that a singular matrix maps to next to nothing, of length one; not a number if there is no telling."""

    @abstractmethod
    def _substituted(self, right: FloatArray) -> FloatArray:
        """Solution by the factors as they are."""

    @abstractmethod
    def _refined(self, solution: FloatArray, right: FloatArray) -> FloatArray:
        """A solution that leaves less."""

    @abstractmethod
    def _product(self, solution: FloatArray) -> FloatArray:
        """The matrix times a vector."""

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution for one right-hand side, shape (unknowns,).

        Raises
        ------
        SingularSystemError
            What it leaves of the right-hand side is not small, nor is it after refinement.
        """
        with self._ledger.phase("solve"):
            solution = self._substituted(right)
            self._refines = not self._left(solution, right) <= constants.REFINED_ABOVE
            if self._refines:
                solution = self._refined(solution, right)
                left = self._left(solution, right)
                if not left <= constants.REFUSED_ABOVE:
                    raise SingularSystemError(
                        f"the solution of the linear system leaves {left:.1e} of its right-hand side: round-off has taken its digits "
                        f"(reciprocal condition {self.rcond:.1e})",
                        -1,
                    )
        self._ledger.counts["solves"] += 1
        return solution

    def solve_again(self, right: FloatArray) -> FloatArray:
        """Solution by factors that have solved before, for an iteration that looks itself at what it leaves.

        It is checked, which takes a product with the matrix, and refined where the one before had to be, or where it is no number.

        Raises
        ------
        SingularSystemError
            As `solve`.
        """
        if not self._refines:
            with self._ledger.phase("solve"):
                solution = self._substituted(right)
            if np.isfinite(solution).all():
                self._ledger.counts["solves"] += 1
                return solution
        return self.solve(right)

    def _left(self, solution: FloatArray, right: FloatArray) -> float:
        """What a solution leaves of the right-hand side; not a number where it is not finite."""
        size = float(np.linalg.norm(right))
        return float(np.linalg.norm(right - self._product(solution))) / size if size > 0.0 else float(np.abs(solution).max(initial=0.0))


class LinearSystem(CheckedSystem):
    """A general system: analysed once, assembled, factorised and solved many times."""

    def __init__(
        self,
        size: int,
        sources: Sequence[Source],
        ledger: Ledger,
        known: sparse.csr_array | None = None,
        ordering: Ordering | None = None,
    ) -> None:
        """Analyse the pattern of all sources together.

        `known` is that of the first source in its own rows and columns, where it is at hand already. Without an `ordering` that one of
        the size is kept whose first factors take the fewest operations.
        """
        super().__init__(size, ledger)
        first = entries(sources[:1], size) if known is None else known
        start = np.append(first.indptr, np.full(size + 1 - len(first.indptr), first.nnz, dtype=first.indptr.dtype))
        total = sparse.csr_array((first.data, first.indices, start), shape=(size, size))
        if len(sources) > 1:
            total = total + entries(sources[1:], size)
        self._start, self._column = total.indptr.astype(np.int64), total.indices.astype(np.int64)
        self.values = np.zeros(len(self._column))
        self._whole = self.matrix()  # the values are its own
        with ledger.phase("factor"):
            self._places = [
                _bindings.find_places(s.pattern, s.row_of, s.column_of, s.transposed, self._start, self._column) for s in sources
            ]
            self._rivals = [SparseLU(self._start, self._column, ordering=name) for name in ((ordering,) if ordering else orderings(size))]
        ledger.counts["analyses"] += len(self._rivals)

    def begin(self) -> None:
        """The orderings that were chosen are part of the state."""

    def factorise(self, sources: Sequence[FloatArray]) -> None:
        """Gather the values of all sources and factorise."""
        with self._ledger.phase("factor"):
            self.values[:] = 0.0
            for places, source in zip(self._places, sources, strict=True):
                _bindings.add_values(places, source, self.values)
            sound, refused = [], None
            for factors in self._rivals:
                try:
                    sound.append(factors.factorise(self.values))
                except SingularSystemError as error:  # by this ordering
                    refused = error
            if refused and not sound:
                raise refused
            best = min(sound, key=lambda factors: factors.flops)
            self._rivals = [best]
        self._ledger.counts["factorisations"] += 1
        self._ledger.largest("system non-zeros", len(self._column))
        self._ledger.largest("factor non-zeros", best.statistics.factor_entries if best.statistics else 0)

    @property
    def rcond(self) -> float:
        """Estimate of the reciprocal condition of the last factors."""
        return self._rivals[0].rcond

    @property
    def ordering(self) -> Ordering:
        """The ordering that was kept, after the first factors."""
        return self._rivals[0].ordering

    def _substituted(self, right: FloatArray) -> FloatArray:
        return self._rivals[0].solve(right, refine=0)

    def _refined(self, solution: FloatArray, right: FloatArray) -> FloatArray:  # noqa: ARG002  UMFPACK begins anew
        return self._rivals[0].solve(right)

    def _product(self, solution: FloatArray) -> FloatArray:
        return np.asarray(self._whole @ solution)

    def near_null(self) -> FloatArray:
        """By inverse iteration on a matrix next to it: the one itself has no factors."""
        matrix = self.matrix()
        size = matrix.shape[0]
        beside = sparse.csr_array(matrix + constants.SHIFT * float(np.abs(self.values).max()) * sparse.eye_array(size))
        beside.sort_indices()
        direction = np.random.default_rng(0).standard_normal(size)
        try:
            factors = SparseLU(beside.indptr.astype(np.int64), beside.indices.astype(np.int64), ordering=self.ordering)
            factors.factorise(beside.data, rcond_min=0.0)
            for _ in range(3):
                direction = factors.solve(direction)
                direction /= np.linalg.norm(direction)
        except KernelError:
            return np.full(size, np.nan)
        return direction

    def matrix(self) -> sparse.csr_array:
        """The assembled matrix."""
        return sparse.csr_array((self.values, self._column, self._start), shape=(len(self._start) - 1,) * 2)


def add_product(source: Source, values: FloatArray, vector: FloatArray, right: FloatArray) -> None:
    """Add a source with given values, times a field of control points, to the equations of its rows."""
    copies = len(source.column_of) // 3 - len(vector)
    product = block_product(source.pattern, values, np.pad(vector, ((0, copies), (0, 0))) if copies else vector).ravel()
    kept = source.row_of >= 0
    np.add.at(right, source.row_of[kept], product[kept])


def block_product(pattern: Pattern, values: FloatArray, vector: FloatArray) -> FloatArray:
    """Product of a matrix of blocks with a field of control points, cheap where that is zero at most of them; (rows of blocks, 3)."""
    field = vector.reshape(-1, 3)
    rows = len(pattern.start) - 1
    met = np.flatnonzero(np.any(field != 0.0, axis=1)[pattern.column])
    row = np.searchsorted(pattern.start, met, side="right") - 1
    shares = np.einsum("bij,bj->ib", values[met], field[pattern.column[met]])
    return np.stack([np.bincount(row, share, minlength=rows) for share in shares], axis=1)
