"""Results do not depend on the number of threads, not in one bit; a program that uses the package has none that are in its way."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

#: A deformed body of more than one batch of elements, with weights that are all the same and that differ, and with what it has in the
#: reference configuration kept and not; prints a hash of its forces and tangents.
PROGRAM = """
import hashlib
from dataclasses import replace
import numpy as np
from isomortar import _bindings
from isomortar._bindings import BodyArrays, Pattern
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.model.entities import Material
from isomortar.model.numbering import patch_arrays
patch = mesh(box((0.0, 0.0, 0.0), (1.0, 2.0, 1.0)), ("N", "N", "N"), (2, 3, 2), (4, 4, 4))
reference, n = patch.control_points, len(patch.weights)
pattern = Pattern(np.arange(0, n * n + 1, n, dtype=np.int32), np.tile(np.arange(n, dtype=np.int32), n))
positions = reference + np.random.default_rng(3).uniform(-0.02, 0.02, reference.shape)
bits, point = hashlib.sha256(), np.arange(n, dtype=np.int32)
for weights in (np.ones(n), 1.0 + 0.1 * (point % 3)):
    for often in (True, False):
        forces, tangent = np.zeros_like(reference), np.zeros((n * n, 3, 3))
        body = BodyArrays(patch_arrays(replace(patch, weights=weights), point), (3, 4, 3), reference, often)
        _bindings.add_body(body, Material().arrays, positions, forces, pattern, tangent)
        assert np.abs(tangent).max() > 0
        bits.update(forces.tobytes() + tangent.tobytes())
print(bits.hexdigest())
"""


#: A scene in a few load steps; prints a hash of each state and of what was counted.
RUN = """
import hashlib, sys
from isomortar import Scene
from isomortar.march.simulation import Simulation
bits = hashlib.sha256()
for step in Simulation(Scene.load(sys.argv[1], sys.argv[2:]).problem()).run():
    for contact in step.state.contacts:
        bits.update(contact.pressure.tobytes() + contact.traction.tobytes())
    bits.update(step.state.positions.tobytes() + repr(sorted(step.counters.items())).encode())
print(bits.hexdigest())
"""
SHORT = ("stages.0.steps=2", "stages.1.steps=1")
#: Feet on a plane, by closest points, along averaged normals; the paper's slip sum.
RUNS = {
    "plane": ("press", "bodies.block.mesh.elements=[4,4,2]", "stages.0.steps=2"),
    "closest": ("twist", *SHORT, "stages.0.motions.top.translate=[0,0,-0.25]", "stages.1.motions.top.rotate=6.0"),
    "averaged": ("block", *SHORT, "stages.1.motions.top.translate=[0.05,0,0]"),
    "summed": ("press", "bodies.block.mesh.elements=[4,4,2]", "stages.0.steps=2", "solver.method=uzawa", "solver.slip_sum=paper"),
}


def bits(threads: int, *program: str) -> str:
    environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, "-c", *program], capture_output=True, text=True, env=environment, check=True)
    return done.stdout


@pytest.mark.parametrize("threads", [2, 3, 7])
def test_assembly_has_the_same_bits_on_any_number_of_threads(threads: int) -> None:
    assert bits(threads, PROGRAM) == bits(1, PROGRAM)


@pytest.mark.parametrize("words", RUNS.values(), ids=RUNS)
def test_runs_have_the_same_bits_on_any_number_of_threads(words: tuple[str, ...]) -> None:
    """Solids and contacts: passes of a contact have results, and orders of sums, that no thread can change."""
    assert {bits(threads, RUN, *words) for threads in (2, 3, 7)} == {bits(1, RUN, *words)}


#: Runs scenes with two threads for NumPy, as they are on most machines; prints the seconds of the second one.
HELPER = """
import os, time
import numpy
helper = sorted(int(thread) for thread in os.listdir("/proc/self/task"))[1]
import isomortar
seconds = lambda: int(open(f"/proc/self/task/{helper}/schedstat").read().split()[0]) / 1e9
before = -1.0
while seconds() != before:  # until it sleeps, which it does not at once, and later where the machine is busy
    before = seconds()
    time.sleep(1.0)
for name, change in (("twist", "stages.twist.steps=1"), ("block", "stages.slide.steps=1")):
    scene = isomortar.Scene.load(name, [change])
    isomortar.run(scene, f"{name}.h5").close()
print(seconds() - before)
"""


@pytest.mark.skipif(os.cpu_count() == 1, reason="NumPy has no second thread on one core")
def test_a_run_wakes_no_thread_of_numpy(tmp_path: Path) -> None:
    """It would stay awake for half a second, on a core that another run has use for; the system's own looks at it take 1e-5 s."""
    assert float(said(HELPER, tmp_path, OPENBLAS_NUM_THREADS="2")) < 1e-3


#: Prints what the environment says before and after the kernel is loaded, and how many threads the kernel's OpenBLAS has.
LOADED = """
import ctypes, os
before = dict(os.environ)
from isomortar._compiled import kernel
print(before == dict(os.environ), ctypes.CDLL(kernel.__file__).openblas_get_num_threads())
"""


@pytest.mark.parametrize(("environment", "threads"), [({}, 1), ({"OPENBLAS_NUM_THREADS": "2"}, 2)])
def test_the_kernel_is_loaded_with_one_thread_for_its_linear_algebra_unless_the_user_says_so(tmp_path, environment, threads) -> None:
    assert said(LOADED, tmp_path, **environment) == f"True {threads}"


@pytest.mark.parametrize(
    ("environment", "looks"),
    [({}, "3000"), ({"GOMP_SPINCOUNT": "7"}, "7"), ({"OMP_WAIT_POLICY": "passive"}, "0"), ({"OMP_WAIT_POLICY": "active"}, "30000000000")],
)
def test_threads_of_the_assembly_look_for_a_moment_before_they_sleep_unless_the_user_says_so(tmp_path, environment, looks) -> None:
    told = output("import isomortar._compiled", tmp_path, OMP_DISPLAY_ENV="verbose", **environment).stderr
    assert f"GOMP_SPINCOUNT = '{looks}'" in told


#: Computes a scene, and the same in a process that is forked off: a child would wait for threads of the assembly that it does not have.
FORKED = """
import os
import isomortar
def force():
    scene = isomortar.Scene.load("press", {"bodies.block.mesh.elements": [3, 3, 2]})
    with isomortar.run(scene, f"{os.getpid()}.h5") as results:
        return results.curve("force", support="top", component="z")[-1].hex()
print(force(), flush=True)
if os.fork() == 0:
    print(force(), flush=True)
    os._exit(0)
os.wait()
"""


@pytest.mark.skipif(os.cpu_count() == 1, reason="the assembly has no second thread on one core")
def test_a_process_that_is_forked_off_a_run_runs(tmp_path: Path) -> None:
    one, other = said(FORKED, tmp_path).splitlines()
    assert one == other


def said(code: str, folder: Path, **environment: str) -> str:
    """What a program prints, in an environment that says nothing of threads but this."""
    return output(code, folder, **environment).stdout.strip()


def output(code: str, folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """All that a program prints, in an environment that says nothing of threads but this."""
    clean = {name: value for name, value in os.environ.items() if not name.startswith(("OMP_", "OPENBLAS_", "GOMP_"))}
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=clean | environment, check=True, cwd=folder, timeout=300
    )
