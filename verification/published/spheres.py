"""Spheres pressed together by a force, octants with their poles in contact: Hertz's formulas, and what finite strain makes of them."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from typing import Any

import numpy as np
from analytic.hertz import APPROACH, HEMISPHERE, PEAK, PUBLISHED_RADIUS, YOUNG, Found, profile
from published.benchmark import Benchmark, Beside, Drawing, Known, Quantity, at_force, reaction
from spheres import graded

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.primitives import sphere
from isomortar.geometry.refinement import mesh as refined
from isomortar.geometry.splines import Spline
from isomortar.harness import Bound, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.program.declaration import LoadStep
from isomortar.results.fields import contact_surfaces
from isomortar.scene import Scene
from isomortar.scene.geometry_file import patch_table
from isomortar.scene.toml_text import dump

POISSON = 0.3
#: Hertz's modulus and radius of both spheres, and the force that makes the approach of literature.
MODULUS, RADIUS = YOUNG / (1.0 - POISSON**2) / 2.0, HEMISPHERE / 2.0
FORCE = 4.0 / 3.0 * MODULUS * np.sqrt(RADIUS) * APPROACH**1.5
#: Orders, and equal elements up to FINE contact radii; half as many grow beyond.
MESHES = {"N2 coarse": (2, 12), "N2 fine": (2, 24), "N3 coarse": (3, 10), "N3 fine": (3, 16)}
FINE = 1.5
#: Eighths of the force, which halve the strain: the last two make the limit of none.
HALVED = (0, 2, 3)
#: The peak is told by the mean pressure up to this share of the contact radius, where Hertz's is `_SHARE` of his peak.
MIDDLE = 0.25
_SHARE = 2.0 / 3.0 * (1.0 - (1.0 - MIDDLE**2) ** 1.5) / MIDDLE**2


def octant(mesh: str, upper: bool, contact: float) -> Patch:
    """An octant that touches the plane z = 0 with its pole, fine up to some contact radii; exact, one element round the axis."""
    order, elements = MESHES[mesh]
    centre, latitudes = ((0.0, 0.0, HEMISPHERE), (-90.0, 0.0)) if upper else ((0.0, 0.0, -HEMISPHERE), (0.0, 90.0))
    whole = sphere(centre, 0.0, HEMISPHERE, latitudes, (0.0, 90.0), "z")
    patch = refined(whole, ("N", "N", "N"), (2, order, order), (1, 1, 1))
    spline = Spline(patch.directions, patch.control_points, patch.weights)
    outwards = 1.0 - _boundaries(HEMISPHERE, contact, elements // 2)[::-1]
    down = _boundaries(0.5 * np.pi * HEMISPHERE, contact, elements)
    for axis, places in ((1, outwards), (2, 1.0 - down[::-1] if upper else down)):
        line = patch.directions[axis].boundaries
        spline.insert(axis, (line[0] + np.ptp(line) * places)[1:-1])
    v, w = (Direction("N", order, knots) for knots in spline.knots[1:])
    return Patch((patch.directions[0], v, w), spline.control_points, spline.weights)


def _boundaries(length: float, contact: float, elements: int) -> FloatArray:
    """Where elements end, from 0 in the contact to 1."""
    return graded(1.0, FINE * contact / length, elements, elements // 2 + 1)


def hertz(force: float) -> tuple[float, float]:
    """Contact radius and peak pressure."""
    contact = float(np.cbrt(0.75 * force * RADIUS / MODULUS))
    return contact, 1.5 * force / (np.pi * contact**2)


def pressed(mesh: str, force: float, both: bool) -> tuple[Found, float]:
    """Pressures, and by how much the spheres' equators approach; on their plane of symmetry, or `both` deformed, by other elements."""
    contact, _ = hertz(force)
    patches = {"upper": octant(mesh, True, contact)} | ({"lower": octant(mesh, False, 0.75 * contact)} if both else {})
    planes = {f"{body}-{face}": {"face": f"{body}.{face}", "components": [x]} for body in patches for face, x in (("u0", "y"), ("u1", "x"))}
    master: dict[str, Any] = {"master": "lower.v1"} if both else {"plane": {}}
    scene = {
        "format": 1,
        "name": "spheres",
        "materials": {"steel": {"young": YOUNG, "poisson": POISSON}},
        "bodies": {name: {"patch": patch_table(patch)} for name, patch in patches.items()},
        "contacts": {"face": {"slave": "upper.v1", "friction": 0.0, **master}},
        "supports": {
            "top": {"face": "upper.w0", "force": {"z": -force / 4.0}},
            **({"bottom": {"face": "lower.w1"}} if both else {}),
            **planes,
        },
        "stages": [{"name": "press", "steps": 3}],
    }
    problem = Scene.from_toml(dump(scene)).problem()
    *_, step = Simulation(problem).run()
    top = next(r for s, r in zip(problem.supports, step.reactions, strict=True) if s.name == "top")
    return profile(contact_surfaces(problem, step)[0], step.contacts[0]), -float(top.displacement[2]) * (1.0 if both else 2.0)


