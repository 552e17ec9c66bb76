"""Slip and friction as vectors in space, of results: on flat masters against motions and forces that are known without them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import BSpline

from isomortar._bindings import SlaveArrays
from isomortar.geometry.patch import Direction, FloatArray, IntArray, Patch
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.results.vectors import contact_vectors
from isomortar.scene import Scene

#: A block is pressed, turned a little and dragged; what it slides on goes another way, and its coordinates are oblique.
_BLOCK = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.8, 0.5] }
bodies.block.mesh = { order = [2, 2, 1], elements = [3, 2, 1] }
supports.top.face = "block.w1"
"""
_DRAG = "motions.top = { translate = [0.15, 0.1, 0], rotate = 4 }"
_PLANE = f"""
contacts.pair = {{ slave = "block.w0", plane = {{ tangent = [0.8, 0.6, 0] }}, friction = 0.3 }}
stages = [
  {{ name = "press", steps = 1, motions.top.translate = [0.06, -0.04, -0.03] }},
  {{ name = "drag", steps = 1, {_DRAG} }},
]
"""
_BASE = """
bodies.base.geometry = { kind = "box", lower = [-0.5, -0.6, -0.4], upper = [1.6, 1.7, 0] }
bodies.base.mesh = { order = [1, 1, 1], elements = [1, 1, 1] }
supports.ground.face = "base.w0"
contacts.pair = { slave = "block.w0", master = "base.w1", friction = 0.3, projection = "PROJECTION" }
"""
_BASE_GOES = f"""
bodies.base.rigid = true
stages = [
  {{ name = "press", steps = 1, motions.top.translate = [0.06, -0.04, -0.03] }},
  {{ name = "drag", steps = 1, {_DRAG}, motions.ground.translate = [-0.1, 0.05, 0] }},
]
"""
#: Averaged normals and the slave's tangents are those of a plane where the slave is stiff.
_STIFF = f"""
materials.stiff.young = 1e7
materials.soft.young = 10
bodies.block.material = "stiff"
bodies.base.material = "soft"
stages = [
  {{ name = "press", steps = 1, motions.top.translate = [0.06, -0.04, -0.01] }},
  {{ name = "drag", steps = 1, {_DRAG} }},
]
"""
SCENES = {
    "plane": _BLOCK + _PLANE,
    "closest": _BLOCK + _BASE.replace("PROJECTION", "closest") + _BASE_GOES,
    "averaged": _BLOCK + _BASE.replace("PROJECTION", "averaged") + _STIFF,
}
#: How far a master goes in each load step.
_GOES = {"plane": np.zeros((2, 2)), "closest": np.array([[0.0, 0.0], [-0.1, 0.05]])}
_ROUND_OFF = "round-off: on a flat master integrals are those of polynomials"


def products(direction: Direction) -> FloatArray:
    """Integrals of the products of two functions of a direction by its parameter, as SciPy has its B-splines."""
    line, weight = np.polynomial.legendre.leggauss(direction.order + 1)
    half = 0.5 * np.diff(direction.boundaries)[:, None]
    places = direction.boundaries[:-1, None] + half * (1.0 + line)
    values = BSpline.design_matrix(places.ravel(), direction.knots, direction.order).toarray()
    return values.T @ ((half * weight).ravel()[:, None] * values)


def shares(patch: Patch) -> FloatArray:
    """The same over the area of the face w0 of a block, shape (n, n)."""
    u, v = (products(direction) / direction.knots[-1] for direction in patch.face_directions("w0"))
    return np.kron(v, u) * np.prod(np.ptp(patch.control_points, axis=0)[:2])


@case(
    claim="Slip and traction vectors are the way of the slave on its master, and friction: it opposes the way, and adds up to the force.",
    tier="gate",
    grid={"master": list(SCENES)},
    bounds=lambda master: {
        **({} if master == "averaged" else {"slip": Bound(at_most=1e-12, reason="theory: displacements, averaged; " + _ROUND_OFF)}),
        "force": Bound(
            at_most=1e-4 if master == "averaged" else 1e-11,
            reason="theory: the slave, a million times as stiff as the master, stays flat" if master == "averaged" else _ROUND_OFF,
        ),
        "opposed": Bound(at_most=1e-12, reason="theory: Coulomb's friction opposes the way; round-off"),
        "slipping": Bound(at_least=6.0, reason="definition: vectors are told only where something slides"),
        "unknown": Bound(at_least=1.0, reason="definition: not a number where the load step before is not kept, and something acts"),
    },
)
def vectors(master: str) -> dict[str, float]:
    """Largest errors over two load steps, the first of which begins at rest; points that slip; whether slips are known without the first.

    Of slips over the longest one, of friction in sum over itself; what its work lacks to the most there can be.
    """
    problem = Scene.from_toml(SCENES[master]).problem()
    simulation = Simulation(problem)
    results = list(simulation.run())
    patch, numbering = problem.body("block").patch, simulation.equilibrium.numbering
    face, matrix = numbering.points["block"][patch.face_points("w0")], shares(patch)
    areas, begun = matrix.sum(axis=1), numbering.reference
    errors: dict[str, list[float]] = {name: [] for name in ("force", "opposed", *(("slip",) if master in _GOES else ()))}
    for number, result in enumerate(results):
        (found,) = contact_vectors(problem, result, results[number - 1] if number else None)
        contact, now = result.contacts[0], result.state.positions
        force, sliding, acts = contact.force_slave[:2], contact.status == 2, contact.status > 0
        errors["force"].append(float(np.linalg.norm(areas @ found.traction[:, :2] - force) / np.linalg.norm(force)))
        slip, traction = found.slip[sliding], found.traction[sliding]
        most = np.linalg.norm(slip, axis=1) @ np.linalg.norm(traction, axis=1)
        errors["opposed"].append(float(abs(1.0 + np.sum(slip * traction) / most)))
        if master in _GOES:
            way = np.zeros_like(found.slip)
            way[acts, :2] = (matrix @ (now - begun)[face, :2] / areas[:, None] - _GOES[master][number])[acts]
            errors["slip"].append(float(np.abs(found.slip - way).max() / np.abs(way).max()))
        begun = now
    (alone,) = contact_vectors(problem, results[-1], None)
    return {
        **{name: float(np.max(numbers)) for name, numbers in errors.items()},
        "slipping": float(np.min([result.contacts[0].slip for result in results])),
        "unknown": float(np.isnan(alone.slip[results[-1].contacts[0].status > 0]).all()),
    }


