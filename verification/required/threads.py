"""Results do not depend on the number of threads, not in one bit."""

from __future__ import annotations

import ctypes
import hashlib
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np

from isomortar import _bindings
from isomortar._bindings import BodyArrays, Pattern
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Material
from isomortar.model.numbering import patch_arrays
from isomortar.scene import Scene

#: Numbers of threads, and how often each is tried: what threads do to each other is not always seen.
THREADS, TIMES = (2, 3, 7), 3
_SHORT = ("stages.0.steps=1", "stages.1.steps=1")
#: Feet on a plane, by closest points, along averaged normals.
RUNS = {
    "plane": ("press", "bodies.block.mesh.elements=[4,4,2]", "stages.0.steps=1"),
    "closest": ("twist", *_SHORT, "stages.0.motions.top.translate=[0,0,-0.25]", "stages.1.motions.top.rotate=6.0"),
    "averaged": ("block", *_SHORT, "stages.1.motions.top.translate=[0.05,0,0]"),
}
SAME = Bound(0.0, 0.0, "definition: sums are taken in the same order; results whose bits are others")


@contextmanager
def by_threads(many: int) -> Iterator[None]:
    """The kernel's loops by so many threads: of the library that it has loaded."""
    loaded = re.search(r"/\S*libgomp\S*", Path("/proc/self/maps").read_text())
    assert loaded is not None, "the kernel has its threads from libgomp"
    library = ctypes.CDLL(loaded[0])
    before = library.omp_get_max_threads()
    library.omp_set_num_threads(many)
    assert library.omp_get_max_threads() == many
    try:
        yield
    finally:
        library.omp_set_num_threads(before)


def of_bodies() -> str:
    """Forces and tangents of a deformed body of more than one batch, with equal weights and others, kept at its Gauss points or not."""
    patch = mesh(box((0.0, 0.0, 0.0), (1.0, 2.0, 1.0)), ("N", "N", "N"), (2, 3, 2), (4, 4, 4))
    reference, n = patch.control_points, len(patch.weights)
    pattern = Pattern(np.arange(0, n * n + 1, n, dtype=np.int32), np.tile(np.arange(n, dtype=np.int32), n))
    positions = reference + np.random.default_rng(3).uniform(-0.02, 0.02, reference.shape)
    bits, point = hashlib.sha256(), np.arange(n, dtype=np.int32)
    for weights in np.stack([np.ones(n), 1.0 + 0.1 * (point % 3)]):
        for often in (True, False):
            forces, tangent = np.zeros_like(reference), np.zeros((n * n, 3, 3))
            body = BodyArrays(patch_arrays(replace(patch, weights=weights), point), (3, 4, 3), reference, often)
            _bindings.add_body(body, Material().arrays, positions, forces, pattern, tangent)
            bits.update(forces.tobytes() + tangent.tobytes())
    return bits.hexdigest()


def of_a_run(name: str) -> str:
    """States of all load steps of a scene, and what was counted."""
    scene, *changes = RUNS[name]
    bits = hashlib.sha256()
    for step in Simulation(Scene.load(scene, changes).problem()).run():
        for contact in step.state.contacts:
            bits.update(contact.pressure.tobytes() + contact.traction.tobytes())
        bits.update(step.state.positions.tobytes() + repr(sorted(step.counters.items())).encode())
    return bits.hexdigest()


@case(
    claim="Forces and tangents of bodies have the same bits by any number of threads.",
    tier="gate",
    bounds={"others": SAME},
)
def bodies_by_threads() -> dict[str, float]:
    """How many, of nine."""
    with by_threads(1):
        alone = of_bodies()
    others = 0
    for many in THREADS * TIMES:
        with by_threads(many):
            others += of_bodies() != alone
    return {"others": float(others)}


@case(
    claim="Runs of contacts have the same bits by any number of threads: states, and what is counted.",
    tier="gate",
    grid={"run": tuple(RUNS)},
    bounds={"others": SAME},
)
def runs_by_threads(run: str) -> dict[str, float]:
    """How many, of three."""
    with by_threads(1):
        alone = of_a_run(run)
    others = 0
    for many in THREADS:
        with by_threads(many):
            others += of_a_run(run) != alone
    return {"others": float(others)}
