"""The linear system by parts: the bodies by Cholesky, what is left on their faces with contact by dense LU (theory 5.11)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from scipy import sparse

from isomortar import _bindings
from isomortar._bindings import LongArray
from isomortar._condensed import BodyFactors, CondensedFactors, SymmetricPattern
from isomortar._distributed import DistributedFactors, ranks, refuse_unbuilt
from isomortar._sparse import Ordering
from isomortar.errors import KernelError, SingularSystemError
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.settings import SolverSettings
from isomortar.model.supports import BoolArray
from isomortar.solve.system import CheckedSystem, LinearSystem, Source, orderings
from isomortar.solve.timing import Ledger

#: Makes factors of a pattern, with the unknowns of faces last, in an order of the others.
Engine = Callable[[SymmetricPattern, BoolArray, LongArray], BodyFactors]


def engine_of(settings: SolverSettings) -> Engine | None:
    """What makes the bodies' factors; nothing where this process does it by itself. Other ranks listen from here on.

    Raises
    ------
    InputError
        The build does not have the engine, or this process is not the first one.
    """
    if settings.engine == "own":
        return None
    refuse_unbuilt()
    ranks()
    return partial(DistributedFactors, compression=settings.compression)


class Bodies:
    """The stiffness of all bodies: its unknowns are ordered once, and analysed anew where contact acts on others of them.

    Parameters
    ----------
    solid : Source
        Stiffness of the bodies.
    among : csr_array, shape (unknowns, unknowns)
        Where it has entries, among the free unknowns.
    ledger : Ledger
    engine : callable, optional
        Makes the factors, in the place of this process' own.

    Attributes
    ----------
    pattern : SymmetricPattern
        The same.
    on_face : ndarray of bool, shape (unknowns,)
        Unknowns that contact acts on.
    """

    def __init__(self, solid: Source, among: sparse.csr_array, ledger: Ledger, engine: Engine | None = None) -> None:
        self._ledger, self._engine = ledger, engine
        with ledger.phase("factor"):
            self.pattern = SymmetricPattern(among.indptr.astype(np.int64), among.indices.astype(np.int64))
            self._places = _bindings.find_places(
                solid.pattern, solid.row_of, solid.column_of, False, self.pattern.indptr, self.pattern.indices
            )
            rivals = [self.pattern.fill_reducing(ordering) for ordering in orderings(len(self.pattern))]
        ledger.counts["analyses"] += len(rivals)
        self._order = min(rivals, key=lambda rival: rival[1])[0]
        self._values, shape = np.zeros(len(self.pattern.indices)), (len(self.pattern),) * 2
        self._matrix = sparse.csr_array((self._values, self.pattern.indices, self.pattern.indptr), shape=shape)
        self._gathered: FloatArray | None = None  # the blocks that the values are of
        self._analyse(np.zeros(len(self.pattern), dtype=bool))

    def act_on(self, on_face: BoolArray) -> None:
        """Analyse with the unknowns that contact acts on last, where these are others than before."""
        if not np.array_equal(on_face, self.on_face):
            self._analyse(on_face)

    def _analyse(self, on_face: BoolArray) -> None:
        self._factors: BodyFactors | None = None  # they go before others come
        self._factorised = False
        with self._ledger.phase("factor"):
            analysed = CondensedFactors(self.pattern, on_face, self._order)
        self.on_face, self._faces, self._flops = on_face, float(analysed.faces), analysed.flops
        if self._engine is None:
            self._factors = analysed

    @property
    def factors(self) -> BodyFactors:
        """Factors with the unknowns that contact acts on last; an engine's are made when they are asked for."""
        if self._factors is None:
            assert self._engine is not None, "own factors are there"
            with self._ledger.phase("factor"):
                self._factors = self._engine(self.pattern, self.on_face, self._order)
        return self._factors

    def factorise(self, blocks: FloatArray, added: FloatArray) -> None:
        """Factorise with what contact adds; the bodies' factors stay where the blocks of their stiffness are the same array as before.

        Raises
        ------
        SingularSystemError
        """
        stands = self._gathered is blocks and self._factorised
        if self._gathered is not blocks:
            self._values[:] = 0.0
            _bindings.add_values(self._places, blocks, self._values)
            self._gathered = blocks
        self._factorised = False
        if stands:
            self.factors.renew(added)
        else:
            self.factors.factorise(self._values, added)
        self._factorised = True

    def product(self, vector: FloatArray) -> FloatArray:
        """The stiffness that was factorised last times a vector, both of shape (unknowns,)."""
        return np.asarray(self._matrix @ vector)

    def condense(self, others: int) -> bool:
        """Whether what is dense, with so many unknowns more than faces have, is worth its operations (theory 5.13)."""
        return self._faces**3 + 2.0 / 3.0 * (self._faces + others) ** 3 <= constants.DENSE_SHARE * self._flops


def touched(sources: Sequence[Source], unknowns: int) -> BoolArray:
    """Which of the bodies' unknowns some sources act on, shape (unknowns,)."""
    found = np.zeros(unknowns + 1, dtype=bool)  # the last one: of what is dropped, and of multipliers
    for source in sources:
        columns = source.column_of.reshape(-1, 3)[source.pattern.column]  # rows are the same unknowns, or multipliers
        found[np.where(columns < unknowns, columns, -1)] = True
    return found[:-1]


