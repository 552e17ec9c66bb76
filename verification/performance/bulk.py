"""One Newton iteration of a hyperelastic block, without contact: isomortar beside GetFEM, NGSolve and nutils."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from performance.peers.bulk_work import answer, multilinear, seconds
from performance.peers.programs import peers_python

from isomortar.harness.bench import ASIDE, Row, benchmark
from isomortar.program.getfem import DEBIAN_PYTHON, has_module
from isomortar.program.process import run
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.system import LinearSystem, block_product
from isomortar.solve.timing import Ledger

BLOCK = """
format = 1
name = "bulk"

[materials.rubber]
young = 10.0
poisson = 0.3

[bodies.block]
geometry = { kind = "box", lower = [0.0, 0.0, 0.0], upper = [1.0, 1.0, 0.5] }
mesh = { family = "L", order = [1, 1, 1], elements = [1, 1, 1] }

[supports.top]
face = "block.w1"

[[stages]]
name = "rest"
steps = 1
"""
#: The deformation and the direction in which the tangent is compared: coefficients of `multilinear`.
STATE, DIRECTION = 0.1 * np.random.default_rng(3).uniform(-1.0, 1.0, (2, 3, 7))
#: Kinds and elements along each edge: as many nodes whatever the order, and splines on the elements of the nodal functions.
MESHES = {"L1": (24, 24, 12), "L2": (12, 12, 6), "N2": (12, 12, 6), "L3": (8, 8, 4), "N3": (8, 8, 4)}
#: Other programs: interpreter, module, script, kinds, and how to get them.
PEERS = {
    "GetFEM": (DEBIAN_PYTHON, "getfem", "bulk_getfem", "L", "apt-get install python3-getfem"),
    "NGSolve": (peers_python(), "ngsolve", "bulk_ngsolve", "L", "bash verification/performance/peers/install.sh"),
    "nutils": (peers_python(), "nutils", "bulk_nutils", "LN", "bash verification/performance/peers/install.sh"),
}


def block_of(kind: str, elements: tuple[int, int, int]) -> Scene:
    """The block in the discretisation of a kind."""
    mesh = {"family": f'"{kind[0]}"', "order": [int(kind[1])] * 3, "elements": list(elements)}
    return Scene.from_toml(BLOCK, overrides=[f"bodies.block.mesh.{key}={value}" for key, value in mesh.items()])


def isomortar_answer(equilibrium: Equilibrium) -> dict[str, Any]:
    """Forces and tangent, then the factors of the free unknowns' system and Newton's correction."""
    solid, free, reference = equilibrium.solid, equilibrium.supports.free, equilibrium.numbering.reference
    positions, direction = reference + multilinear(STATE, reference), multilinear(DIRECTION, reference)
    # Copies: the tangent of positions that are the very same is kept, not assembled.
    assembly = seconds(lambda: solid.forces_and_tangent(positions.copy()))
    forces, tangent = solid.forces_and_tangent(positions)
    start = process_time()
    system = LinearSystem(len(free), [equilibrium.solid_source], equilibrium.ledger)
    ordering = process_time() - start
    correction = np.zeros_like(forces)

    def solve() -> None:
        system.factorise([tangent])
        correction.ravel()[free] = system.solve(forces.ravel()[free])

    spent = seconds(solve)
    vectors = {
        "forces": forces,
        "action": block_product(solid.pattern, tangent, direction),
        "correction": correction,
    }
    return {"ordering": ordering, **answer(assembly, spent, direction, vectors, reference)}


def difference(found: Mapping[str, Any], own: Mapping[str, Any], kind: str) -> float:
    """Largest difference of a program's numbers from isomortar's, relative; with linear elements also of what it has at the nodes."""
    apart = [abs(found["numbers"][name] / own["numbers"][name] - 1.0) for name in own["numbers"]]
    for name in own["nodes"] if kind == "L1" else ():
        ours = np.asarray(own["nodes"][name])
        apart.append(float(np.abs(np.asarray(found["nodes"][name]) - ours).max() / np.abs(ours).max()))
    return max(apart)


def peer_row(program: str, problem: Mapping[str, Any], own: Mapping[str, Any], kind: str) -> Row:
    """Another program's times, in a process of its own."""
    python, module, script, _, install = PEERS[program]
    if not has_module(python, module):
        return {"note": f"not installed: {install}"}
    finished = run([python, "-m", f"performance.peers.{script}"], json.dumps(problem), folder=Path(__file__).parents[1])
    if finished.end.status != 0:
        return {"note": finished.last_words}
    found = json.loads(finished.output.splitlines()[-1])
    return {"assembly": found["assembly"], "ordering": "in solve", "solve": found["solve"], "difference": difference(found, own, kind)}


@benchmark(
    question="What does a Newton iteration of a solid cost in isomortar, GetFEM, NGSolve and nutils?",
    columns={"kind": "", "elements": "", "program": "", "unknowns": "", "assembly": "s", "ordering": "s", "solve": "s", "difference": ""},
    limits={"difference": (1e-10, "the same work: round-off of sums and of a solution, times the condition of the matrix")},
)
def bulk(quick: bool) -> Iterator[Row]:
    """A hyperelastic block without contact, held at its top and deformed smoothly; CPU seconds with one thread.

    Assembly is that of forces and tangent, solve the factors and Newton's correction. All have the same strain energy, elements, Gauss
    points, and space of functions, in the basis of each. isomortar orders the unknowns once for all iterations; the others do it in every
    solve: GetFEM in MUMPS, NGSolve (on half of the matrix) and nutils in MKL Pardiso where they find it. All but isomortar derive forces
    and tangent from the energy by themselves.

    The difference is the largest from isomortar's numbers, relative: work and second variation in the direction of a smooth field,
    and the work of Newton's correction; with linear elements also forces, product of the tangent, and correction, at all nodes.
    """
    for kind, elements in {"L1": (2, 2, 2), "L2": (2, 2, 1), "N2": (2, 2, 2)}.items() if quick else MESHES.items():
        block = block_of(kind, elements)
        equilibrium = Equilibrium(block.problem(), Ledger())
        body = block.problem().bodies[0]
        problem = {
            "upper": body.patch.control_points.max(axis=0).tolist(),
            "elements": elements,
            "order": int(kind[1]),
            "smooth": kind[0] == "N",
            "points": body.quadrature[0],
            "bulk": body.material.bulk,
            "shear": body.material.shear,
            "state": STATE.tolist(),
            "direction": DIRECTION.tolist(),
        }
        head: Row = {"kind": kind, "elements": "x".join(map(str, elements))}
        free = len(equilibrium.supports.free)
        own = isomortar_answer(equilibrium)
        row = {name: own[name] for name in ("assembly", "ordering", "solve")}
        yield {**head, "program": "isomortar", "unknowns": free, **row, "difference": ASIDE}
        for program, (_, _, _, kinds, _) in PEERS.items():
            if kind[0] in kinds:
                yield {**head, "program": program, "unknowns": free, **peer_row(program, problem, own, kind)}
