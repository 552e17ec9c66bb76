"""Rigid bodies as masters, beside supports that hold every control point, rigid planes, slaves moved the other way, and stiff bodies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike
from slopes import fall
from small_scenes import TIGHT

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, Curve, case
from isomortar.harness.cases import Tier
from isomortar.harness.tangents import BOUND, PARTS, SYMMETRY_BOUND, measure
from isomortar.harness.visits import visited_states
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Face, Motion, Problem, Stage
from isomortar.model.numbering import Numbering
from isomortar.model.plates import rotation
from isomortar.model.supports import Supports
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: A bowl on a warped block of one bilinear element: two faces have all of its control points. It is pressed, then dragged and turned.
_BOWL = """
format = 1
[bodies.slave]
geometry = { kind = "bowl", centre = [0.05, 0.02], half_width = 0.375, bottom = 0, rise = 0.06, top = 0.5 }
mesh = { order = [2, 2, 1], elements = [4, 4, 1] }
[bodies.master.patch]
order = 1
knots = [[0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0]]
control_points = [[-0.6, -0.6, -0.5], [0.7, -0.6, -0.5], [-0.6, 0.65, -0.5], [0.7, 0.65, -0.5],
  [-0.6, -0.6, 0.02], [0.7, -0.6, -0.02], [-0.6, 0.65, -0.02], [0.7, 0.65, 0.03]]
