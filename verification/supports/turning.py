"""Supports by a moment: their tangent, and a body that hangs on a hinge, which turns to where its weight points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import TIGHT

from isomortar.errors import ConvergenceError
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.constants import LARGEST_TURN
from isomortar.model.numbering import Numbering
from isomortar.model.supports import Supports
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.system import LinearSystem, add_product, block_product
from isomortar.solve.timing import Ledger
from isomortar.told.during.snapping import Snapping

#: A bar whose ends both turn about axes of their own, one of them while a force moves it as well.
_BAR = """
format = 1
bodies.bar = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 1] }, mesh = { order = 2, elements = [3, 2, 2] } }
supports.one = { face = "bar.u0", moment = 0.2, axis = [0, 1, 0], components = ["x", "z"] }
supports.other = { face = "bar.u1", force = { x = 0.1, z = -0.1 }, moment = -0.1, axis = AXIS, centre = [2.1, 0.4, 0.3] }
supports.side = { face = "bar.v0", components = ["y"] }
stages = [{ name = "bend", steps = 1 }]
"""
_AXES = {"along y": "[0, 1, 0]", "askew": "[1, 2, 3]"}
_EXACT = "round-off: positions are trigonometric polynomials of the angle, of order one, so that differences are exact"


def bar(axis: str) -> Equilibrium:
    """The bar; turned about an axis askew its other end takes the side's component with it."""
    text = _BAR.replace("AXIS", _AXES[axis])
    if axis == "askew":
        text = text.replace('supports.side = { face = "bar.v0", components = ["y"] }\n', "")
    return Equilibrium(Scene.from_toml(text).problem(), Ledger())


def plates_turned(supports: Supports, numbering: Numbering, way: FloatArray) -> FloatArray:
    """Positions in shape where the two plates have turned by some angles, and the second one gone along x and z."""
    found = numbering.reference.copy()
    for plate, angle in zip(supports.plates, way, strict=True):
        found[plate.points] = plate.centre + plate.arms(float(angle))
        for k in plate.pressed:
            found[plate.points, k] += 0.1 * (k + 1)
    return found


@case(
    claim="The tangent of plates that turn is that of all control points seen through their motion, and the bend of that under its forces.",
    tier="gate",
    grid={"axis": tuple(_AXES)},
    bounds={
        "shape": Bound(at_most=1e-14, reason="round-off: turned plates are where they are put in shape again"),
        "first": Bound(at_most=1e-13, reason=_EXACT),
        "second": Bound(at_most=1e-12, reason=_EXACT),
        "work": Bound(at_most=1e-13, reason="theory: virtual work is the same by unknowns and by control points"),
        "matrix": Bound(at_most=1e-12, reason="round-off: sums of products"),
        "product": Bound(at_most=1e-12, reason="round-off: as above"),
    },
)
def tangent(axis: str) -> dict[str, float]:
    """Relative errors: plates off the shape that they are in, slopes and bends of positions by angles, the matrix and a product of it."""
    equilibrium, random = bar(axis), np.random.default_rng(4)
    supports, numbering = equilibrium.supports, equilibrium.numbering
    angles, length = np.array([0.2, -0.3]), np.pi / 3
    here = plates_turned(supports, numbering, angles)
    slopes, bends = supports.slopes(here)
    ahead, behind = (plates_turned(supports, numbering, angles + way * length) for way in (1.0, -1.0))
    of, lengths = supports.copies, np.repeat([p.length for p in supports.plates], [len(p.points) for p in supports.plates])[:, None]
    goes = supports.unknowns[3 * numbering.count :].reshape(-1, 3) >= 0
    first = goes * (ahead - behind)[of] / (2.0 * np.sin(length) * lengths)
    second = goes * (ahead - 2.0 * here + behind)[of] / (2.0 * (1.0 - np.cos(length)) * lengths**2)
    into = np.stack([supports.spread(column, here).ravel() for column in np.eye(len(supports.free))], axis=1)
    forces, step = random.standard_normal((2, *here.shape))
    gathered = supports.gathered(forces, here).ravel()[supports.free]
    values = random.standard_normal((len(equilibrium.solid.pattern.column), 3, 3))
    balance = replace(equilibrium.balance(here, equilibrium.initial_state(), []), total=forces)
    sources, blocks = equilibrium.seen([equilibrium.solid_source], [values], balance)
    system = LinearSystem(len(supports.free), sources, equilibrium.ledger, ordering="amd")
    whole = np.stack([block_product(equilibrium.solid.pattern, values, column).ravel() for column in into.T], axis=1)
    wanted = into.T @ whole
    for plate, bend in zip(supports.plates, np.split(bends * forces[of], [len(supports.plates[0].points)]), strict=True):
        place = int(np.searchsorted(supports.free, plate.slots[-1]))
        wanted[place, place] += bend.sum()
    system.factorise(blocks)
    right = np.zeros(len(supports.free))
    add_product(sources[0], blocks[0], step, right)
    product = into.T @ block_product(equilibrium.solid.pattern, values, step).ravel()
    return {
        "shape": float(np.abs(supports.placed(here, 0.0) - here)[of][goes].max()),
        "first": float(np.abs(slopes - first).max()),
        "second": float(np.abs(bends - second).max()),
        "work": float(np.abs(gathered - into.T @ forces.ravel()).max()),
        "matrix": float(np.abs(system.matrix().toarray() - wanted).max() / np.abs(wanted).max()),
        "product": float(np.abs(right - product).max() / np.abs(product).max()),
    }


