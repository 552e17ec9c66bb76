"""How far supports go: refused is where they have gone too far by the end of a stage, and not what they go within it."""

from __future__ import annotations

import re

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.scene import Scene

#: A block of length one that goes along in several stages, beside one a thousand times as large, which would have digits left.
SCENE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
supports.base.face = "block.w0"
bodies.large.geometry = { kind = "box", lower = [5, 0, 0], upper = [1005, 1000, 1000] }
supports.large.face = "large.w0"
"""
#: Far, but 1e-3 is still more than the last bit there; so it is at twice as far, and at three times no more.
FAR = 3e12
#: Ways along x, y and z by stage, and the stage that is refused; 0: none.
WAYS = (
    (((FAR, 0, 0), (FAR, 0, 0), (FAR, 0, 0)), 3),
    (((FAR, 0, 0), (-FAR, 0, 0), (FAR, 0, 0)), 0),
    (((FAR, 0, 0), (0, FAR, 0), (0, 0, FAR)), 0),
    (((0, 0, -FAR), (0, 0, -FAR), (0, 0, -FAR)), 3),
    (((0, 3 * FAR, 0), (0, -3 * FAR, 0), (0, 0, 0)), 1),
    (((0, -FAR, 0), (0, -2 * FAR, 0), (0, 3 * FAR, 0)), 2),
    (((0, FAR, 0), (0, FAR, 0), (0, -FAR, 0)), 0),
)


@case(
    claim="A support that has gone so far by the end of a stage that its body has no digits left is refused, in that stage.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes that are refused for another stage, or for none, or should not be")},
)
def ways_of_stages() -> dict[str, float]:
    """How many of seven scenes."""
    wrong = 0
    for ways, stage in WAYS:
        stages = ", ".join(f'{{ name = "s{k}", steps = 1, motions.base.translate = {list(way)} }}' for k, way in enumerate(ways, 1))
        try:
            Scene.from_toml(f"{SCENE}stages = [{stages}]").problem()
            named = 0
        except InputError as error:
            found = re.search(r"stages\.s(\d)\.motions\.base\.translate", str(error))
            named = int(found[1]) if found else -1
        wrong += named != stage
    return {"wrong": float(wrong)}


#: A block above a plane, and motions along x and z.
ABOVE = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = [2, 2, 1] }
contacts.c = { slave = "block.w0", plane = { point = [0, 0, -GAP] }, smoothing = SMOOTHING }
supports.top.face = "block.w1"
stages = [{ name = "go", steps = 10, motions.top.translate = [ALONG, 0, DOWN] }]
"""
SENTENCES = {"flat": "they would be pressed flat", "apart": "it cannot close", "away": "take its sides away from each other"}
#: Gap, smoothing, the motion along and down, and what is said.
NEARER: tuple[tuple[float, float, float, float, list[str]], ...] = (
    (0.5, 0, 0, -0.6, []),
    (0.5, 0, 1, -0.4, []),
    (0.5, 0, 1, -0.2, ["apart"]),
    (3.0, 0, 0, -3.2, []),
    (3.0, 0, 0, -5.0, ["flat"]),
    (0.0, 0, 0, 0.1, ["away"]),
    (0.0, 0.001, 0, 0.1, []),
)


@case(
    claim="That motions press bodies flat, do not bring them together or take them apart is said where they do, and only there.",
    tier="gate",
    bounds={"others": Bound(0.0, 0.0, "definition: scenes of which another one of these is said, or none")},
)
def nearer() -> dict[str, float]:
    """How many of seven scenes."""
    others = []
    for gap, smoothing, along, down, expected in NEARER:
        text = ABOVE
        for word, value in {"GAP": gap, "SMOOTHING": smoothing, "ALONG": along, "DOWN": down}.items():
            text = text.replace(word, str(value))
        warnings = outlook(Scene.from_toml(text).problem()).warnings
        said = [name for name, words in SENTENCES.items() for warning in warnings if words in warning]
        others += [(gap, down)] if said != expected else []
    return {"others": float(len(others))}
