"""The tangent where feet are beside a pole of the master, and at a pole that is a vertex: exact in every part."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from shapes import dome
from tangents.placed import placed

from isomortar import _bindings
from isomortar.geometry.patch import FloatArray
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.harness.tangents import BOUND, SYMMETRY_BOUND, measure
from isomortar.harness.visits import PairVisit, Visit
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: A block on a body that the dome takes the place of.
_SCENE = """
format = 1
bodies.slave = { geometry = { kind = "box", lower = [-0.1, -0.1, 0.7], upper = [0.1, 0.1, 0.9] }, mesh = { order = [2, 2, 1] } }
bodies.master.geometry = { kind = "box", lower = [-0.7, -0.7, 0.0], upper = [0.7, 0.7, 0.7] }
contacts.interface = { slave = "slave.w0", master = "master.v1", quadrature = 3 }
supports.top.face = "slave.w1"
supports.floor.face = "master.v0"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.05] }]
"""
#: Distance of a foot from the pole as a share of the patch, and the angle round it, beside C0 lines.
OFF, ANGLE = (1e-1, 1e-2, 1e-4, 1e-6, 1e-8), 0.4
EPSILON = float(np.finfo(float).eps)
#: What is done to the positions of the master.
STRETCH = np.array([[1.1, 0.2, 0.0], [0.0, 0.9, 0.1], [0.1, 0.0, 1.05]])
PARTS = ("normal, geometric", "normal, gap", "normal, pressure", "whole")
#: The quadrature point that is put there.
POINT = 4


def problem(raised: float) -> Problem:
    """The block on a dome whose pole is raised to a vertex."""
    boxes = Scene.from_toml(_SCENE).problem()
    patch = mesh(dome(0.4, 0.7, -0.3), ("N", "N", "N"), (2, 1, 2), (3, 1, 8))
    points = patch.control_points.copy()
    points[patch.face_points("u1"), 2] += raised
    master = replace(boxes.body("master"), patch=replace(patch, control_points=points), closed="w", quadrature=(4, 2, 4))
    settings = replace(boxes.settings, method="uzawa")
    return replace(boxes, bodies=(boxes.body("slave"), master), settings=settings)


def placed_over(given: Problem, xi: FloatArray, height: float) -> tuple[Visit, FloatArray]:
    """A state with everything active, and the coordinates of the feet.

    The master is stretched and sheared; a quadrature point of the uneven slave is at a height above the place `xi` of its face.
    """
    equilibrium = Equilibrium(given, Ledger())
    numbering, pair, start = equilibrium.numbering, equilibrium.pairs[0], equilibrium.initial_state().contacts[0]
    positions = numbering.reference @ STRETCH
    master = given.body("master")
    face = numbering.points["master"][master.patch.face_points("v1")]
    nodes, functions = _bindings.surface_functions(numbering.patch_arrays(master), 2, 1, xi[None])
    foot, *tangents = functions[0, :3] @ positions[face[nodes[0]]]
    normal = np.array([0.02, 0.0, 1.0]) @ np.linalg.inv(STRETCH).T if xi[1] == 1.0 else np.cross(*tangents)
    slave, moved = pair.pair.slave, numbering.points["slave"]
    positions[moved] = numbering.reference[moved] + 0.01 * np.random.default_rng(1).standard_normal((len(moved), 3))
    now = slave.shape.values[POINT] @ positions[slave.point[slave.shape.nodes[0]]]
    positions[moved] += foot + height * normal / np.linalg.norm(normal) - now
    n = len(slave.point)
    visit = PairVisit(start, pair.law(np.array([20.0, 10.0]), np.zeros(n), np.zeros((n, 2))))
    visit = placed(pair, positions, visit, np.resize([1.0, 0.7], n), np.zeros(n))
    return Visit(positions, (visit,)), pair.kinematics(positions, start).projections.xi


def bounds(off: float = 1.0, **_: float) -> dict[str, Bound]:
    """A bound for every part: round the pole curvatures are the last bits of positions over the distance from it."""
    reason = "round-off: of the positions over the distance from the pole, against differences of a twin in extended precision"
    return {part: Bound(at_most=BOUND + 16 * EPSILON / off, reason=reason) for part in PARTS} | {
        "symmetry": Bound(at_most=SYMMETRY_BOUND, reason="round-off: without friction the tangent is symmetric"),
        "off": Bound(at_least=0.5, at_most=1.5, reason="definition: there is a foot as near to the pole as is asked for"),
    }


@case(
    claim="Beside a pole of the master the tangent is exact in every part, however near.",
    tier="gate",
    grid={"off": list(OFF), "height": [-0.02, 0.05]},
    bounds=bounds,
)
def beside_a_pole(off: float, height: float) -> dict[str, float]:
    """Largest relative error of each part; distance of the foot from the pole over that asked for."""
    given = problem(0.0)
    visit, feet = placed_over(given, np.array([ANGLE, 1.0 - off]), height)
    report = measure(given, 1, [visit], directions=1, length=min(1.0, 1e-3 * off))
    return {row.part: row.error for row in report.rows if row.part in (*PARTS, "symmetry")} | {"off": float((1 - feet[POINT, 1]) / off)}


@case(
    claim="Where a pole of the master is a vertex, and the foot of a point, the tangent is exact in every part.",
    tier="gate",
    grid={"height": [1e-3, 0.05]},
    bounds=lambda height: bounds() | {"off": Bound(at_most=0.0, reason="definition: the pole is the foot")},  # noqa: ARG005
)
def at_a_vertex(height: float) -> dict[str, float]:
    """Largest relative error of each part; distance of the foot from the pole."""
    given = problem(0.05)
    visit, feet = placed_over(given, np.array([ANGLE, 1.0]), height)
    report = measure(given, 1, [visit], directions=1, length=1e-3 * height)
    return {row.part: row.error for row in report.rows if row.part in (*PARTS, "symmetry")} | {"off": float(1 - feet[POINT, 1])}
