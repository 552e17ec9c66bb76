"""Control quantities of a slave that reaches over its master's edge: what is off the master counts for nothing, and has no past."""

from __future__ import annotations

import numpy as np
from friction.virtual_work import Surface, areas, on_surface

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: A square slave of 4 x 4 elements, two columns of which lie over a flat master whose parameters are lengths over 1 and 1.5.
_SCENE = """
format = 1
bodies.slave = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = [2, 3, 1], elements = [4, 4, 1] } }
bodies.master = { geometry = { kind = "box", lower = [-0.5, -0.25, -1], upper = [0.5, 1.25, 0] } }
contacts.interface = { slave = "slave.w0", master = "master.w1", friction = 0.5 }
supports.top.face = "slave.w1"
supports.floor.face = "master.w0"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.1] }]
"""
#: Metric of the master: 11, 12, 22.
METRIC = np.array([1.0, 0.0, 2.25])
#: The slave moves by one element: a third column comes over the master.
STEP = -0.25
_ROUND_OFF = "round-off: sums over some hundred quadrature points; element boundaries lie on the master's edge, so nothing else is left"


@case(
    claim="Points off the master take no part in any control quantity, and one that comes over the master has not slipped.",
    tier="gate",
    bounds={name: Bound(at_most=1e-13, reason=_ROUND_OFF) for name in ("weight", "metric", "new weight", "slip", "new slip")},
)
def edge() -> dict[str, float]:
    """Errors of the area met before and after the motion, of the metric, of the slip's integral, and the slip of new points."""
    equilibrium = Equilibrium(Scene.from_toml(_SCENE).problem(), Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    before = pair.kinematics(state.positions, state.contacts[0])
    positions = state.positions.copy()
    positions[pair.pair.slave.point, 0] += STEP
    after = pair.kinematics(positions, state.contacts[0])
    met = before.control.square > 0
    ratio = before.control.metric[met] / before.control.square[met, None]
    new = (after.projections.found == 1) & (before.projections.found == 0)
    return {
        "weight": abs(before.control.weight.sum() - 0.5),
        "new weight": abs(after.control.weight.sum() - 0.75),
        "metric": float(np.abs(ratio - METRIC).max()),
        "slip": float(np.abs(after.control.slip.sum(axis=0) - [0.5 * STEP, 0.0]).max()),
        "new slip": float(np.abs(after.projections.slip[new]).max()),
    }


@case(
    claim="Control points all of whose quadrature points have left the master have no weight, others have one, however feet are found.",
    grid={"projection": ("closest", "averaged")},
    bounds={
        "kept": Bound(0.0, 0.0, "definition: weights of control points without a foot"),
        "lost": Bound(0.0, 0.0, "definition: control points with a foot that have no weight"),
        "left": Bound(at_least=1.0, reason="definition: or nothing has left"),
    },
)
def left_behind(projection: str) -> dict[str, float]:
    """Largest such weight, and numbers of control points, of the square as it is."""
    equilibrium = Equilibrium(Scene.from_toml(_SCENE, overrides=[f"contacts.interface.projection={projection}"]).problem(), Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    kinematics, slave = pair.kinematics(state.positions, state.contacts[0]), pair.pair.slave
    nodes = np.repeat(slave.test.nodes, slave.per_element, axis=0)
    over = np.zeros(slave.test.count, dtype=bool)
    over[nodes[(slave.test.values > 0.0) & (kinematics.projections.found == 1)[:, None]]] = True
    weight = kinematics.control.weight
    return {
        "kept": float(np.abs(weight[~over]).max()),
        "lost": float(np.count_nonzero(weight[over] <= 0.0)),
        "left": float(np.count_nonzero(~over)),
    }


#: A bowl pressed near the corner of its master, then moved over the corner and off.
_CORNER = """
format = 1
bodies.slave.geometry = { kind = "bowl", half_width = 0.3, bottom = 0.0, rise = 0.05, top = 0.4 }
bodies.slave.mesh = { order = [2, 2, 1], elements = [4, 4, 1] }
bodies.master.geometry = { kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.6, 0.6, 0] }
bodies.master.mesh = { order = [3, 3, 1], elements = [4, 4, 1] }
contacts.interface = { slave = "slave.w0", master = "master.w1", friction = FRICTION }
supports.top.face = "slave.w1"
supports.base.face = "master.w0"
stages = [
    { name = "press", steps = 1, motions.top.translate = [0, 0, -0.03] },
    { name = "slide", steps = 10, motions.top.translate = [1.2, 1.2, 0] },
]
"""


@case(
    claim="A slave that leaves its master over a corner is followed to the last point, and is free of forces then.",
    tier=lambda friction: "gate" if friction else "nightly",
    grid={"friction": (0.0, 0.3)},
    bounds={
        "force": Bound(at_most=1e-8, reason="round-off: Newton's method stops at 1e-9 of the stiffness; nothing is left in contact"),
        "left": Bound(at_least=1.0, at_most=1.0, reason="definition: the last points have left the master"),
        "alone": Bound(at_least=1.0, reason="definition: in some load step most control points are off the master, and some bear"),
    },
)
def over_a_corner(friction: float) -> dict[str, float]:
    """Force at the end over the largest one, share of points off the master, and load steps with a contact on few points."""
    results = list(Simulation(Scene.from_toml(_CORNER.replace("FRICTION", str(friction))).problem()).run())
    forces = [float(np.linalg.norm(result.reactions[0].force)) for result in results]
    points = 16 * 6 * 6
    alone = [result.contacts[0].excluded > points / 2 and result.contacts[0].active > 0 for result in results]
    return {"force": forces[-1] / max(forces), "left": results[-1].contacts[0].excluded / points, "alone": float(sum(alone))}


#: A bowl pressed near the edge of its master, moved half over it and back.
_OUT_AND_BACK = """
format = 1
bodies.slave.geometry = { kind = "bowl", half_width = 0.3, bottom = 0.0, rise = 0.05, top = 0.4 }
bodies.slave.mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
bodies.master.geometry = { kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.4, 0.6, 0] }
bodies.master.mesh = { order = [2, 3, 1], elements = [3, 2, 1] }
contacts.interface = { slave = "slave.w0", master = "master.w1", friction = FRICTION, subcells = 0 }
supports.top.face = "slave.w1"
supports.base.face = "master.w0"
stages = [
    { name = "press", steps = 1, motions.top.translate = [0, 0, -0.05] },
    { name = "out", steps = 2, motions.top.translate = [0.45, 0.1, 0] },
    { name = "back", steps = 2, motions.top.translate = [-0.45, -0.1, 0] },
]
"""


@case(
    claim="A point that leaves its master counts as excluded for as long as it is away and no longer; one that has come back is where its "
    "foot is. Without friction all is then as it was before.",
    tier="gate",
    grid={"friction": (0.0, 0.3)},
    bounds=lambda friction: (
        {
            "excluded": Bound(0.0, 0.0, "definition: points whose foot is beyond the edge, by a search of its own"),
            "remembered": Bound(0.0, 0.0, "definition: the state says of the same points that they have a foot"),
            "foot": Bound(at_most=1e-13, reason="round-off: coordinates of size one, by two searches that stop where nothing moves"),
            "away": Bound(at_least=50.0, reason="definition: points are away, and have all come back at the end"),
            "left": Bound(0.0, 0.0, "definition: at the end no point is away"),
        }
        | (
            {}
            if friction
            else {"change": Bound(at_most=1e-7, reason="theory: no path; Newton's method stops at 1e-9 of the internal forces")}
        )
    ),
)
def out_and_back(friction: float) -> dict[str, float]:
    """Wrong numbers of excluded points, wrong states of points, distance of coordinates from those of the feet.

    Then the most points that were away, those at the end, and what is not as it was before they went.
    """
    problem = Scene.from_toml(_OUT_AND_BACK.replace("FRICTION", str(friction))).problem()
    simulation = Simulation(problem)
    functions, _ = areas(problem)
    numbers, patch = simulation.equilibrium.numbering.points, problem.body("master").patch
    slave, master = (numbers[name][problem.body(name).patch.face_points(face)] for name, face in (("slave", "w0"), ("master", "w1")))
    results, wrong = list(simulation.run()), []
    for result in results:
        (state,), (measured,), x = result.state.contacts, result.contacts, result.state.positions
        feet = on_surface(Surface(patch, "w1"), x[master], functions @ x[slave])
        apart = np.abs(state.projection - feet.xi)[feet.found].max()
        wrong.append([abs(measured.excluded - np.sum(~feet.found)), np.sum((state.projected > 0) != feet.found), apart])
    away = [result.contacts[0].excluded for result in results]
    found = dict(zip(("excluded", "remembered", "foot"), np.max(wrong, axis=0).tolist(), strict=True))
    found |= {"away": float(max(away)), "left": float(away[-1])}
    change = float(np.abs(results[-1].state.positions - results[0].state.positions).max())
    return found if friction else found | {"change": change}
