"""How far supports go: refused is where they have gone too far by the end of a stage, and not what they go within it."""

from __future__ import annotations

import re

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.scene import Scene

#: A block of length one that goes along in several stages.
SCENE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
supports.base.face = "block.w0"
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
