"""Handles of what the kernel was handed once: made at first use, let go with the arrays, told from stale ones."""

from __future__ import annotations

import copy
import gc
import os
import pickle
import resource
import subprocess
import sys

import numpy as np
import pytest

from isomortar import _bindings, _extended
from isomortar._arrays import FrictionArrays, MaterialArrays, Pattern
from isomortar._codes import WORK, Status
from isomortar._compiled import kernel
from isomortar._descriptors import Descriptors
from isomortar.errors import InputError, KernelError


def pattern(rows: int = 2) -> Pattern:
    return Pattern(np.arange(rows + 1, dtype=np.int32), np.arange(rows, dtype=np.int32))


@pytest.fixture(params=[kernel, _extended], ids=["double", "extended"])
def descriptors(request: pytest.FixtureRequest) -> Descriptors:
    return Descriptors(request.param)


def test_the_same_arrays_have_one_handle_and_others_another(descriptors: Descriptors) -> None:
    one, other = pattern(), pattern()
    handle = descriptors.handle("pattern", one, Pattern)
    assert descriptors.handle("pattern", one, Pattern) == handle
    assert descriptors.handle("pattern", other, Pattern) != handle
    assert descriptors.handle("pattern", copy.deepcopy(one), Pattern) != handle
    assert descriptors.handle("pattern", pickle.loads(pickle.dumps(one)), Pattern) != handle


@pytest.mark.parametrize("library", [kernel, _extended])
def test_a_handle_is_stale_once_its_arrays_are_gone(library: object) -> None:
    descriptors = Descriptors(library)
    arrays = pattern()
    handle = descriptors.handle("pattern", arrays, Pattern)
    del arrays
    gc.collect()
    assert library.release_descriptor(handle) == Status.STALE_HANDLE  # type: ignore[attr-defined]


@pytest.mark.parametrize("handle", [-1, 0, 10**6, 2**62, -(2**62)])
def test_a_handle_that_was_never_given_out_is_stale(handle: int) -> None:
    arrays = pattern()
    Descriptors(kernel).handle("pattern", arrays, Pattern)
    assert kernel.release_descriptor(handle if handle else 10**9) == Status.STALE_HANDLE
    assert kernel.friction_radius(handle if handle else 10**9, np.ones(2))[1] == Status.STALE_HANDLE


def test_a_handle_of_something_else_is_refused_by_every_routine() -> None:
    arrays, descriptors = pattern(), Descriptors(kernel)
    wrong = descriptors.handle("pattern", arrays, Pattern)
    material = MaterialArrays(1, np.ones(2))
    also_wrong = descriptors.handle("material", material, MaterialArrays)
    points, feet = np.zeros((3, 2), order="F"), np.zeros((2, 2), order="F")
    flags, places = np.zeros(2, np.int32), np.zeros((2, 2), np.int32, order="F")
    assert kernel.friction_radius(wrong, np.ones(2))[1] == Status.STALE_HANDLE
    assert kernel.material_stress(wrong, np.zeros((3, 3, 1), order="F"))[1] == Status.STALE_HANDLE
    assert kernel.surface_functions(wrong, 1, 0, feet, 4)[2] == Status.STALE_HANDLE
    assert kernel.keep_body(wrong, np.ones(3, np.int32), points, 0) == (-1, Status.STALE_HANDLE)
    assert kernel.control_volumes(wrong, 2)[2] == Status.STALE_HANDLE
    assert kernel.keep_face(wrong, 1, 0, 0, 0.0, places) == (-1, Status.STALE_HANDLE)
    counts = np.zeros(len(WORK), np.int64)
    assert kernel.project_points(wrong, wrong, points, flags, feet, flags, 1, counts, feet)[-2] == Status.STALE_HANDLE
    projected = (points, feet, places, places, flags)
    assert kernel.contact_forces(wrong, wrong, *projected, 1, np.ones(2), feet, flags, counts, points) == Status.STALE_HANDLE
    assert not counts.any()
    assert kernel.find_places(also_wrong, 1, flags, flags, 0, np.zeros(1, np.int64), np.zeros(0, np.int64))[1] == Status.STALE_HANDLE


def test_arrays_of_another_kind_are_refused_by_name() -> None:
    with pytest.raises(InputError, match=r"^friction: .* allowed: FrictionArrays"):
        _bindings.friction_radius(pattern(), np.ones(2))  # type: ignore[arg-type]


def test_a_law_with_other_parameters_is_refused() -> None:
    with pytest.raises(KernelError, match="no law of material or friction has that number and so many parameters"):
        _bindings.friction_radius(FrictionArrays(1, np.ones(2)), np.ones(2))


OUT_OF_MEMORY = """
import resource, sys
import numpy as np
from isomortar._arrays import BodyArrays, Pattern
from isomortar._compiled import kernel
from isomortar._descriptors import Descriptors
from isomortar.errors import KernelError
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.model.numbering import patch_arrays

n = 2 * 10**7
patch = mesh(box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), ("N", "N", "N"), (1, 1, 1), (10, 10, 10))
body = BodyArrays(patch_arrays(patch, np.arange(11**3, dtype=np.int32)), (16, 16, 16), patch.control_points, often=True)
pattern = Pattern(np.array([0, n], dtype=np.int32), np.zeros(n, dtype=np.int32))
in_use = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (in_use + (40 << 20),) * 2)
try:
    Descriptors(kernel).handle(sys.argv[1], globals()[sys.argv[1]], BodyArrays, Pattern)
except KernelError as error:
    print(error)
"""


@pytest.mark.parametrize("name", ["pattern", "body"])
def test_want_of_memory_is_an_error_and_no_end(name: str) -> None:
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}  # others would need memory to begin
    done = subprocess.run([sys.executable, "-c", OUT_OF_MEMORY, name], capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 0, done.stderr
    assert "memory ran out" in done.stdout


def test_memory_of_arrays_that_are_gone_is_used_again() -> None:
    """Fifty patterns of 8 MB one after the other, of which one is alive at a time."""
    descriptors = Descriptors(kernel)
    for _ in range(10):
        descriptors.handle("pattern", pattern(10**6), Pattern)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(40):
        descriptors.handle("pattern", pattern(10**6), Pattern)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < before + 60_000
