"""The engine mumps: factors against dense matrices and CHOLMOD's, runs on two ranks against those on none, and how ranks end.

Where the engine is not built in, what needs it is left out; its refusals are heard in any build.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import sparse

from isomortar import _distributed
from isomortar._condensed import CondensedFactors
from isomortar._distributed import DistributedFactors, is_built
from isomortar.cli import factor
from isomortar.errors import InputError, KernelError, SingularSystemError
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.condensed import CondensedSystem
from isomortar.trade.knobs import KNOBS, dials_of
from test_condensed import RANDOM, body, factors, pattern, whole

built = pytest.mark.skipif(not is_built(), reason="the engine mumps is not built in: bash tools/setup.sh --mumps")
started = pytest.mark.skipif(not is_built() or not shutil.which("mpirun"), reason="needs the engine mumps and mpirun")

TESTS = Path(__file__).parent
#: What mpirun asks of who starts more ranks than there are cores, or as root.
GRANTED = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
FACTOR = [sys.executable, "-c", "from isomortar.cli.factor import main; main()"]
PRESS = ["bodies.block.mesh.elements=[6,6,4]", "stages.press.steps=2"]
TWIST = [
    *(f"bodies.{name}.mesh.elements={elements}" for name, elements in (("slave", [3, 3, 2]), ("master", [4, 4, 4]))),
    *("stages.press.steps=1", "stages.press.motions.top.translate=[0,0,-0.25]"),
    *("stages.twist.steps=1", "stages.twist.motions.top.rotate=4"),
]


def distributed(matrix, on_face, compression=0.0):
    return DistributedFactors(pattern(matrix), on_face, pattern(matrix).fill_reducing("metis")[0], compression)


def ranks_of(first, other=FACTOR, seconds=120):
    """How mpirun ended with a first rank, the code of a program or a command, and one other."""
    command = [sys.executable, "-c", first] if isinstance(first, str) else first
    environment = {**os.environ, **GRANTED, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, [str(TESTS), os.environ.get("PYTHONPATH")]))
    every = ["mpirun", "--bind-to", "none", "-n", "1", *command, ":", "-n", "1", *other]
    return subprocess.run(every, env=environment, capture_output=True, text=True, timeout=seconds, check=False)


def forces(name, *overrides):
    """Forces and moments of all supports after all load steps, shape (steps, supports, 6)."""
    results = Simulation(Scene.load(name, overrides).problem()).run()
    return np.array([[[*reaction.force, *reaction.moment] for reaction in result.reactions] for result in results])


# Factors


@built
@pytest.mark.parametrize(("faces", "others"), [(40, 6), (40, 0), (0, 0), (300, 5), (1, 1)])
def test_solutions_are_those_of_the_whole_matrix(faces, others):
    matrix, on_face, added = body(faces=faces, others=others)
    on_face = RANDOM.permutation(on_face)
    found = distributed(matrix, on_face)
    right = RANDOM.standard_normal(matrix.shape[0] + others)
    for scale in (1.0, 3.0):
        found.factorise(scale * matrix.data, scale * added)
        np.testing.assert_allclose(found.solve(right), np.linalg.solve(scale * whole(matrix, on_face, added), right), rtol=1e-9, atol=1e-11)
    assert found.faces == faces
    assert 1e-13 < found.rcond <= 1.0
    assert found.factor_entries > matrix.nnz / 2


@built
@pytest.mark.parametrize("others", [0, 6, 20])
def test_bodies_keep_their_factors_where_contact_alone_is_another(others):
    matrix, on_face, added = body(others=6)
    again = np.asfortranarray(10.0 * np.eye(40 + others) + RANDOM.standard_normal((40 + others,) * 2))
    right = RANDOM.standard_normal(matrix.shape[0] + others)
    found = distributed(matrix, on_face)
    with pytest.raises(KernelError, match="no matrix is factorised"):
        found.renew(added)
    found.factorise(matrix.data, added)
    for _ in range(2):  # what was added before is not there any more
        found.renew(again)
        np.testing.assert_allclose(found.solve(right), np.linalg.solve(whole(matrix, on_face, again), right), rtol=1e-9, atol=1e-11)


@built
def test_the_complement_on_the_faces_is_that_of_cholmod():
    """Where contact adds a unit matrix, solutions on the faces are columns of the inverse of the complement and that."""
    matrix, on_face, _ = body(faces=30, others=0)
    found = []
    for one in (factors(matrix, on_face), distributed(matrix, on_face)):
        one.factorise(matrix.data, np.asfortranarray(np.eye(30)))
        columns = [one.solve(row)[on_face] for row in np.eye(matrix.shape[0])[on_face]]
        found.append(np.linalg.inv(columns) - np.eye(30))
    inner = ~on_face
    dense = matrix.toarray()
    exact = dense[np.ix_(on_face, on_face)] - dense[np.ix_(on_face, inner)] @ np.linalg.solve(
        dense[np.ix_(inner, inner)], dense[np.ix_(inner, on_face)]
    )
    for complement in found:
        np.testing.assert_allclose(complement, exact, rtol=1e-11, atol=1e-12)


@built
def test_what_is_not_definite_or_singular_is_left_to_others():
    matrix, on_face, added = body()
    found = distributed(matrix, on_face)
    for shift in (30.0, 1e6):  # pivots are negative, diagonals too
        inner = sparse.csr_array(matrix - shift * sparse.diags_array((np.arange(matrix.shape[0]) < 9).astype(float)))
        inner.sort_indices()
        with pytest.raises(SingularSystemError, match="not definite"):
            found.factorise(inner.data, added)
        with pytest.raises(KernelError, match="no matrix is factorised"):
            found.solve(np.ones(matrix.shape[0] + 6))
    added[-1] = 0.0  # a multiplier that nothing determines
    with pytest.raises(SingularSystemError):
        found.factorise(matrix.data, added)
    found.factorise(matrix.data, np.asfortranarray(8.0 * np.eye(46)))


@built
def test_a_body_that_nothing_holds_is_singular():
    """Its least pivot is round-off, of either sign."""
    line = sparse.diags_array([-1.0, np.array([1.0, 2.0, 2.0, 1.0]), -1.0], offsets=[-1, 0, 1], shape=(4, 4))
    one = sparse.eye_array(4)
    springs = sparse.kron(sparse.kron(line, one), one) + sparse.kron(sparse.kron(one, line), one) + sparse.kron(sparse.kron(one, one), line)
    for held, regular in ((0.0, False), (1e-15, False), (1e-8, True)):
        matrix = sparse.csr_array(springs + held * sparse.eye_array(64))
        matrix.sort_indices()
        found = distributed(matrix, np.zeros(64, dtype=bool))
        nothing = np.zeros((0, 0), order="F")
        if regular:
            found.factorise(matrix.data, nothing)
        else:
            with pytest.raises(SingularSystemError):
                found.factorise(matrix.data, nothing)


@built
def test_instances_are_given_back():
    matrix, on_face, added = body(nodes=2, faces=4, others=0)
    for _ in range(150):  # more than the ranks hold
        distributed(matrix, on_face).factorise(matrix.data, added)
    with pytest.raises(KernelError, match="too many factorisations are alive: the ranks hold 64"):
        _ = [distributed(matrix, on_face) for _ in range(65)]


@built
def test_what_is_released_while_a_task_is_done_goes_with_the_next_one():
    matrix, on_face, added = body(nodes=2, faces=4, others=0)
    found = distributed(matrix, on_face)
    with _distributed._one_task:
        del found
        assert len(_distributed._left) == 1
    distributed(matrix, on_face).factorise(matrix.data, added)
    assert not _distributed._left


# Runs


@built
@pytest.mark.parametrize(("name", "overrides"), [("press", PRESS), ("twist", TWIST)])
def test_forces_are_those_of_a_run_without(monkeypatch, name, overrides):
    own, made = forces(name, *overrides), []
    eliminate = DistributedFactors._eliminate
    monkeypatch.setattr(DistributedFactors, "_eliminate", lambda *given: made.append(1) or eliminate(*given))
    np.testing.assert_allclose(forces(name, *overrides, "solver.engine=mumps"), own, rtol=1e-10, atol=1e-10 * np.abs(own).max())
    assert made


@built
def test_bodies_that_are_not_definite_get_general_factors(monkeypatch):
    """MUMPS refuses; the run goes on, and each increment begins by parts."""
    own = forces("press", *PRESS)
    eliminate, calls = DistributedFactors._eliminate, []

    def fails_at_first(self, *given):
        calls.append(1)
        if len(calls) == 1:
            raise SingularSystemError("not definite", -1)
        eliminate(self, *given)

    monkeypatch.setattr(DistributedFactors, "_eliminate", fails_at_first)
    np.testing.assert_allclose(forces("press", *PRESS, "solver.engine=mumps"), own, rtol=1e-10, atol=1e-10 * np.abs(own).max())
    assert len(calls) > 1


@built
@pytest.mark.parametrize("compression", [1e-9, 1e-6, 1e-3])
def test_what_compressed_factors_leave_out_is_refined(compression):
    own = forces("press", *PRESS)
    found = forces("press", *PRESS, "solver.engine=mumps", f"solver.compression={compression}")
    np.testing.assert_allclose(found, own, rtol=1e-9, atol=1e-9 * np.abs(own).max())


@built
def test_poor_factors_are_refined_often_and_no_good_ones_end_the_run(monkeypatch):
    solve, calls = DistributedFactors.solve, []
    own = forces("press", *PRESS)
    compressed = (*PRESS, "solver.engine=mumps", "solver.compression=1e-3")
    monkeypatch.setattr(DistributedFactors, "solve", lambda self, b: calls.append(1) or 0.8 * solve(self, b))
    np.testing.assert_allclose(forces("press", *compressed), own, rtol=1e-8, atol=1e-8 * np.abs(own).max())
    assert len(calls) > 50
    monkeypatch.setattr(DistributedFactors, "solve", lambda self, b: 0.3 * solve(self, b))
    with pytest.raises(KernelError, match=r"0.001 leaves out too much of this matrix: refined solutions leave 4.9e-01"):
        forces("press", *compressed)


@built
def test_compression_is_a_knob_of_scenes_that_take_the_engine(monkeypatch):
    knobs = [knob for knob in KNOBS if knob.name == "compression"]
    assert not dials_of(Scene.load("press"), knobs=knobs)
    (dial,) = dials_of(Scene.load("press", ["solver.engine=mumps"]), knobs=knobs)
    assert [setting.label for setting in dial.settings] == ["0.001", "1e-06", "1e-09", "0.0"]
    assert dial.own == 3
    scene = Scene.load("press", ["solver.engine=mumps"])
    monkeypatch.setattr("isomortar.trade.knobs.is_built", lambda: False)
    assert not dials_of(scene, knobs=knobs)


# Ranks


@started
def test_two_ranks_give_the_forces_of_none():
    first = """
