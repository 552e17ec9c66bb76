"""Every block of the tangent on its own: its error, and that a scaling by 1 + 1e-6 or 1 - 1e-6 of any one of them is seen."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from tangents.blocks import PartBlocks, tangent_blocks
from tangents.placed import placed

from isomortar.harness import Bound, case
from isomortar.harness.tangents import BOUND
from isomortar.harness.visits import PairVisit, Visit
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: A bowl over an uneven block: few blocks, all kinds of them.
_SCENE = """
format = 1

[bodies.slave]
geometry = { kind = "bowl", centre = [0.03, 0.02], half_width = 0.35, bottom = 0, rise = 0.06, top = 0.4 }
mesh = { order = [2, 2, 1], elements = [2, 1, 1] }

[bodies.master]
geometry = { kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.7, 0.65, 0] }
mesh = { order = [3, 2, 1], elements = [1, 2, 1] }

[contacts.interface]
slave = "slave.w0"
master = "master.w1"
friction = 0.3
quadrature = [3, 3]

[supports.top]
face = "slave.w1"

[supports.floor]
face = "master.w0"

[[stages]]
name = "press"
steps = 1
motions.top = { translate = [0, 0, -0.05] }
"""
#: Share of a block that is planted on it.
PLANTED = 1e-6
PARTS = (
    "solid", "normal, geometric", "normal, gap", "normal, pressure", "condensed", "tangential, geometric", "tangential, projection",
    "tangential, slip increment", "tangential, metric", "stick", "slip",
)  # fmt: skip
_ROUND_OFF = Bound(at_most=BOUND, reason="round-off: a block of double precision against differences of a twin in extended precision")


def uneven(*overrides: str, rough: float = 0.01, lift: float = 0.0) -> tuple[Equilibrium, Visit]:
    """The scene, `rough` by random moves of all control points, the slave lifted, with open, sticking and slipping ones in turn.

    Every third quadrature point has no history, as where it comes over the master's edge: no slip is counted there.
    """
    problem = Scene.from_toml(_SCENE, overrides=overrides).problem()
    equilibrium = Equilibrium(replace(problem, settings=replace(problem.settings, method="uzawa")), Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    positions = state.positions + rough * np.random.default_rng(1).standard_normal(state.positions.shape)
    positions[equilibrium.numbering.points["slave"], 2] += lift
    n = pair.pair.slave.test.count
    begun = state.contacts[0]
    begun = replace(begun, projected=np.resize(np.array([1, 0, 1], np.int32), len(begun.projected)))
    law = pair.law(np.array([20.0, 10.0]), np.zeros(n), np.zeros((n, 2)))
    pressure, length = (np.resize(np.array(pattern), n) for pattern in ((-1.0, 1.0, 0.7), (0.0, 0.5, 2.0)))
    return equilibrium, Visit(positions, (placed(pair, positions, PairVisit(begun, law), pressure, length),))


def planted(blocks: PartBlocks) -> list[bool]:
    """Whether a scaling of a block by 1 + 1e-6 and by 1 - 1e-6 is seen, one block at a time; zero blocks can not be scaled."""
    seen = []
    for k in np.flatnonzero(np.abs(blocks.ours).max(axis=(1, 2))):
        for factor in (1 + PLANTED, 1 - PLANTED):
            ours = blocks.ours.copy()
            ours[k] *= factor
            seen.append(bool(replace(blocks, ours=ours).errors.max() > BOUND))
    return seen


@case(
    claim="Every block of the tangent is exact, none is missing, and a scaling of any one of them by 1 + 1e-6 or 1 - 1e-6 is seen.",
    tier=lambda slip_sum: "gate" if slip_sum == "local" else "nightly",
    grid={"slip_sum": ("local", "paper")},
    bounds={
        **dict.fromkeys(PARTS, _ROUND_OFF),
        "outside": Bound(at_most=1e-14, reason="round-off: the twin's derivative is zero where a part has no block"),
        "planted, not seen": Bound(at_most=0.0, reason="definition: a check that a fault passes is worth nothing"),
        "planted, seen": Bound(at_least=100.0, reason="definition: every part has dozens of blocks, each scaled up and down"),
    },
)
def every_block(slip_sum: str) -> dict[str, float | list[float]]:
    """Largest error of a block, by its own size, in each part.

    Then, part by part: derivatives without a block, and the numbers of planted faults within and beyond the bound.
    """
    blocks = tangent_blocks(*uneven(f"solver.slip_sum={slip_sum}"))
    seen = [planted(part) for part in blocks]
    return {part.part: float(part.errors.max()) for part in blocks} | {
        "outside": [part.outside for part in blocks],
        "planted, not seen": [float(len(of_part) - sum(of_part)) for of_part in seen],
        "planted, seen": [float(sum(of_part)) for of_part in seen],
    }
