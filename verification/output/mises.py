"""Equivalent stress in exports and on pages: no place has less than none, and where there is some it is what it was."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

import isomortar
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.model.entities import Body
from isomortar.model.numbering import Numbering
from isomortar.results import Results
from isomortar.results.bezier import at_parts, fitted, inner_places, rational
from isomortar.results.coloured import stress
from isomortar.results.paraview import states
from isomortar.results.vtu import BezierGrid
from isomortar.scene import Scene

#: Scenes by what they are cut down to: blocks whose stress bends sharply where it changes its sign, and one that turns as a whole.
SCENES = {
    "press": Scene.load("press", ["stages.press.steps=2"]),
    "twist": Scene.load("twist", ["stages.press.steps=3", "stages.twist.steps=1"]),
    "turned": Scene.from_toml(
        """
        format = 1
        bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 2, elements = 2 } }
        supports.top = { face = "block.w1", axis = [0, 0, 1] }
        stages = [{ name = "turn", steps = 2, motions.top.rotate = 40 }]
        """
    ),
}


@case(
    claim="No place of a body has an equivalent stress below zero, at rest, turned, pressed or twisted; elsewhere it stays near "
    "what goes through its values.",
    tier="gate",
    grid={"scene": tuple(SCENES)},
    bounds={
        "below": Bound(0.0, 0.0, "definition: at equal parts of elements, over the largest stress"),
        "between": Bound(at_most=1e-3, reason="definition: at other places, which are not looked at, over the largest stress"),
        "moved": Bound(at_most=0.02, reason="definition: largest change of what goes through its values, over the largest stress"),
    },
)
def mises(scene: str) -> dict[str, float]:
    """How far it is below at most, and how far off what goes through its values in each element."""
    worst = {"below": 0.0, "between": 0.0, "moved": 0.0}
    with tempfile.TemporaryDirectory() as folder:
        isomortar.run(SCENES[scene], Path(folder) / "run.h5").close()
        with Results(Path(folder) / "run.h5") as results:
            for _, number, grids in states(results):
                positions = results.step(number).state.positions if number else Numbering(results.problem).reference
                for body, grid in zip(results.problem.bodies, grids["bodies"], strict=True):
                    found = of_body(body, Numbering(results.problem).of_patch(body.name, positions), grid)
                    worst = {name: float(np.maximum(value, found[name])) for name, value in worst.items()}
    return worst


def of_body(body: Body, points: FloatArray, grid: BezierGrid) -> dict[str, float]:
    """The same of a body in a state."""
    directions, told = body.patch.directions, grid.fields["von Mises stress"]
    values = stress(body, points, [inner_places(direction) for direction in directions])
    through = fitted(directions, body.patch.weights, values[:, None])
    largest = np.maximum(values.max(), body.material.young * 1e-9)

    def field(net: FloatArray, parts: int) -> FloatArray:
        return rational([at_parts(d.order, d.elements, parts) for d in directions], grid.weights, net)[0] / largest

    return {
        "below": np.maximum(-field(told, 4).min(), 0.0),
        "between": -field(told, 7).min(),
        "moved": np.abs(field(told - through, 7)).max(),
    }
