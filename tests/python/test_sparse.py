"""Sparse LU: solutions against scipy, one analysis for many matrices, singular matrices named, no memory lost."""

import gc
import resource
import sys
import threading
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spl
from hypothesis import given, settings
from hypothesis import strategies as st

from isomortar import _kernel, _sparse
from isomortar._sparse import ORDERINGS, SparseLU, _check_status
from isomortar.errors import InputError, KernelError, SingularSystemError

STALE_HANDLE, OUT_OF_MEMORY = 6, 7


@pytest.fixture(autouse=True, scope="module", params=[32, 64], ids=["narrow", "wide"])
def index_bits(request):
    """Everything holds with either width of indices."""
    with pytest.MonkeyPatch.context() as patched:
        if request.param == 64:
            patched.setattr(_sparse, "NARROW_LIMIT", 0.0)
        yield request.param


def compressed(matrix):
    """Compressed rows with 64-bit positions, sorted, as the kernel wants them."""
    matrix = sp.csr_array(matrix)
    matrix.sort_indices()
    return matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64), matrix.data.astype(np.float64)


def factorised(matrix, **options):
    indptr, indices, values = compressed(matrix)
    return SparseLU(indptr, indices, **options).factorise(values)


def random_matrix(rng, n, density=0.05):
    """Unsymmetric, with a diagonal that makes it well conditioned."""
    matrix = sp.random_array((n, n), density=density, rng=rng, data_sampler=lambda size: rng.standard_normal(size))
    return sp.csr_array(matrix + sp.diags_array(3.0 + rng.random(n)))


def hexahedron(young=1.0, poisson=0.3):
    """Stiffness of the trilinear unit cube, small strain, 2x2x2 Gauss points; shape (24, 24)."""
    corners = np.array([[i, j, k] for k in (0, 1) for j in (0, 1) for i in (0, 1)])
    shear, lame = young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    stiffness = np.zeros((8, 3, 8, 3))
    for point in corners / np.sqrt(3) + 0.5 * (1 - 1 / np.sqrt(3)):
        factors = np.where(corners == 1, point, 1 - point)
        slopes = np.where(corners == 1, 1.0, -1.0)
        gradient = np.column_stack([slopes[:, a] * factors[:, (a + 1) % 3] * factors[:, (a + 2) % 3] for a in range(3)])
        stiffness += 0.125 * (
            lame * np.einsum("ia,jb->iajb", gradient, gradient)
            + shear * np.einsum("ib,ja->iajb", gradient, gradient)
            + shear * np.einsum("ic,jc,ab->iajb", gradient, gradient, np.eye(3))
        )
    return stiffness.reshape(24, 24)


