"""What is said at the ends of load steps, by what they are made of: pressures, points beside the master, and when a contact was closed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import ContactResult, ContactState, StepResult
from isomortar.told.during.advice import StepAdvice
from isomortar.told.during.leaving import Leaving

#: Two contacts of a body, of which the first one is never spoken of.
SCENE = """
format = 1
bodies.b = { geometry = { kind = "box", lower = [2, 0, 0], upper = [3, 1, 1] }, mesh = { order = 2, elements = 2 } }
contacts.quiet = { slave = "b.u1", plane = { point = [3.5, 0, 0], normal = [-1, 0, 0] } }
contacts.told = { slave = "b.w0", plane = {}, friction = 0.3 }
supports.b.face = "b.w1"
stages = [{ name = "press", steps = 5, motions.b.translate = [0, 0, -0.01] }]
"""
#: Words of what is said.
SAID = {"left": "have left the master", "beside": "wholly beside", "never": "never closed", "spurious": "spurious work"}
Given = tuple[int, float, float, int, float, float]
#: Active constraints, largest control pressure, largest pressure, points without a foot, and works, of each load step.
CLOSED: Given = (9, 1.0, 1.0, 0, 1.0, 0.0)
OPEN: Given = (0, 0.0, 0.0, 0, 0.0, 0.0)
HISTORIES: tuple[tuple[tuple[Given, ...], str], ...] = (
    ((CLOSED,) * 4, ""),
    ((CLOSED, (9, 1.49, 1.0, 0, 1.0, 0.0)), ""),
    (((9, 1.51, 1.0, 0, 1.0, 0.0),) * 2, "oscillate"),
    (((3, 1.51, 1.0, 0, 1.0, 0.0),), ""),
    (((9, 3e-14, 1e-14, 0, 1.0, 0.0),), ""),  # pressures of round-off, of a modulus of 1 and beside a pressure of 1
    (((9, 3e-9, 1e-9, 0, 1.0, 0.0),), ""),
    (((9, 3e-7, 1e-7, 0, 1.0, 0.0),), "oscillate"),
    ((CLOSED, (9, 1.0, 1.0, 5, 1.0, 0.0), (9, 1.0, 1.0, 7, 1.0, 0.0)), "left"),
    (((9, 1.0, 1.0, 7, 1.0, 0.0), (9, 1.0, 1.0, 5, 1.0, 0.0)), "left"),
    ((CLOSED, (0, 0.0, 0.0, 5, 0.0, 0.0)), ""),
    ((CLOSED, (0, 0.0, 0.0, -1, 0.0, 0.0)), "beside"),
    ((OPEN,) * 4, "never"),
    ((OPEN, OPEN, CLOSED), ""),
    ((CLOSED, OPEN), ""),
    ((OPEN, CLOSED, OPEN, OPEN), "opened in load step 3"),
    ((OPEN, CLOSED, OPEN, CLOSED, OPEN), ""),
    (((9, 1.0, 1.0, 0, 1.0, 0.019), (9, 1.0, 1.0, 0, 1.0, -0.05)), ""),
    (((9, 1.0, 1.0, 0, 1.0, 0.01), (9, 1.0, 1.0, 0, 1.0, 0.031)), "spurious"),
    (((9, 1.0, 1.0, 0, 1.0, 0.01), (9, 1.0, 1.0, 0, 1.0, -0.051)), "spurious"),
    (((9, 1.0, 1.0, 0, 1e-31, 3e-7),) * 2, ""),  # all sticks
)

#: Runs that go on from load step 3: what the second contact was in there, what follows, and what is said.
GOING_ON: tuple[tuple[Given, tuple[Given, ...], str], ...] = (
    (CLOSED, (CLOSED,), ""),
    (OPEN, (OPEN, OPEN), ""),  # what was closed before is not known
    (OPEN, (OPEN, CLOSED, OPEN, OPEN), "opened in load step 6"),
    (CLOSED, (OPEN, OPEN), "opened in load step 4"),
    (OPEN, ((9, 3e-7, 1e-7, 0, 1.0, 0.0),), "oscillate"),
    ((9, 1.0, 1.0, 5, 1.0, 0.0), ((9, 1.0, 1.0, 5, 1.0, 0.0),), ""),
    ((9, 1.0, 1.0, 5, 1.0, 0.0), ((9, 1.0, 1.0, 7, 1.0, 0.0),), "2 slave quadrature points have left the master"),
    (CLOSED, ((9, 1.0, 1.0, 5, 1.0, 0.0),), "5 slave quadrature points have left the master"),
    ((0, 0.0, 0.0, -1, 0.0, 0.0), ((0, 0.0, 0.0, -1, 0.0, 0.0),), ""),
    (CLOSED, ((0, 0.0, 0.0, -1, 0.0, 0.0), CLOSED, (0, 0.0, 0.0, -1, 0.0, 0.0)), "beside"),
)


def made(result: ContactResult, state: ContactState, given: Given) -> tuple[ContactResult, ContactState]:
    """A result and state with some numbers; -1 points without a foot: all."""
    active, largest, field, excluded, friction, spurious = given
    pressure = np.zeros_like(state.pressure)
    pressure[1] = largest
    points = len(state.projected) if excluded < 0 else excluded
    range_ = np.array([-0.25 * field, field])
    slip = active if friction > 1e-20 else 0  # below that it is round-off
    told = replace(result, active=active, slip=slip, pressure_field=range_, excluded=points, friction_work=friction, spurious_work=spurious)
    feet = np.where(np.arange(len(state.projected)) < points, 0, 1).astype(state.projected.dtype)
    return told, replace(state, pressure=pressure, projected=feet)


def said(of: Equilibrium, start: tuple[ContactState, ...], step: StepResult, history: tuple[Given, ...], begun: int = 0) -> str:
    """What is said of a history of the second contact, beside one that stays closed, in a run that goes on from load step `begun`."""
    advice = StepAdvice(of.problem, begun, start)
    leaving = Leaving([mechanics.pair for mechanics in of.pairs], start)
    heard: list[str] = []
    for number, given in enumerate(history, start=begun + 1):
        both = [made(*of) for of in zip(step.contacts, step.state.contacts, (CLOSED, given), strict=True)]
        results, states = [result for result, _ in both], [state for _, state in both]
        heard += [*leaving.after_step(number, results, states), *advice.after_step(number, results, states)]
    heard += advice.at_the_end({})
    return "; ".join(heard)


@case(
    claim="At the ends of load steps it is said once what is doubtful of a contact, of that contact, and nothing of what is sound; also in "
    "runs that go on, by how the contact was before.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: histories of which something else is said, or nothing, or too much")},
)
def histories() -> dict[str, float]:
    """Of how many."""
    problem = Scene.from_toml(SCENE).problem()
    simulation = Simulation(problem)
    start = simulation.state.contacts
    step = next(iter(simulation.run()))
    wrong = 0
    for history, expected in HISTORIES:
        words = SAID.get(expected, expected)
        heard = said(simulation.equilibrium, start, step, history)
        wrong += heard.count("contact '") != bool(words) or heard.count("contact 'told'") != bool(words) or words not in heard
    for given, history, expected in GOING_ON:
        words = SAID.get(expected, expected)
        before = tuple(made(*of)[1] for of in zip(step.contacts, step.state.contacts, (CLOSED, given), strict=True))
        heard = said(simulation.equilibrium, before, step, history, 3)
        wrong += heard.count("contact '") != bool(words) or heard.count("contact 'told'") != bool(words) or words not in heard
    return {"wrong": float(wrong)}
