"""Contacts side by side: a bridge between two piers, a weight and a wall, each contact with friction and each body with a support."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import TIGHT

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Face
from isomortar.model.origin import about
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: The bridge is master of three contacts, slave of the one with the wall; two of the three are on one of its faces.
_SCENE = """
format = 1
bodies.bridge.geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 0.8, 0.4] }
bodies.bridge.mesh = { order = [2, 2, 1], elements = [4, 2, 1] }
bodies.west.geometry = { kind = "box", lower = [0.1, 0.1, -0.5], upper = [0.6, 0.5, 0] }
bodies.west.mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
bodies.east.geometry = { kind = "box", lower = [1.2, 0.2, -0.4], upper = [1.8, 0.7, 0] }
bodies.east.mesh = { order = [2, 1, 1], elements = [3, 2, 1] }
bodies.weight.geometry = { kind = "bowl", centre = [1.1, 0.35], half_width = 0.3, bottom = 0.4, rise = 0.04, top = 0.8 }
bodies.weight.mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
contacts.west = { slave = "west.w1", master = "bridge.w0", friction = 0.2 }
contacts.wall = { slave = "bridge.u0", plane = { point = [0, 0, 0], normal = [1, 0.05, 0] }, friction = 0.1 }
contacts.east = { slave = "east.w1", master = "bridge.w0", friction = 0.5 }
contacts.weight = { slave = "weight.w0", master = "bridge.w1", friction = 0.3 }
supports.west = { face = "west.w0" }
supports.weight = { face = "weight.w1", centre = [1.1, 0.35, 0.8] }
supports.bridge = { face = "bridge.v1", centre = [1, 0.8, 0.2], axis = [0, 1, 0] }
supports.east = { face = "east.w0", centre = [1.5, 0.4, -0.4], axis = [0, 0, 1] }
[[stages]]
name = "close"
steps = 1
motions = { bridge.translate = [-0.02, 0, -0.02], weight.translate = [0, 0, -0.05] }
[[stages]]
name = "slide"
steps = 1
motions.bridge = { translate = [-0.01, -0.02, 0], rotate = 0.5 }
motions.weight = { translate = [0.03, 0, -0.02], rotate = 6 }
motions.east.rotate = 4
"""
#: By place of the scene; far away it is computed about an origin of its own.
PLACES = {"here": (0.0, 0.0, 0.0), "far away": (-4096.0, 2048.0, 8192.0)}
_BALANCE = "theory: every body is in balance, its free control points to 1e-12 of its internal forces; arms as long as the place is far"
_DEFINITION = "definition: what `ContactResult` says its numbers are"
_CONDITIONS = "theory: the contact conditions, to ten times the 1e-11 at which Newton's method stops"


def results(place: str) -> list[StepResult]:
    """The load steps of the bridge."""
    problem = about(Scene.from_toml(_SCENE).problem(), -np.array(PLACES[place]))
    return list(Simulation(replace(problem, settings=replace(problem.settings, **TIGHT))).run())  # type: ignore[arg-type]


@case(
    claim="Each of several contacts of a body has forces and moments of its own on either side: with them every body is in balance.",
    tier="gate",
    grid={"place": tuple(PLACES)},
    bounds={
        "force": Bound(at_most=1e-12, reason=_BALANCE),
        "moment": Bound(at_most=1e-12, reason=_BALANCE),
        "smallest": Bound(at_least=0.02, reason="definition: each contact bears a load, and no two bear the same"),
    },
)
def side_by_side(place: str) -> dict[str, float]:
    """What the forces on a body, and their moments about the origin, leave, over the largest force (and its arm).

    The smallest contact force, or difference of two of them, over the largest one.
    """
    problem = Scene.from_toml(_SCENE).problem()
    left, arm = [], max(1.0, float(np.abs(PLACES[place]).max()))
    for result in results(place):
        total = {body.name: np.zeros((2, 3)) for body in problem.bodies}
        for support, reaction in zip(problem.supports, result.reactions, strict=True):
            total[support.place.body] += reaction.force, reaction.moment + np.cross(reaction.centre, reaction.force)
        for contact, measured in zip(problem.contacts, result.contacts, strict=True):
            total[contact.slave.body] += measured.force_slave, measured.moment_slave
            if isinstance(contact.master, Face):
                total[contact.master.body] += measured.force_master, measured.moment_master
        forces = np.array([contact.force_slave for contact in result.contacts])
        largest = np.linalg.norm(forces, axis=1).max()
        left.append(np.abs(list(total.values())).max(axis=(0, 2)) / largest / (1.0, arm))
        apart = np.linalg.norm([*forces, *(a - b for i, a in enumerate(forces) for b in forces[:i])], axis=1).min() / largest
    return {"force": float(np.max(left, axis=0)[0]), "moment": float(np.max(left, axis=0)[1]), "smallest": float(apart)}


@case(
    claim="What is said of a contact's control points is said of its own: numbers, states, gaps, and tractions by its own friction.",
    tier="gate",
    bounds={
        "counts": Bound(0.0, 0.0, reason=_DEFINITION),
        "open": Bound(0.0, 0.0, reason="definition: an open control point has neither pressure nor traction"),
        "sunk": Bound(0.0, 0.0, reason="definition: an open control point is not inside its master"),
        "gap": Bound(at_most=1e-10, reason=_CONDITIONS),
        "cone": Bound(at_most=1e-10, reason=_CONDITIONS),
        "within": Bound(at_most=1.0, reason="theory: what sticks is inside the cone"),
        "states": Bound(at_least=3.0, reason="definition: open, sticking and slipping control points are all tested"),
    },
)
def of_each_contact() -> dict[str, float]:
    """Wrong counts; multipliers of what is open, and how deep it is; gap of what is closed; tractions over those of the cone."""
    contacts = Scene.from_toml(_SCENE).problem().contacts
    found: dict[str, list[float]] = {name: [0.0] for name in ("counts", "open", "sunk", "gap", "cone", "within")}
    states = set[int]()
    for result in results("here"):
        for contact, state, measured in zip(contacts, result.state.contacts, result.contacts, strict=True):
            status, cone = measured.status, contact.friction * state.pressure
            states |= set(status.tolist())
            counts = (measured.active - np.sum(status > 0), measured.slip - np.sum(status == 2))
            found["counts"].append(float(np.abs(counts).max()))
            found["open"] += [*state.pressure[status == 0], *measured.traction_norm[status == 0]]
            found["sunk"] += list(measured.gap[status == 0])
            found["gap"] += list(np.abs(measured.gap[status > 0]))
            found["cone"] += list(np.abs(measured.traction_norm / np.where(cone > 0, cone, 1.0) - 1.0)[status == 2])
            found["within"] += list((measured.traction_norm / np.where(cone > 0, cone, 1.0))[status == 1])
    return {name: float(np.max(values)) for name, values in found.items()} | {"states": float(len(states))}