#: Octants with a hole at the centre and along the axis, held as that is: other programs take no edges that are points, nor forces of
#: supports. Elements round the axis, from the centre, and from the hole to the equator; equators go past the force.
_HOLLOW = """
format = 1
name = "spheres"
materials.steel = { young = 20e3, poisson = 0.3, law = "neo-hookean-j" }
bodies.upper.geometry = { kind = "sphere", centre = [0, 0, 50], inner = 2, outer = 50, latitudes = [-89.5, 0], angles = [0, 90] }
bodies.lower.geometry = { kind = "sphere", centre = [0, 0, -50], inner = 2, outer = 50, latitudes = [0, 89.5], angles = [0, 90] }
contacts.face = { slave = "upper.v1", master = "lower.v1", friction = 0 }
stages = [{ name = "press", steps = 4, motions.top.translate = [0, 0, -4.4] }]

[supports]
top.face = "upper.w0"
bottom.face = "lower.w1"
upper-axis = { face = "upper.w1", components = ["x", "y"] }
lower-axis = { face = "lower.w0", components = ["x", "y"] }
upper-front = { face = "upper.u0", components = ["y"] }
upper-side = { face = "upper.u1", components = ["x"] }
lower-front = { face = "lower.u0", components = ["y"] }
lower-side = { face = "lower.u1", components = ["x"] }
"""
_LINEAR = {"upper": (6, 10, 20), "lower": (6, 10, 16)}


def by_way(kind: str) -> Problem:
    """Both octants of Lagrange elements, finer towards the contact, pressed by way."""
    scene = tomllib.loads(_HOLLOW)
    for body, elements in _LINEAR.items():
        grading = [1, 0.05, 0.02 if body == "upper" else 50]
        scene["bodies"][body]["mesh"] = {"family": "L", "order": [int(kind[1:])] * 3, "elements": list(elements), "grading": grading}
    return Scene.from_toml(dump(scene)).problem()


def by_others(problem: Problem, steps: Sequence[LoadStep]) -> dict[str, float]:
    """The approach by the whole force."""
    forces = [-4.0 * float(reaction(problem, step, "top")[2]) for step in steps]
    return {"approach": at_force(FORCE, forces, [4.4 * step.step / len(steps) for step in steps])}


def peak(found: Found, contact: float) -> float:
    """That of Hertz's pressures whose mean in the middle is the one found."""
    middle = found.radii < MIDDLE * contact
    return float(found.pressure[middle] @ found.area[middle] / found.area[middle].sum() / _SHARE)


_FINITE = "theory: the formula, and terms of first order in the strain, which is 0.25: a twelfth at most"


