"""What is said of bodies that deform into themselves: strips that are wound up, by how far and how tightly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Face
from isomortar.scene import Scene
from isomortar.told.during.in_itself import InItself

#: A strip, and what else may be in the scene.
STRIP = """
format = 1
bodies.strip.geometry = { kind = "box", lower = [0, 0, 0], upper = [4, 0.3, 0.1] }
bodies.strip.mesh = { order = [3, 1, 1], elements = [72, 1, 1] }
bodies.other = { geometry = { kind = "box", lower = [5, 0, 0], upper = [6, 1, 1] } }
supports = { held.face = "strip.u0", base.face = "other.w0" }
stages = [{ name = "one", steps = 1 }, { name = "two", steps = 1 }]
"""
THICK = 0.1
#: A contact of the strip with another body.
ELSEWHERE = 'contacts.c = { slave = "strip.w1", master = "other.u0" }\n'
#: Degrees that a strip is wound through, how far it is from where it was after a whole turn, over its thickness, and what is in the scene.
WOUND = {
    "bent": (90.0, 0.0, ""),
    "half round": (180.0, 0.0, ""),
    "nearly closed": (350.0, 0.0, ""),
    "over its end": (370.0, 0.0, ""),
    "beside its end": (370.0, 1.3, ""),
    "half on its end": (370.0, 0.5, ""),
    "twice round": (700.0, 1.3, ""),
    "twice round, too tightly": (700.0, 0.8, ELSEWHERE),
    "in contact with itself": (370.0, 0.0, ELSEWHERE),
}
TOLD = "body 'strip' is in itself at the end of stage 'one'"
#: Of these, such as are in themselves with nothing that keeps them from it.
IN_THEMSELVES = ("over its end", "half on its end", "twice round, too tightly")


def wound(body: Body, degrees: float, apart: float) -> Body:
    """A body whose length goes round an axis, at a radius that grows."""
    along, width, across = body.patch.control_points.T
    angle = np.radians(degrees) * along / 4.0
    radius = 1.0 + across + THICK * apart * angle / (2.0 * np.pi)
    points = np.column_stack([radius * np.sin(angle), width, radius * np.cos(angle)])
    return replace(body, patch=replace(body.patch, control_points=points))


@case(
    claim="A body that comes into itself as it deforms, where no contact keeps it from that, is told of at the end of the stage, once, "
    "with a place where it does; one that only comes near itself is not.",
    tier="gate",
    bounds={
        "others": Bound(0.0, 0.0, "definition: strips of which something else is said"),
        "places": Bound(0.0, 0.0, "definition: places that are not in the strip"),
    },
)
def in_itself() -> dict[str, float]:
    """How many of nine, seen twice, and of the places."""
    others, places = 0, 0
    for name, (degrees, apart, contacts) in WOUND.items():
        problem = Scene.from_toml(STRIP + contacts).problem()
        if name == "in contact with itself":
            problem = replace(problem, contacts=(replace(problem.contacts[0], master=Face("strip", "w0")),))
        watch, bodies = InItself(problem), [wound(problem.body("strip"), degrees, apart), problem.body("other")]
        said = [*watch.after_stage(bodies, "one"), *watch.after_stage(bodies, "two")]
        others += [words.split(",")[0] for words in said] != ["body 'strip' is in itself at the end of stage 'one'"] * (
            name in IN_THEMSELVES
        )
        for words in said:
            x, _, z = (float(part) for part in words[words.index("(") + 1 : words.index(")")].split(","))
            places += not -0.02 < np.hypot(x, z) - 1.0 < THICK * (1.0 + apart * degrees / 360.0) + 0.02
    return {"others": float(others), "places": float(places)}
