"""The tangent of each law of friction: what sticks, what slips below and at the largest traction, and either side of its kink."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
from tangents.by_state import ABSENT, OFF, PLACED, SHORT, STEP, scene
from tangents.placed import placed

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.harness.cases import Tier
from isomortar.harness.tangents import PARTS, SYMMETRY_BOUND, measure
from isomortar.harness.visits import Visit
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: Coefficient; cohesion, as a share of the largest pressure; share of that pressure at which the largest traction is reached, 0: none.
LAWS: Final = {"cohesion": (0.3, 0.1, 0.0), "constant": (0.0, 0.2, 0.0), "cap": (0.3, 0.0, 0.85), "both": (0.3, 0.1, 0.85)}
#: States of `PLACED` that each is tried in.
STATES: Final = ("slip", "mixed", "stick | slip: stick", "stick | slip: slip")
#: Those with a largest traction, and trials on either side of where it is reached (see `PLACED`).
CAPPED: Final = tuple(law for law, (_, _, kink) in LAWS.items() if kink)
SIDES: Final = {"below": 0.85 * (1.0 - OFF), "above": 0.85 * (1.0 + OFF)}
#: Elastic slip; and states with it: trial pressures, lengths of stretches, and the state of `PLACED` that has the same parts.
SLIP = 0.02
STRETCHED: Final[dict[str, tuple[tuple[float, ...], tuple[float, ...], str]]] = {
    "none": ((1.0, 0.7), (0.0,), "stick"),
    "elastic": ((1.0, 0.7, -1.0), (0.1, 0.5, 0.9), "stick"),
    "sliding": (*PLACED["slip"], "slip"),
    "mixed": (*PLACED["mixed"], "mixed"),
    "elastic | sliding: elastic": (*PLACED["stick | slip: stick"], "mixed"),
    "elastic | sliding: sliding": (*PLACED["stick | slip: slip"], "mixed"),
}
_ROUND_OFF = "round-off: products of double precision against differences of a twin in extended precision"


def bounds(state: str) -> dict[str, Bound]:
    """A bound for every part that a state has."""
    parts = [part for part in PARTS if part not in ABSENT.get(state, ())]
    return {part: Bound(at_most=SYMMETRY_BOUND if part == "symmetry" else 1e-12, reason=_ROUND_OFF) for part in parts}


def errors(
    law: str, pressure: tuple[float, ...], length: tuple[float, ...], short: bool, elastic_slip: float = 0.0, smooth: float = 0.0
) -> tuple[dict[str, float], FloatArray]:
    """Largest relative error of each part, and the pressures of what slips over that at which the largest traction is reached."""
    problem, equilibrium, visit = scene(0.3)
    coulomb = equilibrium.pairs[0]
    at = coulomb.kinematics(visit.positions, visit.pairs[0].start)
    largest = float(coulomb.respond(at, visit.pairs[0].law).pressure.max())
    friction, cohesion, kink = LAWS[law]
    smoothing = smooth * largest**2 / float(visit.pairs[0].law.penalties[0])
    contact = replace(problem.contacts[0], friction=friction, cohesion=cohesion * largest, elastic_slip=elastic_slip, smoothing=smoothing)
    if kink:
        contact = replace(contact, traction_max=contact.cohesion + friction * kink * largest)
    problem = replace(problem, contacts=(contact,))
    pair = Equilibrium(replace(problem, settings=replace(problem.settings, method="uzawa")), Ledger()).pairs[0]
    pressures, lengths = (np.resize(np.array(pattern), len(coulomb.pair.slave.point)) for pattern in (pressure, length))
    stretch = visit.pairs[0].law.traction / largest if elastic_slip else None
    own = replace(visit.pairs[0].law, friction=pair.friction, elastic_slip=elastic_slip, stretch=stretch, smoothing=smoothing)
    start = replace(visit.pairs[0], law=own)
    there = placed(pair, visit.positions, start, largest * pressures, lengths)
    response = pair.respond(pair.kinematics(visit.positions, there.start), there.law)
    report = measure(problem, STEP, [Visit(visit.positions, (there,))], directions=1, length=SHORT if short else 1.0)
    return {row.part: row.error for row in report.rows}, response.pressure[response.state == 2] / largest


def tier(law: str, state: str) -> Tier:
    """The gate has half of the products: every law in two states, every state of two laws."""
    return "nightly" if (tuple(LAWS).index(law) + STATES.index(state)) % 2 else "gate"


@case(
    claim="With each law of friction, in every state and from either side of the edge of slip, the tangent is the derivative.",
    tier=tier,
    grid={"law": tuple(LAWS), "state": STATES},
    bounds=lambda law, state: bounds(state),  # noqa: ARG005
)
def friction_laws(law: str, state: str) -> dict[str, float]:
    """Largest relative error of each part."""
    return errors(law, *PLACED[state], short="|" in state)[0]


@case(
    claim="With elastic slip, none, some, at the edge of sliding and beyond, the tangent is the derivative.",
    grid={"law": ("constant", "both"), "state": tuple(STRETCHED)},
    bounds=lambda law, state: bounds(STRETCHED[state][2]),  # noqa: ARG005
)
def elastic_slip(law: str, state: str) -> dict[str, float]:
    """Largest relative error of each part."""
    pressure, length, _ = STRETCHED[state]
    return errors(law, pressure, length, short="|" in state or state == "none", elastic_slip=SLIP)[0]


@case(
    claim="With smooth contact, all but sharp or with pressures far beyond their trials, the tangent is the derivative.",
    grid={"law": ("cohesion", "both"), "state": ("slip", "mixed"), "smooth": (1e-6, 1e-2)},
    bounds=lambda law, state, smooth: bounds(state),  # noqa: ARG005
)
def smooth_contact(law: str, state: str, smooth: float) -> dict[str, float]:
    """Largest relative error of each part; `smooth`: the product (theory 4.18) over the square of the largest pressure."""
    return errors(law, *PLACED[state], short=True, smooth=smooth)[0]


@case(
    claim="So it is on either side of the pressure at which the largest traction is reached.",
    grid={"law": CAPPED, "side": tuple(SIDES)},
    bounds=lambda law, side: {  # noqa: ARG005
        **bounds("slip"),
        "near": Bound(at_most=3 * OFF, reason="definition: trials are placed 1e-12 off the kink; round-off of the control quantities"),
    },
)
def largest_traction(law: str, side: str) -> dict[str, float]:
    """Largest relative error of each part; distance of the nearest pressure from the kink, infinite on its other side."""
    found, slipping = errors(law, (SIDES[side], 0.5, 0.95, -1.0), (2.0, 1.5), short=True)
    off = slipping / LAWS[law][2] - 1.0
    nearest = float(off[np.argmin(np.abs(off))])
    return found | {"near": abs(nearest) if (nearest > 0.0) == (side == "above") else float("inf")}
