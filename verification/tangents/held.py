"""The tangent where supports hold control points of the contact face, in directions oblique to the plane's coordinates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import TIGHT

from isomortar.harness import Bound, case
from isomortar.harness.tangents import BOUND, SYMMETRY_BOUND, measure
from isomortar.harness.visits import visited_states
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: A quarter of a block: x is held on one side, y on another, both in the corner; neither is a coordinate of the plane.
_QUARTER = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [0.5, 0.4, 0.5] }
bodies.block.mesh = { order = [2, 2, 1], elements = [3, 2, 1] }
contacts.base = { slave = "block.w0", plane = { point = [0, 0, 0], tangent = [0.8, 0.6, 0] }, friction = 0.4 }
supports.top = { face = "block.w1", components = ["z"] }
supports.west = { face = "block.u0", components = ["x"] }
supports.south = { face = "block.v0", components = ["y"] }
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.04] }]
"""
PARTS = (
    *("solid", "normal, gap", "normal, pressure", "tangential, projection", "tangential, slip increment"),
    *("stick", "slip", "multipliers", "whole", "symmetry"),
)
_ROUND_OFF = "round-off: products of double precision against differences of a twin in extended precision"


@case(
    claim="The tangent is exact also where supports take a part of the traction.",
    tier="gate",
    grid={"slip_sum": ("local", "paper")},
    bounds={
        **{part: Bound(at_most=SYMMETRY_BOUND if part == "symmetry" else BOUND, reason=_ROUND_OFF) for part in PARTS},
        "sticking": Bound(at_least=1.0, reason="definition: a part is tested only where it acts"),
        "slipping": Bound(at_least=1.0, reason="definition: a part is tested only where it acts"),
    },
)
def held(slip_sum: str) -> dict[str, float]:
    """Largest relative error of each part; control points that are held in one direction of the plane and stick, and that slip."""
    problem = Scene.from_toml(_QUARTER).problem()
    problem = replace(problem, settings=replace(problem.settings, slip_sum=slip_sum, **TIGHT))  # type: ignore[arg-type]
    visits = visited_states(problem, 2)
    report = measure(problem, 2, visits, directions=2)
    pair, at = Equilibrium(problem, Ledger()).pairs[0], visits[-1]
    state = pair.respond(pair.kinematics(at.positions, at.pairs[0].start), at.pairs[0].law).state
    partly = np.isclose(np.linalg.norm(at.pairs[0].law.free, axis=(1, 2)), 1.0)
    counts = {name: float(np.sum(partly & (state == number))) for number, name in ((1, "sticking"), (2, "slipping"))}
    return {row.part: row.error for row in report.rows} | counts
