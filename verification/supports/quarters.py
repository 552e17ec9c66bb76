"""Scenes of the program computed in half and in quarter: what results say of forces is the whole's, whatever the method."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

_HERTZ = """
format = 1
bodies.sphere.geometry = { kind = "cap", radius = 1.0, half_width = 0.6, bottom = 0.0, top = 0.8 }
bodies.sphere.mesh = { family = "L", order = 2, elements = [6, 6, 2] }
contacts.floor = { slave = "sphere.w0", plane = {}, friction = 0.0 }
supports.top = { face = "sphere.w1" }
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.1] }]
"""
#: Scenes, on few elements with functions that planes of symmetry halve, Lagrange's; what is changed for that, and the planes.
SCENES = {
    "press": (
        "press",
        ('bodies.block.mesh={ family = "L", order = [2, 2, 1], elements = [4, 4, 2] }', "stages.press.steps=3"),
        "x = 0.0, y = 0.0",
    ),
    "Hertz": (_HERTZ, (), "x = 0.0, y = 0.0"),
    "iron": (
        "iron",
        (
            'bodies.slave.mesh={ family = "L", order = 1, elements = [4, 4, 2] }',
            'bodies.master.mesh={ family = "L", order = [2, 2, 1], elements = [6, 4, 2] }',
            *("stages.press.steps=3", "stages.press.motions.top.translate=[0, 0, -0.2]"),
            *("stages.drag.steps=3", "stages.drag.motions.top.translate=[0.15, 0, 0]"),
        ),
        "y = 0.0",
    ),
}
#: To round-off.
_MONOLITHIC = ("solver.newton_tolerance=1e-12", "solver.complementarity_tolerance=1e-12")
#: Softer penalties than the default: each augmentation then takes fewer tangents.
_UZAWA = (
    *("solver.method=uzawa", "solver.newton_tolerance=1e-12", "solver.penalty_normal=20", "solver.penalty_tangential=2"),
    *("solver.augmentation_tolerance=1e-11", "solver.max_augmentations=400"),
)
METHODS = {"monolithic": _MONOLITHIC, "uzawa": _UZAWA}
_SOLVER = {"monolithic": "Newton's method stops at 1e-12", "uzawa": "augmentations end at relative changes of 1e-11 that halve each time"}


def computed(scene: str, method: str, planes: str) -> list[StepResult]:
    """All load steps of a scene, of what is above planes of symmetry."""
    source, overrides, _ = SCENES[scene]
    changes = (*overrides, *METHODS[method], f"symmetry={{ {planes} }}")
    given = Scene.from_toml(source, overrides=changes) if "\n" in source else Scene.load(source, changes)
    return list(Simulation(given.problem()).run())


@case(
    claim="Half of the iron, a quarter of the press and of Hertz's sphere give the forces of the whole, by either method.",
    grid={"scene": list(SCENES), "method": list(METHODS)},
    tier=lambda scene, method: "gate" if method == "monolithic" or scene == "Hertz" else "nightly",
    bounds=lambda scene, method: {
        "support": Bound(at_most=1e-9, reason=f"theory: the same equations by symmetry; {_SOLVER[method]}"),
        "slave": Bound(at_most=1e-9, reason=f"theory: the same equations by symmetry; {_SOLVER[method]}"),
        "slipping": Bound(at_least=0.0 if scene == "Hertz" else 1.0, reason="definition: there is friction in press and iron"),
    },
)
def forces_of_the_whole(scene: str, method: str) -> dict[str, float]:
    """Largest errors over the largest force, of the top and of the slave, and load steps of the part in which something slips."""
    planes = SCENES[scene][2]
    parts, wholes = computed(scene, method, planes), computed(scene, method, "")
    support = [np.array([result.reactions[0].force for result in results]) for results in (parts, wholes)]
    slave = [np.array([result.contacts[0].force_slave for result in results]) for results in (parts, wholes)]
    size = float(np.abs(support[1]).max())
    return {
        "support": float(np.abs(support[0] - support[1]).max()) / size,
        "slave": float(np.abs(slave[0] - slave[1]).max()) / size,
        "slipping": float(sum(result.contacts[0].slip > 0 for result in parts)),
    }
