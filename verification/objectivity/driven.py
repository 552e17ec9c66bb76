"""The same for what forces, moments and loads drive, and supports of some stages hold: turned, mirrored, moved, in other units, renamed."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from small_scenes import TIGHT
from transforms import mirrored, moved, orientations, oriented, relabelled, scaled, turned

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: A pad that is begun by a support, then pressed, tilted and dragged by others, under loads of all kinds and held by an edge for a while.
_PAD = """
format = 1
bodies.pad.geometry = { kind = "wedge", bottom = [-0.5, 0.4], top = [-0.4, 0.5], y = [-0.4, 0.45], z = [0, 0.4] }
bodies.pad.mesh = { order = [2, 3, 2], elements = [3, 2, 1], grading = [0.5, 1, 1], quadrature = [3, 4, 5] }
contacts.floor = { slave = "pad.w0", plane = {}, friction = 0.3, quadrature = [4, 6] }
supports.begin = { face = "pad.w1", centre = [0.1, 0.2, 0.4], axis = [1, 2, 3], stages = ["begin"] }
supports.side = { edge = "pad.u0.v0", components = ["y"], stages = ["begin", "press"] }
[supports.top]
face = "pad.w1"
stages = ["press", "drag"]
force = { x = 0.02, z = -0.4 }
moment = 0.01
centre = [0, 0, 0.4]
axis = [0, 1, 0]
[loads]
wind = { face = "pad.u0", pressure = 0.05 }
pull = { face = "pad.u1", traction = [0.03, 0, -0.01] }
own = { body = "pad", weight = [0.03, 0.01, -0.1] }
[[stages]]
name = "begin"
steps = 1
motions.begin.translate = [0.01, 0, -0.02]
[[stages]]
name = "press"
steps = 1
[[stages]]
name = "drag"
steps = 2
loads.top = 1.2
motions.top.translate = [0, 0.02, 0]
"""


@dataclass(frozen=True)
class Twin:
    """A change of the scene, and what takes its results back: a matrix, a shift, units of length and stress."""

    change: Callable[[Problem], Problem]
    turn: FloatArray
    shift: FloatArray
    length: float = 1.0
    stress: float = 1.0


_NO_TURN, _NO_SHIFT = np.eye(3), np.zeros(3)
#: Quarter turns about two axes; the image in x = 0.
_TURN, _MIRROR = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), np.diag([-1.0, 1.0, 1.0])
_AWAY = np.array([1000.0, -700.0, 300.0])


def _in_another_order(problem: Problem) -> Problem:
    return replace(problem, supports=problem.supports[::-1], loads=problem.loads[::-1])


TWINS = {
    "turned": Twin(lambda problem: turned(problem, _TURN), _TURN, _NO_SHIFT),
    "mirrored": Twin(mirrored, _MIRROR, _NO_SHIFT),
    "moved": Twin(lambda problem: moved(problem, _AWAY), _NO_TURN, _AWAY),
    "units": Twin(lambda problem: scaled(problem, 1e-3, 1e6), _NO_TURN, _NO_SHIFT, 1e-3, 1e6),
    "micro": Twin(lambda problem: scaled(problem, 1e6, 1e-3), _NO_TURN, _NO_SHIFT, 1e6, 1e-3),
    "relabelled": Twin(relabelled, _NO_TURN, _NO_SHIFT),
    "in another order": Twin(_in_another_order, _NO_TURN, _NO_SHIFT),
    **{
        f"orientation {k}": Twin(functools.partial(oriented, name="pad", order=order, axes=axes), _NO_TURN, _NO_SHIFT)
        for k, (order, axes) in enumerate(orientations())
        if k in (7, 14, 23)
    },
}


def wrenches(problem: Problem, results: list[StepResult], twin: Twin) -> dict[str, FloatArray]:
    """Forces, moments and ways of supports by name, loads and the contact, by load step, taken back to those of the first scene."""
    sense, back = float(np.linalg.det(twin.turn)), twin.turn
    by_force, by_moment = (1.0 / (twin.stress * twin.length**power) for power in (2, 3))
    supports = sorted(range(len(problem.supports)), key=lambda k: problem.supports[k].name)
    loads = sorted(range(len(problem.loads)), key=lambda k: problem.loads[k].name)
    reactions = [[result.reactions[k] for k in supports] for result in results]
    on_slave = [result.contacts[0] for result in results]
    held = np.array([[(r.force, r.moment) for r in one] for one in reactions])
    loaded = np.array([[(result.loads[k].force, result.loads[k].moment) for k in loads] for result in results])
    touched = np.array([[(c.force_slave, c.moment_slave)] for c in on_slave])
    forces, moments = np.moveaxis(np.concatenate([held, loaded, touched], axis=1), 2, 0)
    moments[:, len(supports) :] -= np.cross(twin.shift, forces[:, len(supports) :])
    return {
        "forces": by_force * forces @ back,
        "moments": by_moment * sense * moments @ back,
        "ways": np.array([[r.displacement for r in one] for one in reactions]) @ back / twin.length,
        "centres": (np.array([[r.centre for r in one] for one in reactions]) - twin.shift) @ back / twin.length,
        "angles": sense * np.array([[r.rotation for r in one] for one in reactions]),
        "pressures": np.array([np.sort(result.state.contacts[0].pressure) for result in results]) / twin.stress,
        "works": by_moment * np.array([[c.friction_work, c.spurious_work] for c in on_slave]),
    }


@functools.cache
def as_it_is() -> tuple[Problem, dict[str, FloatArray]]:
    """The scene and its results."""
    found = Scene.from_toml(_PAD).problem()
    problem = replace(found, settings=replace(found.settings, **TIGHT))  # type: ignore[arg-type]
    return problem, wrenches(problem, list(Simulation(problem).run()), Twin(lambda given: given, _NO_TURN, _NO_SHIFT))


_TIGHT = "round-off: forces are in balance to Newton's 1e-12"
_FAR = 1e3 * float(np.spacing(1000.0))


@case(
    claim="A scene that forces, moments and loads drive has the results of its twins: turned, mirrored, moved, in other units, renamed.",
    tier="gate",
    grid={"twin": list(TWINS)},
    bounds=lambda twin: {
        name: Bound(at_most=_FAR if twin == "moved" else 1e-10, reason="round-off: last bits far away" if twin == "moved" else _TIGHT)
        for name in ("forces", "moments", "ways", "centres", "angles", "pressures", "works")
    },
)
def driven(twin: str) -> dict[str, float]:
    """Largest change of each quantity over its largest value."""
    (problem, before), other = as_it_is(), TWINS[twin]
    there = other.change(problem)
    after = wrenches(there, list(Simulation(there).run()), other)
    return {name: float(np.abs(after[name] - value).max() / np.abs(value).max()) for name, value in before.items()}
