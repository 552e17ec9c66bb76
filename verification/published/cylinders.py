"""Curved patch test: two cylinders in each other under pressure inside, tied or sliding, against Lamé's solution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from published.benchmark import Benchmark, Drawing, Known, Quantity

from isomortar.geometry.patch import Direction, FloatArray
from isomortar.harness import Bound, Convergence, Order, Shown, case
from isomortar.harness.cases import Claim
from isomortar.harness.orders import regression
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Problem
from isomortar.model.numbering import Numbering
from isomortar.results.bezier import functions_at, rational
from isomortar.results.stress import cauchy_stress, deformation_gradient
from isomortar.scene import Scene
from isomortar.scene.toml_text import dump
from isomortar.solve.record import StepResult

#: Radii: of the bore, the joint, the outer surface. Young's moduli of both, and Poisson's ratio.
BORE, JOINT, OUTSIDE = 1.0, 1.5, 2.0
YOUNG, POISSON = {"inner": 1.0, "outer": 3.0}, 0.3
#: How both are joined: one mesh of both; sticking, or sliding, with elements that do not match, and the slave inside or outside.
JOINTS = ("glued", "tied", "sliding", "sliding, slave outside")
#: Elements through each wall by order: splines take the longer to the order of theory the higher that is, and round-off ends it.
#: Half as many are round the inner quarter; half as many again as that round the outer one, but where they are glued.
ELEMENTS = {"N2": (4, 6, 8, 12), "N3": (16, 20, 26, 34), "N4": (8, 10, 12, 16)}
#: Pressure in the bore, times 1, 2 and 4, and what solutions over it count for in the limit of none: terms of first and second order go.
PRESSURE, TIMES, SHARES = 1e-4, np.array([1.0, 2.0, 4.0]), np.array([8.0, -6.0, 1.0]) / 3.0
#: Gauss points an element through a wall; places an element round it.
_THROUGH, _ROUND = 6, np.array([0.1, 0.5, 0.9])
_RADII = {"inner": (BORE, JOINT), "outer": (JOINT, OUTSIDE)}
_TIGHT = {"newton_tolerance": 1e-12, "complementarity_tolerance": 1e-11}


def problem(kind: str, joint: str, elements: int, pressure: float) -> Problem:
    """Quarters of both cylinders in plane strain."""
    order, rows = int(kind[1:]), {"inner": elements // 2, "outer": elements // 2 if joint == "glued" else 3 * elements // 4}
    planes = (("u0", "y"), ("u1", "x"), ("w0", "z"), ("w1", "z"))
    scene: dict[str, Any] = {
        "format": 1,
        "name": "cylinders",
        "materials": {body: {"law": "linear-elastic", "young": young, "poisson": POISSON} for body, young in YOUNG.items()},
        "bodies": {
            body: {
                "material": body,
                "geometry": {"kind": "ring", "axis": "z", "angles": [0, 90], "width": 0.25, "inner": radii[0], "outer": radii[1]},
                "mesh": {"order": [order, order, 1], "elements": [rows[body], elements, 1]},
            }
            for body, radii in _RADII.items()
        },
        "supports": {f"{body}-{face}": {"face": f"{body}.{face}", "components": [along]} for body in _RADII for face, along in planes},
        "loads": {"bore": {"face": "inner.v0", "pressure": pressure}},
        "stages": [{"name": "press", "steps": 1}],
        "solver": _TIGHT,
    }
    faces = ["inner.v1", "outer.v0"]
    if joint == "glued":
        scene["glue"] = [faces]
    else:
        slave, master = faces[::-1] if "outside" in joint else faces
        scene["contacts"] = {"joint": {"slave": slave, "master": master, "friction": 1.0 if joint == "tied" else 0.0}}
    return Scene.from_toml(dump(scene)).problem()


@dataclass(frozen=True)
class Wall:
    """Lamé's solution in a wall in plane strain: radial stress `mean` - `drop` / r^2."""

    young: float
    mean: float
    drop: float

    @classmethod
    def under(cls, young: float, radii: tuple[float, float], pressures: tuple[float, float]) -> Wall:
        """The wall between two radii by the pressures on them."""
        inside, outside = (radius**-2 for radius in radii)
        drop = (pressures[0] - pressures[1]) / (inside - outside)
        return cls(young, drop * inside - pressures[0], drop)

    def stress(self, radii: FloatArray) -> FloatArray:
        """Radial stress."""
        return self.mean - self.drop / radii**2

    def displacement(self, radii: FloatArray) -> FloatArray:
        """Outwards."""
        return (1.0 + POISSON) / self.young * ((1.0 - 2.0 * POISSON) * self.mean * radii + self.drop / radii)


