"""What a run that is resumed with another scene is told: what was changed, and not what follows of it."""

from __future__ import annotations

from typing import Any

from isomortar.harness import Bound, case
from isomortar.results.comparison import differences
from isomortar.scene import Scene

COARSE = {"bodies.slave.mesh.elements": [2, 2, 1], "bodies.master.mesh.elements": [4, 2, 1]}
#: One change of a scene each, and how the one sentence begins that tells it: what follows of it is not told beside it.
CHANGES: dict[str, tuple[dict[str, Any], str]] = {
    "elements": ({"bodies.slave.mesh.elements": [3, 2, 1]}, "bodies.slave.mesh: 2 x 2 x 1 elements of N2 x N2 x N2 in the file, 3 x 2"),
    "order": (
        {"bodies.slave.mesh.order": 3},
        "bodies.slave.mesh: 2 x 2 x 1 elements of N2 x N2 x N2 in the file, 2 x 2 x 1 elements of N3",
    ),
    "family": ({"bodies.slave.mesh.family": "L"}, "bodies.slave.mesh: "),
    "order of a master": ({"bodies.master.mesh.order": 3}, "bodies.master.mesh: "),
    "a master that cuts": ({"bodies.master.mesh.elements": [5, 2, 1], "bodies.master.mesh.order": 1}, "bodies.master.mesh: "),
    "order of a face": ({"bodies.slave.mesh.contact_order": 3}, "bodies.slave.mesh: "),
    "grading": ({"bodies.slave.mesh.grading": [2.0, 1.0, 1.0]}, "bodies.slave.patch: another shape, or other sizes of as many elements"),
    "shape": ({"bodies.slave.geometry.rise": 0.2}, "bodies.slave.patch: another shape, or other sizes of as many elements"),
    "shape of a master": ({"bodies.master.geometry.upper": [3.1, 0.75, 0.0]}, "bodies.master.patch: another shape, or other sizes"),
    "points of a body": ({"bodies.slave.mesh.quadrature": [5, 5, 5]}, "bodies.slave.quadrature: "),
    "name of a stage": ({"stages.press.name": "push"}, "stages.press: is called push in the scene"),
    "a place": ({"supports.top.face": "slave.u0"}, "supports.top.place.face: 'w1' in the file, 'u0' in the scene"),
    "a setting": ({"solver.max_cuts": 3}, "settings.max_cuts: "),
}


@case(
    claim="One change of a scene, be it a mesh from which other numbers follow or a name that others have, is told in one sentence, by "
    "what was changed.",
    tier="gate",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: changes of which something else is said, or more"),
        "silent": Bound(0.0, 0.0, "definition: changes among several that nothing is said of"),
        "late": Bound(0.0, 0.0, "definition: names and meshes that are told after single values"),
    },
)
def told_once() -> dict[str, float]:
    """How many, with slave elements that the master's knot lines cut and in whole ones."""
    wrong = 0
    iron = Scene.load("iron").to_toml()
    for text in (iron, iron.replace("subcells = 0", "")):
        own = Scene.from_toml(text, overrides=COARSE).problem()
        for changes, words in CHANGES.values():
            said = differences(own, Scene.from_toml(text, overrides=COARSE | changes).problem())
            wrong += len(said) != 1 or not said[0].startswith(words)
    several = [CHANGES[name] for name in ("a setting", "a place", "shape of a master", "order", "name of a stage")]
    changes = {path: value for change, _ in several for path, value in change.items()}
    said = differences(own, Scene.from_toml(text, overrides=COARSE | changes).problem())
    order = [words for sentence in said for _, words in several[::-1] if sentence.startswith(words)]
    return {
        "wrong": float(wrong),
        "silent": float(len(several) - len(order)),
        "late": float(order[:3] != [words for _, words in several[:1:-1]]),
    }
