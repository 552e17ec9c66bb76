"""What is said of bodies that slide and tip at once, as in a corner: neither friction nor a base alone is what lacks."""

from __future__ import annotations

import re

from told.too_steep import said

from isomortar.harness import Bound, case

#: A block on a floor and against a wall, both rough, whose weight leans.
SCENE = """
format = 1
materials.soft.young = 1e4
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, HEIGHT] }, mesh.elements = [4, 2, 2] }
contacts.floor = { slave = "block.w0", friction = FRICTION, FLOOR }
contacts.wall = { slave = "block.u1", friction = FRICTION, WALL }
loads.own = { body = "block", weight = WEIGHT }
solver = { method = "METHOD", max_cuts = 1, max_iterations = 15 }
stages = [{ name = "stand", steps = 1 }]
"""
GROUNDS = {
    "planes": ("plane = {}", "plane = { point = [1, 0, 0], normal = [-1, 0, 0] }"),
    "bodies": (
        'master = "table.w1" }\nbodies.table = { rigid = true, geometry = { kind = "box", lower = [-2, -2, -1], upper = [3, 3, 0] }',
        'master = "side.u0" }\nbodies.side = { rigid = true, geometry = { kind = "box", lower = [1, -2, -1], upper = [2, 3, 4] }',
    ),
}
#: Heights, and weights by which friction of 0.3 holds the block and by which nothing does: that slides from the wall, along it and up it.
WAYS = {
    "away": (0.5, (-0.24, 0.0, -1.0), (-0.4, 0.0, -1.0)),
    "away, tipping": (2.0, (-0.2, 0.0, -1.0), (-0.7, 0.0, -1.0)),
    "along": (0.5, (0.5, 0.3, -1.0), (0.5, 0.6, -1.0)),
    "along, tipping": (2.0, (0.5, 0.25, -1.0), (0.5, 0.9, -1.0)),
    "up": (0.5, (1.5, 0.0, 0.3), (1.5, 0.0, 0.6)),
}
TOLD = re.compile(
    r"No pressures of contact 'floor' and 'wall', with the friction that they have, are in balance with the loads on body 'block'"
)


def in_corner(height: float, weight: tuple[float, float, float], method: str, ground: str, friction: str = "0.3") -> str:
    """Why a block does not stand; nothing, if it does."""
    floor, wall = GROUNDS[ground]
    scene = SCENE.replace("HEIGHT", str(height)).replace("WEIGHT", str(list(weight))).replace("FLOOR", floor).replace("WALL", wall)
    return said(scene.replace("METHOD", method).replace("FRICTION", friction))


def gives_way(sentence: str) -> bool:
    """Whether that is told: that nothing holds the block, or where it only slides how much friction can bear."""
    return bool(TOLD.search(sentence)) or "where friction of contact 'floor' and 'wall' can bear about" in sentence


@case(
    claim="A block in a rough corner that nothing holds is told to slide or to tip, though neither alone would be told, and to take more "
    "friction if twice as much would hold it; one that is held stands.",
    tier=lambda ground, method: "gate" if (ground, method) in (("bodies", "monolithic"), ("planes", "uzawa")) else "nightly",
    grid={"ground": tuple(GROUNDS), "method": ("monolithic", "uzawa")},
    bounds={
        "restless": Bound(0.0, 0.0, "definition: of five blocks, those that do not stand though they are held"),
        "silent": Bound(0.0, 0.0, "definition: of five, those that nothing holds of which something else is told"),
        "cures": Bound(0.0, 0.0, "definition: those told to take more friction that twice of it does not hold, or not told though it does"),
        "cohesive": Bound(0.0, 0.0, "definition: those told though a cohesion holds them, too, by which sum is not known"),
    },
)
def in_corners(ground: str, method: str) -> dict[str, float]:
    """How many of each."""
    ways = WAYS.values()
    said_of = [in_corner(height, goes, method, ground) for height, _, goes in ways]
    cohesive = [in_corner(height, goes, method, ground, "0.3, cohesion = 0.01") for height, _, goes in ways]
    twice = [in_corner(height, goes, method, ground, "0.6") for height, _, goes in ways]
    return {
        "restless": float(sum(in_corner(height, holds, method, ground) != "" for height, holds, _ in ways)),
        "silent": float(sum(not gives_way(sentence) for sentence in said_of)),
        "cures": float(sum(("more friction" in one) == gives_way(two) for one, two in zip(said_of, twice, strict=True))),
        "cohesive": float(sum(bool(TOLD.search(sentence)) for sentence in cohesive)),
    }
