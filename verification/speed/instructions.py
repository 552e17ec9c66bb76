"""Instructions that the kernel takes for a fixed piece of work, counted by valgrind: unlike times they are the same on a busy machine."""

from __future__ import annotations

import re
import shutil
import sys
import tempfile
from importlib.util import find_spec
from itertools import islice
from pathlib import Path

import numpy as np

from isomortar._compiled import KERNEL
from isomortar.harness import Bound, Matches, case, skip
from isomortar.march.simulation import Simulation
from isomortar.program.process import output_of
from isomortar.scene import Scene

#: A small twist on a master of order 3: two deformable bodies with friction; its first two load steps, with contact in both.
SCENE, STEPS = "twist", 2
SETTINGS = (
    "bodies.slave.mesh.elements=[2,2,2]",
    "bodies.master.mesh.order=[3,3,2]",
    "bodies.master.mesh.elements=[3,3,2]",
    "stages.press.steps=4",
)
#: Routines of the kernel's interface by the work that they do, and those that count in `load steps` alone.
WORK = {
    "solid": ("add_body_",),
    "projection": ("project_points_",),
    "contact": (
        *("control_quantities_", "augmented_multipliers_", "friction_radius_", "contact_forces_", "contact_blocks_", "multiplier_rows_"),
    ),
    "factors": (
        *("condensed_order_", "condensed_analyse_", "condensed_factorise_", "condensed_renew_", "sparse_analyse_", "sparse_factorise_"),
    ),
    "solves": ("condensed_solve_", "sparse_solve_"),
}
OTHERS = (
    *("slave_tables_", "surface_functions_", "condense_multipliers_", "find_climbs_", "find_places_", "add_values_"),
    *("control_volumes_", "squares_times_", "sparse_release_"),
    *("keep_patch_", "keep_body_", "keep_material_", "keep_friction_", "keep_slave_", "keep_plane_", "keep_face_"),
    *("keep_pattern_", "release_descriptor_"),
)
#: valgrind knows no AVX-512; and the routines that OpenBLAS takes must not depend on the machine.
CORE = {"OPENBLAS_CORETYPE": "Haswell", "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PYTHONHASHSEED": "0"}
#: The kernel for all processors: of instructions that process more at once there are fewer, where there are any.
PLAIN = {KERNEL: str(find_spec("isomortar._kernel").origin)}  # type: ignore[union-attr]
#: Share by which a count may differ.
SHARE = 0.02


def run() -> float:
    """Do the work; returns what the forces of the two supports leave over, relative to either's."""
    *_, last = islice(Simulation(Scene.load(SCENE, SETTINGS).problem()).run(), STEPS)
    forces = np.array([reaction.force for reaction in last.reactions])
    return float(np.linalg.norm(forces.sum(axis=0)) / np.linalg.norm(forces[0]))


def count() -> dict[str, float]:
    """Instructions by the work that they do, and of all routines of the kernel together."""
    routines = [*(name for names in WORK.values() for name in names), *OTHERS]
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "callgrind.out"
        options = ["--tool=callgrind", f"--callgrind-out-file={output}", *(f"--toggle-collect={name}" for name in routines)]
        # This file's folder is put on the path of the process.
        command = ["valgrind", *options, sys.executable, "-c", "import instructions; instructions.run()"]
        output_of(command, folder=Path(__file__).parent, environment=CORE | PLAIN)
        said = output_of(["callgrind_annotate", "--inclusive=yes", "--threshold=100", str(output)], folder=Path(folder))
    found = {name: float(number.replace(",", "")) for number, name in re.findall(r"^ *([\d,]+)[^:\n]*:(\w+_) ", said, re.MULTILINE)}
    total = re.search(r"^ *([\d,]+).* PROGRAM TOTALS", said, re.MULTILINE)
    assert total, "callgrind_annotate prints totals"
    counts = {work: sum(found.get(name, 0.0) for name in names) for work, names in WORK.items()}  # bodies are definite, or are not
    return {**counts, "load steps": float(total.group(1).replace(",", ""))}


_SAME = "reference: counts of the same work repeat to far less than one per cent; a smaller one is to be blessed, lest it grow back unseen"


@case(
    claim="The kernel takes as many instructions for two load steps as it did, to two per cent, built with the compiler and the libraries "
    "that the record of the reference names: after a change of those, bless anew.",
    tier="nightly",
    bounds={
        "imbalance": Bound(at_most=1e-7, reason="theory: equilibrium, to the tolerance of Newton's method times ten"),
        **{name: Matches("instructions", _SAME, allowance=SHARE) for name in (*WORK, "load steps")},
    },
    scene=SCENE,
)
def instructions() -> dict[str, float]:
    """Run here for the result, then in a process under valgrind, which counts within the kernel's routines alone."""
    if shutil.which("valgrind") is None:
        skip("valgrind, which counts, is not installed: apt-get install valgrind")
    return {"imbalance": run(), **count()}
