"""Friction with a cohesion and with a largest traction: forces known in closed form, and contact that opens."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

import numpy as np
from friction.sliding import PUSH_STEPS, STRIDE, block
from small_scenes import bowl

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Contact, Material, Motion, Problem, Stage
from isomortar.scene import Scene

#: Coefficient, cohesion and largest traction.
Numbers = tuple[float, float, float | None]


def borne(contact: Contact, pressure: FloatArray) -> FloatArray:
    """Largest norms of tractions under pressures: none where open."""
    most = np.inf if contact.traction_max is None else contact.traction_max
    return np.where(pressure > 0.0, np.minimum(contact.cohesion + contact.friction * pressure, most), 0.0)


_PRISM = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.8, 0.5] }
bodies.block.mesh = { order = [1, 1, 1], elements = [1, 1, 1] }
contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0], tangent = [0.8, 0.6, 0] }, CONTACT }
supports.top.face = "block.w1"
supports.left = { face = "block.u0", components = ["x"] }
supports.right = { face = "block.u1", components = ["x"] }
supports.front = { face = "block.v0", components = ["y"] }
supports.back = { face = "block.v1", components = ["y"] }
solver = { newton_tolerance = 1e-13, complementarity_tolerance = 1e-12, augmentation_tolerance = 1e-12, penalty_normal = 1e4 }
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0, 0, -DEPTH]
[[stages]]
name = "push"
steps = 2
motions = { top = { translate = [0.13, 0, 0] }, left = { translate = [0.13, 0, 0] }, right = { translate = [0.13, 0, 0] } }
"""
#: The face of the prism, and its height.
AREA, HEIGHT = 0.8, 0.5
#: Pressures are about 0.7 and 3.5.
DEPTHS: Final = (0.025, 0.1)
LAWS: Final[dict[str, Numbers]] = {
    "Coulomb": (0.3, 0.0, None),
    "cohesion": (0.3, 0.2, None),
    "constant": (0.0, 0.2, None),
    "cap": (0.3, 0.0, 0.6),
    "both": (0.3, 0.2, 0.6),
}


def keys(numbers: Numbers) -> str:
    """As keys of a contact."""
    friction, cohesion, most = numbers
    return f"friction = {friction}, cohesion = {cohesion}" + ("" if most is None else f", traction_max = {most}")


@case(
    claim="A prism that is pressed evenly and pushed along bears its area times min(c + mu p, tau_max), by either method.",
    grid={"law": tuple(LAWS), "depth": DEPTHS, "method": ("monolithic", "uzawa")},
    bounds={
        "pressure": Bound(at_most=1e-11, reason="theory: the strain is uniaxial; augmentations end within 1e-12"),
        "traction": Bound(at_most=1e-11, reason="theory: the limit at that pressure, at every point; augmentations end within 1e-12"),
        "across": Bound(at_most=1e-11, reason="theory: a traction is against its slip; augmentations end within 1e-12"),
    },
)
def even_pressure(law: str, depth: float, method: str) -> dict[str, float]:
    """Relative errors of the forces on the prism, and the share across the push."""
    text = _PRISM.replace("CONTACT", keys(LAWS[law])).replace("DEPTH", str(depth))
    problem = Scene.from_toml(text, overrides=[f"solver.method='{method}'"]).problem()
    *_, last = Simulation(problem).run()
    force = last.contacts[0].force_slave
    material, stretch = Material(), 1.0 - depth / HEIGHT
    deviator = stretch ** (-2.0 / 3.0) * (stretch - (2.0 + stretch**2) / (3.0 * stretch))
    pressure = -(material.bulk * np.log(stretch) / stretch + material.shear * deviator)
    friction, cohesion, most = LAWS[law]
    traction = min(cohesion + friction * pressure, np.inf if most is None else most)
    return {
        "pressure": float(abs(force[2] / (AREA * pressure) - 1.0)),
        "traction": float(abs(-force[0] / (AREA * traction) - 1.0)),
        "across": float(abs(force[1]) / (AREA * traction)),
    }


#: Of a block that slides: nowhere capped, in a part, everywhere.
SLIDING: Final[dict[str, Numbers]] = {"nowhere": (0.3, 0.1, 10.0), "in a part": (0.3, 0.1, 0.9), "everywhere": (0.3, 0.1, 0.11)}