def block_of_elements(*counts):
    """Stiffness of a free block of unit cubes: 27-point rows of 3x3 blocks."""
    nodes = np.arange(np.prod(np.add(counts, 1))).reshape(np.add(counts, 1))
    corners = [nodes[i : i + counts[0], j : j + counts[1], k : k + counts[2]].ravel() for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    unknowns = (3 * np.stack(corners, axis=1)[:, :, None] + np.arange(3)).reshape(-1, 24)
    rows, columns = np.repeat(unknowns, 24, axis=1).ravel(), np.tile(unknowns, 24).ravel()
    return sp.csr_array((np.tile(hexahedron().ravel(), len(unknowns)), (rows, columns)))


def held(stiffness, unknowns):
    """The stiffness with springs at some unknowns."""
    springs = np.zeros(stiffness.shape[0])
    springs[unknowns] = 1.0
    return stiffness + sp.diags_array(springs)


@pytest.mark.parametrize("ordering", ORDERINGS)
@settings(max_examples=40, deadline=None)
@given(n=st.integers(1, 120), seed=st.integers(0, 2**31), density=st.floats(0.0, 0.3), refine=st.integers(0, 2))
def test_solution_is_that_of_scipy(ordering, n, seed, density, refine):
    rng = np.random.default_rng(seed)
    matrix = random_matrix(rng, n, density) + sp.diags_array(np.full(n, 3.0 * np.sqrt(n)))
    b = rng.standard_normal(n)
    x = factorised(matrix, ordering=ordering).solve(b, refine=refine)
    expected = spl.spsolve(sp.csc_array(matrix), b)
    np.testing.assert_allclose(x, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_indices_have_the_width_that_the_factors_need(index_bits):
    matrix = held(block_of_elements(3, 3, 3), np.arange(48))
    assert factorised(matrix).index_bits == index_bits


def test_either_width_gives_the_same_bits(monkeypatch):
    matrix = held(block_of_elements(4, 4, 4), np.arange(75))
    b = np.random.default_rng(6).standard_normal(matrix.shape[0])
    solutions = []
    for limit in (0.0, 2.0**31):
        monkeypatch.setattr(_sparse, "NARROW_LIMIT", limit)
        solutions.append(factorised(matrix).solve(b))
    np.testing.assert_array_equal(*solutions)


def test_what_does_not_fit_narrow_indices_is_repeated_with_wide_ones(monkeypatch, index_bits):
    matrix = held(block_of_elements(3, 3, 3), np.arange(48))
    expected = factorised(matrix).solve(np.ones(matrix.shape[0]))
    factorise, seen = _kernel.sparse_factorise, []

    def full(handle, values, rcond_min):
        seen.append(handle)
        answer = factorise(handle, values, rcond_min)
        return (*answer[:-1], OUT_OF_MEMORY) if len(seen) == 1 else answer

    monkeypatch.setattr(_sparse, "_kernel", SimpleNamespace(**{**vars(_kernel), "sparse_factorise": full}))
    indptr, indices, values = compressed(matrix)
    lu = SparseLU(indptr, indices)
    if index_bits == 64:
        with pytest.raises(KernelError, match="memory ran out"):
            lu.factorise(values)
        return
    np.testing.assert_array_equal(lu.factorise(values).solve(np.ones(len(indptr) - 1)), expected)
    assert lu.index_bits == 64
    assert _kernel.sparse_release(seen[0]) == STALE_HANDLE, "the first analysis is still held"


def test_several_right_hand_sides_are_solved_one_by_one():
    rng = np.random.default_rng(1)
    matrix = random_matrix(rng, 200)
    b = rng.standard_normal((200, 3))
    lu = factorised(matrix)
    x = lu.solve(b)
    assert x.shape == b.shape
    np.testing.assert_array_equal(x, np.column_stack([lu.solve(column) for column in b.T]))
    np.testing.assert_allclose(matrix @ x, b, atol=1e-12)


@pytest.mark.parametrize("ordering", ORDERINGS)
@pytest.mark.parametrize(("refine", "least"), [(0, 4e-15), (2, 1e-15)])
def test_bordered_system_with_zero_diagonal(ordering, refine, least):
    """To round-off; without refinement to some times that, how many depends on the order of sums: on the threads of BLAS too."""
    rng = np.random.default_rng(2)
    stiffness = held(block_of_elements(6, 6, 4), np.arange(3 * 35))
    n = stiffness.shape[0]
    rows = sp.random_array((60, n), density=0.02, rng=rng)
    matrix = sp.block_array([[stiffness, rows.T * 1.3], [rows, None]], format="csr")
    b = rng.standard_normal(n + 60)
    x = factorised(matrix, ordering=ordering).solve(b, refine=refine)
    residual = np.abs(matrix @ x - b).max() / (abs(matrix).sum(axis=1).max() * np.abs(x).max())
    assert residual < least
    expected = spl.spsolve(sp.csc_array(matrix), b)
    np.testing.assert_allclose(x, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_analysis_serves_matrices_of_its_pattern():
    rng = np.random.default_rng(3)
    indptr, indices, values = compressed(random_matrix(rng, 300))
    lu = SparseLU(indptr, indices)
    b = rng.standard_normal(300)
    for _ in range(5):
        values = values * rng.uniform(0.9, 1.1, len(values))
        x = lu.factorise(values).solve(b)
        np.testing.assert_allclose(sp.csr_array((values, indices, indptr)) @ x, b, atol=1e-12)


def test_statistics_count_the_work():
    lu = factorised(block_of_elements(6, 6, 6) + sp.eye_array(3 * 343))
    assert lu.statistics.unknowns == 1029
    assert lu.statistics.factor_entries > 2 * lu.statistics.entries
    assert lu.statistics.flops > lu.statistics.factor_entries
    assert lu.statistics.peak_bytes > 8 * lu.statistics.factor_entries
    assert 1e-6 < lu.rcond <= 1


def two_bodies(order):
    """A held block, a free one, and which unknowns are the free one's after renumbering with `order`."""
    first = held(block_of_elements(4, 4, 3), np.arange(60))
    second = block_of_elements(3, 4, 3)
    matrix = sp.block_diag([first, second], format="csr")
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    return sp.csr_array(matrix[order][:, order]), set(place[first.shape[0] :].tolist())


@pytest.mark.parametrize("ordering", ORDERINGS)
@pytest.mark.parametrize("seed", range(5))
def test_free_body_is_named(ordering, seed):
    order = np.random.default_rng(seed).permutation(3 * (100 + 80)) if seed else np.arange(3 * (100 + 80))
    matrix, free = two_bodies(order)
    with pytest.raises(SingularSystemError, match="singular") as caught:
        factorised(matrix, ordering=ordering)
    assert caught.value.place in free


@pytest.mark.parametrize("ordering", ORDERINGS)
@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_free_body_far_softer_or_stiffer_is_named(ordering, scale):
    first = held(block_of_elements(4, 4, 3), np.arange(60))
    matrix = sp.block_diag([first, scale * block_of_elements(3, 4, 3)], format="csr")
    with pytest.raises(SingularSystemError) as caught:
        factorised(matrix, ordering=ordering)
    assert caught.value.place >= first.shape[0]


@pytest.mark.parametrize("ordering", ORDERINGS)
def test_body_free_to_slide_is_named(ordering):
    first = held(block_of_elements(4, 4, 3), np.arange(60))
    n = first.shape[0]
    matrix = sp.block_diag([first, block_of_elements(4, 4, 3)], format="lil")
    for node in range(0, n // 3, 4):  # frictionless contact of the planes z = 3 and z = 0: normal springs
        a, b = 3 * (node + 3) + 2, n + 3 * node + 2
        matrix[a, a] += 10.0
        matrix[b, b] += 10.0
        matrix[a, b] -= 10.0
        matrix[b, a] -= 10.0
    with pytest.raises(SingularSystemError) as caught:
        factorised(matrix, ordering=ordering)
    assert caught.value.place >= n


@pytest.mark.parametrize("unknown", [0, 17, 49])
def test_exactly_singular_names_the_unknown(unknown):
    matrix = random_matrix(np.random.default_rng(4), 50).tolil()
    matrix[:, unknown] = 0.0  # nothing depends on this unknown
    with pytest.raises(SingularSystemError) as caught:
        factorised(matrix)
    assert caught.value.place == unknown


def test_repeated_constraint_is_singular():
    rng = np.random.default_rng(5)
    stiffness = held(block_of_elements(3, 3, 2), np.arange(36))
    n = stiffness.shape[0]
    row = sp.random_array((1, n), density=0.1, rng=rng)
    rows = sp.vstack([row, 2.0 * row])
    with pytest.raises(SingularSystemError) as caught:
        factorised(sp.block_array([[stiffness, rows.T], [rows, None]], format="csr"))
    assert caught.value.place >= n


def test_threshold_of_the_condition_can_be_chosen():
    indptr, indices, values = compressed(sp.diags_array([1.0, 1.0, 1e-3]) + sp.csr_array(np.full((3, 3), 1e-5)))
    lu = SparseLU(indptr, indices)
    assert lu.factorise(values).rcond > 1e-4
    with pytest.raises(SingularSystemError):
        lu.factorise(values, rcond_min=0.5 * (1 + lu.rcond))


def test_a_condition_at_the_threshold_is_regular_and_one_below_it_is_not():
    """However small the threshold is: what has no pivot is singular without one, too."""
    indptr, indices, values = compressed(random_matrix(np.random.default_rng(3), 12, 0.3))
    lu = SparseLU(indptr, indices)
    rcond = lu.factorise(values).rcond
    lu.factorise(values, rcond_min=rcond).solve(np.ones(12))
    with pytest.raises(SingularSystemError, match="is singular: reciprocal condition"):
        lu.factorise(values, rcond_min=np.nextafter(rcond, 1.0))
    with pytest.raises(SingularSystemError) as caught:
        lu.factorise(np.zeros_like(values), rcond_min=0.0)
    assert 0 <= caught.value.place < 12


def test_after_a_refused_matrix_nothing_solves_until_the_next_good_one():
    indptr, indices, values = compressed(random_matrix(np.random.default_rng(6), 40))
    lu = SparseLU(indptr, indices).factorise(values)
    with pytest.raises(SingularSystemError):
        lu.factorise(np.zeros_like(values))
    assert lu.rcond == 0.0
    with pytest.raises(KernelError, match="no matrix is factorised"):
        lu.solve(np.ones(40))
    assert np.all(np.isfinite(lu.factorise(values).solve(np.ones(40))))


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_entries_that_are_not_finite_are_named(bad):
    indptr, indices, values = compressed(random_matrix(np.random.default_rng(7), 40))
    lu = SparseLU(indptr, indices).factorise(values)
    spoilt = values.copy()
    spoilt[indptr[11]] = bad
    with pytest.raises(KernelError, match="matrix is not finite in row 11") as caught:
        lu.factorise(spoilt)
    assert caught.value.place == 11
    b = np.ones(40)
    b[3] = bad
    with pytest.raises(KernelError, match="right-hand side is not finite in row 3"):
        lu.solve(b)


def test_arrays_that_would_be_copied_are_refused():
    indptr, indices, values = compressed(random_matrix(np.random.default_rng(8), 40))
    with pytest.raises(InputError, match="indptr: is int32"):
        SparseLU(indptr.astype(np.int32), indices)
    with pytest.raises(InputError, match="indices: is list"):
        SparseLU(indptr, indices.tolist())
    with pytest.raises(InputError, match="ordering: is 'best'; allowed: metis, amd"):
        SparseLU(indptr, indices, ordering="best")
    lu = SparseLU(indptr, indices)
    for wrong in (values.astype(np.float32), np.repeat(values, 2)[::2], values[:-1], values.reshape(1, -1)):
        with pytest.raises(InputError, match="values: "):
            lu.factorise(wrong)
    lu.factorise(values)
    for wrong in (np.ones(39), np.ones((2, 40)), np.ones((40, 1, 1))):
        with pytest.raises(InputError, match="b: has shape"):
            lu.solve(wrong)
    with pytest.raises(InputError, match="refine: "):
        lu.solve(np.ones(40), refine=-1)


@pytest.mark.parametrize(
    ("indptr", "indices", "message"),
    [
        ([0], [], "indptr: has no rows"),
        ([0, 2, 1], [0], "indptr: must rise from 0 to the number of entries, 1"),
        ([0, 1, 2], [0, 2], "indices: has columns outside 0 to 1"),
        ([0, 1, 3], [0, 1, 0], "indices: must increase strictly .* row 1"),
        ([0, 0, 2], [1, 1], "indices: must increase strictly .* row 1"),
    ],
)
def test_broken_patterns_are_refused(indptr, indices, message):
    with pytest.raises(InputError, match=message):
        SparseLU(np.array(indptr, dtype=np.int64), np.array(indices, dtype=np.int64))


def test_empty_rows_are_singular_not_broken():
    with pytest.raises(SingularSystemError) as caught:
        SparseLU(np.array([0, 1, 1, 2]), np.array([0, 2])).factorise(np.ones(2))
    assert caught.value.place == 1


def test_stale_handles_return_a_status():
    indptr, indices, values = compressed(sp.eye_array(5))
    handle, _, _, status = _kernel.sparse_analyse(indptr, indices, 1, _sparse.NARROW_LIMIT)
    assert status == 0
    assert _kernel.sparse_solve(handle, values, np.ones((5, 1), order="F"), 0)[-1] == STALE_HANDLE  # no factors yet
    assert _kernel.sparse_release(handle) == 0
    again, *_ = _kernel.sparse_analyse(indptr, indices, 1, _sparse.NARROW_LIMIT)
    assert again != handle  # the slot is used again, the handle is not
    for stale in (handle, 0, -1, 7, 2**62):
        assert _kernel.sparse_release(stale) == STALE_HANDLE
        assert _kernel.sparse_factorise(stale, values, 0.0)[-1] == STALE_HANDLE
        assert _kernel.sparse_solve(stale, values, np.ones((5, 1), order="F"), 0)[-1] == STALE_HANDLE
    assert _kernel.sparse_release(again) == 0


def test_want_of_memory_is_told_whoever_of_the_library_meets_it() -> None:
    for status, code in ((7, -1), (8, -18)):
        with pytest.raises(KernelError, match="memory ran out"):
            _check_status(status, code)
    with pytest.raises(KernelError, match="failed with its code -911"):
        _check_status(8, -911)


def test_slots_run_out_with_a_sentence_and_come_back():
    indptr, indices, values = compressed(sp.eye_array(3))
    alive = []

    def fill():
        while True:
            alive.append(SparseLU(indptr, indices, ordering="amd"))

    with pytest.raises(KernelError, match="too many factorisations are alive"):
        fill()
    assert len(alive) > 500
    alive.clear()
    gc.collect()
    np.testing.assert_array_equal(SparseLU(indptr, indices).factorise(values).solve(np.ones(3)), np.ones(3))


def peak_memory():
    """Most resident memory of the process so far, in bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)


def test_memory_stays_bounded_over_many_cycles():
    matrix = held(block_of_elements(6, 6, 6), np.arange(3 * 49))
    indptr, indices, values = compressed(matrix)
    singular = np.zeros_like(values)

    def cycle():
        lu = SparseLU(indptr, indices)
        for _ in range(2):
            lu.factorise(values).solve(np.ones(len(indptr) - 1))
        with pytest.raises(SingularSystemError):
            lu.factorise(singular)
        return lu.statistics.peak_bytes

    for _ in range(3):
        size = cycle()
    before = peak_memory()
    for _ in range(25):
        cycle()
    assert peak_memory() - before < 2 * size


def test_threads_work_on_their_own_factorisations_at_the_same_time():
    matrix = held(block_of_elements(4, 4, 4), np.arange(3 * 25))
    indptr, indices, values = compressed(matrix)
    b = np.random.default_rng(9).standard_normal(len(indptr) - 1)
    expected = SparseLU(indptr, indices).factorise(values).solve(b)
    shared = SparseLU(indptr, indices)
    shared.factorise(values)
    differences = []

    def work():
        for _ in range(5):
            differences.append(np.abs(SparseLU(indptr, indices).factorise(values).solve(b) - expected).max())
            differences.append(np.abs(shared.factorise(values).solve(b) - expected).max())

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(differences) == 40
    assert max(differences) == 0.0