#: A bar that hangs on a hinge across its end, held at the other one until it is under tension, then drawn aside.
_PENDULUM = """
format = 1
bodies.bar = { geometry = { kind = "box", lower = [0, -0.5, -0.2], upper = [2, 0.5, 0.2] }, mesh = { order = 2, elements = [3, 1, 2] } }
supports.hinge = { face = "bar.u0", moment = 0, axis = [0, 1, 0] }
supports.tip = { face = "bar.u1", components = ["y", "z"], stages = ["hang"] }
loads.down = { body = "bar", weight = [0.3, 0, 0] }
loads.aside = { body = "bar", weight = [0, 0, 0.4] }
stages = [{ name = "hang", steps = 1, loads.aside = 0 }, { name = "let", steps = 1 }, { name = "swing", steps = 3, loads.aside = 1 }]
"""


@case(
    claim="A body on a hinge turns to where its weight points, as a rigid one does, and the hinge bears that weight and no moment.",
    tier="gate",
    bounds={
        "angle": Bound(at_most=1e-9, reason="theory: hanging along its weight it is its own mirror image; forces are in balance to 1e-12"),
        "force": Bound(at_most=1e-10, reason="theory: forces are in balance to 1e-12 of the internal ones"),
        "moment": Bound(at_most=1e-10, reason="theory: as above"),
        "turned": Bound(at_least=40.0, reason="definition: an angle that is not small"),
    },
)
def pendulum() -> dict[str, float]:
    """Angle in radians off the weight's, after each load step; force of the hinge off the weight, and moment, over it; the last angle."""
    found = Scene.from_toml(_PENDULUM).problem()
    angle, force, moment, turned = [], [], [], 0.0
    for result in Simulation(replace(found, settings=replace(found.settings, **TIGHT))).run():  # type: ignore[arg-type]
        hinge, weight = result.reactions[0], np.sum([load.force for load in result.loads], axis=0)
        turned = hinge.rotation
        angle.append(abs(np.radians(turned) + np.arctan2(weight[2], weight[0])))
        force.append(np.linalg.norm(hinge.force + result.reactions[1].force + weight) / np.linalg.norm(weight))
        moment.append(abs(hinge.moment[1]) / np.linalg.norm(weight))
    return {"angle": float(max(angle)), "force": float(max(force)), "moment": float(max(moment)), "turned": -turned}


#: Half of a rigid die that a force and a moment press, and that is dragged: beside where it stands it could lean on its rim.
_DIE = """
format = 1
symmetry = {{ y = 0.0 }}
bodies.die.geometry = {{ kind = "bowl", half_width = 0.3, bottom = 0, rise = 0.05, top = 0.3 }}
bodies.die.mesh.elements = [2, 2, 1]
bodies.die.rigid = true
bodies.block.geometry = {{ kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.7, 0.6, 0] }}
bodies.block.mesh = {{ family = ["L", "L", "N"], order = 1, elements = [5, 4, 1] }}
contacts.c = {{ slave = "die.w0", master = "block.w1", subcells = 0, elastic_slip = 0.001 }}
supports.base.face = "block.w0"
[supports.die]
face = "die.w1"
force.z = -0.1
moment = 0.002
axis = [0, 1, 0]
centre = [0, 0, 0.3]
[[stages]]
name = "press"
steps = 2
[[stages]]
name = "drag"
steps = {steps}
loads.die = 1.25
motions.die.translate = [0.025, 0, 0]
"""


@case(
    claim="A body that a moment lets turn comes to the same equilibrium in one load step as in four, not to one half a right angle away.",
    tier="gate",
    bounds={
        "apart": Bound(at_most=0.01, reason="discretisation: with friction longer load steps are another path"),
        "turned": Bound(at_least=4.0, reason="definition: an angle that is not small"),
    },
)
def leaning() -> dict[str, float]:
    """Angle in degrees at the end of one load step off that at the end of four, which is the other number."""
    one, four = (
        [result.reactions[1].rotation for result in Simulation(Scene.from_toml(_DIE.format(steps=steps)).problem()).run()][-1]
        for steps in (1, 4)
    )
    return {"apart": abs(one - four), "turned": four}


@case(
    claim="How far a plate has turned in a load increment is the shorter way round, wherever it begins; only what is far is objected to.",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: turns that are far and not objected to, or are told as another one, or are near and are"),
        "far": Bound(at_least=50.0, at_most=150.0, reason="definition: of 200 turns, or one of both is not tried"),
    },
)
def far_turns() -> dict[str, float]:
    """How many, of a plate about an axis askew."""
    equilibrium, random = bar("askew"), np.random.default_rng(5)
    snapping, numbering, wrong, far = Snapping(equilibrium), equilibrium.numbering, 0, 0
    for begin, way in zip(random.uniform(-180.0, 180.0, 200), random.uniform(-80.0, 80.0, 200), strict=True):
        before, after = (plates_turned(equilibrium.supports, numbering, np.radians([0.0, angle])) for angle in (begin, begin + way))
        said = ""
        try:
            snapping.look(before, after, 1.0)
        except ConvergenceError as objection:
            said = str(objection)
        far += abs(way) > LARGEST_TURN
        wrong += bool(said) != (abs(way) > LARGEST_TURN) or (bool(said) and f"turns by {way:.0f} degrees" not in said)
    return {"wrong": float(wrong), "far": float(far)}
