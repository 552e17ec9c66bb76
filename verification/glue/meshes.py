"""Directions that have one mesh because bodies are glued: of a row of bodies, in whatever order they are glued."""

from __future__ import annotations

from itertools import pairwise, permutations

from isomortar.harness import Bound, case
from isomortar.model.glue import shared_directions
from isomortar.scene import Scene

#: Bodies of a row along x, and one that is by itself.
ROW, ALONE = "abcd", "e"


@case(
    claim="Bodies that are glued in a row have one mesh across it, all of them, and each its own along it, in whatever order.",
    tier="gate",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: orders in which directions are left out, told twice, or said to be shared and are not"),
        "orders": Bound(at_least=40.0, reason="definition: of three joints, either of whose faces may come first"),
    },
)
def row() -> dict[str, float]:
    """How many."""
    boxes = [
        f'bodies.{name}.geometry = {{ kind = "box", lower = [{k}, 0, 0], upper = [{k + 1}, 1, 1] }}' for k, name in enumerate(ROW + ALONE)
    ]
    joints = [(f"{one}.u1", f"{other}.u0") for one, other in pairwise(ROW)]
    expected = {frozenset((name, letter) for name in ROW) for letter in "vw"}
    expected |= {frozenset({(name, "u")}) for name in ROW} | {frozenset({(ALONE, letter)}) for letter in "uvw"}
    wrong = orders = 0
    for order in permutations(joints):
        for turned in range(2 ** len(joints)):
            glue = [list(joint[:: -1 if turned >> k & 1 else 1]) for k, joint in enumerate(order)]
            text = "\n".join(
                ["format = 1", *boxes, f"glue = {glue}".replace("'", '"'), 'supports = { end.face = "a.u0", alone.face = "e.u1" }']
            )
            found = shared_directions(Scene.from_toml(text + '\nstages = [{ name = "rest", steps = 1 }]').problem())
            wrong += {frozenset(group) for group in found} != expected or len(found) != len(expected)
            orders += 1
    return {"wrong": float(wrong), "orders": float(orders)}
