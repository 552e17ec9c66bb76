"""Which bodies hang together, and which of their directions have one mesh, in whatever order they are glued."""

from __future__ import annotations

from itertools import pairwise, permutations

from isomortar.harness import Bound, case
from isomortar.model.glue import pieces, shared_directions
from isomortar.scene import Scene

#: Boxes in a row along x, from the left to the right, and one that stands apart.
ROW = ("one", "two", "three", "four")
BOX = 'bodies.{name}.geometry = {{ kind = "box", lower = [{place}, 0, 0], upper = [{end}, 1, 1] }}\nsupports.{name}.face = "{name}.v0"\n'
JOINTS = tuple(f'["{left}.u1", "{right}.u0"]' for left, right in pairwise(ROW))


@case(
    claim="Bodies that are glued in a row are one piece, and have one mesh across it, in whatever order their joints are named; where one "
    "joint lacks they are two; and what stands apart is a piece of its own.",
    tier="gate",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: pieces, and directions with one mesh, that are others, of all orders of two joints or three")
    },
)
def in_any_order() -> dict[str, float]:
    """How many."""
    wrong = 0
    for count in (2, 3):
        for joints in permutations(range(3), count):
            problem = Scene.from_toml(scene([JOINTS[k] for k in joints])).problem()
            parts = [list(part) for part in hung(joints)]
            wrong += [[body.name for body in piece] for piece in pieces(problem)] != [*parts, ["apart"]]
            alike = {frozenset(directions) for directions in shared_directions(problem)}
            alone = {frozenset({(name, letter)}) for name in (*ROW, "apart") for letter in "uvw" if letter == "u" or name == "apart"}
            wrong += alike != alone | {frozenset((name, letter) for name in part) for part in parts for letter in "vw"}
    return {"wrong": float(wrong)}


def scene(joints: list[str]) -> str:
    """With the boxes glued by some joints, in their order."""
    boxes = [BOX.format(name=name, place=k, end=k + 1) for k, name in enumerate(ROW)]
    return f"format = 1\nglue = [{', '.join(joints)}]\n" + "".join(boxes) + BOX.format(name="apart", place=9, end=10) + STAGE


STAGE = 'stages = [{ name = "stand", steps = 1 }]\n'


def hung(joints: tuple[int, ...]) -> list[tuple[str, ...]]:
    """Names of boxes that hang together, from the left."""
    found = [[ROW[0]]]
    for k, name in enumerate(ROW[1:]):
        if k in joints:
            found[-1].append(name)
        else:
            found.append([name])
    return [tuple(part) for part in found]