import json
from test_mumps import PRESS, TWIST, forces
from isomortar._distributed import ranks
engine = "solver.engine=mumps"
found = [forces("press", *PRESS, engine), forces("twist", *TWIST, engine), forces("press", *PRESS, engine, "solver.compression=1e-6")]
print(json.dumps([ranks(), *[one.tolist() for one in found]]))
"""
    ended = ranks_of(first)
    assert ended.returncode == 0, ended.stderr
    many, press, twist, compressed = json.loads(ended.stdout.splitlines()[-1])
    assert many == 2
    own = forces("press", *PRESS), forces("twist", *TWIST)
    np.testing.assert_allclose(press, own[0], rtol=1e-10, atol=1e-10 * np.abs(own[0]).max())
    np.testing.assert_allclose(twist, own[1], rtol=1e-10, atol=1e-10 * np.abs(own[1]).max())
    np.testing.assert_allclose(compressed, own[0], rtol=1e-9, atol=1e-9 * np.abs(own[0]).max())


#: Factors that take some memory on both ranks.
FACTORISE = """
from test_mumps import body, distributed
matrix, on_face, added = body(nodes=14, faces=100)
"""


@started
def test_want_of_memory_on_another_rank_is_an_exception_on_the_first_one():
    other = """
import resource
from pathlib import Path
from isomortar._compiled import mumps
from isomortar._distributed import serve
mumps().mumps_join()
held = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (held + 2_000_000,) * 2)
serve()
"""
    first = f"""
