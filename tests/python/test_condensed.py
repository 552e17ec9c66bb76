"""Factors of bodies with what contact adds on their faces, against dense matrices; and the system that is made of them."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import sparse

from isomortar._condensed import CondensedFactors, SymmetricPattern
from isomortar.errors import InputError, KernelError, SingularSystemError
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.condensed import Bodies, CondensedSystem, touched
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.system import LinearSystem, entries
from isomortar.solve.timing import Ledger

ROOT = Path(__file__).parents[2]
RANDOM = np.random.default_rng(5)


def body(nodes: int = 5, faces: int = 40, others: int = 6, soft: float = 0.0):
    """Stiffness of a cube of springs between neighbours, held at one side; its last unknowns are faces'; what contact adds, unsymmetric."""
    line = sparse.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(nodes, nodes))
    one, three = sparse.eye_array(nodes), np.array([[2.0, 0.3, 0.1], [0.3, 1.0, 0.2], [0.1, 0.2, 1.5]])
    springs = sparse.kron(sparse.kron(line, one), one) + sparse.kron(sparse.kron(one, line), one) + sparse.kron(sparse.kron(one, one), line)
    matrix = sparse.csr_array(sparse.kron(springs, three))
    n = matrix.shape[0]
    matrix = sparse.csr_array(matrix - soft * sparse.diags_array((np.arange(n) >= n - faces).astype(float)))
    matrix.sort_indices()
    on_face = np.arange(n) >= n - faces
    added = RANDOM.standard_normal((faces + others, faces + others)) + 8.0 * np.eye(faces + others)
    return matrix, on_face, np.asfortranarray(added)


def pattern(matrix):
    return SymmetricPattern(matrix.indptr.astype(np.int64), matrix.indices.astype(np.int64))


def factors(matrix, on_face, ordering="metis"):
    return CondensedFactors(pattern(matrix), on_face, pattern(matrix).fill_reducing(ordering)[0])


def whole(matrix, on_face, added):
    """K with C, dense."""
    others = len(added) - np.count_nonzero(on_face)
    n = matrix.shape[0]
    total = np.zeros((n + others, n + others))
    total[:n, :n] = matrix.toarray()
    trailing = np.concatenate([np.flatnonzero(on_face), np.arange(n, n + others)])
    total[np.ix_(trailing, trailing)] += added
    return total


@pytest.mark.parametrize("ordering", ["metis", "amd"])
@pytest.mark.parametrize(("faces", "others"), [(40, 6), (40, 0), (0, 0), (375, 5), (1, 1)])
def test_solutions_are_those_of_the_whole_matrix(ordering, faces, others):
    matrix, on_face, added = body(faces=faces, others=others)
    on_face = RANDOM.permutation(on_face)  # faces are anywhere
    found = factors(matrix, on_face, ordering)
    right = RANDOM.standard_normal(matrix.shape[0] + others)
    for scale in (1.0, 3.0):
        found.factorise(scale * matrix.data, scale * added)
        np.testing.assert_allclose(found.solve(right), np.linalg.solve(scale * whole(matrix, on_face, added), right), rtol=1e-9, atol=1e-11)
    assert found.faces == faces
    assert 1e-13 < found.rcond <= 1.0


def test_faces_that_contact_alone_holds_need_no_definite_stiffness():
    """The stiffness is indefinite on the faces; with what contact adds it is regular."""
    matrix, on_face, added = body(soft=3.0)
    assert np.linalg.eigvalsh(matrix.toarray())[0] < -0.1
    found = factors(matrix, on_face)
    found.factorise(matrix.data, added)
    right = RANDOM.standard_normal(matrix.shape[0] + 6)
    np.testing.assert_allclose(found.solve(right), np.linalg.solve(whole(matrix, on_face, added), right), rtol=1e-8, atol=1e-10)


def test_what_is_not_definite_or_singular_is_left_to_others():
    matrix, on_face, added = body()
    found = factors(matrix, on_face)
    inner = sparse.csr_array(matrix - 30.0 * sparse.diags_array((np.arange(matrix.shape[0]) < 9).astype(float)))
    inner.sort_indices()
    with pytest.raises(SingularSystemError, match="not definite"):
        found.factorise(inner.data, added)
    with pytest.raises(KernelError, match="no matrix is factorised"):
        found.solve(np.ones(matrix.shape[0] + 6))
    added[-1] = 0.0  # a multiplier that nothing determines
    with pytest.raises(SingularSystemError):
        found.factorise(matrix.data, added)
    added[-1, -1] = 1e-17
    with pytest.raises(SingularSystemError):
        found.factorise(matrix.data, added)
    found.factorise(matrix.data, np.asfortranarray(8.0 * np.eye(46)))


