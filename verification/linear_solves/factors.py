"""The sparse LU: what it solves, what it refuses, and what it lets go."""

from __future__ import annotations

from contextlib import suppress
from unittest.mock import patch

import numpy as np
from scipy import sparse

from isomortar._compiled import kernel
from isomortar._sparse import NARROW_LIMIT, SparseLU
from isomortar.errors import KernelError, SingularSystemError
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case

#: Unknowns of a chain, and constraints that border it.
LENGTH, BORDER = 400, 12
#: The unknown that nothing holds.
FREE = 137
#: Of the levers of a mechanism that with the longest arm.
LONGEST = 2
#: Status of a handle that was released (fortran/base/status.f90).
STALE = 6

_SAID = "definition: the one that was made so"


def bordered() -> sparse.csr_array:
    """An unsymmetric chain with springs over six decades, bordered by constraint rows: zeros on the diagonal, as with multipliers."""
    random = np.random.default_rng(5)
    springs = 10.0 ** random.uniform(-3, 3, LENGTH - 1)
    diagonal = np.append(springs, 0.0) + np.insert(springs, 0, 0.0) + 1.0
    chain = sparse.diags_array([diagonal, -springs, -0.8 * springs], offsets=[0, 1, -1])
    rows = sparse.random_array((BORDER, LENGTH), density=0.05, rng=random)
    return sparse.csr_array(sparse.block_array([[chain, 1.3 * rows.T], [rows, None]]))


def factors(matrix: sparse.csr_array, ordering: str, index_bits: int = 32) -> tuple[SparseLU, FloatArray]:
    """The analysis of a matrix's pattern, and its entries in the pattern's order."""
    matrix.sort_indices()
    pattern = (np.asarray(index, dtype=np.int64) for index in (matrix.indptr, matrix.indices))
    with patch("isomortar._sparse.NARROW_LIMIT", NARROW_LIMIT if index_bits == 32 else 0.0):
        lu = SparseLU(*pattern, ordering=ordering)  # type: ignore[arg-type]
    assert lu.index_bits == index_bits, "factors as small as these fit either way"
    return lu, matrix.data


@case(
    claim="The sparse LU solves bordered, badly scaled systems to round-off, with refinement and without.",
    tier="gate",
    grid={"ordering": ("metis", "amd"), "refine": (0, 2), "index_bits": (32, 64)},
    bounds=lambda ordering, refine, index_bits: {  # noqa: ARG005
        "residual": Bound(at_most=4.5e-16, reason="round-off: of residuals in double precision, two units, where refinement ends")
        if refine
        else Bound(at_most=1e-14, reason="round-off: backward error of an LU with threshold pivoting, some tens of units")
    },
)
def solution(ordering: str, refine: int, index_bits: int) -> dict[str, float]:
    """Largest error of a row over the sizes of its terms, of three right-hand sides."""
    matrix = bordered()
    lu, values = factors(matrix, ordering, index_bits)
    b = np.random.default_rng(6).standard_normal((LENGTH + BORDER, 3))
    x = lu.factorise(values).solve(b, refine=refine)
    return {"residual": float((np.abs(matrix @ x - b) / (abs(matrix) @ np.abs(x) + np.abs(b))).max())}


@case(
    claim="A solution is refined where that is asked for, and is that of the factors alone where it is not.",
    tier="gate",
    grid={"ordering": ("metis", "amd"), "index_bits": (32, 64)},
    bounds={"gain": Bound(at_least=5.0, reason="round-off: residuals fall from those of a hundred and fifty eliminations to a row's own")},
)
def refined(ordering: str, index_bits: int) -> dict[str, float]:
    """By how much refinement makes residuals of a full matrix smaller, root of the mean square over ten right-hand sides."""
    matrix = sparse.csr_array(np.random.default_rng(8).standard_normal((150, 150)))
    lu, values = factors(matrix, ordering, index_bits)
    b = np.random.default_rng(6).standard_normal((150, 10))
    lu.factorise(values)
    plain, better = (lu.solve(b, refine=steps) for steps in (0, 2))
    before, after = (np.linalg.norm((matrix @ x - b) / (abs(matrix) @ np.abs(x) + np.abs(b))) for x in (plain, better))
    return {"gain": float(before / after)}


