"""What looking at a scene before its first load step takes, beside what there is of it."""

from __future__ import annotations

import tracemalloc
from unittest.mock import patch

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.checks import check
from isomortar.model.stance import _on_face
from isomortar.scene import Scene

#: A plate half of whose control points are held, and nothing else.
_PLATE = """
format = 1
bodies.plate.geometry = {{ kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.1] }}
bodies.plate.mesh = {{ order = [1, 1, 1], elements = [{n}, {n}, 1] }}
supports.top.face = "plate.w1"
stages = [{{ name = "lift", steps = 1, motions.top.translate = [0, 0, 0.1] }}]
"""


def taken(elements: int) -> tuple[int, int]:
    """Bytes that checks and doubts hold at once at most, and the scene's control points."""
    problem = Scene.from_toml(_PLATE.format(n=elements)).problem()
    tracemalloc.start()
    check(problem)
    list(Simulation(problem).doubts())
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return peak, sum(len(body.patch.weights) for body in problem.bodies)


@case(
    claim="Looking at a scene before its first load step takes memory as its control points do, however many of them a support holds.",
    tier="gate",
    bounds={"growth": Bound(at_most=1.5, at_least=0.5, reason="definition: as many bytes a control point, and a half for what is small")},
)
def looked_at() -> dict[str, float]:
    """Twelve elements along each side, and forty-eight."""
    (few, fewer), (many, more) = taken(12), taken(48)
    return {"growth": (many / more) / (few / fewer)}


@case(
    claim="How a slave and its master stand is found out once from the scene's file to its first load step.",
    tier="gate",
    bounds={"times": Bound(1, 1, reason="definition: what is known of a problem is not found out of the same problem again")},
)
def found_out_once() -> dict[str, float]:
    """How often it is found out of two blocks."""
    with patch("isomortar.model.stance._on_face", wraps=_on_face) as stands:
        list(Simulation(Scene.load("block").problem()).doubts())
    return {"times": float(stands.call_count)}