@case(
    claim="What sticks has friction as well, which adds up to the force, and does not slip.",
    tier="gate",
    bounds={
        "force": Bound(at_most=1e-11, reason=_ROUND_OFF),
        "slip": Bound(at_most=1e-12, reason="round-off: constraints that hold, over the way of the support"),
        "sticking": Bound(at_least=8.0, reason="definition: two fifths of the control points, at the end of both load steps"),
    },
)
def sticking() -> dict[str, float]:
    """Largest errors of the block on the plane with friction that nothing overcomes."""
    little = ("press.motions.top.translate=[0.006,-0.004,-0.03]", "drag.motions.top={translate=[0.004,0.003,0],rotate=0.5}")
    overrides = ["contacts.pair.friction=2", *(f"stages.{motion}" for motion in little)]
    problem = Scene.from_toml(SCENES["plane"], overrides=overrides).problem()
    results = list(Simulation(problem).run())
    patch = problem.body("block").patch
    areas = shares(patch).sum(axis=1)
    forces, slips = [], []
    for number, result in enumerate(results):
        (found,) = contact_vectors(problem, result, results[number - 1] if number else None)
        sticks, force = result.contacts[0].status == 1, result.contacts[0].force_slave[:2]
        forces.append(np.linalg.norm(areas @ found.traction[:, :2] - force) / np.linalg.norm(force))
        slips.append(np.abs(found.slip[sticks]).max() / 0.005)
    counts = [np.count_nonzero(result.contacts[0].status == 1) for result in results]
    return {"force": float(np.max(forces)), "slip": float(np.max(slips)), "sticking": float(np.min(counts))}


#: The same block, a part of which is beyond the edge of what is below it.
_OVER_AN_EDGE = {name: SCENES[name].replace("upper = [1.6, 1.7, 0]", "upper = [0.6, 1.7, 0]") for name in ("closest", "averaged")}


@case(
    claim="The slip of a part of a face that comes onto its master, or leaves it, is that of the points that are on it before and after.",
    tier="gate",
    grid={"master": list(_OVER_AN_EDGE), "way": (0.3, -0.3)},
    bounds={
        "slip": Bound(at_most=1e-12, reason=_ROUND_OFF),
        "some": Bound(at_least=3.0, reason="definition: constraints of which some points have a foot at one of the two ends alone"),
        "all off": Bound(at_least=3.0, reason="definition: constraints without a point that has a foot at both ends"),
    },
)
def over_an_edge(master: str, way: float) -> dict[str, float]:
    """Largest error over the way, of a block that goes rigidly; how many constraints are in part, and how many in no part, on it."""
    problem = Scene.from_toml(_OVER_AN_EDGE[master]).problem()
    numbering = Numbering(problem)
    slave, result = Pair(problem.contacts[0], problem, numbering).slave, next(Simulation(problem).run())
    nodes = np.repeat(slave.shape.nodes, slave.per_element, axis=0)
    begins = np.einsum("qa,qac->qc", slave.shape.values, numbering.reference[slave.point[nodes]])
    goes, own = np.array([way, 0.1, 0.0]), numbering.own["block"]
    low, high = (problem.body("base").patch.control_points[k, :2] for k in (0, -1))
    states, found = [], []
    for step in (1, 2):
        positions = numbering.reference.copy()
        positions[own] += goes * (step - 1)
        places = (begins + goes * (step - 1))[:, :2]
        found.append((places[:, 0] < high[0]).astype(np.int32))
        feet = np.where(found[-1][:, None] > 0, (places - low) / (high - low), 0.0)
        contact = replace(result.state.contacts[0], projection=feet, projected=found[-1])
        acts = replace(result.contacts[0], status=np.ones_like(result.contacts[0].status))
        states.append(replace(result, step=step, state=replace(result.state, positions=positions, contacts=(contact,)), contacts=(acts,)))
    shares = [_touched(nodes, slave, mark) for mark in (found[0] * found[1], found[0] + found[1])]
    known = shares[0] > 0.0
    (vectors,) = contact_vectors(problem, states[1], states[0])
    error = np.abs(vectors.slip - known[:, None] * goes).max() / np.abs(goes).max()
    return {
        "slip": float(error),
        "some": float(np.count_nonzero(known & (shares[1] > shares[0] * (1.0 + 1e-9)))),
        "all off": float(np.count_nonzero(~known)),
    }


def _touched(nodes: IntArray, slave: SlaveArrays, marks: IntArray) -> FloatArray:
    """Area times functions of a slave at the points that are marked, by control point."""
    weights = slave.test.values * (slave.area * (marks > 0))[:, None]
    return np.asarray(np.bincount(nodes.ravel(), weights.ravel(), minlength=slave.test.count), dtype=np.float64)