class CondensedSystem(CheckedSystem):
    """A system of bodies and what contact adds; where these are not definite a general one takes its place until the increment ends.

    Parameters
    ----------
    bodies : Bodies
    size : int
        Unknowns: those of the bodies first, multipliers after them.
    sources : sequence of Source
        The first is the bodies'.
    general : callable
        Makes the general system of the same sources.
    ledger : Ledger
    """

    def __init__(self, bodies: Bodies, size: int, sources: Sequence[Source], general: Callable[[], LinearSystem], ledger: Ledger) -> None:
        super().__init__(size, ledger)
        self._bodies, self._make_general = bodies, general
        self._general: LinearSystem | None = None
        unknowns = len(bodies.pattern)
        self._trailing = np.concatenate([np.flatnonzero(bodies.on_face), np.arange(unknowns, size)])
        number = np.full(size, -1, dtype=np.int64)
        number[self._trailing] = np.arange(len(self._trailing))
        self._places = [_dense_places(source, number, len(self._trailing)) for source in sources[1:]]
        self._added = np.zeros((len(self._trailing),) * 2, order="F")

    def begin(self) -> None:
        """Where the bodies were not definite, they may be again."""
        self._general = None

    def factorise(self, sources: Sequence[FloatArray]) -> None:
        """Gather the values of all sources and factorise, in general where the bodies do not allow it.

        Raises
        ------
        SingularSystemError
        """
        if self._general is None:
            try:
                self._factorise(sources)
                return
            except SingularSystemError:  # for the general one to judge
                self._general = self._make_general()
        self._general.factorise(sources)

    def _factorise(self, sources: Sequence[FloatArray]) -> None:
        """By parts (theory 5.11)."""
        with self._ledger.phase("factor"):
            self._added[:] = 0.0
            flat = self._added.reshape(-1, order="F")
            for places, source in zip(self._places, sources[1:], strict=True):
                _bindings.add_values(places, source, flat)
            self._bodies.factorise(sources[0], self._added)
        self._ledger.counts["factorisations"] += 1
        self._ledger.largest("system non-zeros", len(self._bodies.pattern.indices) + self._added.size)
        self._ledger.largest("factor non-zeros", self._bodies.factors.factor_entries + self._added.size)

    def by_bodies(self, step: FloatArray) -> FloatArray | None:
        """See `CheckedSystem.by_bodies`."""
        return self._bodies.product(step) if self._general is None else None

    @property
    def rcond(self) -> float:
        """Estimate of the reciprocal condition of the last factors."""
        return self._bodies.factors.rcond if self._general is None else self._general.rcond

    @property
    def ordering(self) -> Ordering | None:
        """That of the general factors, where these have taken its place."""
        return None if self._general is None else self._general.ordering

    def near_null(self) -> FloatArray:
        """Of the general system, which alone finds one singular."""
        assert self._general is not None, "a general system has found it singular"
        return self._general.near_null()

    def _substituted(self, right: FloatArray) -> FloatArray:
        return self._bodies.factors.solve(right) if self._general is None else self._general._substituted(right)

    def _refined(self, solution: FloatArray, right: FloatArray) -> FloatArray:
        if self._general is not None:
            return self._general._refined(solution, right)
        factors = self._bodies.factors
        if not factors.compression:
            return solution + factors.solve(right - self._product(solution))
        return self._refined_often(solution, right)

    def _refined_often(self, solution: FloatArray, right: FloatArray) -> FloatArray:
        """By factors that leave something out: until what is left is small (theory 5.19)."""
        factors, left = self._bodies.factors, self._left(solution, right)
        for _ in range(constants.REFINEMENTS):
            solution = solution + factors.solve(right - self._product(solution))
            before, left = left, self._left(solution, right)
            if left <= constants.REFINED_ABOVE:
                return solution
            if not left <= 0.5 * before:
                break
        raise KernelError(
            f"solver.compression = {factors.compression:g} leaves out too much of this matrix: refined solutions leave {left:.1e} of their "
            "right-hand side; take a smaller one, or 0"
        )

    def _product(self, solution: FloatArray) -> FloatArray:
        """By parts too (theory 5.11)."""
        if self._general is not None:
            return self._general._product(solution)
        product = np.zeros_like(solution)
        unknowns = len(self._bodies.pattern)
        product[:unknowns] = self._bodies.product(solution[:unknowns])
        # Not by `@`: NumPy's threads would stay awake afterwards.
        product[self._trailing] += np.einsum("ij,j->i", self._added, solution[self._trailing])
        return product


def _dense_places(source: Source, number: LongArray, size: int) -> LongArray:
    """Where each entry of a source goes in a dense matrix by columns (from 1; 0: dropped), shape (blocks, 3, 3)."""
    row_of, column_of = (np.where(of >= 0, number[of], -1).reshape(-1, 3) for of in (source.row_of, source.column_of))
    block_row = np.repeat(np.arange(len(source.pattern.start) - 1), np.diff(source.pattern.start))
    row, column = row_of[block_row][:, :, None], column_of[source.pattern.column][:, None, :]
    if source.transposed:
        row, column = column, row
    return np.where((row >= 0) & (column >= 0), 1 + row + size * column, 0)