from isomortar.errors import KernelError
{FACTORISE}
try:
    distributed(matrix, on_face).factorise(matrix.data, added)
except KernelError as error:
    print("heard:", error)
"""
    ended = ranks_of(first, [sys.executable, "-c", other])
    assert "heard: memory ran out on one of the ranks" in ended.stdout, ended.stderr
    assert ended.returncode == 0


@started
def test_an_exception_on_the_first_rank_ends_the_others():
    ended = ranks_of(f"{FACTORISE}\nfound = distributed(matrix, on_face)\nraise SystemExit(5)")
    assert ended.returncode == 5
    ended = ranks_of(f"{FACTORISE}\nfound = distributed(matrix, on_face)\nraise ValueError('of no rank')")
    assert ended.returncode == 1
    assert "of no rank" in ended.stderr


@started
def test_a_rank_that_dies_ends_the_run():
    other = [sys.executable, "-c", "import os; from isomortar._compiled import mumps; mumps().mumps_join(); os._exit(7)"]
    ended = ranks_of(f"{FACTORISE}\ndistributed(matrix, on_face).factorise(matrix.data, added)\nprint('went on')", other)
    assert ended.returncode != 0
    assert "went on" not in ended.stdout


@started
def test_a_run_by_the_command_line_is_that_of_one_rank(tmp_path):
    """Its ranks end with it, where there was nothing to do as well."""
    run = [sys.executable, "-m", "isomortar", "run", "press", "-q", "--output", str(tmp_path / "press.h5")]
    settings = [word for override in (*PRESS, "solver.engine=mumps") for word in ("--set", override)]
    for more in ([], ["--resume"]):
        ended = ranks_of([*run, *settings, *more])
        assert (ended.returncode, ended.stdout.strip()) == (0, str(tmp_path / "press.h5")), ended.stderr


@started
def test_ranks_that_would_wait_for_ever_are_refused(tmp_path):
    run = [sys.executable, "-m", "isomortar", "run", "press", "-q", "--output", str(tmp_path / "press.h5")]
    ended = ranks_of(run)
    assert ended.returncode == 2
    assert 'isomortar: solver.engine: is "own", and ranks were started beside this run, which would wait for it' in ended.stderr
    ended = ranks_of(FACTOR)
    assert ended.returncode == 2
    assert "isomortar-factor is no program of its own: mpirun -n 1 isomortar run SCENE : -n 7 isomortar-factor" in ended.stderr
    run = [*run[:-1], str(tmp_path / "first.h5"), "--set", "solver.engine=mumps"]
    ended = ranks_of(run, [*run, "--output", str(tmp_path / "other.h5")])
    assert ended.returncode != 0
    assert "is of the first rank, and this is rank 1" in ended.stderr


# Any build


def test_the_kernel_knows_nothing_of_mpi():
    from isomortar import _kernel

    needed = subprocess.run(["ldd", _kernel.__file__], capture_output=True, text=True, check=True).stdout
    assert "openblas" in needed
    assert "mpi" not in needed


def test_nothing_of_the_engine_is_loaded_where_it_is_not_asked_for():
    code = "import sys, isomortar; from test_mumps import forces, PRESS; forces('press', *PRESS); print('isomortar._mumps' in sys.modules)"
    environment = {**os.environ, "PYTHONPATH": str(TESTS)}
    ended = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=60, check=True)
    assert ended.stdout.strip() == "False"


def test_without_the_engine_what_asks_for_it_is_refused(monkeypatch, capsys):
    monkeypatch.setattr(_distributed, "is_built", lambda: False)
    problem = Scene.load("press", ["solver.engine=mumps"]).problem()  # may be looked at, as in a results file from elsewhere
    for asked in (_distributed.ranks.__wrapped__, _distributed.serve, lambda: Simulation(problem)):
        with pytest.raises(InputError, match="this build does not have"):
            asked()
    with pytest.raises(SystemExit):
        factor.main()
    assert "bash tools/setup.sh --mumps" in capsys.readouterr().err


def test_the_systems_own_factors_are_refined_once(monkeypatch):
    """As before there were others: their bits are the same."""
    assert CondensedFactors.compression == 0.0
    monkeypatch.setattr(CondensedSystem, "_refined_often", None)
    solve = CondensedFactors.solve
    monkeypatch.setattr(CondensedFactors, "solve", lambda self, b: 1.0001 * solve(self, b))
    forces("press", *PRESS)
