"""A scene that is carried along: all of it turned and moved a little further with every load step, on top of its own history."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from objectivity import invariance, retold
from transforms import vector

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Motion, Problem, Stage, Support
from isomortar.model.plates import rotation

#: Turn of each load step about the z-axis through a point, in degrees, and its way.
DEGREES, CENTRE, WAY = 25.0, np.array([0.3, -0.2, 0.1]), np.array([0.1, 0.2, -0.3])


def turn(step: int) -> FloatArray:
    """Of everything at the end of a load step, shape (3, 3)."""
    return rotation(np.array([0.0, 0.0, 1.0]), np.radians(DEGREES * step))


def carried(problem: Problem) -> Problem:
    """The problem with that on top of what its supports do, each load step a stage; supports turn about z alone, and nothing else loads."""
    steps = [stage for stage, given in enumerate(problem.stages) for _ in range(given.steps)]
    stages = tuple(Stage(f"s{number}", 1) for number, _ in enumerate(steps))
    return replace(problem, stages=stages, supports=tuple(_carried(problem, support, steps) for support in problem.supports))


def _carried(problem: Problem, support: Support, steps: list[int]) -> Support:
    own, centre, gone, motions = np.zeros(3), np.asarray(support.centre), np.zeros(3), list[Motion]()
    for number, stage in enumerate(steps, 1):
        motion, share = support.motions[stage] if support.motions else Motion(), 1.0 / problem.stages[stage].steps
        own = own + share * np.asarray(motion.translate)
        there = CENTRE + turn(number) @ (centre + own - CENTRE) + number * WAY - centre
        motions.append(Motion(vector(there - gone), share * motion.rotate + DEGREES))
        gone = there
    return replace(support, motions=tuple(motions))


def _two_contacts() -> Problem:
    return replace(retold.as_it_is(), loads=())


def _averaged(**changes: object) -> Problem:
    problem = invariance.SCENES["block"]()
    return replace(problem, contacts=(replace(problem.contacts[0], **changes),))  # type: ignore[arg-type]


def _rigid() -> Problem:
    problem = invariance.SCENES["block"]()
    slave, master = problem.bodies
    return replace(problem, bodies=(slave, replace(master, rigid=True)))


def _augmented() -> Problem:
    problem = invariance.SCENES["block"]()
    return replace(problem, settings=replace(problem.settings, method="uzawa", augmentation_tolerance=1e-9))


SCENES: dict[str, Callable[[], Problem]] = {
    **{name: invariance.SCENES[name] for name in ("block", "kinked", "capped", "greville")},
    "smooth": lambda: _averaged(smoothing=1e-4),
    "rigid": _rigid,
    "augmented": _augmented,
    "two contacts": _two_contacts,
}
_REASON = "round-off: forces are in balance to Newton's 1e-12"


@case(
    claim="A scene that is carried along, turned and moved with every load step, has the positions, forces, pressures, tractions and feet "
    "that it has at rest, turned likewise, and friction takes up as much.",
    tier="gate",
    grid={"scene": tuple(SCENES)},
    bounds={
        "positions": Bound(at_most=1e-11, reason=_REASON),
        "forces": Bound(at_most=1e-11, reason=_REASON),
        "pressures": Bound(at_most=1e-9, reason=f"{_REASON}; of the load of one control point, augmentations to 1e-9"),
        "tractions": Bound(at_most=1e-9 / 0.3, reason="round-off: the same, and 0.3, the friction, of the pressures"),
        "feet": Bound(at_most=1e-11, reason=_REASON),
        "work": Bound(at_most=1e-9, reason="round-off: of tractions times slips"),
    },
)
def frame(scene: str) -> dict[str, float]:
    """Largest change of each over its largest value in the run, when what is carried has been turned back."""
    problem = SCENES[scene]()
    rest, moving = (list(Simulation(given).run()) for given in (problem, carried(problem)))
    apart: dict[str, list[float]] = {}
    sizes: dict[str, list[float]] = {}
    for step, (one, other) in enumerate(zip(rest, moving, strict=True), 1):
        back = turn(step)
        places = (other.state.positions - step * WAY - CENTRE) @ back + CENTRE
        pairs = [("positions", one.state.positions, places)]
        pairs += [("forces", a.force, b.force @ back) for a, b in zip(one.reactions, other.reactions, strict=True)]
        pairs += [("forces", a.force_slave, b.force_slave @ back) for a, b in zip(one.contacts, other.contacts, strict=True)]
        pairs += [("work", np.array(a.friction_work), np.array(b.friction_work)) for a, b in zip(one.contacts, other.contacts, strict=True)]
        for a, b in zip(one.state.contacts, other.state.contacts, strict=True):
            pairs += [("pressures", a.pressure, b.pressure), ("tractions", a.traction, b.traction), ("feet", a.projection, b.projection)]
        for name, here, there in pairs:
            apart.setdefault(name, []).append(float(np.abs(here - there).max()))
            sizes.setdefault(name, []).append(float(np.abs(here).max()))
    return {name: float(np.max(values) / np.max(sizes[name])) for name, values in apart.items()}
