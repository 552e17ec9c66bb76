"""What is said of tolerances that ask for more digits than round-off leaves: which, and with what the scene comes to its end."""

from __future__ import annotations

import re
import tomllib

from told.too_steep import said

from isomortar.harness import Bound, case

#: A block that is pressed and pushed over two that are glued to one.
SCENE = """
format = 1
bodies.near = { geometry = { kind = "box", lower = [0, 0, 0], upper = [0.7, 1.1, 0.6] }, mesh.elements = [3, 3, 2] }
bodies.far = { geometry = { kind = "box", lower = [0.7, 0, 0], upper = [1.3, 1.1, 0.6] }, mesh.elements = [2, 3, 2] }
bodies.block = { geometry = { kind = "box", lower = [0.2, 0.3, 0.6], upper = [0.9, 0.83, 1.1] }, mesh.elements = [3, 3, 2] }
glue = [["near.u1", "far.u0"]]
contacts.c = { slave = "block.w0", master = ["near.w1", "far.w1"], enforcement = "dual" }
supports = { near.face = "near.w0", far.face = "far.w0", top = { face = "block.w1", force = { z = -0.2 }, components = ["x", "y"] } }
loads.push = { face = "block.u1", pressure = 0.05 }
solver = { SOLVER }
stages = [{ name = "press", steps = 1 }]
"""
TIGHT = {
    "of contact": "complementarity_tolerance = 1e-15, max_cuts = 1",
    "both": "complementarity_tolerance = 1e-15, newton_tolerance = 1e-15, max_cuts = 1",
    "of increments so short that more is left": "complementarity_tolerance = 1e-15, max_cuts = 14",
}
TOLD = re.compile(r"next to round-off: take (solver\..*), the default")


def ending(solver: str) -> str:
    """Why a scene comes to no end; nothing, if it does."""
    return said(SCENE.replace("SOLVER", solver))


def cured(solver: str, told: str) -> bool:
    """Whether the scene comes to its end with what is told."""
    given = tomllib.loads(f"solver = {{ {solver} }}")["solver"]
    given |= tomllib.loads(told.replace(" and ", "\n"))["solver"]
    return ending(", ".join(f"{key} = {value!r}" for key, value in given.items())) == ""


@case(
    claim="Tolerances that ask for more digits than round-off leaves are told, and with those that are advised the scene comes to its end; "
    "what leaves more than that is not told so.",
    tier="gate",
    bounds={
        "silent": Bound(0.0, 0.0, "definition: of three scenes, those that come to no end and are not told so"),
        "cured": Bound(3.0, 3.0, "definition: of these, those that come to their end as they are told"),
        "others": Bound(0.0, 0.0, "definition: sentences on tolerances where too few iterations are what lacks"),
    },
)
def too_tight() -> dict[str, float]:
    """How many of each."""
    found = {name: TOLD.search(ending(solver)) for name, solver in TIGHT.items()}
    few = [ending(f"{solver}, max_iterations = 1") for solver in TIGHT.values()]
    return {
        "silent": float(sum(told is None for told in found.values())),
        "cured": float(sum(told is not None and cured(TIGHT[name], told[1]) for name, told in found.items())),
        "others": float(sum("round-off" in sentence for sentence in few)),
    }