[contacts.interface]
slave = "slave.w0"
master = "master.w1"
friction = 0.6
quadrature = [4, 4]
[supports.top]
face = "slave.w1"
[supports.floor]
face = "master.w0"
centre = [0.1, 0.2, -0.3]
axis = [0.1, 0.2, 1.0]
[[stages]]
name = "press"
steps = 1
motions.floor.translate = [0, 0, 0.1]
[[stages]]
name = "turn"
steps = 1
motions.floor = { translate = [-0.01, 0, 0], rotate = -6 }
"""
#: On what is flat: the bowl, a quarter of a block that is held on its planes of symmetry, and a block that is dragged by its sides.
_FLAT = {
    "bowl": """
        format = 1
        bodies.slave.geometry = { kind = "bowl", centre = [0.05, 0.02], half_width = 0.375, bottom = 0, rise = 0.06, top = 0.5 }
        bodies.slave.mesh = { order = [2, 2, 1], elements = [4, 4, 1] }
        contacts.interface = { slave = "slave.w0", plane = {}, friction = 0.6, quadrature = [4, 4] }
        supports.top = { face = "slave.w1" }
        stages = [{ name = "press", steps = 2, motions.top = { translate = [0.005, 0, -0.1], rotate = 2 } }]
    """,
    "quarter": """
        format = 1
        bodies.slave.geometry = { kind = "box", lower = [0, 0, 0], upper = [0.5, 0.4, 0.4] }
        bodies.slave.mesh = { order = [2, 2, 1], elements = [3, 2, 1] }
        contacts.interface = { slave = "slave.w0", plane = {}, friction = 0.6, quadrature = [4, 4] }
        supports.x = { face = "slave.u0", components = ["x"] }
        supports.y = { face = "slave.v0", components = ["y"] }
        supports.top = { face = "slave.w1", components = ["z"] }
        stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.04] }]
    """,
    "dragged": """
        format = 1
        bodies.slave.geometry = { kind = "box", lower = [0, 0, 0], upper = [0.5, 0.4, 0.4] }
        bodies.slave.mesh = { order = [2, 2, 1], elements = [3, 2, 1] }
        contacts.interface = { slave = "slave.w0", plane = {}, friction = 1.5, quadrature = [4, 4] }
        supports.left = { face = "slave.u0", components = ["x"] }
        supports.right = { face = "slave.u1", components = ["x"] }
        supports.top = { face = "slave.w1", components = ["y", "z"] }
        [[stages]]
        name = "press"
        steps = 1
        motions.top.translate = [0, 0, -0.02]
        [[stages]]
        name = "drag"
        steps = 1
        motions.left.translate = [0.05, 0, 0]
        motions.right.translate = [0.05, 0, 0]
    """,
}
#: A box of bilinear elements in place of a plane at height zero.
_BOX = """
[bodies.master]
rigid = true
geometry = { kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.7, 0.65, 0] }
mesh = { order = 1, elements = [3, 2, 1] }
"""
SOFTLY = {"augmentation_tolerance": 1e-7, "max_augmentations": 400}
_ROUND_OFF = "round-off: products of double precision against differences of a twin in extended precision"
RIGID = "bodies.master.rigid=true"
#: Meshes, by the side that is rigid: a slave's elements are larger than those of a master that gives way.
MESHES = {
    "master": (),
    "slave": ("bodies.slave.mesh.elements=[2,2,1]", "bodies.master.mesh.order=2", "bodies.master.mesh.elements=[4,4,1]"),
}
#: How the master of the bowl goes, in stages: its slave goes there the other way.
MOTIONS = {
    "pressed": (Motion((0.0, 0.0, 0.1)),),
    "dragged": (Motion((0.0, 0.0, 0.08)), Motion((-0.04, 0.02, 0.0))),
    "turned": (Motion((0.0, 0.0, 0.08)), Motion(rotate=20.0)),
    "tilted": (Motion(rotate=8.0),),
}
AXES = {"tilted": (0.3, 1.0, 0.0)}
#: Moduli of a stiff master over the slave's.
STIFF = (1e2, 1e4, 1e6)


def _close(method: str, names: tuple[str, ...]) -> dict[str, Bound]:
    """Bounds of distances between two ways to the same solution."""
    if method == "monolithic":
        return {name: Bound(at_most=1e-10, reason="round-off: residuals and conditions are met to 1e-11 of them") for name in names}
    return {
        name: Bound(at_most=1e-6, reason="theory: augmentations end at relative changes of 1e-7 that halve each time") for name in names
    }


def tight(text: str, method: str, *changes: str) -> Problem:
    """The problem of a scene at tight tolerances."""
    problem = Scene.from_toml(text, overrides=[f"solver.method={method}", *changes]).problem()
    settings = {**TIGHT, **(SOFTLY if method == "uzawa" else {})}
    return replace(problem, settings=replace(problem.settings, **settings))  # type: ignore[arg-type]


def bowl(method: str, projection: str, *changes: str) -> Problem:
    """The bowl on the block."""
    return tight(_BOWL, method, f"contacts.interface.projection={projection}", *changes)


def solved(problem: Problem) -> list[StepResult]:
    """All load steps."""
    return list(Simulation(problem).run())


def apart(ones: ArrayLike, others: ArrayLike) -> float:
    """Largest distance over the largest entry of the others."""
    return float(np.abs(np.array(ones) - np.array(others)).max() / np.abs(others).max())


def pressures(results: list[StepResult]) -> list[FloatArray]:
    """Control pressures of all load steps."""
    return [result.state.contacts[0].pressure for result in results]


def mixed(results: list[StepResult]) -> float:
    """Load steps in which points stick and slip at once."""
    return float(sum(0 < result.contacts[0].slip < result.contacts[0].active for result in results))


def tier(side: str, method: str, projection: str) -> Tier:
    """The gate has half of the products: every two settings in every choice."""
    others = (side == "slave", method == "uzawa", projection == "averaged")
    return "nightly" if sum(others) % 2 else "gate"


@case(
    claim="A rigid body, master or slave, is one whose control points are all held by supports: pressed, dragged and turned.",
    tier=tier,
    grid={"side": tuple(MESHES), "method": ("monolithic", "uzawa"), "projection": ("closest", "averaged")},
    bounds=lambda side, method, projection: {  # noqa: ARG005
        **_close(method, ("positions", "soft", "rigid", "pressures")),
        "mixed": Bound(at_least=1.0, reason="definition: points stick and slip at once in some load step"),
        "unknowns": Bound(at_least=0.0, at_most=0.0, reason="definition: of a rigid body none are left"),
    },
)
def as_held(side: str, method: str, projection: str) -> dict[str, float]:
    """Distances of positions, of support forces and moments on both bodies, of pressures; free components of the rigid body."""
    rigid, free = (bowl(method, projection, *MESHES[side], *changes) for changes in ((f"bodies.{side}.rigid=true",), ()))
    soft, own = (0, 1) if side == "master" else (1, 0)
    facing = rigid.contacts[0].master if side == "master" else rigid.contacts[0].slave
    assert isinstance(facing, Face)
    ours = solved(rigid)
    others = solved(replace(free, supports=(*free.supports, replace(free.supports[own], name="facing", place=facing))))
    borne, theirs = (np.array([[[a.force, a.moment] for a in r.reactions] for r in results]) for results in (ours, others))
    numbering = Numbering(rigid)
    return {
        "positions": apart([r.state.positions for r in ours], [r.state.positions for r in others]),
        "soft": apart(borne[:, soft], theirs[:, soft]),
        "rigid": apart(borne[:, own], theirs[:, own] + theirs[:, 2]),
        "pressures": apart(pressures(ours), pressures(others)),
        "mixed": mixed(ours),
        "unknowns": float(np.count_nonzero(~Supports(rigid, numbering).held[numbering.points[side]])),
    }


@case(
    claim="A rigid box is a rigid plane, whatever its elements, also where supports hold or drag control points of the contact.",
    tier="gate",
    grid={"scene": tuple(_FLAT), "method": ("monolithic", "uzawa")},
    bounds=lambda scene, method: {  # noqa: ARG005
        **_close(method, ("positions", "forces", "pressures", "tractions")),
        "sticks": Bound(at_least=1.0, reason="definition: points stick in some load step"),
        "slips": Bound(at_least=1.0, reason="definition: points slip in some load step"),
    },
)
def as_plane(scene: str, method: str) -> dict[str, float]:
    """Distances of the slave's positions, support forces, pressures and norms of tractions; load steps with stick and with slip."""
    text = _FLAT[scene]
    ours, others = solved(tight(text.replace("plane = {}", 'master = "master.w1"') + _BOX, method)), solved(tight(text, method))
    n = len(others[0].state.positions)
    return {
        "positions": apart([r.state.positions[:n] for r in ours], [r.state.positions for r in others]),
        "forces": apart([a.force for r in ours for a in r.reactions], [a.force for r in others for a in r.reactions]),
        "pressures": apart(pressures(ours), pressures(others)),
        "tractions": apart([r.contacts[0].traction_norm for r in ours], [r.contacts[0].traction_norm for r in others]),
        "sticks": float(sum(r.contacts[0].slip < r.contacts[0].active for r in ours)),
        "slips": float(sum(r.contacts[0].slip > 0 for r in ours)),
    }


