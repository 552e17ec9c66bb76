"""What dials of a trade and of advice make of a scene: the scene itself at its own settings, at others a change of what they name."""

from __future__ import annotations

import re
from itertools import pairwise

from isomortar.harness import Bound, case
from isomortar.results.comparison import differences
from isomortar.scene import Scene
from isomortar.trade.advice import VARIANTS
from isomortar.trade.knobs import KNOBS, changed, dials_of

#: Two bodies of other sizes and meshes, their control points nowhere even; a stage of each kind.
SCENE = """
format = 1
[bodies.block]
geometry = { kind = "box", lower = [0.25, 0.5, 0], upper = [1.25, 1.5, 0.5] }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[bodies.base]
geometry = { kind = "box", lower = [-1.5, -0.5, -0.5], upper = [3, 2.5, 0] }
mesh = { order = [1, 1, 2], elements = [1, 2, 1] }
[contacts]
between = { slave = "block.w0", master = "base.w1", friction = 0.3 }
side = { slave = "block.u1", plane = { point = [2, 0, 0], normal = [-1, 0, 0] }, friction = 0 }
[supports]
ground.face = "base.w0"
top.face = "block.w1"
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0, 0, -0.01]
[[stages]]
name = "drag"
steps = 4
motions.top.translate = [0.05, 0, 0]
"""
#: What no difference is called.
UNKNOWN = "unknown"
#: What of a problem a dial changes, by its name: a pattern that each difference has.
CHANGES = {
    r"order at the contact of (\w+)": r"bodies\.{0}\.",
    r"order of (\w+)": r"bodies\.{0}\.",
    r"elements of (\w+)": r"bodies\.{0}\.",
    r"quadrature of (block|base)": r"bodies\.{0}\.quadrature",
    r"quadrature of (\w+)": r"contacts\.{0}\.quadrature",
    r"(subcells|elastic slip|smoothing|enforcement|projection) of (\w+)": r"contacts\.{1}\.{0}",
    r"load steps of (\w+)": r"stages\.{0}\.steps",
    r"tolerance": r"settings\.(newton|complementarity)_tolerance",
    r"method|slip sum": r"settings\.{0}",
    r"friction of (\w+)": r"contacts\.{0}\.(friction|cohesion)",
    r"(\w+) rigid": r"bodies\.{0}\.",
    r"the scene beyond y = 1": r"symmetry|bodies|contacts|supports",
}
#: What follows from other settings, and may change with any: rules that contacts take where nothing is said.
FOLLOWS = r"contacts\.\w+\.(quadrature|subcells|projection|by_default)"
#: Dials that there must be among others.
THERE = {
    "trade": {"order of block", "elements of base along v", "load steps of drag", "tolerance", "method", "smoothing of side"},
    "advice": {"base rigid", "friction of between", "the scene beyond y = 1", "order of base across"},
}


@case(
    claim="Each dial of a trade or of advice has the scene itself at its own setting; each other one changes what the dial is called by "
    "and nothing else that does not follow from it; settings that refine have no fewer unknowns and load steps than those before them.",
    tier="gate",
    grid={"of": list(THERE), "tolerance": (1e-9, 1e-5, 1e-3)},
    bounds={
        "own": Bound(0.0, 0.0, "definition: dials whose own setting changes the scene"),
        "nothing": Bound(0.0, 0.0, "definition: other settings that do not, or change as much as the one before"),
        "elsewhere": Bound(0.0, 0.0, "definition: changes of what a dial is not called by, and settings that leave that alone"),
        "cheaper": Bound(0.0, 0.0, "definition: settings that refine to fewer unknowns or load steps"),
        "missing": Bound(0.0, 0.0, "definition: dials that there are not, or that nobody knows"),
    },
)
def settings(of: str, tolerance: float) -> dict[str, float]:
    """How many of each, of the scene with some tolerance, the loosest that there is as well."""
    scene = Scene.from_toml(SCENE, overrides=[f"solver.{name}_tolerance={tolerance}" for name in ("newton", "complementarity")])
    own = scene.problem()
    dials = dials_of(scene, knobs=KNOBS if of == "trade" else VARIANTS)
    found = dict.fromkeys(("own", "nothing", "elsewhere", "cheaper"), 0)
    for dial in dials:
        problems = [changed(scene, [setting]).problem() for setting in dial.settings]
        paths = [{said.split(":")[0] for said in differences(own, problem)} for problem in problems]
        others = [changes for number, changes in enumerate(paths) if number != dial.own]
        meant = called(dial.name)
        found["own"] += bool(paths[dial.own])
        found["nothing"] += sum(not changes for changes in others) + sum(not differences(*pair) for pair in pairwise(problems))
        found["elsewhere"] += sum(not any(re.match(meant, path) for path in changes) for changes in others)
        found["elsewhere"] += sum(not re.match(f"{meant}|{FOLLOWS}", path) for changes in others for path in changes)
        sizes = [(sum(len(body.patch.weights) for body in problem.bodies), problem.total_steps) for problem in problems]
        found["cheaper"] += dial.refines and any(b < a for one, other in pairwise(sizes) for a, b in zip(one, other, strict=True))
    missing = len(THERE[of] - {dial.name for dial in dials}) + sum(called(dial.name) == UNKNOWN for dial in dials)
    return {name: float(count) for name, count in found.items()} | {"missing": float(missing)}


def called(name: str) -> str:
    """The pattern of what a dial of that name changes."""
    name = name.removesuffix(" across").split(" along ")[0]
    for pattern, meant in CHANGES.items():
        if match := re.fullmatch(pattern, name):
            return meant.format(*(word.replace(" ", "_") for word in match.groups() or (name,)))
    return UNKNOWN


#: The same, on one more body that the base is glued to.
GLUED = SCENE.replace("format = 1", 'format = 1\nglue = [["base.w0", "under.w1"]]').replace(
    'ground.face = "base.w0"', 'ground.face = "under.w0"'
)
GLUED += """
[bodies.under]
geometry = { kind = "box", lower = [-1.5, -0.5, -1], upper = [3, 2.5, -0.5] }
mesh = { order = [1, 1, 3], elements = [1, 2, 1] }
"""


@case(
    claim="Advice lowers orders in depth of bodies in contact and of those that they are glued to, of each by itself, and nothing else.",
    tier="gate",
    grid={"body": ("base", "under")},
    bounds={
        "settings": Bound(at_least=1, reason="definition: lower orders than the scene has"),
        "elsewhere": Bound(0.0, 0.0, "definition: changes of another body, or along the joint"),
    },
)
def in_depth(body: str) -> dict[str, float]:
    """How many of each."""
    scene = Scene.from_toml(GLUED)
    own, found = scene.problem(), {"settings": 0, "elsewhere": 0}
    for dial in dials_of(scene, knobs=VARIANTS):
        for setting in dial.settings[: dial.own] if dial.name == f"order of {body} across" else ():
            for before, after in zip(own.bodies, changed(scene, [setting]).problem().bodies, strict=True):
                lower = [a < b for a, b in zip(after.orders, before.orders, strict=True)]
                found["settings"] += before.name == body and lower == [False, False, True]
                found["elsewhere"] += (before.name != body and any(lower)) or lower[:2] != [False, False]
    return {name: float(count) for name, count in found.items()}
