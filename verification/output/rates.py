"""Rates that a load step keeps for the first guess of the next one: changes of its last increment, and none over what begins or ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.extrapolation import multipliers_ahead, positions_ahead
from isomortar.solve.record import ContactRates

#: A pad that comes down onto a plane in the second of three load steps, is dragged, and lifted; beside it one that stays above another.
SCENE = """
format = 1
bodies.pad = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }, mesh = { order = 2, elements = [2, 2, 1] } }
contacts.floor = { slave = "pad.w0", plane = { point = [0, 0, -0.015] }, friction = 0.3 }
supports.top.face = "pad.w1"
bodies.other = { geometry = { kind = "box", lower = [2, 0, 0], upper = [3, 1, 0.5] }, mesh = { order = 1 } }
contacts.none = { slave = "other.w0", plane = { point = [0, 0, -1] }, friction = 0.3 }
supports.other.face = "other.w1"
stages = [
    { name = "press", steps = 3, motions.top.translate = [0, 0, -0.03] },
    { name = "drag", steps = 3, motions.top.translate = [0.03, 0.01, 0] },
]
"""
#: Load steps with rates: not where a contact has begun, 2, nor at the ends of the stages, 3 and 6.
WITH = (1, 4, 5)
_EXACT = "round-off: differences of what is recorded"


@case(
    claim="A load step keeps the changes of its last increment, by its length, unless a contact or the stage began or ended with it.",
    tier="gate",
    bounds={
        "steps": Bound(0.0, 0.0, "definition: load steps that keep rates and should not, or the other way round"),
        **dict.fromkeys(("positions", "pressures", "tractions"), Bound(at_most=1e-12, reason=_EXACT)),
        "places": Bound(at_most=1e-14, reason="definition: straight on, and prescribed ones where supports put them; round-off"),
        "ahead": Bound(at_most=1e-14, reason="definition: straight on, and no pressure below zero; round-off"),
        "cut off": Bound(at_least=1.0, reason="definition: a pressure would come below zero, or that is not tried"),
    },
)
def kept() -> dict[str, float]:
    """Largest differences of rates from those of recorded states, and of places and pressures a length ahead from straight lines."""
    simulation = Simulation(Scene.from_toml(SCENE).problem())
    states = [simulation.state]
    found = {"steps": 0.0, "positions": 0.0, "pressures": 0.0, "tractions": 0.0, "places": 0.0, "ahead": 0.0, "cut off": 0.0}
    for result in simulation.run():
        assert result.substeps == 1
        before, state, rates = states[-1], result.state, result.state.rates
        found["steps"] += (rates is not None) != (result.step in WITH)
        states.append(state)
        if rates is None:
            continue
        old, new, rate = before.contacts[0], state.contacts[0], rates.contacts[0]
        at_origin = before.positions + (simulation.equilibrium.origin if result.step == 1 else 0.0)
        for name, change in (
            ("positions", rates.positions - (state.positions - at_origin)),
            ("pressures", rate.pressure - (new.pressure - old.pressure)),
            ("tractions", rate.traction - (new.traction - old.traction)),
        ):
            found[name] = float(np.maximum(found[name], np.abs(change).max()))
        supports = simulation.equilibrium.supports
        for length in (0.5, 0.25, 2.0):
            time = result.time + length
            straight = np.where(supports.held, supports.place(time), state.positions + length * rates.positions)
            off = float(np.abs(positions_ahead(state, rates, supports, time) - straight).max())
            found["places"] = float(np.maximum(found["places"], off))
        for length in (0.5, -0.25, -1e3, 1e3):
            pressure, traction = multipliers_ahead(simulation.equilibrium.pairs[0], new, rate, length)
            straight = new.pressure + length * rate.pressure
            off = np.abs(np.concatenate([pressure - np.maximum(straight, 0.0), (traction - new.traction - length * rate.traction).ravel()]))
            found["ahead"] = float(np.maximum(found["ahead"], off.max() / (1.0 + np.abs(straight).max())))
            found["cut off"] += float(np.count_nonzero(straight < 0.0))
    return found


@case(
    claim="Multipliers go on along their rates, but for those whose conditions may repeat others: around points that have no foot they "
    "stay as they are, and no others do.",
    tier="gate",
    bounds={
        "loose": Bound(0.0, 0.0, "definition: pressures and tractions around points without a foot, which stay"),
        "others": Bound(at_most=1e-14, reason="definition: straight on, and no pressure below zero; round-off"),
        "both": Bound(at_least=1.0, reason="definition: constraints of either kind, whichever are fewer"),
    },
)
def loose_ones() -> dict[str, float]:
    """Largest differences, with each of the slave's elements beside the master in turn, by rates that are drawn by lot."""
    simulation, random = Simulation(Scene.from_toml(SCENE).problem()), np.random.default_rng(8)
    *_, last = simulation.run()
    (begun, *_), (pair, *_) = last.state.contacts, simulation.equilibrium.pairs
    rates = ContactRates(*(random.standard_normal(of.shape) for of in (begun.pressure, begun.traction)))
    found, both = {"loose": [0.0], "others": [0.0]}, []
    for element, nodes in enumerate(pair.pair.slave.test.nodes):
        projected = np.ones_like(begun.projected)
        projected[element * pair.pair.slave.per_element] = 0
        pressure, traction = multipliers_ahead(pair, replace(begun, projected=projected), rates, 0.5)
        straight = np.maximum(begun.pressure + 0.5 * rates.pressure, 0.0), begun.traction + 0.5 * rates.traction
        loose = np.isin(np.arange(len(pressure)), nodes)
        for name, some, expected in (("loose", loose, (begun.pressure, begun.traction)), ("others", ~loose, straight)):
            off = [np.abs(of[some] - other[some]).max(initial=0.0) for of, other in zip((pressure, traction), expected, strict=True)]
            found[name].append(float(np.max(off)))
        both += [np.count_nonzero(loose), np.count_nonzero(~loose)]
    return {name: float(np.max(off)) for name, off in found.items()} | {"both": float(np.min(both))}
