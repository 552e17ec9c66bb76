"""Supports that ask different things of the same control points: refused, whichever of several it is; those that agree are not."""

from __future__ import annotations

from itertools import permutations

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.scene import Scene

#: A block that is held below. Of the edges of its upper face a and b are opposite to each other, and c ends at both.
SCENE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
supports.base.face = "block.w0"
stages = [{ name = "one", steps = 1, motions = { MOTIONS } }, { name = "two", steps = 1 }]
"""
EDGES = {"a": "block.u0.w1", "b": "block.u1.w1", "c": "block.v0.w1"}
ALL, BOTH = '["x", "y", "z"]', ("one", "two")
#: Components of a, b and c, how far each goes along z in the first stage, where c holds, and which two contradict each other.
CASES = (
    ((ALL, ALL, ALL), (1, 1, 1), BOTH, ""),
    ((ALL, ALL, ALL), (1, 0, 1), BOTH, "bc"),
    ((ALL, ALL, ALL), (0, 1, 1), BOTH, "ac"),
    ((ALL, '["x", "y"]', ALL), (0, 0, 1), BOTH, "ac"),
    (('["x", "y"]', ALL, ALL), (0, 0, 1), BOTH, "bc"),
    (('["z"]', '["z"]', '["x", "y"]'), (1, 2, 0), BOTH, ""),
    (('["x", "y"]', ALL, '["x", "z"]'), (0, 1, 1), BOTH, ""),
    ((ALL, ALL, ALL), (1, 1, 0), ("two",), ""),
)


def named(order: tuple[str, ...], components: tuple[str, ...], ways: tuple[int, ...], stages: tuple[str, ...]) -> str:
    """Which of the supports, given in some order, a scene is refused for; `stages`: in which c holds; empty: it is not refused."""
    motions = [f"{name}.translate = [0, 0, {0.01 * way}]" for name, way in zip("abc", ways, strict=True) if way]
    text = SCENE.replace("MOTIONS", ", ".join(motions))
    for name in order:
        held = f", stages = {list(stages)}" if name == "c" else ""
        text += f'supports.{name} = {{ edge = "{EDGES[name]}", components = {components["abc".index(name)]}{held} }}\n'
    try:
        Scene.from_toml(text).problem()
    except InputError as error:
        return "".join(name for name in "abc" if f"supports.{name}" in str(error) or f"support {name!r}" in str(error))
    return ""


@case(
    claim="Supports that move the same control points differently are refused by their names, in whatever order; no others are.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes that are refused for other supports, or for none, or should not be")},
)
def contradicting() -> dict[str, float]:
    """How many of eight scenes in six orders each."""
    tried = [(order, *scene) for scene in CASES for order in permutations("abc")]
    return {"wrong": float(sum(named(order, *given) != pair for order, *given, pair in tried))}


#: Angles, axes and centres of a and c where these turn, and whether they contradict each other: the end that they share is at the origin
#: of the upper face.
TURNED = (
    ((30, "[0, 0, 1]", "[0, 0, 1]"), (30, "[0, 0, 1]", "[0, 0, 1]"), False),
    ((30, "[0, 0, 1]", "[0, 0, 1]"), (30, "[0, 0, 1]", "[0.5, 0.5, 1]"), True),
    ((30, "[0, 0, 1]", "[0, 0, 1]"), (30, "[0, 1, 0]", "[0, 0, 1]"), True),
    ((30, "[0, 0, 1]", "[0, 0, 1]"), (20, "[0, 0, 1]", "[0, 0, 1]"), True),
    ((30, "[0, 0, 1]", "[0, 0, 1]"), (0, "[0, 0, 1]", "[0, 0, 1]"), True),
)


@case(
    claim="Of two supports that turn the same control points angle, axis and centre are to be the same; else they are refused.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes that are refused and should not be, or the other way round")},
)
def turning_together() -> dict[str, float]:
    """How many of five scenes in both orders."""
    wrong = 0
    for *turns, contradict in TURNED:
        for order in ("ac", "ca"):
            given = dict(zip("ac", turns, strict=True))
            text = SCENE.replace("MOTIONS", ", ".join(f"{name}.rotate = {given[name][0]}" for name in order))
            for name in order:
                _, axis, centre = given[name]
                text += f'supports.{name} = {{ edge = "{EDGES[name]}", axis = {axis}, centre = {centre} }}\n'
            try:
                Scene.from_toml(text).problem()
            except InputError as error:
                wrong += not contradict or "moves differently" not in str(error)
            else:
                wrong += contradict
    return {"wrong": float(wrong)}
