"""The tangent of bodies with raised faces, whose control points below follow from fewer (theory 2.12)."""

from __future__ import annotations

from dataclasses import replace

from small_scenes import TIGHT

from isomortar.harness import Bound, case
from isomortar.harness.tangents import BOUND, SYMMETRY_BOUND, measure
from isomortar.harness.visits import visited_states
from isomortar.scene import Scene

_SCENE = """
format = 1
bodies.punch.geometry = { kind = "bowl", half_width = 0.3, bottom = 0.01, rise = 0.1, top = 0.5 }
bodies.punch.mesh = { order = [2, 2, 1], elements = [2, 2, 2], contact_order = 3 }
bodies.base.geometry = { kind = "box", lower = [-0.6, -0.5, -0.5], upper = [0.6, 0.5, 0] }
bodies.base.mesh = { order = [1, 2, 2], elements = [3, 2, 2], contact_order = 3 }
contacts.pair = { slave = "punch.w0", master = "base.w1", friction = 0.3, projection = "closest" }
supports.top = { face = "punch.w1" }
supports.ground = { face = "base.w0" }
stages = [{ name = "press", steps = 2, motions.top.translate = [0.01, 0, -0.06] }]
"""
PARTS = ("solid", "normal, gap", "normal, pressure", "multipliers", "whole", "symmetry")


@case(
    claim="The tangent of bodies with raised faces is exact, and the solid's symmetric.",
    tier="gate",
    grid={},
    bounds={
        part: Bound(
            at_most=SYMMETRY_BOUND if part == "symmetry" else BOUND,
            reason="round-off: products of double precision against differences of a twin in extended precision",
        )
        for part in PARTS
    },
)
def raised() -> dict[str, float]:
    """Largest relative error of each part."""
    problem = Scene.from_toml(_SCENE).problem()
    problem = replace(problem, settings=replace(problem.settings, **TIGHT))  # type: ignore[arg-type]
    report = measure(problem, 2, visited_states(problem, 2), directions=1)
    return {row.part: row.error for row in report.rows if row.part in PARTS}
