"""Runs that go on from the record of any load step, where supports come and go, and forces, moments and loads drive what they hold."""

from __future__ import annotations

import numpy as np
from objectivity.driven import as_it_is
from transforms import moved

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation


@case(
    claim="A run that goes on from the record of a load step comes to the same bits, at the beginning and within a stage, far away too.",
    tier="gate",
    grid={"place": ("here", "far away")},
    bounds={
        "positions": Bound(at_most=0.0, reason="definition: all that later steps depend on is recorded"),
        "forces": Bound(at_most=0.0, reason="definition: as above"),
        "moments": Bound(at_most=0.0, reason="definition: as above"),
    },
)
def from_any_step(place: str) -> dict[str, float]:
    """Largest differences of positions, forces and moments of supports, over all load steps to go on from."""
    problem, _ = as_it_is()
    given = problem if place == "here" else moved(problem, np.array([1000.0, -700.0, 300.0]))
    whole = list(Simulation(given).run())
    apart = np.zeros(3)
    for begin in whole[:-1]:
        rest = list(Simulation(given, resume_from=begin).run())
        for one, other in zip(whole[begin.step :], rest, strict=True):
            wrenches = [np.array([[r.force, r.moment] for r in result.reactions]) for result in (one, other)]
            off = np.abs(wrenches[0] - wrenches[1])
            apart = np.maximum(apart, [np.abs(one.state.positions - other.state.positions).max(), off[:, 0].max(), off[:, 1].max()])
    return dict(zip(("positions", "forces", "moments"), apart.tolist(), strict=True))
