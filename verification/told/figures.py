"""What is told of a scene before a run, against what the scene says: sizes, meshes, motions, forces, and how bodies stand."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.scene import Scene

#: A lid on a stem that is glued to it, above a plane, and a bar on its own; no two numbers are the same.
SCENE = """
format = 1
glue = [["lid.w0", "stem.w1"]]
materials.soft = { young = 3, poisson = 0.2 }
materials.hard = { young = 7, poisson = 0.3, law = "linear-elastic" }
[bodies.lid]
geometry = { kind = "box", lower = [0, 0, 1], upper = [2, 3, 1.5] }
mesh = { order = [2, 2, 1], elements = [4, 2, 1], grading = [4, 1, 1] }
material = "soft"
[bodies.stem]
geometry = { kind = "box", lower = [0, 0, 0.25], upper = [2, 3, 1] }
mesh = { order = [2, 2, 1], elements = [4, 2, 3], grading = [4, 1, 1] }
material = "hard"
[bodies.bar]
geometry = { kind = "box", lower = [9, 0, 0], upper = [14, 0.5, 0.75] }
mesh = { family = "L", order = [1, 2, 1], elements = [2, 1, 2] }
material = "soft"
[bodies.anvil]
geometry = { kind = "ring", centre = [3.5, 4, 0.5], inner = 0.25, outer = 0.75, width = 2 }
rigid = true
[contacts]
floor = { slave = "stem.w0", plane = { point = [0, 0, 0.125] }, friction = 0.1, quadrature = [3, 4] }
side = { slave = "stem.u1", master = "anvil.v1", friction = 0, quadrature = [4, 5], enforcement = "greville" }
[supports]
top = { face = "lid.w1", components = ["y"], force = { z = -0.25 } }
wall = { face = "bar.u0", axis = [1, 0, 0], centre = [9, 0.25, 0.5] }
end = { face = "bar.u1", axis = [1, 0, 0], centre = [14, 0.25, 0.5], stages = ["there", "on"] }
hub.face = "anvil.v0"
[loads]
own = { body = "lid", weight = [0, 0.5, -0.125] }
wind = { face = "bar.v0", pressure = 0.0625 }
[[stages]]
name = "there"
steps = 2
motions.end = { translate = [3, 0, 4], rotate = 10 }
motions.top.translate = [2, 0.5, 0]
[[stages]]
name = "on"
steps = 3
motions.end.rotate = -25
motions.hub.translate = [-1, -2, 2]
motions.top.translate = [0, -1, 0]
[[stages]]
name = "free"
steps = 5
"""
#: Elements of a geometric series along u: the last one is four times as long as the first.
_RATIO = 4.0 ** (1.0 / 3.0)
_SHORTEST = 2.0 / sum(_RATIO**k for k in range(4))
#: As `BodyOutlook` has them. The lid is held along y and as a plate along z, which leaves it x and z; the stem goes with it.
BODIES = {
    "lid": ("neo-hookean", 3.0, 0.2, (2.0, 3.0, 0.5), tuple("NNN"), (2, 2, 1), (4, 2, 1), _SHORTEST, 1.5, (1.0, 1.0), 48, 2),
    "stem": ("linear-elastic", 7.0, 0.3, (2.0, 3.0, 0.75), tuple("NNN"), (2, 2, 1), (4, 2, 3), _SHORTEST, 1.5, (1.0, 1.0), 96, 2),
    "bar": ("neo-hookean", 3.0, 0.2, (5.0, 0.5, 0.75), tuple("LLL"), (1, 2, 1), (2, 1, 2), 0.375, 2.5, (1.0, 1.0), 27, 0),
    "anvil": ("rigid", None, None, (1.5, 2.0, 1.5), tuple("NNN"), (2, 2, 2), (4, 1, 1), np.sqrt(0.5), 2.0, (np.sqrt(0.5), 1.0), 81, 0),
}
#: As `ContactOutlook` has them but for what is apart: 3 x 4 points in 4 x 2 elements, and a point for each control point of stem.u1.
CONTACTS = {
    "floor": ("stem.w0", "a rigid plane", "along the plane's normal", "mortar", 96),
    "side": ("stem.u1", "anvil.v1", "closest points", "greville", 24),
}
#: As `SupportOutlook` has them. Ways of 0.5 and 1 along y, what is along x does nothing; of 5 and turns by 10 and 25 degrees, of 3.
SUPPORTS = {
    "top": ("lid.w1", "y", 1.5, 0.0, (None, None, -0.25), None, ()),
    "wall": ("bar.u0", "xyz", 0.0, 0.0, (), None, ()),
    "end": ("bar.u1", "xyz", 5.0, 35.0, (), None, ("there", "on")),
    "hub": ("anvil.v0", "xyz", 3.0, 0.0, (), None, ()),
}
LOADS = {"own": ("weight", "lid", (0.0, 0.5, -0.125)), "wind": ("pressure", "bar.v0", (0.0625,))}
#: Of 120 control points of what is glued 24 have no y and one z in common, and 9 of the bar are free.
UNKNOWNS = 3 * 120 - 24 - 23 + 3 * 9


def entries(told: Iterable[Any]) -> dict[str, list[Any]]:
    """What is told by names, each without it, in single entries."""
    return {of.name: list(flat([getattr(of, field.name) for field in fields(of)[1:]])) for of in told}


def flat(values: Iterable[Any]) -> Iterator[Any]:
    """The entries of what is nested; words stay."""
    for value in values:
        if isinstance(value, (list, tuple)):
            yield from (len(value), *flat(value))
        else:
            yield value


def wrong(told: Iterable[Any], expected: Mapping[str, Sequence[Any]]) -> int:
    """How many entries are others than those expected, which may be the first ones alone."""
    found = entries(told)
    count = len(found.keys() ^ expected.keys())
    for name, values in expected.items():
        pairs = zip(found.get(name, []), flat(values), strict=False)
        count += sum(not (np.isclose(a, b, rtol=1e-12, atol=0.0) if isinstance(b, float) else a == b) for a, b in pairs)
    return count


@case(
    claim="What is told of bodies, contacts, supports and loads before a run is what the scene says, by its own numbers.",
    tier="gate",
    bounds={
        **dict.fromkeys(
            ("bodies", "contacts", "supports", "loads"), Bound(0.0, 0.0, "definition: entries that are not what the scene says")
        ),
        "counts": Bound(0.0, 0.0, "definition: unknowns and load steps, counted by hand"),
        "apart": Bound(at_most=1e-12, reason="round-off: the stem is an eighth above the plane"),
    },
)
def first_look() -> dict[str, float]:
    """How many entries are wrong; by how much unknowns and load steps are, and the distance of the plane."""
    told = outlook(Scene.from_toml(SCENE).problem())
    return {
        "bodies": float(wrong(told.bodies, BODIES)),
        "contacts": float(wrong(told.contacts, CONTACTS)),
        "supports": float(wrong(told.supports, SUPPORTS)),
        "loads": float(wrong(told.loads, LOADS)),
        "counts": float(abs(told.unknowns - UNKNOWNS) + abs(told.load_steps - 10)),
        "apart": abs(told.contacts[0].apart - 0.125),
    }