@case(
    claim="A singular system is refused, and the unknown that nothing holds is named.",
    tier="gate",
    grid={"ordering": ("metis", "amd"), "index_bits": (32, 64)},
    bounds={"place": Bound(at_least=FREE, at_most=FREE, reason=_SAID)},
)
def singular(ordering: str, index_bits: int) -> dict[str, float]:
    """The unknown that is named where one has nothing in its row and column but a zero on the diagonal."""
    matrix = bordered().tocoo()
    kept = (matrix.row != FREE) & (matrix.col != FREE)
    row, column = np.append(matrix.row[kept], FREE), np.append(matrix.col[kept], FREE)
    lu, values = factors(sparse.csr_array((np.append(matrix.data[kept], 0.0), (row, column))), ordering, index_bits)
    try:
        lu.factorise(values)
    except SingularSystemError as error:
        return {"place": float(error.place)}
    return {}


@case(
    claim="A system that is singular but for round-off is refused too.",
    tier="gate",
    grid={"ordering": ("metis", "amd")},
    bounds={
        "refused": Bound(at_least=1.0, at_most=1.0, reason="definition: its solution has no correct digit"),
        "place": Bound(at_least=LENGTH + BORDER, reason="definition: an unknown of the part that floats"),
    },
)
def floating(ordering: str) -> dict[str, float]:
    """Share of matrices that are refused, with a chain beside that nothing holds, its springs changed; least unknown that is named."""
    places = []
    for springs in np.random.default_rng(7).uniform(0.1, 1.0, (20, 5)):
        ends = np.append(springs, 0.0) + np.insert(springs, 0, 0.0)
        chain = sparse.diags_array([ends, -springs, -springs], offsets=[0, 1, -1])
        lu, values = factors(sparse.csr_array(sparse.block_diag([bordered(), chain])), ordering)
        try:
            lu.factorise(values)
        except SingularSystemError as error:
            places.append(error.place)
    return {"refused": len(places) / 20, "place": float(min(places, default=-1))}


def mechanism(arms: FloatArray) -> sparse.csr_array:
    """Levers on one shaft that nothing holds, the arm of one of them much longer: its end moves most, the shaft is eliminated last."""
    ends = np.where(np.arange(len(arms)) == LONGEST, 1e3, 1.0) * arms
    shaft = np.array([[np.sum(arms * ends)]])
    return sparse.csr_array(sparse.block_array([[sparse.eye_array(len(arms)), -ends[:, None]], [-arms[None], shaft]]))


@case(
    claim="Of a mechanism the unknown that moves most is named.",
    tier="gate",
    grid={"ordering": ("metis", "amd")},
    bounds={"named": Bound(at_least=1.0, at_most=1.0, reason=_SAID)},
)
def moves_most(ordering: str) -> dict[str, float]:
    """Share of mechanisms, beside a held system, whose longest lever is named."""
    places = []
    for arms in np.random.default_rng(8).uniform(0.1, 1.0, (20, 5)):
        lu, values = factors(sparse.csr_array(sparse.block_diag([bordered(), mechanism(arms)])), ordering)
        try:
            lu.factorise(values)
        except SingularSystemError as error:
            places.append(error.place)
    return {"named": places.count(LENGTH + BORDER + LONGEST) / 20}


@case(
    claim="Indices are narrow where a factorisation is far within the memory that they can address, and wide where it takes more.",
    tier="gate",
    grid={"ordering": ("metis", "amd")},
    bounds={
        "within": Bound(at_least=1.0, at_most=1.0, reason="definition: narrow where ten times what it takes is allowed"),
        "beyond": Bound(
            at_least=0.0, at_most=0.0, reason="definition: narrow where less than what it takes is allowed: the estimate is a bound"
        ),
    },
)
def narrow_indices(ordering: str) -> dict[str, float]:
    """Whether indices are narrow, for limits of the memory above and below what the factorisation turns out to take."""
    matrix = bordered()
    lu, values = factors(matrix, ordering)
    taken = lu.factorise(values).statistics
    assert taken is not None, "it was factorised"
    pattern = [np.asarray(index, dtype=np.int64) for index in (matrix.indptr, matrix.indices)]
    found = {}
    for name, share in (("within", 10.0), ("beyond", 0.999)):
        handle, narrow, *_ = kernel.sparse_analyse(*pattern, ordering == "metis", share * taken.peak_bytes)
        kernel.sparse_release(handle)
        found[name] = float(narrow)
    return found