@case(
    claim="A block that slides drags with the sum of what its points bear: c A + mu N below the largest traction, tau_max A at it, with "
    "the area A where there is contact.",
    grid={"capped": tuple(SLIDING)},
    bounds=lambda capped: (
        {
            "sum": Bound(at_most=1e-12, reason="theory: all tractions are along the motion, deviations of direction squared; sums of them"),
            "share": Bound(
                *{"nowhere": (0.0, 0.0), "in a part": (0.8, 0.2), "everywhere": (1.0, 1.0)}[capped],
                reason="definition: what is to be tested",
            ),
        }
        | ({} if capped == "in a part" else {"closed form": Bound(at_most=1e-12, reason="theory: a limit linear in p, summed")})
    ),
)
def sliding_block(capped: str) -> dict[str, float]:
    """Relative errors of the drag, and share of the points in contact that bear the largest traction."""
    problem = block([(STRIDE * PUSH_STEPS, PUSH_STEPS)], 30.0)
    friction, cohesion, most = SLIDING[capped]
    contact = replace(problem.contacts[0], friction=friction, cohesion=cohesion, traction_max=most)
    *_, last = Simulation(replace(problem, contacts=(contact,))).run()
    pair = Simulation(problem).equilibrium.pairs[0]
    before = Simulation(problem).state.contacts[0]
    pressure = last.state.contacts[0].pressure
    weight = np.where(pressure > 0.0, pair.kinematics(last.state.positions, before).control.weight, 0.0)
    force = last.contacts[0].force_slave
    drag = float(np.linalg.norm(force[:2]))
    each = borne(contact, pressure)
    assert most is not None
    found = {"sum": float(abs(drag / (weight @ each) - 1.0)), "share": float(np.mean(each[pressure > 0.0] == most))}
    if capped == "in a part":
        return found
    whole = most * weight.sum() if capped == "everywhere" else cohesion * weight.sum() + friction * force[2]
    return found | {"closed form": float(abs(drag / whole - 1.0))}


#: Press, shift and lift of the bowl: supports' motions and load steps.
LIFTED: Final = {
    "press": (Motion((0, 0, -0.1)), 2),
    "shift": (Motion((0.04, 0.02, 0)), 2),
    "lift": (Motion((0, 0, 0.12)), 4),
}


def lifted(master: str, numbers: Numbers, **settings: Any) -> Problem:
    """The bowl, pressed, shifted and lifted off."""
    problem = bowl(master)
    friction, cohesion, most = numbers
    contact = replace(problem.contacts[0], friction=friction, cohesion=cohesion, traction_max=most)
    held = (replace(support, motions=(Motion(),) * len(LIFTED)) for support in problem.supports[1:])
    top = replace(problem.supports[0], motions=tuple(motion for motion, _ in LIFTED.values()))
    stages = tuple(Stage(name, steps) for name, (_, steps) in LIFTED.items())
    return replace(problem, contacts=(contact,), supports=(top, *held), stages=stages, settings=replace(problem.settings, **settings))


#: Pressures are up to 5.
OPENING: Final[dict[str, Numbers]] = {"little": (0.3, 0.1, None), "much": (0.3, 10.0, None), "capped": (0.3, 0.1, 0.4)}


@case(
    claim="No traction is larger than what its point bears, and contact opens without one, at every point and as a whole.",
    grid={"law": tuple(OPENING)},
    bounds={
        "outside": Bound(at_most=1e-10, reason="round-off: contact conditions are solved to 1e-11"),
        "open": Bound(0.0, 0.0, "definition: a point without pressure has no traction"),
        "leaving": Bound(at_least=3.0, reason="definition: load steps in which points have opened since the step before"),
        "left": Bound(0.0, 0.0, "theory: nothing holds bodies together that do not touch"),
    },
)
def opening(law: str) -> dict[str, float]:
    """Tractions above what is borne, over the largest one; norms of open points; load steps that open some; the last force."""
    problem = lifted("plane", OPENING[law])
    results = list(Simulation(problem).run())
    outside, without = [0.0], [0.0]
    for result in results:
        pressure, norm = result.state.contacts[0].pressure, result.contacts[0].traction_norm
        outside += list((norm - borne(problem.contacts[0], pressure)) / (norm.max() or 1.0))
        without += list(norm[pressure <= 0.0])
    return {
        "outside": float(np.max(outside)),
        "open": float(np.max(without)),
        "leaving": float(np.count_nonzero(np.diff([result.contacts[0].active for result in results]) < 0)),
        "left": float(np.abs(results[-1].contacts[0].force_slave).max()),
    }


@case(
    claim="Augmentations and the monolithic method come to the same forces with any limit of the tractions, also where points open.",
    tier="nightly",
    grid={"law": tuple(OPENING), "master": ("plane", "block")},
    bounds={
        "apart": Bound(at_most=1e-5, reason="round-off: augmentations end within 1e-6, and tractions carry over load steps"),
        "compared": Bound(at_least=4.0, reason="definition: press and shift; with friction a cut step is another path"),
    },
)
def both_methods(law: str, master: str) -> dict[str, float]:
    """Largest difference of contact forces over the largest force, until either method cuts a load step; load steps until then."""
    problems = lifted(master, OPENING[law]), lifted(master, OPENING[law], method="uzawa", augmentation_tolerance=1e-6)
    found = [list(Simulation(problem).run()) for problem in problems]
    whole = [one.cuts == other.cuts == 0 for one, other in zip(*found, strict=True)]
    count = int(np.argmin([*whole, False]))
    monolithic, uzawa = (np.array([result.contacts[0].force_slave for result in results[:count]]) for results in found)
    return {"apart": float(np.abs(monolithic - uzawa).max() / np.abs(monolithic).max()), "compared": float(count)}
