"""Newton's order, as it is told of the log of a loop: that of the last three residuals in which nothing but Newton's method acts."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.newton import observed_order
from isomortar.solve.record import IterationRecord

#: Residuals that fall by an order each: the first two, and so many after them.
FIRST, SECOND, MORE = 1e-2, 1e-3, 2
#: Round-off of the residuals: below all of them.
ROUND_OFF = 1e-30


def residuals_of(order: float) -> list[float]:
    """Residuals r_(k+1) = C r_k^order."""
    found = [FIRST, SECOND]
    for _ in range(MORE):
        found.append(found[-1] * (found[-1] / found[-2]) ** order)
    return found


def log_of(
    residuals: list[float], slips: tuple[int, ...] = (), notes: tuple[int, ...] = (), active: tuple[int, ...] = ()
) -> list[IterationRecord]:
    """A log of 9 active constraints, 4 of which slip; in some iterations one slips or acts more, or something else acts."""
    records = []
    for k, residual in enumerate(residuals):
        slip, acting = 4 + (k in slips), 9 + (k in active)
        records.append(IterationRecord(k, residual, acting, acting - slip, slip, ("reversal of 1",) if k in notes else ()))
    return records


@case(
    claim="Newton's order is told of the last three residuals that fall above round-off, while states stay and nothing else acts; "
    "else it is not a number.",
    tier="gate",
    grid={"order": (1.0, 1.5, 2.0)},
    bounds={
        "last": Bound(at_most=1e-12, reason="definition: residuals are made of that order; round-off"),
        "before": Bound(at_most=1e-12, reason="definition: the last one is no residual of Newton's method, the three before it are"),
        "untold": Bound(0.0, 0.0, "definition: logs without three such residuals of which an order is told"),
    },
)
def observed(order: float) -> dict[str, float]:
    """Distance of the observed order from that of the residuals; logs of which it should not be told."""
    good = residuals_of(order)
    spoilt = [log_of([*good, value], **where) for value, where in (
        (good[-1], {}), (2.0 * good[-1], {}), (0.0, {}), (1e-9 * good[-1], {"slips": (4,)}), (1e-9 * good[-1], {"active": (4,)}),
        (1e-9 * good[-1], {"notes": (4,)}),
    )]  # fmt: skip
    three = good[:3]
    none = [log_of(three[:2]), log_of(three[::-1]), log_of([three[0], three[0], three[2]]), log_of([*three[:2], 0.0])]
    none += [log_of(three, **{name: (k,)}) for name in ("slips", "notes", "active") for k in range(3)]
    at_round_off = SECOND**3 / FIRST**2
    told = [observed_order(log, ROUND_OFF) for log in none] + [observed_order(log_of(three), 1.001 * at_round_off)]
    just = observed_order(log_of(three), 0.999 * at_round_off)
    return {
        "last": float(np.abs(np.array([observed_order(log_of(good), ROUND_OFF), just]) - order).max()),
        "before": float(np.abs(np.array([observed_order(log, ROUND_OFF) for log in spoilt]) - order).max()),
        "untold": float(np.count_nonzero(np.isfinite(told))),
    }


#: A pad that is pressed onto a plane, and a block beside it that nothing moves.
PAD = """
format = 1
bodies.pad = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }, mesh = { order = 2, elements = [2, 2, 1] } }
contacts.floor = { slave = "pad.w0", plane = { point = [0, 0, -0.01] }, friction = 0.3 }
supports.top.face = "pad.w1"
solver.measures = ["forgiving", "halving"]
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.05] }]
"""
RESTING = """
bodies.block.geometry = { kind = "box", lower = [3, 0, 0], upper = [4, 1, 1] }
supports.block.face = "block.w0"
"""


@case(
    claim="A body at rest, whose forces are nothing but round-off, leaves the order that is told of a load step.",
    tier="gate",
    bounds={
        "apart": Bound(at_most=0.05, reason="round-off: of the last of three residuals"),
        "order": Bound(at_least=1.5, reason="theory: about 2, or nothing is told"),
    },
)
def beside_one_at_rest() -> dict[str, float]:
    """Difference of the orders with and without it; the order without."""
    alone, beside = (next(Simulation(Scene.from_toml(text).problem()).run()).newton_order for text in (PAD, PAD + RESTING))
    return {"apart": abs(beside - alone), "order": alone}
