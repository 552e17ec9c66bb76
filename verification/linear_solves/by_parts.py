"""Factors of bodies with what contact adds on their faces: what they solve, and what they leave to general ones."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import IO

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from isomortar._compiled import kernel
from isomortar._condensed import CondensedFactors, SymmetricPattern
from isomortar.errors import KernelError, SingularSystemError
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case

#: Nodes along a body, unknowns of faces, and multipliers.
LENGTH, FACES, OTHERS = 60, 40, 12
#: Status of a handle that was released (fortran/base/status.f90).
STALE = 6


def held(nodes: int, springs: FloatArray, support: float = 1.0) -> sparse.csr_array:
    """Stiffness of a ladder of springs of two unknowns a node, held at one end."""
    chain = np.append(springs, 0.0) + np.insert(springs, 0, support)
    line = sparse.diags_array([chain, -springs, -springs], offsets=[0, 1, -1], shape=(nodes, nodes))
    return sparse.csr_array(sparse.kron(line, np.array([[2.0, 0.5], [0.5, 1.0]])))


def body(random: np.random.Generator, soft: float = 0.0) -> tuple[sparse.csr_array, NDArray[np.bool_]]:
    """A body with springs over four decades and faces anywhere, which press for more where they are soft."""
    matrix = held(LENGTH, 10.0 ** random.uniform(-2, 2, LENGTH - 1))
    on_face = random.permutation(np.arange(2 * LENGTH) < FACES)
    matrix = sparse.csr_array(matrix - soft * sparse.diags_array(on_face * matrix.diagonal()))
    matrix.sort_indices()
    return matrix, on_face


def factors(matrix: sparse.csr_array, on_face: NDArray[np.bool_], ordering: str = "amd") -> CondensedFactors:
    """The analysis of a body."""
    pattern = pattern_of(matrix)
    return CondensedFactors(pattern, on_face, pattern.fill_reducing(ordering)[0])  # type: ignore[arg-type]


def pattern_of(matrix: sparse.csr_array) -> SymmetricPattern:
    """Where it has entries."""
    return SymmetricPattern(matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64))


def added(random: np.random.Generator) -> FloatArray:
    """What contact adds: an unsymmetric block, with zeros on the diagonal of multipliers."""
    block = 10.0 * np.eye(FACES + OTHERS) + random.standard_normal((FACES + OTHERS, FACES + OTHERS))
    block[-OTHERS:, -OTHERS:] = 0.0
    return np.asfortranarray(block)


@case(
    claim="Systems of bodies and contact are solved to round-off by parts, faces that contact alone holds included.",
    tier="gate",
    grid={"ordering": ("metis", "amd"), "soft": (0.0, 0.4)},
    bounds={
        "residual": Bound(at_most=2e-15, reason="round-off: backward error of Cholesky and LU in the matrix' norm, ten units"),
        "indefinite": Bound(at_least=1.0, reason="definition: the bodies alone are just where their faces are soft"),
    },
)
def solution_by_parts(ordering: str, soft: float) -> dict[str, float]:
    """Largest residual over the sizes of the matrix and of the solution, of ten bodies; whether these are indefinite as they should."""
    random, residuals, indefinite = np.random.default_rng(9), [], 0
    for _ in range(10):
        matrix, on_face = body(random, soft)
        residuals.append(_residual(random, matrix, on_face, added(random), ordering))
        indefinite += bool(np.linalg.eigvalsh(matrix.toarray())[0] < 0)
    return {"residual": float(np.max(residuals)), "indefinite": float((indefinite == 10) == (soft > 0.0))}


def _residual(random: np.random.Generator, matrix: sparse.csr_array, on_face: NDArray[np.bool_], block: FloatArray, ordering: str) -> float:
    """Residual of a solution over the sizes of the matrix and of the solution."""
    n, size = matrix.shape[0], matrix.shape[0] + len(block) - np.count_nonzero(on_face)
    trailing = np.concatenate([np.flatnonzero(on_face), np.arange(n, size)])
    whole = np.zeros((size, size))
    whole[:n, :n] = matrix.toarray()
    whole[np.ix_(trailing, trailing)] += block
    found, right = factors(matrix, on_face, ordering), random.standard_normal(size)
    found.factorise(matrix.data, block)
    x = found.solve(right)
    return float(np.abs(whole @ x - right).max() / (np.abs(whole).sum(axis=1).max() * np.abs(x).max() + np.abs(right).max()))


@case(
    claim="Systems with next to nothing on faces are solved to round-off as well: no unknown there, one, two, with a multiplier or none.",
    tier="gate",
    grid={"faces": (0, 1, 2), "others": (0, 1)},
    bounds={
        "residual": Bound(at_most=2e-15, reason="round-off: as of systems with more"),
        "printed": Bound(0.0, 0.0, "definition: libraries that are asked for nothing complain on the terminal"),
    },
)
def next_to_nothing_on_faces(faces: int, others: int) -> dict[str, float]:
    """Largest residual over the sizes of the matrix and of the solution, of ten bodies; bytes that went to the terminal meanwhile."""
    random, residuals = np.random.default_rng(17), []
    with _terminal() as terminal:
        for _ in range(10):
            matrix = body(random)[0]
            on_face = random.permutation(np.arange(matrix.shape[0]) < faces)
            block = np.asfortranarray(10.0 * np.eye(faces + others) + random.standard_normal((faces + others,) * 2))
            residuals.append(_residual(random, matrix, on_face, block, "amd"))
        printed = os.fstat(terminal.fileno()).st_size
    return {"residual": float(np.max(residuals)), "printed": float(printed)}


@contextmanager
def _terminal() -> Iterator[IO[bytes]]:
    """A file in the place of the terminal, for libraries too."""
    with tempfile.TemporaryFile() as file:
        kept = [os.dup(end) for end in (1, 2)]
        try:
            for end in (1, 2):
                os.dup2(file.fileno(), end)
            yield file
        finally:
            for end, was in zip((1, 2), kept, strict=True):
                os.dup2(was, end)
                os.close(was)


def _refused(matrix: sparse.csr_array, on_face: NDArray[np.bool_], block: FloatArray) -> bool:
    try:
        factors(matrix, on_face).factorise(matrix.data, block)
    except SingularSystemError:
        return True
    return False


@case(
    claim="What is singular, or not definite within, is left to general factors: of those that are one of a kind each is.",
    tier="gate",
    bounds={
        name: Bound(at_least=1.0, at_most=1.0, reason="definition: its solution has no correct digit, or Cholesky's factors are none")
        for name in ("floats", "repeats", "indefinite within")
    }
    | {"sound": Bound(at_most=0.0, reason="definition: the same without what is wrong of it")},
)
def left_to_general_factors() -> dict[str, float]:
    """Shares of bodies that are refused: with a part that nothing holds, a repeated multiplier, a soft inside, and with none."""
    random, found = np.random.default_rng(10), dict.fromkeys(("floats", "repeats", "indefinite within", "sound"), 0.0)
    for _ in range(20):
        (matrix, on_face), block = body(random), added(random)
        loose = held(6, random.uniform(0.1, 1.0, 5), support=0.0)
        apart = sparse.csr_array(sparse.block_diag([matrix, loose]))
        repeated = block.copy(order="F")
        repeated[-1], repeated[:, -1] = repeated[-2], repeated[:, -2]
        inside = sparse.csr_array(matrix - sparse.diags_array(3.0 * ~on_face * matrix.diagonal()))
        for one in (apart, inside):
            one.sort_indices()
        found["sound"] += _refused(matrix, on_face, block) / 20
        found["floats"] += _refused(apart, np.append(on_face, np.zeros(12, dtype=bool)), block) / 20
        found["repeats"] += _refused(matrix, on_face, repeated) / 20
        found["indefinite within"] += _refused(inside, on_face, block) / 20
    return {name: round(share, 12) for name, share in found.items()}


@case(
    claim="Bodies whose last matrix was refused solve nothing, whatever they solved before, until they have one that is not.",
    tier="gate",
    bounds={
        "stale": Bound(0.0, 0.0, "definition: solutions with factors of an earlier matrix, or with none"),
        "anew": Bound(at_most=1e-13, reason="round-off: the same matrix once more"),
    },
)
def nothing_stale() -> dict[str, float]:
    """How many there are: before the first matrix, and after one that was refused; and whether the sound one is solved again."""
    random = np.random.default_rng(12)
    (matrix, on_face), block = body(random), added(random)
    repeated = block.copy(order="F")
    repeated[-1], repeated[:, -1] = repeated[-2], repeated[:, -2]
    bodies, right = factors(matrix, on_face), random.standard_normal(matrix.shape[0] + OTHERS)
    stale = int(_solves(bodies, right))
    bodies.factorise(matrix.data, block)
    solution = bodies.solve(right)
    try:
        bodies.factorise(matrix.data, repeated)
        stale += 1
    except SingularSystemError:
        stale += _solves(bodies, right)
    bodies.factorise(matrix.data, block)
    return {"stale": float(stale), "anew": float(np.abs(bodies.solve(right) - solution).max() / np.abs(solution).max())}


def _solves(bodies: CondensedFactors, right: FloatArray) -> bool:
    try:
        bodies.solve(right)
    except KernelError:
        return False
    return True


@case(
    claim="Where contact alone is another, bodies keep their factors: the same solutions to the last bit, with more multipliers or fewer.",
    tier="gate",
    grid={"others": (0, OTHERS, 30)},
    bounds={
        "difference": Bound(0.0, 0.0, "definition: the same operations on the same numbers"),
        "near": Bound(at_most=0.0, reason="definition: the reciprocal condition, of the smallest pivot of both"),
        "another": Bound(at_least=1e-3, reason="definition: another contact has another solution"),
        "stale": Bound(0.0, 0.0, "definition: renewed with no bodies or refused ones, or solved by what was refused"),
    },
)
def contact_alone(others: int) -> dict[str, float]:
    """Largest differences of solutions and conditions from those of factors made anew, and how often there should have been none."""
    random = np.random.default_rng(16)
    (matrix, on_face), block = body(random), added(random)
    again = np.asfortranarray(10.0 * np.eye(FACES + others) + random.standard_normal((FACES + others,) * 2))
    right = random.standard_normal(matrix.shape[0] + others)
    kept, anew = factors(matrix, on_face), factors(matrix, on_face)
    stale = int(_renews(kept, block))
    kept.factorise(matrix.data, block)
    first = kept.solve(np.resize(right, matrix.shape[0] + OTHERS))
    for one in (block, again):
        kept.renew(one)
    anew.factorise(matrix.data, again)
    solution, expected, near = kept.solve(right), anew.solve(right), abs(kept.rcond - anew.rcond)
    inside = sparse.csr_array(matrix - sparse.diags_array(3.0 * ~on_face * matrix.diagonal()))
    inside.sort_indices()
    try:
        kept.factorise(inside.data, block)
        stale += 1
    except SingularSystemError:
        stale += _renews(kept, block)
    try:
        anew.renew(np.zeros_like(again))  # nothing tells the multipliers
        stale += others > 0
    except SingularSystemError:
        stale += _solves(anew, right)
    unknowns = matrix.shape[0]
    return {
        "difference": float(np.abs(solution - expected).max()),
        "near": near,
        "another": float(np.abs(solution[:unknowns] - first[:unknowns]).max() / np.abs(solution).max()),
        "stale": float(stale),
    }


def _renews(bodies: CondensedFactors, block: FloatArray) -> bool:
    try:
        bodies.renew(block)
    except KernelError:
        return False
    return True


@case(
    claim="How near a system is to a singular one is told by the pivots of what is dense: the smallest over the largest, in any unit.",
    tier="gate",
    grid={"unit": (2.0**-501, 0.5, 2.0**499)},
    bounds={
        "error": Bound(
            at_most=1e-15, reason="round-off: pivots are powers of two; so are twice the diagonal and its root, so that all sums are exact"
        ),
        "of zero": Bound(0.0, 0.0, "definition: a pivot that is zero is as near as can be"),
    },
)
def nearness_to_singular(unit: float) -> dict[str, float]:
    """Largest relative error of the estimate, of diagonal systems with pivots twelve decades apart; the estimate where one is zero."""
    random, error = np.random.default_rng(12), 0.0
    alone = sparse.csr_array(unit * sparse.eye_array(8))
    for least in (-2, -10, -20, -40):
        pivots = random.permutation(2.0 ** np.linspace(least, 1, 8).round()) * random.choice([-1.0, 1.0], 8)
        found = factors(alone, np.ones(8, dtype=bool))
        found.factorise(alone.data, np.asfortranarray(np.diag(unit * (pivots - 1.0))))
        error = float(np.maximum(error, abs(found.rcond * 2.0 ** (1 - least) - 1.0)))
    return {"error": error, "of zero": _estimate_of_zero(alone, unit)}


def _estimate_of_zero(alone: sparse.csr_array, unit: float) -> float:
    """The estimate of a system with a pivot that is zero, which is refused."""
    found = factors(alone, np.ones(8, dtype=bool))
    with suppress(SingularSystemError):
        found.factorise(alone.data, np.asfortranarray(np.diag(unit * (np.arange(8.0) - 1.0))))
    return found.rcond


@case(
    claim="How near bodies are to having no stiffness is told by their pivots, as shares of their diagonals, where faces are farther.",
    tier="gate",
    bounds={
        "alone": Bound(at_most=1e-12, reason="round-off: of a difference from one, over the least pivot"),
        "with faces": Bound(at_most=1e-12, reason="round-off: as above; the smaller of the two"),
    },
)
def nearness_within() -> dict[str, float]:
    """Largest relative errors of the estimate, of pairs of springs with pivots of shares from a half to a thousandth."""
    random, errors = np.random.default_rng(15), {"alone": 0.0, "with faces": 0.0}
    for within in (1, 3, 6, 10):
        share = np.sqrt(1.0 - 2.0**-within)
        scales = random.uniform(1.0, 3.0, 4)
        pairs = sparse.kron(sparse.diags_array(scales), np.array([[1.0, share], [share, 1.0]]))
        for faces, least in ((0, within), (4, 2), (4, 8)):
            matrix = sparse.csr_array(sparse.block_diag([pairs, sparse.eye_array(faces)]) if faces else pairs)
            matrix.sort_indices()
            found = factors(matrix, np.arange(matrix.shape[0]) >= 8)
            pivots = np.array([1.0, 2.0**-least, 1.0, 1.0])[:faces]
            found.factorise(matrix.data, np.asfortranarray(np.diag(pivots - 1.0)))
            exact = 2.0 ** -np.max([within, least])
            name = "with faces" if faces else "alone"
            errors[name] = float(np.maximum(errors[name], abs(found.rcond / exact - 1.0)))
    return errors


@case(
    claim="Bodies that were released, or never made, solve nothing.",
    tier="gate",
    bounds={
        name: Bound(at_least=STALE, at_most=STALE, reason="definition: the handle is stale")
        for name in ("factorised", "renewed", "solved", "released twice")
    },
)
def handles_of_bodies() -> dict[str, float]:
    """Status codes of the kernel for a handle that was released."""
    matrix, on_face = body(np.random.default_rng(11))
    pattern = pattern_of(matrix)
    order = pattern.fill_reducing("amd")[0]
    handle = kernel.condensed_analyse(pattern.indptr, pattern.indices, on_face.astype(np.int32), order)[0]
    kernel.sparse_release(handle)
    return {
        "factorised": float(kernel.condensed_factorise(handle, matrix.data, np.eye(FACES, order="F"), 0.0)[-1]),
        "renewed": float(kernel.condensed_renew(handle, np.eye(FACES, order="F"), 0.0)[-1]),
        "solved": float(kernel.condensed_solve(handle, np.ones(2 * LENGTH))[-1]),
        "released twice": float(kernel.sparse_release(handle)),
    }


@case(
    claim="Matrices and right-hand sides that are not finite are refused by their row, in bodies and beside them, and factors stay.",
    tier="gate",
    grid={"value": ("nan", "inf", "-inf")},
    bounds={
        "others": Bound(0.0, 0.0, "definition: numbers that are taken, or refused by another row"),
        "stays": Bound(at_most=0.0, reason="definition: the same factors give the same bits"),
    },
)
def not_finite(value: str) -> dict[str, float]:
    """How many, of right-hand sides and of matrices; largest change of a solution."""
    random = np.random.default_rng(14)
    (matrix, on_face), block = body(random), added(random)
    bodies, right = factors(matrix, on_face), random.standard_normal(matrix.shape[0] + OTHERS)
    bodies.factorise(matrix.data, block)
    solution, others = bodies.solve(right), 0
    for row in (0, 7, matrix.shape[0] - 1, matrix.shape[0], len(right) - 1):
        spoilt = right.copy()
        spoilt[row] = float(value)
        others += _row_refused(partial(bodies.solve, spoilt)) != row
    stays = float(np.abs(bodies.solve(right) - solution).max())
    for row in (0, 7, matrix.shape[0] - 1):
        entries = matrix.data.copy()
        entries[matrix.indptr[row]] = float(value)
        others += _row_refused(partial(bodies.factorise, entries, block)) != row
    return {"others": float(others), "stays": stays}


def _row_refused(action: Callable[[], object]) -> int | None:
    """The row by which something is refused; None: it is not."""
    try:
        action()
    except KernelError as error:
        return error.place
    return None