def exact() -> tuple[dict[str, Wall], float]:
    """Both walls under a pressure of one in the bore, and the pressure in the joint, at which they move alike."""

    def walls(joint: float) -> dict[str, Wall]:
        pressures = {"inner": (1.0, joint), "outer": (joint, 0.0)}
        return {body: Wall.under(YOUNG[body], radii, pressures[body]) for body, radii in _RADII.items()}

    def apart(joint: float) -> float:
        inner, outer = (float(wall.displacement(np.array(JOINT))) for wall in walls(joint).values())
        return inner - outer

    joint = apart(0.0) / (apart(0.0) - apart(1.0))
    return walls(joint), joint


@dataclass(frozen=True)
class Solution:
    """Displacements outwards and radial stresses at places in both walls, and pressures in the joint, over the pressure in the bore.

    `areas`: of the places, shape (n,).
    """

    areas: FloatArray
    displacement: FloatArray
    stress: FloatArray
    pressure: FloatArray

    def off(self, other: Solution) -> dict[str, float]:
        """Difference from another one: of displacement and stress in L2 over the other's norm, of the pressure the largest one."""
        found = {}
        for name in ("displacement", "stress"):
            wanted = getattr(other, name)
            found[name] = float(np.sqrt(self.areas @ (getattr(self, name) - wanted) ** 2 / (self.areas @ wanted**2)))
        return found | {"pressure": float(np.abs(self.pressure / other.pressure - 1.0).max(initial=0.0))}


def solved(kind: str, joint: str, elements: int, pressure: float) -> tuple[Solution, Solution]:
    """What is found in the limit of no pressure, from a small one, and what Lamé says."""
    runs = []
    for times in TIMES:
        given = problem(kind, joint, elements, times * pressure)
        *_, step = Simulation(given).run()
        found, wanted = _looked_at(given, step, times * pressure)
        runs.append(found)
    limit = [np.tensordot(SHARES, [getattr(run, name) for run in runs], 1) for name in ("displacement", "stress", "pressure")]
    return Solution(wanted.areas, *limit), wanted


def _looked_at(given: Problem, step: StepResult, pressure: float) -> tuple[Solution, Solution]:
    """A run, and Lamé, at the same places."""
    numbering, (walls, joint) = Numbering(given), exact()
    parts: list[tuple[FloatArray, ...]] = []
    for body in given.bodies:
        positions = numbering.of_patch(body.name, step.state.positions)
        parameters, areas = _places(body)
        functions = [functions_at(d, x)[0] for d, x in zip(body.patch.directions, parameters, strict=True)]
        both, _ = rational(functions, body.patch.weights, np.column_stack([body.patch.control_points, positions]))
        radius = np.hypot(both[:, 0], both[:, 1])
        outward = both[:, :2] / radius[:, None]
        moved = np.einsum("ni,ni->n", outward, both[:, 3:5] - both[:, :2])
        stress = cauchy_stress(body.material, deformation_gradient(body, positions, parameters))[:, :2, :2]
        radial = np.einsum("ni,nij,nj->n", outward, stress, outward)
        wall = walls[body.name]
        parts.append((areas * radius, moved / pressure, radial / pressure, wall.displacement(radius), wall.stress(radius)))
    areas, moved, radial, wanted, tension = (np.concatenate(part) for part in zip(*parts, strict=True))
    between = step.contacts[0].pressure_field if step.contacts else np.zeros(0)
    return Solution(areas, moved, radial, between / pressure), Solution(areas, wanted, tension, np.full(len(between), joint))


def _places(body: Body) -> tuple[list[FloatArray], FloatArray]:
    """Parameters along u, v, w at which a body is looked at, and areas over the radius (both walls are as thick), u fastest."""
    gauss, weights = np.polynomial.legendre.leggauss(_THROUGH)
    around, through, deep = body.patch.directions
    parameters = [_inside(around, _ROUND), _inside(through, (1.0 + gauss) / 2.0), _inside(deep, np.array([0.5]))]
    lengths = np.outer(np.diff(through.boundaries), weights).ravel()
    return parameters, np.repeat(lengths, len(parameters[0])) / len(parameters[0])


