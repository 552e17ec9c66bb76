"""What is said of a body that loads push along or tip over, beside another one that rests, or on it: its weight does not matter."""

from __future__ import annotations

from told.tipping import GROUNDS as TIPPING_GROUNDS
from told.tipping import LOADS as TIPPING_LOADS
from told.tipping import SCENE as TIPPING
from told.tipping import TOLD
from told.too_steep import BLOCK, FLOOR, HEAD, ON_TOP, PUSHED, over, said

from isomortar.harness import Bound, case

SOFT = 'material = "soft", '
#: A block that rests beside, of so much weight, and pushed by a third of what friction bears.
STONE = """
bodies.stone = { geometry = { kind = "box", lower = [9, 0, 0], upper = [10, 1, 0.3] }, mesh.elements = [2, 2, 1], material = "hard" }
materials.hard.young = YOUNG
contacts.ground = { slave = "stone.w0", friction = 0.3, plane = {} }
loads.stone = { body = "stone", weight = [ALONG, 0, -WEIGHT] }
"""
#: A block that slides, or tips, or rests, and one that slides on a heavy one.
SLIDES = (
    (HEAD + BLOCK + FLOOR + PUSHED)
    .replace("FRICTION", "0.3")
    .replace("ASIDE", "0")
    .replace("bodies.block = {", f"bodies.block = {{ {SOFT}")
)
TIPS = (
    TIPPING.replace("GROUND", TIPPING_GROUNDS["plane"]).replace("LOADS", TIPPING_LOADS["weight"]).replace("METHOD", "monolithic")
    .replace("bodies.block = {", f"bodies.block = {{ {SOFT}")
)  # fmt: skip
PILE = (
    HEAD + BLOCK + ON_TOP + FLOOR.replace("FRICTION", "0.3") + 'contacts.mid = { slave = "top.w0", master = "block.w1", friction = 0.2 }\n'
)
#: Weights beside a light one of 2, or below it up to 1e7 times that.
HEAVY = {"as heavy": 2.0, "of stone": 2e3, "of lead": 2e5, "a house": 2e9}


def sentence(scene: str, weight: float) -> str:
    """Why a scene comes to no end beside a stone of that weight."""
    stone = STONE.replace("YOUNG", f"{50.0 * weight:.1f}").replace("WEIGHT", f"{weight:.1f}").replace("ALONG", f"{0.1 * weight:.2f}")
    return said(scene + stone)


@case(
    claim="Of a body that friction can not hold, or that loads tip over, the same is said beside another one that rests, however heavy it "
    "is; and of one that lies on another one, up to 1e7 times as heavy.",
    tier="gate",
    grid={"heavy": tuple(HEAVY)},
    bounds={
        "slides": Bound(at_most=0.01, reason="round-off: three digits are told of each number, load over limit"),
        "tips": Bound(0.0, 0.0, "definition: of soft and stiff bodies that tip over those that are not told"),
        "silent": Bound(0.0, 0.0, "definition: of a body that rests, and one that tips, those of which it is said that it slides"),
        "on top": Bound(at_most=0.01, reason="round-off: three digits are told of each number, load over limit"),
    },
)
def company(heavy: str) -> dict[str, float]:
    """How far off, and how many."""
    weight = HEAVY[heavy]
    below = min(weight, 2e7)
    tips = [sentence(TIPS.replace("LEAN", lean).replace("YOUNG", young), weight) for lean, young in (("0.7", "10000"), ("0.41", "100"))]
    rests = sentence(SLIDES.replace("FORWARDS", "0.5"), weight)
    pile = PILE.replace('block = { body = "block", weight = [1, 0, -2] }', f'block = {{ body = "block", weight = [0, 0, {-below}] }}')
    return {
        "slides": abs(over(sentence(SLIDES.replace("FORWARDS", "1.2"), weight)) / 2.0 - 1.0),
        "tips": float(sum((found := TOLD.search(s)) is None or found[3] != "0, 1, 0" for s in tips)),
        "silent": float(sum(over(s) > 0.0 for s in (rests, *tips))),
        "on top": abs(over(said(pile.replace("young = 100", f"young = {50.0 * below}"))) / 2.5 - 1.0),
    }


#: Two blocks far from each other: one leans, the other is pushed along or up.
APART = """
format = 1
materials.m = { young = 1e4, poisson = 0.3 }
bodies.a = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 2] }, mesh = { elements = [2, 2, 1] }, material = "m" }
bodies.b = { geometry = { kind = "box", lower = [8, 0, 0], upper = [9, 1, 0.3] }, mesh = { elements = [2, 2, 1] }, material = "m" }
contacts.a = { slave = "a.w0", plane = {}, friction = 0.9 }
contacts.b = { slave = "b.w0", plane = {}, friction = 0.3 }
loads.a = { body = "a", weight = [LEAN, 0, -1] }
loads.b = { body = "b", weight = OTHER }
solver = { max_cuts = 1, max_iterations = 15 }
stages = [{ name = "p", steps = 2 }]
"""
#: Loads of both, and what is said of each.
EACH = {
    "tips, and holds barely": ("0.7", "[0.285, 0, -1]", ("turn body 'a'", "body 'b'")),
    "tips, and slides": ("0.7", "[0.5, 0, -1]", ("turn body 'a'", "push body 'b'")),
    "tips, and lifts": ("0.7", "[0, 0, 1]", ("turn body 'a'", "move body 'b'")),
    "tips, and rests": ("0.7", "[0, 0, -1]", ("turn body 'a'",)),
    "rests, and lifts": ("0.1", "[0, 0, 1]", ("move body 'b'",)),
}


@case(
    claim="Of bodies that do not touch each is told what its own loads do, whatever is told of another one.",
    tier="gate",
    grid={"loads": tuple(EACH)},
    bounds={"missing": Bound(0.0, 0.0, "definition: bodies of which nothing, or something else, is said")},
)
def each_by_itself(loads: str) -> dict[str, float]:
    """Of how many."""
    lean, other, words = EACH[loads]
    sentence = said(APART.replace("LEAN", lean).replace("OTHER", other))
    return {"missing": float(sum(word not in sentence for word in words))}
