"""Load steps that are linear, of bodies of small strains on what is rigid and flat: each takes a single solve."""

from __future__ import annotations

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A pad, held above, on a rigid block; all of its lower face is in contact from the first load step on.
SCENE = """
format = 1
solver.measures = []
materials.m = { young = 1, poisson = 0.3, law = "linear-elastic" }
bodies.pad = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }, mesh = { order = 2, elements = [2, 2, 1] } }
bodies.block = { geometry = { kind = "box", lower = [-1, -1, -1], upper = [2, 2, 0] }, rigid = true }
contacts.between = { slave = "pad.w0", master = "block.w1", friction = 0, projection = "closest" }
supports.top.face = "pad.w1"
supports.under.face = "block.w0"
stages = [{ name = "press", steps = 3, motions.MOVES.translate = [0, 0, WAY] }]
"""
WAYS = {"top": "-0.003", "under": "0.003"}


@case(
    claim="Where all is linear and the same constraints stay active a load step takes one solve, whichever side its support moves.",
    tier="gate",
    grid={"moves": tuple(WAYS)},
    bounds={"solves": Bound(1.0, 1.0, "theory: Newton's method solves linear equations in one step (5.4)")},
)
def linear(moves: str) -> dict[str, float]:
    """Tangents of the last load step."""
    *_, last = Simulation(Scene.from_toml(SCENE.replace("MOVES", moves).replace("WAY", WAYS[moves])).problem()).run()
    return {"solves": float(sum(len(record.iterations) - 1 for record in last.augmentations))}