def _inside(direction: Direction, shares: FloatArray) -> FloatArray:
    """The same shares of every element, as parameters."""
    return (direction.boundaries[:-1, None] + np.outer(np.diff(direction.boundaries), shares)).ravel()


def _held(mesh: str) -> dict[str, Claim]:
    """Claims by a kind and a joint; bodies that are glued have no contact whose pressure could be told."""
    order = int(mesh[1])
    claims: dict[str, Claim] = {
        "elements": Shown("through each wall"),
        "displacements": Shown("errors in L2, relative"),
        "stresses": Shown("errors in L2 of the radial stress, relative"),
    }
    for name, expected in (("displacement", order + 1), ("stress", order)):
        reason = "theory: best approximation by order p, smooth solution, exact circles"
        near = Bound(
            at_least=expected - 0.25, at_most=expected + 0.05, reason=f"{reason}; less at the ends of splines, by the element size"
        )
        claims |= {f"order of {name}": near} | ({name: Order(expected, reason=reason)} if order < 4 else {})
    if mesh.endswith("glued"):
        return claims
    exactly = "theory: Lamé's; a traction from its equation has order 2 p, 2e-6 at 4 elements of order 2 and a 81st of it at 12"
    return claims | {
        "pressure": Bound(at_most=1e-7, reason=exactly),
        "pressure in the joint": Shown("mean, over the pressure in the bore"),
    }


@case(
    claim="Cylinders in each other carry Lamé's stresses, glued, tied or sliding, whichever is the slave, with the orders of theory.",
    tier=lambda mesh: "gate" if mesh.startswith("N2") else "nightly",
    grid={"mesh": tuple(f"N{order} {joint}" for joint in JOINTS for order in (2, 3, 4))},
    bounds=_held,
)
def concentric_cylinders(mesh: str) -> dict[str, Any]:
    """Errors of four meshes; the last one's pressure in the joint, largest difference and mean."""
    kind, joint = mesh.split(" ", 1)
    runs = [solved(kind, joint, count, PRESSURE) for count in ELEMENTS[kind]]
    errors = [found.off(wanted) for found, wanted in runs]
    load = solved(kind, joint, ELEMENTS[kind][0], PRESSURE / 2)[0].off(runs[0][0])
    sizes = 1.0 / np.array(ELEMENTS[kind])
    numbers: dict[str, Any] = {"elements": np.array(ELEMENTS[kind])}
    for name, plural in (("displacement", "displacements"), ("stress", "stresses")):
        numbers[plural] = np.array([error[name] for error in errors])
        numbers[f"order of {name}"] = regression(np.log(sizes), np.log(numbers[plural]))[0]
        if kind != "N4":
            numbers[name] = Convergence(sizes, numbers[plural], {"load": load[name]})
    if joint != "glued":
        numbers |= {"pressure": errors[-1]["pressure"], "pressure in the joint": float(runs[-1][0].pressure.mean())}
    return numbers


BENCHMARKS = (
    Benchmark(
        "concentric_cylinders",
        "Curved patch test",
        f"Two cylinders in each other, radii {BORE:g}, {JOINT:g} and {OUTSIDE:g}, the outer one three times stiffer, in plane strain and "
        "small strain (the limit of no pressure, from three small ones). Glued they have one mesh; tied by friction and sliding without, "
        "two thirds as many elements round the inner one as round the outer one. ± is here what it changes that the slave is outside.",
        "",
        ("N4 sliding", "N4 sliding, slave outside"),
        (
            Quantity("pressure in the joint", "pressure in the joint over that in the bore", "", (Known("Lamé", exact()[1]),)),
            Quantity("order of displacement", "order of the displacement", "", (Known("theory, order 4", 5.0),)),
            Quantity("order of stress", "order of the radial stress", "", (Known("theory, order 4", 4.0),)),
        ),
        (
            Drawing("elements", "displacements", "elements through a wall", "error of the displacement", {}, log=True),
            Drawing("elements", "stresses", "elements through a wall", "error of the radial stress", {}, log=True),
        ),
        "GetFEM and CalculiX have Lagrange elements: with facets in the place of circles, that do not match, it is another problem.",
    ),
)