@case(
    claim="A box that is turned about, no edge of which is in a plane of symmetry, presses a quarter of a block as a plane does.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={
        "force": Bound(at_most=2e-3, reason="discretisation: tractions across planes of symmetry are zero but for slips beside them"),
        "mixed": Bound(at_least=1.0, reason="definition: points stick and slip at once in some load step"),
        "cuts": Bound(at_most=0.0, reason="definition: what is held repeats no condition"),
    },
)
def turned_about(method: str) -> dict[str, float]:
    """Relative distance of the pressing force from that on the plane, load steps with stick and slip, cuts."""
    text = _FLAT["quarter"]
    boxed = tight(text.replace("plane = {}", 'master = "master.w1"') + _BOX, method)
    slave, box = boxed.bodies
    patch = replace(box.patch, control_points=box.patch.control_points @ rotation(np.array([0.0, 0.0, 1.0]), 0.5).T)
    ours, others = solved(replace(boxed, bodies=(slave, replace(box, patch=patch)))), solved(tight(text, method))
    top = [s.name for s in boxed.supports].index("top")
    return {
        "force": apart([r.reactions[top].force for r in ours], [r.reactions[top].force for r in others]),
        "mixed": mixed(ours),
        "cuts": float(sum(r.cuts for r in ours)),
    }


