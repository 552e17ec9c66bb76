"""What is said of a body that can go without forces: that it moves or turns, and along what, wherever it is and however large."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.singular import explain
from isomortar.solve.timing import Ledger

#: A box at some place, of some size, whose support is taken away.
SCENE = """
format = 1
bodies.block.geometry = {{ kind = "box", lower = [{place}, {place}, 0], upper = [{end}, {end}, {size}] }}
bodies.block.mesh.elements = 2
contacts.base = {{ slave = "block.w0", plane = {{ point = [0, 0, 0] }}, friction = 0.0 }}
supports.top.face = "block.w1"
stages = [{{ name = "stand", steps = 1 }}]
"""
#: Directions, and how they are told.
ALONG = {"(1, 0, 0)": (2.0, 0.0, 0.0), "(0, 1, 0)": (0.0, -3.0, 0.0), "(0, -0.5, 1)": (0.0, -0.5, 1.0)}


@case(
    claim="A body that can go freely is told to move or to turn, and along what, wherever it is and in any unit; one that deforms is not.",
    tier="gate",
    grid={"size": (1e-3, 1.0, 1e3), "away": (0.0, 1e3)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: motions in closed form of which something else is said")},
)
def goes_freely(size: float, away: float) -> dict[str, float]:
    """How many."""
    place = away * size
    problem = Scene.from_toml(SCENE.format(place=place, end=place + size, size=size)).problem()
    equilibrium = Equilibrium(replace(problem, supports=()), Ledger())
    positions, wrong = equilibrium.initial_state().positions, 0
    arms = (positions - positions.mean(axis=0)) / size

    def said(motion: np.ndarray) -> str:
        return str(explain(0.0, motion.ravel()[equilibrium.supports.free], equilibrium.supports, positions, equilibrium.numbering, []))

    for words, way in ALONG.items():
        shift, turn = np.tile(way, (len(arms), 1)), np.cross(way, arms)
        wrong += f"body 'block' can move along {words} freely" not in said(shift)
        wrong += f"body 'block' can turn about an axis along {words} freely" not in said(turn)
        wrong += f"body 'block' can turn about an axis along {words} freely" not in said(turn + 0.5 * shift)
        wrong += "freely" in said(turn * arms[:, :1])
    return {"wrong": float(wrong)}
