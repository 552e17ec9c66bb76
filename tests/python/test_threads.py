"""Results do not depend on the number of threads, not in one bit."""

import os
import subprocess
import sys

import pytest

#: A deformed body of more than one batch of elements; prints a hash of its forces and tangent.
PROGRAM = """
import hashlib
import numpy as np
from isomortar import _bindings
from isomortar._bindings import Pattern
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.model.entities import Material
from isomortar.model.numbering import patch_arrays
patch = mesh(box((0.0, 0.0, 0.0), (1.0, 2.0, 1.0)), ("N", "N", "N"), (2, 3, 2), (4, 4, 4))
reference, n = patch.control_points, len(patch.weights)
pattern = Pattern(np.arange(0, n * n + 1, n, dtype=np.int32), np.tile(np.arange(n, dtype=np.int32), n))
forces, tangent = np.zeros_like(reference), np.zeros((n * n, 3, 3))
positions = reference + np.random.default_rng(3).uniform(-0.02, 0.02, reference.shape)
arrays = patch_arrays(patch, np.arange(n, dtype=np.int32))
_bindings.add_body(arrays, (3, 4, 3), Material().arrays, positions, reference, forces, pattern, tangent)
assert np.abs(tangent).max() > 0
print(hashlib.sha256(forces.tobytes() + tangent.tobytes()).hexdigest())
"""


def bits(threads: int) -> str:
    environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, env=environment, check=True)
    return done.stdout


@pytest.mark.parametrize("threads", [2, 3, 7])
def test_assembly_has_the_same_bits_on_any_number_of_threads(threads: int) -> None:
    assert bits(threads) == bits(1)