def test_what_is_wrong_is_named():
    matrix, on_face, added = body()
    stiffness = pattern(matrix)
    order = stiffness.fill_reducing("amd")[0]
    with pytest.raises(InputError, match="ordering: is 'best'; allowed: metis, amd"):
        stiffness.fill_reducing("best")
    with pytest.raises(InputError, match="order: is no order of the unknowns"):
        CondensedFactors(stiffness, on_face, np.zeros_like(order))
    with pytest.raises(InputError, match="on_face: is int"):
        CondensedFactors(stiffness, on_face.astype(int), order)
    upper = sparse.csr_array(sparse.triu(matrix))
    with pytest.raises(InputError, match="indices: is not symmetric"):
        pattern(upper)
    hollow = sparse.csr_array((np.ones(2), np.array([1, 0]), np.array([0, 1, 2])), shape=(2, 2))
    with pytest.raises(InputError, match="indices: has no entry on the diagonal"):
        pattern(hollow)
    found = CondensedFactors(stiffness, on_face, order)
    with pytest.raises(InputError, match="values: is"):
        found.factorise(matrix.data[1:], added)
    with pytest.raises(InputError, match=r"added: has shape \(39, 39\); allowed: square, of 40 unknowns of faces and others"):
        found.factorise(matrix.data, np.asfortranarray(added[:39, :39]))
    with pytest.raises(InputError, match="added: is"):
        found.factorise(matrix.data, np.ascontiguousarray(added))
    with pytest.raises(InputError, match="rcond_min: "):
        found.factorise(matrix.data, added, rcond_min=2.0)
    bad = matrix.data.copy()
    bad[matrix.indptr[7]] = np.nan
    with pytest.raises(KernelError, match="not finite in row 7"):
        found.factorise(bad, added)
    added[3, 4] = np.inf
    with pytest.raises(KernelError, match="what is added to the matrix is not finite"):
        found.factorise(matrix.data, added)
    added[3, 4] = 0.0
    found.factorise(matrix.data, added)
    with pytest.raises(InputError, match="b: is"):
        found.solve(np.ones(3))
    right = np.ones(matrix.shape[0] + 6)
    right[5] = np.nan
    with pytest.raises(KernelError, match="not finite in row 5"):
        found.solve(right)


def test_handles_are_given_back():
    matrix, on_face, added = body(nodes=2, faces=4, others=0)
    for _ in range(1100):  # more than the kernel holds
        factors(matrix, on_face).factorise(matrix.data, added)