@case(
    claim="Entries of factors are counted in both: a triangular matrix is its own factor, beside one of ones on its diagonal.",
    tier="gate",
    grid={"ordering": ("metis", "amd"), "upper": (False, True)},
    bounds={"error": Bound(at_most=0.0, reason="definition: entries that are not counted, or that there are not")},
)
def counted(ordering: str, upper: bool) -> dict[str, float]:
    """How many entries are counted too many or too few, of ten random matrices."""
    random, error = np.random.default_rng(14), 0
    for _ in range(10):
        beside = sparse.triu(sparse.random_array((90, 90), density=0.05, rng=random), 1)
        matrix = sparse.csr_array(beside + sparse.diags_array(random.uniform(1.0, 2.0, 90)))
        lu, values = factors(matrix if upper else sparse.csr_array(matrix.T), ordering)
        statistics = lu.factorise(values).statistics
        assert statistics is not None, "it was factorised"
        error += abs(statistics.factor_entries - len(values) - 90)
    return {"error": float(error)}


@case(
    claim="What was released, refused or never made solves nothing.",
    tier="gate",
    bounds={
        "released twice": Bound(at_least=STALE, at_most=STALE, reason=_SAID),
        "released": Bound(at_least=STALE, at_most=STALE, reason=_SAID),
        "never made": Bound(at_least=STALE, at_most=STALE, reason=_SAID),
        "refused": Bound(at_least=1.0, at_most=1.0, reason="definition: the factors of the matrix before must not be taken for those"),
        "kept": Bound(at_least=STALE, at_most=STALE, reason="definition: nor those of the one that was refused"),
    },
)
def handles() -> dict[str, float]:
    """Status codes of the kernel, the slot of the released handle taken by others meanwhile; whether a refused matrix solves nothing."""
    matrix = bordered()
    pattern = [np.asarray(index, dtype=np.int64) for index in (matrix.indptr, matrix.indices)]
    handle = kernel.sparse_analyse(*pattern, True, NARROW_LIMIT)[0]
    kernel.sparse_release(handle)
    lu, values = factors(matrix, "metis")
    lu.factorise(values)
    b = np.ones((len(pattern[0]) - 1, 1), order="F")
    found = {
        "released twice": float(kernel.sparse_release(handle)),
        "released": float(kernel.sparse_solve(handle, values, b, 0)[-1]),
        "never made": float(kernel.sparse_release(-1)),
    }
    other = kernel.sparse_analyse(*pattern, True, NARROW_LIMIT)[0]
    kernel.sparse_factorise(other, values, 0.5)  # no matrix is that far from a singular one
    found["kept"] = float(kernel.sparse_solve(other, values, b, 0)[-1])
    kernel.sparse_release(other)
    with suppress(SingularSystemError):
        lu.factorise(np.zeros_like(values))
    try:
        lu.solve(b[:, 0])
    except KernelError:
        return found | {"refused": 1.0}
    return found | {"refused": 0.0}


@case(
    claim="A matrix whose condition is just what is asked for is regular, and one that has less by its last bit is not; one without a "
    "pivot is singular whatever is asked for.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: of three matrices those that are taken for something else")},
)
def asked_condition() -> dict[str, float]:
    """How many."""
    wrong, matrix = 0, bordered()
    lu, values = factors(matrix, "amd")
    rcond = lu.factorise(values).rcond
    for entries, least, singular in ((values, rcond, False), (values, np.nextafter(rcond, 1.0), True), (0.0 * values, 0.0, True)):
        refused = False
        with suppress(SingularSystemError):
            refused = True
            lu.factorise(entries, rcond_min=float(least))
            refused = False
        wrong += refused != singular
    return {"wrong": float(wrong)}
