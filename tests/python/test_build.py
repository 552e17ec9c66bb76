"""The compiled kernels: there, each in its precision, and the one that suits the processor to the same bits as the one for all."""

import json
import os
import shlex
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest

from isomortar import _compiled, _extended, _kernel


@pytest.mark.parametrize(("kernel", "digits", "spacing"), [(_kernel, 15, 2.0**-52), (_extended, 33, 2.0**-112)])
def test_kernel_computes_in_its_precision(kernel, digits, spacing):
    assert kernel.working_precision() == (digits, spacing)


def test_double_is_the_double_of_numpy():
    assert _kernel.working_precision() == (np.finfo(np.float64).precision, np.finfo(np.float64).eps)


#: A call of the twin with room for one element of a face that has four.
_OUT_OF_BOUNDS = """
from isomortar import _twin
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar._bindings import FaceArrays
from isomortar.model.numbering import patch_arrays
import numpy as np

patch = mesh(box((0, 0, 0), (1, 1, 1)), ("N",) * 3, (1, 1, 1), (2, 2, 1))
class OneElement(FaceArrays):
    elements = (1, 1)
_twin.surface_hulls(OneElement(patch_arrays(patch, np.arange(18, dtype=np.int32)), 3, 1), patch.control_points)
"""


def test_twin_watches_bounds() -> None:
    """In every build: what the gate runs of the shared sources runs once with all of the compiler's checks."""
    ended = subprocess.run([sys.executable, "-c", _OUT_OF_BOUNDS], capture_output=True, text=True)
    assert ended.returncode == 2
    assert "bound mismatch" in ended.stderr


def test_the_kernel_calls_no_vector_functions() -> None:
    """The compiler puts them into plain loops; they have fewer digits than the others, and none unless numbers are rounded to nearest."""
    needed = subprocess.run(["ldd", _kernel.__file__], capture_output=True, text=True, check=True).stdout
    assert "libm.so" in needed
    assert "libmvec" not in needed


#: Prints all bits of the state after each of some load steps.
_STATES = """
import sys
from itertools import islice
import isomortar
from isomortar.march.simulation import Simulation

scene, steps, *settings = sys.argv[1:]
for record in islice(Simulation(isomortar.Scene.load(scene, settings).problem()).run(), int(steps)):
    print([numbers.tobytes().hex() for numbers in vars(record).values() if hasattr(numbers, "tobytes")])
"""


@pytest.mark.parametrize(
    "words",
    [
        ("press", "1", "bodies.block.mesh.elements=[4, 4, 2]"),
        ("press", "1", "bodies.block.mesh.elements=[3, 2, 2]", "bodies.block.mesh.order=[3, 4, 2]"),
        ("twist", "6", "bodies.master.mesh.order=[3, 3, 2]"),
        ("tire", "2", 'solver.method="uzawa"'),
    ],
)
def test_the_kernel_taken_gives_the_bits_of_the_one_for_all_processors(words: tuple[str, ...]) -> None:
    said = []
    for settings in ({}, {_compiled.KERNEL: str(_kernel.__file__)}):
        ended = subprocess.run([sys.executable, "-c", _STATES, *words], capture_output=True, text=True, env=os.environ | settings)
        assert not ended.returncode, ended.stderr
        said.append(ended.stdout)
    assert said[0].count("\n") == int(words[1])
    assert said[0] == said[1]


@pytest.mark.parametrize(("flags", "name"), [({"sse2"}, "isomortar._kernel"), ({"sse2", "avx2"}, "isomortar._kernel_avx2")])
def test_a_processor_is_given_no_instructions_that_it_lacks(flags: set[str], name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_compiled, "_processor_flags", lambda: frozenset(flags))
    monkeypatch.setattr(_compiled.importlib, "import_module", lambda name: name)
    assert _compiled.suited_kernel() == name


def test_headers_of_numpy_are_those_of_the_environment() -> None:
    """Debian's python3-numpy has older ones beside Python.h: compiled with these, the kernel lacks symbols of the NumPy that loads it."""
    commands = json.loads((Path(_kernel.__file__).parents[1] / "compile_commands.json").read_text(encoding="utf-8"))
    wrapped = [shlex.split(entry["command"]) for entry in commands if entry["file"].endswith(("fortranobject.c", "module.c"))]
    assert wrapped
    for command in wrapped:
        searched = [option[2:] for option in command if option.startswith("-I")]
        assert searched.index(np.get_include()) < searched.index(sysconfig.get_path("include"))
