"""The linear system: gathered from sources of blocks, ordered the cheaper way."""

import numpy as np
import pytest
from scipy import sparse

from isomortar._bindings import Pattern
from isomortar._sparse import SparseLU
from isomortar.errors import SingularSystemError
from isomortar.solve.system import LinearSystem, Source, orderings
from isomortar.solve.timing import Ledger


def grid(nodes: int) -> tuple[Pattern, np.ndarray]:
    """Pattern of the blocks of a cube of nodes a side, each coupled with its neighbours, and values that make it regular."""
    line = sparse.diags_array([1.0, 1.0, 1.0], offsets=[-1, 0, 1], shape=(nodes, nodes))
    matrix = sparse.csr_array(sparse.kron(sparse.kron(line, line), line))
    matrix.sort_indices()
    blocks = -np.random.default_rng(1).uniform(0.1, 1.0, (matrix.nnz, 3, 3))
    rows = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
    blocks[rows == matrix.indices] += 200.0 * np.eye(3)
    return Pattern(matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32)), blocks


def whole(pattern: Pattern, blocks: np.ndarray) -> sparse.csr_array:
    n = 3 * (len(pattern.start) - 1)
    return sparse.csr_array(sparse.bsr_array((blocks, pattern.column, pattern.start), shape=(n, n)))


def test_sources_add_up_and_dropped_rows_are_left_out() -> None:
    pattern, blocks = grid(4)
    n = 3 * (len(pattern.start) - 1)
    kept = np.arange(n) % 7 != 3
    equation = np.where(kept, np.cumsum(kept) - 1, -1).astype(np.int32)
    one, other = Source(pattern, equation, equation), Source(pattern, equation, equation, transposed=True)
    system = LinearSystem(int(kept.sum()), [one, other], Ledger())
    system.factorise([blocks, 0.25 * blocks])
    # a transposed source stands with rows and columns exchanged
    full = whole(pattern, blocks)
    expected = (full + 0.25 * full.T)[kept][:, kept]
    assert abs(system.matrix() - expected).max() < 1e-12
    right = np.arange(1.0, kept.sum() + 1)
    np.testing.assert_allclose(expected @ system.solve(right), right, rtol=1e-10)


@pytest.mark.parametrize(("size", "expected"), [(999, {"amd"}), (1000, {"amd", "metis"}), (5000, {"amd", "metis"}), (5001, {"metis"})])
def test_orderings_in_doubt_by_size(size: int, expected: set[str]) -> None:
    assert set(orderings(size)) == expected


def refuse(*_: object, **__: object) -> SparseLU:
    raise SingularSystemError("by this ordering", 0)


def test_in_doubt_the_ordering_with_fewer_operations_is_kept() -> None:
    pattern, blocks = grid(8)
    n = 3 * (len(pattern.start) - 1)
    equation = np.arange(n, dtype=np.int32)
    system = LinearSystem(n, [Source(pattern, equation, equation)], Ledger())
    system.factorise([blocks])
    matrix = system.matrix()
    rivals = {
        name: SparseLU(matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64), ordering=name).factorise(matrix.data).flops
        for name in ("amd", "metis")
    }
    assert rivals["amd"] != rivals["metis"]
    assert system.ordering == min(rivals, key=rivals.__getitem__)
    refusing = LinearSystem(n, [Source(pattern, equation, equation)], Ledger())
    refusing._rivals[["amd", "metis"].index(system.ordering)].factorise = refuse  # type: ignore[method-assign]
    refusing.factorise([blocks])
    assert refusing.ordering != system.ordering
    told = LinearSystem(n, [Source(pattern, equation, equation)], Ledger(), ordering="amd")
    told.factorise([blocks])
    assert told.ordering == "amd"


def counted(monkeypatch: pytest.MonkeyPatch) -> tuple[LinearSystem, list[int]]:
    """A system with factors, and a list that grows with each product by its matrix."""
    pattern, blocks = grid(3)
    n = 3 * (len(pattern.start) - 1)
    equation, products = np.arange(n, dtype=np.int32), list[int]()
    system = LinearSystem(n, [Source(pattern, equation, equation)], Ledger())
    system.factorise([blocks])
    product = system._product
    monkeypatch.setattr(system, "_product", lambda solution: (products.append(1), product(solution))[1])
    return system, products


def test_a_second_solution_by_the_same_factors_takes_no_product(monkeypatch: pytest.MonkeyPatch) -> None:
    system, products = counted(monkeypatch)
    right = np.arange(1.0, 82.0)
    first, before = system.solve(right), len(products)
    assert before > 0
    np.testing.assert_array_equal(system.solve_again(right), first)
    assert len(products) == before


def test_where_the_first_was_refined_the_second_is_too(monkeypatch: pytest.MonkeyPatch) -> None:
    system, products = counted(monkeypatch)
    exact, right = system._substituted, np.arange(1.0, 82.0)
    monkeypatch.setattr(system, "_substituted", lambda right: 1.001 * exact(right))  # as factors that have lost digits
    first, before = system.solve(right), len(products)
    np.testing.assert_array_equal(system.solve_again(right), first)
    assert len(products) == 2 * before
    np.testing.assert_allclose(system.matrix() @ first, right, rtol=1e-10)