def test_no_threads_are_left_that_a_forked_process_would_wait_for():
    """CHOLMOD by itself takes four, whatever is set."""
    code = """
import os, sys
sys.path.insert(0, "tests/python")
from test_condensed import body, factors
matrix, on_face, added = body(nodes=12, faces=300)
def factorise():
    factors(matrix, on_face).factorise(matrix.data, added)
factorise()
if not (child := os.fork()):
    factorise()
    os._exit(7)
print(len(os.listdir("/proc/self/task")), os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    ended = subprocess.run([sys.executable, "-c", code], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=60, check=False)
    assert ended.stdout.split() == ["1", "7"], ended.stderr


# The system of a scene


PRESSED = ["bodies.block.mesh.elements=[6,6,4]", "stages.press.steps=2"]


def run(*overrides):
    return list(Simulation(Scene.load("press", [*PRESSED, *overrides]).problem()).run())


@pytest.mark.parametrize("method", ["monolithic", "uzawa"])
def test_a_run_by_parts_is_that_by_general_factors(monkeypatch, method):
    monkeypatch.setattr(Equilibrium, "left_by_bodies", lambda *_: np.inf)  # by parts alone bodies can be kept
    by_parts, made = run(f"solver.method={method}"), []
    init = LinearSystem.__init__
    monkeypatch.setattr(LinearSystem, "__init__", lambda *given: made.append(1) or init(*given))
    assert len(run(f"solver.method={method}")) == 2
    assert not made  # it was by parts, all of it
    monkeypatch.setattr(Bodies, "condense", lambda *_: False)
    general = run(f"solver.method={method}")
    assert made
    for one, other in zip(by_parts, general, strict=True):
        np.testing.assert_allclose(one.state.positions, other.state.positions, atol=1e-10)
        assert one.counters["factorisations"] == other.counters["factorisations"]


@pytest.fixture
def last(monkeypatch):
    """The last system by parts of a run, as it was made, and the values that it was factorised with."""
    noted = {}
    init, factorise = CondensedSystem.__init__, CondensedSystem.factorise

    def made(system, bodies, size, sources, *others):
        noted.update(bodies=bodies, size=size, sources=sources)
        init(system, bodies, size, sources, *others)

    def factorised(system, values):
        noted.update(system=system, values=[value.copy() for value in values])
        factorise(system, values)

    monkeypatch.setattr(CondensedSystem, "__init__", made)
    monkeypatch.setattr(CondensedSystem, "factorise", factorised)
    run()
    return noted


def test_the_matrix_by_parts_is_the_general_one(last):
    general = LinearSystem(last["size"], last["sources"], Ledger())
    general.factorise(last["values"])
    vector = RANDOM.standard_normal(last["size"])
    np.testing.assert_allclose(last["system"]._product(vector), general.matrix() @ vector, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(last["system"].solve(vector), general.solve(vector), rtol=1e-7, atol=1e-9)


def test_faces_are_the_unknowns_that_contact_acts_on(last):
    acted = np.unique(np.concatenate(entries(last["sources"][1:], last["size"]).nonzero()))
    unknowns = len(last["bodies"].pattern)
    assert np.array_equal(np.flatnonzero(touched(last["sources"][1:], unknowns)), acted[acted < unknowns])
    assert np.array_equal(np.flatnonzero(last["bodies"].on_face), acted[acted < unknowns])


def test_bodies_that_are_not_definite_get_general_factors(last):
    """A system that began by parts judges by general factors from then on, and names what these name."""
    values = last["values"]
    soft = [-values[0], *values[1:]]
    ledger = Ledger()
    system = CondensedSystem(
        last["bodies"], last["size"], last["sources"], lambda: LinearSystem(last["size"], last["sources"], ledger), ledger
    )
    vector = RANDOM.standard_normal(last["size"])
    system.factorise(values)
    assert system.ordering is None
    system.factorise(soft)
    general = LinearSystem(last["size"], last["sources"], Ledger())
    general.factorise(soft)
    np.testing.assert_allclose(system.solve(vector), general.solve(vector), rtol=1e-12, atol=1e-14)
    assert system.ordering == general.ordering
    assert system.rcond == general.rcond
    with pytest.raises(SingularSystemError):
        system.factorise([0.0 * value for value in values])
    system.begin()
    system.factorise(values)
    assert system.ordering is None


def test_each_increment_begins_by_parts(monkeypatch):
    """Else a run that is resumed would go another way than one that was not stopped."""
    factorise, renew, calls = CondensedFactors.factorise, CondensedFactors.renew, []

    def fails_at_first(self, *given):
        calls.append(1)
        if calls[0] == 1:
            raise SingularSystemError("not definite", -1)
        factorise(self, *given)

    monkeypatch.setattr(CondensedFactors, "factorise", fails_at_first)
    monkeypatch.setattr(CondensedFactors, "renew", lambda self, *given: calls.append(1) or renew(self, *given))
    results = Simulation(Scene.load("press", PRESSED).problem()).run()
    assert next(results).counters["factorisations"] > len(calls)  # a system that has failed is not tried again
    calls[:] = [0]
    assert next(results).counters["factorisations"] == len(calls) - 1


def test_poor_solutions_are_refined(last, monkeypatch):
    system, vector = last["system"], RANDOM.standard_normal(last["size"])
    right = system.solve(vector)
    solve, calls = CondensedFactors.solve, []
    monkeypatch.setattr(CondensedFactors, "solve", lambda self, b: calls.append(1) or 1.0001 * solve(self, b))
    np.testing.assert_allclose(system.solve(vector), right, rtol=1e-6, atol=1e-7 * np.abs(right).max())
    assert len(calls) == 2


def test_dense_parts_take_at_most_six_times_the_operations_of_the_bodies(last):
    bodies = last["bodies"]
    faces = bodies.factors.faces
    most = round((1.5 * (6 * bodies.factors.flops - faces**3)) ** (1 / 3)) - faces
    assert bodies.condense(most - 1)
    assert not bodies.condense(most + 2)
