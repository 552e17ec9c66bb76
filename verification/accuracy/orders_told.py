"""What a report of orders and meshes says that its reference is off by, beside a run with twice the elements."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from orders import page
from orders.analysis import analyse
from orders.plan import Plan
from orders.run import discretised

from isomortar.accuracy.discretisations import Discretisation, refined
from isomortar.harness import Bound, case
from isomortar.harness.measurement import Measurement
from isomortar.scene import Scene

#: A body that is pressed, and where it is pressed onto.
SCENE = """
format = 1
materials.m = { young = 100, poisson = 0.3 }
bodies.block = { material = "m", geometry = GEOMETRY, mesh = { order = [2, 2, 1], elements = [NUMBER, NUMBER, 1] } }
supports.top = { face = "block.w1", axis = [0, 1, 0], centre = [0, 0, 1] }
stages = [{ name = "press", steps = STEPS, motions.top = MOTION }]
"""
FLOOR = 'contacts.floor = { slave = "block.w0", plane = {}, friction = 0 }\n'
BASE = """
supports.under.face = "base.w0"
contacts.floor = { slave = "block.w0", master = "base.w1", friction = 0 }
[bodies.base]
material = "m"
geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }
mesh = { order = [2, 2, 1], elements = [8, 8, 1] }
"""
SIDES = 'supports.x = { face = "block.u0", components = ["x"] }\nsupports.y = { face = "block.v0", components = ["y"] }\n'
BOX = '{ kind = "box", lower = [-0.5, -0.5, 0], upper = [0.5, 0.5, 1] }'
BOWL = '{ kind = "bowl", half_width = 0.5, bottom = 0, rise = 0.1, top = 0.5 }'
DOWN = "{ translate = [0, 0, -0.05] }"
#: Scenes by geometry, elements, load steps, motion, and what else there is.
SCENES = {
    "punch": (BOX, 3, 3, DOWN, BASE),
    "tilted": (BOX, 3, 3, "{ translate = [0, 0, -0.05], rotate = 1 }", FLOOR),
    "ball": (BOWL, 5, 3, "{ translate = [0, 0, -0.15] }", FLOOR),
    "in two load steps": (BOWL, 3, 2, "{ translate = [0, 0, -0.15] }", FLOOR),
    "in one load step": (BOWL, 3, 1, "{ translate = [0, 0, -0.15] }", FLOOR),
    "exact": (BOX, 2, 3, DOWN, FLOOR + SIDES),
}


def scene(name: str) -> Scene:
    """One of the scenes."""
    geometry, number, steps, motion, below = SCENES[name]
    text = SCENE.replace("GEOMETRY", geometry).replace("NUMBER", str(number)).replace("STEPS", str(steps)).replace("MOTION", motion)
    return Scene.from_toml((text.replace('"block.w1",', '"block.w1", components = ["z"],') if name == "exact" else text) + below)


def run(plan: Plan, chosen: Discretisation, folder: Path) -> Measurement:
    """A run of a plan."""
    path = folder / "scene.toml"
    path.write_text(plan.discretised(chosen).to_toml())
    return Measurement("measured", dict(discretised.function(str(path), plan.sweep.body, plan.sweep.contact)))


@case(
    claim="A report of orders and meshes tells what its reference is off by, of however few load steps, and to half of what is seen by "
    "twice the elements; where elements do not matter, that is nothing.",
    tier=lambda name: "nightly" if name in ("tilted", "in two load steps") else "gate",
    grid={"name": tuple(SCENES)},
    bounds={
        "unknown": Bound(0.0, 0.0, "definition: measures of which it is not told though changes fall, or are round-off"),
        "told over real": Bound(at_least=0.5, reason="definition: an error that is told is at most twice as large; above round-off"),
        "pages": Bound(1.0, 1.0, "definition: the page is written"),
    },
)
def own_error(name: str) -> dict[str, float]:
    """The smallest over the measures; a curve that does not tell its own error is left to the first bound."""
    plan = Plan.of(scene(name), ["N2"])
    coarse, medium, fine = plan.reference
    with TemporaryDirectory() as folder:
        runs = {chosen: run(plan, chosen, Path(folder)) for chosen in plan.runs}
        finer = run(plan, refined(plan.scene, plan.sweep, fine, 2.0), Path(folder))
    analysis = analyse(plan, runs)
    real = analyse(plan, runs | {coarse: runs[medium], medium: runs[fine], fine: finer}).points[medium].errors
    told = [analysis.uncertainty[measure] / np.fmax(real[measure], 1e-9) for measure in analysis.measures if real[measure] > 1e-9]
    written = page.page(analysis, datetime.now().astimezone())
    return {
        "unknown": float(sum(not np.isfinite(worth) for worth in analysis.uncertainty.values())) if name == "exact" else 0.0,
        "told over real": float(np.min([1.0, *told])),
        "pages": float("Errors are those of the mesh of block along u and v alone" in written),
    }
