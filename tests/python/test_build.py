"""The two compiled kernels: there, and each in its precision."""

import subprocess
import sys

import numpy as np
import pytest

from isomortar import _extended, _kernel


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