@case(
    claim="Spheres pressed by a force have Hertz's peak pressure as their strain vanishes, a plane between them or both deformed.",
    tier="nightly",
    grid={"mesh": tuple(MESHES)},
    bounds={
        "force": Bound(at_most=1e-9, reason="theory: equilibrium, to the tolerance of Newton's method"),
        "limit": Bound(
            at_least=0.99, at_most=1.01, reason="theory: Hertz; twice the product of strains of 0.06 and 0.03; the discretisation"
        ),
        "peak": Bound(at_least=PEAK, at_most=1.09 * PEAK, reason=_FINITE),
        "peak of both": Bound(at_least=PEAK, at_most=1.09 * PEAK, reason=_FINITE),
        "approach": Shown("of the equators, whose planes stay so, mm"),
        "contact radius": Shown("mm"),
        "radii": Shown("of the samples, mm"),
        "pressures": Shown("MPa, per area as it is deformed"),
    },
)
def spheres_by_force(mesh: str) -> dict[str, Any]:
    """Force of the contact off the one prescribed; the peak over Hertz's in the limit; the rest by the whole force."""
    forces = FORCE / 8.0 ** np.array(HALVED)
    contacts, peaks = np.array([hertz(force) for force in forces]).T
    (whole, approach), *others = (pressed(mesh, force, both=False) for force in forces)
    shares = [peak(found, contact) / exact for (found, _), contact, exact in zip(others, contacts[1:], peaks[1:], strict=True)]
    two, _ = pressed(mesh, FORCE, both=True)
    near = whole.radii < 1.3 * contacts[0]
    return {
        "force": abs(two.force / FORCE - 1.0),
        "limit": 2.0 * shares[1] - shares[0],
        "peak": peak(whole, contacts[0]),
        "peak of both": peak(two, contacts[0]),
        "approach": approach,
        "contact radius": whole.edge,
        "radii": whole.radii[near],
        "pressures": whole.pressure[near],
    }


_CURVE = PUBLISHED_RADIUS * np.linspace(0.0, 1.0, 60)
_HERTZ = np.column_stack([_CURVE, PEAK * np.sqrt(1.0 - (_CURVE / PUBLISHED_RADIUS) ** 2)])
_SOURCE = "Hertz, small strain"
BENCHMARKS = (
    Benchmark(
        "spheres_by_force",
        "Hertz by force: two spheres",
        f"Two hemispheres of radius {HEMISPHERE:g}, E = {YOUNG:g} MPa, Poisson's ratio {POISSON:g}, are pressed together at their equators "
        f"by {FORCE / 1e3:.2f} kN, the force of Hertz's approach of {APPROACH:g} mm; octants with their poles in contact, finite strain, "
        "no friction. On their plane of symmetry, and with both deformed, whose elements do not match.",
        "Equators stay as wide as they are here, which sources do not tell.",
        ("N3 fine", "N2 fine"),
        (
            Quantity(
                "limit", "peak pressure over Hertz's as the force vanishes", "", (Known(_SOURCE, 1.0),), "the formula holds in its limit"
            ),
            Quantity(
                "peak",
                "peak pressure, on the plane of symmetry",
                "MPa",
                (Known(_SOURCE, PEAK),),
                "strains are a quarter: the difference falls with the strain, by half where the force falls to an eighth",
            ),
            Quantity("peak of both", "peak pressure, both deformed", "MPa", (Known(_SOURCE, PEAK),), "as above"),
            Quantity("approach", "approach", "mm", (Known(_SOURCE, APPROACH),), "hemispheres are held at their equators: no half-spaces"),
            Quantity("contact radius", "contact radius", "mm", (Known(_SOURCE, PUBLISHED_RADIUS),), "to an element"),
        ),
        (Drawing("radii", "pressures", "radius, mm", "pressure, MPa", {_SOURCE: _HERTZ}),),
        Beside(
            "Both deformed, by the law neo-hookean-j, which CalculiX has. Octants have a hole at their axis and a cavity at their centre, "
            "are pressed by way, and told at the force.",
            by_way,
            by_others,
            {"approach": Bound(at_least=3.6, at_most=4.4, reason="theory: Hertz; strains of a quarter, bodies held at their equators")},
            ("L1",),
        ),
    ),
)