@case(
    claim="A master that moves presses as one that stands still, against which the slave moves the other way.",
    tier=lambda motion, projection: "gate" if (tuple(MOTIONS).index(motion) + (projection == "averaged")) % 2 else "nightly",
    grid={"motion": tuple(MOTIONS), "projection": ("closest", "averaged")},
    bounds={
        **_close("monolithic", ("positions", "forces", "pressures")),
        "balance": Bound(at_most=1e-9, reason="theory: the support of a rigid body bears the contact's force and moment"),
    },
)
def moved(motion: str, projection: str) -> dict[str, float]:
    """Distances of positions, forces, pressures, seen from the master; force and moment of its support against those of the contact."""
    moving = going(bowl("monolithic", projection, RIGID), "floor", motion, 1.0)
    standing = going(moving, "top", motion, -1.0)
    ours, others = solved(moving), solved(standing)
    (result,), (other,) = ours[-1:], others[-1:]
    supports, centre = moving.supports[1], result.reactions[1].centre
    turn = rotation(np.array(supports.axis) / np.linalg.norm(supports.axis), np.radians(sum(m.rotate for m in MOTIONS[motion])))
    n = len(moving.bodies[0].patch.weights)
    contact = result.contacts[0]
    borne = np.array([contact.force_master, contact.moment_master - np.cross(centre, contact.force_master)])
    return {
        "positions": apart((result.state.positions[:n] - centre) @ turn + supports.centre, other.state.positions[:n]),
        "forces": apart(result.reactions[0].force @ turn, other.reactions[0].force),
        "pressures": apart(pressures(ours), pressures(others)),
        "balance": apart([result.reactions[1].force, result.reactions[1].moment], -borne),
    }


def going(problem: Problem, name: str, motion: str, way: float) -> Problem:
    """The problem in which one support alone moves, one way or the other; both have the same centre and axis."""
    floor = problem.supports[1]
    motions = tuple(Motion(tuple(way * np.array(m.translate)), way * m.rotate) for m in MOTIONS[motion])
    still = tuple(Motion() for _ in motions)
    return replace(
        problem,
        supports=tuple(
            replace(s, motions=motions if s.name == name else still, centre=floor.centre, axis=AXES.get(motion, (0.0, 0.0, 1.0)))
            for s in problem.supports
        ),
        stages=tuple(Stage(f"stage {k}", 2) for k in range(len(motions))),
    )


@case(
    claim="A stiff master comes to a rigid one at first order in its compliance.",
    tier="gate",
    bounds={
        "curve": Bound(at_most=1.0, reason="theory: of two bodies of like shape the compliance of one is lacking"),
        "last": Bound(at_most=1e-5, reason="theory: the error goes with the ratio of moduli, 1e-6, times one of lengths"),
        "order": Bound(at_least=0.97, at_most=1.03, reason="theory: first order, once the compliance is small"),
        "low": Bound(at_least=0.9, reason="definition: the 95 % interval"),
        "high": Bound(at_most=1.1, reason="definition: the 95 % interval"),
    },
)
def stiff() -> dict[str, object]:
    """Relative distance of the slave's forces from those on the rigid master, by the ratio of moduli; the last; order with interval."""
    mesh = ("bodies.master.mesh.order=2", "bodies.master.mesh.elements=[2,2,1]", "contacts.interface.projection=closest")
    rigid = np.array([r.reactions[0].force for r in solved(tight(_BOWL, "monolithic", RIGID, *mesh))])
    errors = []
    for ratio in STIFF:
        problem = tight(_BOWL, "monolithic", *mesh)
        soft, stiff = problem.bodies
        bodies = (soft, replace(stiff, material=replace(stiff.material, young=ratio * soft.material.young)))
        errors.append(apart([r.reactions[0].force for r in solved(replace(problem, bodies=bodies))], rigid))
    return {
        "curve": Curve(STIFF, errors, "ratio of moduli", "relative distance of forces", log_x=True),
        "last": errors[-1],
        **fall(STIFF, errors),
    }


@case(
    claim="The tangent is exact on rigid masters, in every part.",
    tier="gate",
    grid={"projection": ("closest", "averaged")},
    bounds=lambda projection: {
        part: Bound(at_most=SYMMETRY_BOUND if part == "symmetry" else BOUND, reason=_ROUND_OFF)
        for part in PARTS
        if projection == "closest" or part not in ("symmetry", "tangential, projection")
    },
)
def tangent(projection: str) -> dict[str, float]:
    """Relative error of each part where the bowl sticks and slips on the rigid block."""
    problem = bowl("monolithic", projection, RIGID)
    report = measure(problem, 2, visited_states(problem, 2)[-1:], directions=1)
    return {row.part: row.error for row in report.rows}
