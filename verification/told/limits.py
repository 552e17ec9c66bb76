"""From where on motions are doubtful: what is said of a block on its way to a master, by how far it goes."""

from __future__ import annotations

from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.scene import Scene

#: A block below its master, held by its lower face; the master goes to meet it.
SCENE = """
format = 1
bodies.slave.geometry = {{ kind = "box", lower = [-0.25, -0.25, {low}], upper = [0.25, 0.25, {high}] }}
bodies.slave.mesh = {{ order = 2, elements = 2 }}
{master}
supports.bottom.face = "slave.w0"
[[stages]]
name = "aside"
steps = 10
motions = {{ bottom = {{ translate = [0, {aside}, {first}] }}{begins} }}
[[stages]]
name = "on"
steps = 10
motions = {{ bottom = {{ translate = [0, -{aside}, {second}] }}{ends} }}
[[stages]]
name = "back"
steps = 10
motions.bottom.translate = [0, 0, -0.05]
"""
_BODY = """
bodies.master = {{ geometry = {{ {geometry} }}, mesh = {{ order = 2, elements = {elements} }} }}
contacts.between = {{ slave = "slave.w1", master = "master.w0", friction = 0 }}
supports.lid.face = "master.w1"
"""
MASTERS = {
    "plane": "contacts.between = { slave = 'slave.w1', plane = { point = [0, 0, 0], normal = [0, 0, -2] }, friction = 0 }",
    "box": _BODY.format(geometry='kind = "box", lower = [-1, -1, 0], upper = [1, 1, 0.5]', elements=2),
    "cap": _BODY.format(geometry='kind = "cap", radius = 1, half_width = 0.5, bottom = 0, top = 0.5', elements=1),
}
GAP, THICK, DEEP = 0.125, 0.375, 0.5
#: How far it goes aside, and back: to a flat master alone, of which that brings it no nearer.
ASIDE = {"plane": 0.5, "box": 0.5, "cap": 0.0}
#: How far both come nearer to each other, from where on, and what is said; of a motion the master makes a fifth.
SAID = {"away": "away from each other", "short": "it cannot close", "right": "", "far": "they would be pressed flat"}


def said(master: str, way: float) -> str:
    """Which of the sentences is said of a way towards the master, if any; else what is said that is none of them."""
    share = 0.0 if master == "plane" else 0.2
    own = (1.0 - share) * way
    lid = ["" if master == "plane" else f", lid = {{ translate = [0, 0, {-part * share * way}] }}" for part in (0.25, 0.75)]
    block = {"low": -GAP - THICK, "high": -GAP, "master": MASTERS[master]}
    motions = {"first": 0.25 * own, "second": 0.75 * own, "aside": ASIDE[master], "begins": lid[0], "ends": lid[1]}
    text = SCENE.format(**block, **motions)
    warnings = [warning for warning in outlook(Scene.from_toml(text).problem()).warnings if "between" in warning]
    found = [name for name, words in SAID.items() if words and any(words in warning for warning in warnings)]
    return " ".join(found) if len(found) == len(warnings) else str(warnings)


@case(
    claim="Motions are doubted that lead away, end before half of the gap, or leave a tenth of what is between supports; no others.",
    tier="gate",
    grid={"master": tuple(MASTERS)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: ways of which something else is said, a hundredth on either side of each limit")},
)
def approached(master: str) -> dict[str, float]:
    """Of how many ways."""
    flat = GAP + 0.9 * (THICK + (0.0 if master == "plane" else DEEP))
    ways = {-0.25: "away", 0.495 * GAP: "short", 0.505 * GAP: "right"}
    if master != "cap":  # how thick that is, control points tell
        ways |= {0.01: "short", 0.99 * flat: "right", 1.01 * flat: "far"}
    return {"wrong": float(sum(said(master, way) != (expected if SAID[expected] else "") for way, expected in ways.items()))}
