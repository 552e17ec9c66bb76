"""Curved patch test: a cylinder that is too large for the one around it; the pressure between them is the same everywhere.

Quarters of two concentric cylinders that overlap by the interference, held in plane strain. NURBS hold the circles and the radial motion
exactly along the angle, so that what is left there is the quadrature's error, as in the flat test; Lagrange elements approximate both.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.integrate import solve_bvp
from shapes import cylinder_sector

from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.geometry.refinement import mesh
from isomortar.harness import LAGRANGE, NURBS, Bound, Curve, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, Stage, Support
from isomortar.model.settings import SolverSettings

MATERIAL = Material()
#: Radii of the inner bore, the joint and the outer surface before the interference.
BORE, JOINT, OUTSIDE = 1.0, 1.5, 2.0
#: Elements of the slave along the angle, and layers of each body along the radius.
SLAVE_ELEMENTS, LAYERS = 3, 2
#: Elements of the master along the angle. With four Lagrange elements a point of an odd rule in the middle slave element would lie on a
#: knot line, where normals jump and Newton's method goes to and fro.
MASTER_ELEMENTS = {"N": 4, "L": 5}
#: Interference of the test in finite deformation, about six times the sagitta of the coarsest polygon, and of that in small strain.
LARGE, SMALL = 0.3, 1e-4


def cylinder(kind: str, inner: float, outer: float, elements: int) -> Patch:
    """A quarter; u, v, w run along radius, angle and axis. N1 can not hold an arc: it is the polygon of L1."""
    family, order = ("L", 1) if kind == "N1" else (kind[0], int(kind[1:]))
    return mesh(cylinder_sector(inner, outer, np.pi / 2, 0.5), (family,) * 3, (order, order, 1), (LAYERS, elements, 1))  # type: ignore[arg-type]


def hold(body: str, face: str, component: int) -> Support:
    """Hold one component of a face."""
    return Support(f"{body}-{face}", Face(body, face), (Motion(),), components=(component,))


def problem(kind: str, interference: float) -> Problem:
    """The slave inside, its outer radius larger than the master's bore by the interference."""
    patches = {
        "slave": cylinder(kind, BORE, JOINT + interference, SLAVE_ELEMENTS),
        "master": cylinder(kind, JOINT, OUTSIDE, MASTER_ELEMENTS[kind[0]]),
    }
    bodies = tuple(
        Body(name, patch, MATERIAL, tuple(volume_points(d) + 1 for d in patch.directions))  # type: ignore[arg-type]
        for name, patch in patches.items()
    )
    along, across = patches["slave"].face_directions("u1")
    points = (contact_points(along), contact_points(across))
    planes = (("v0", 1), ("v1", 0), ("w0", 2), ("w1", 2))
    return Problem(
        name="curved-patch-test",
        bodies=bodies,
        contacts=(Contact("joint", Face("slave", "u1"), Face("master", "u0"), 0.0, points),),
        supports=tuple(hold(body, face, component) for body in patches for face, component in planes),
        stages=(Stage("fit", 1),),
        settings=SolverSettings(newton_tolerance=1e-10),
    )


def principal(stretches: FloatArray) -> FloatArray:
    """Principal first Piola stresses (theory 8.3) by principal stretches, shape (3, n)."""
    j = np.prod(stretches, axis=0)
    squares = (stretches**2).sum(axis=0)
    return MATERIAL.bulk * np.log(j) / stretches + MATERIAL.shear * j ** (-2 / 3) * (stretches - squares / (3 * stretches))


def bend(radius: FloatArray, place: FloatArray, stretch: FloatArray) -> FloatArray:
    """Second derivative of the deformed radius that balances P_R' + (P_R - P_T) / R = 0; slopes of P_R by complex steps."""
    stretches = np.array([stretch, place / radius, np.ones_like(radius)])
    step = 1e-30
    slopes = [principal(stretches + 1j * step * np.eye(3)[:, [k]])[0].imag / step for k in (0, 1)]
    radial, around, _ = principal(stretches)
    return -(slopes[1] * (stretch - place / radius) / radius + (radial - around) / radius) / slopes[0]


def exact_pressure(interference: float) -> float:
    """Pressure per reference area of the slave, from the radial boundary value problem of both cylinders, to 1e-9."""
    ends = np.array([[BORE, JOINT + interference], [JOINT, OUTSIDE]])
    lengths = np.diff(ends)[:, 0]

    def slopes(t: FloatArray, y: FloatArray) -> FloatArray:
        rows = []
        for k in range(2):
            place, stretch = y[2 * k : 2 * k + 2]
            rows += [lengths[k] * stretch, lengths[k] * bend(ends[k, 0] + lengths[k] * t, place, stretch)]
        return np.array(rows)

    def radial(k: int, end: int, y: FloatArray) -> float:
        return float(principal(np.array([[y[2 * k + 1]], [y[2 * k] / ends[k, end]], [1.0]]))[0, 0])

    def conditions(first: FloatArray, last: FloatArray) -> FloatArray:
        joint = radial(0, 1, last) * ends[0, 1] - radial(1, 0, first) * ends[1, 0]
        return np.array([radial(0, 0, first), last[0] - first[2], joint, radial(1, 1, last)])

    t = np.linspace(0, 1, 21)
    shift = interference / 2
    start = np.array([BORE - shift + lengths[0] * t, 0 * t + 1, JOINT + shift + lengths[1] * t, 0 * t + 1])
    found = solve_bvp(slopes, conditions, t, start, tol=1e-10, max_nodes=20000)
    if not found.success:
        raise RuntimeError(f"reference: {found.message}")
    return -radial(0, 1, found.y[:, -1])


def lame_pressure(interference: float) -> float:
    """Lamé's pressure of two thick cylinders of one material in plane strain."""
    modulus = MATERIAL.young / (1 - MATERIAL.poisson**2)
    inside, outside = JOINT**2 - BORE**2, OUTSIDE**2 - JOINT**2
    return modulus * interference * inside * outside / (2 * JOINT**3 * (OUTSIDE**2 - BORE**2))


def pressure_error(given: Problem, exact: float) -> float:
    """Largest relative error of the pressure field at the quadrature points."""
    (result,) = Simulation(given).run()
    return float(np.abs(result.contacts[0].pressure_field / exact - 1.0).max())


SIZE = Bound(at_most=1.0, reason="theory: a consistent method has no error of the size of the solution")


def curve(kinds: Sequence[str]) -> Curve:
    """Errors of the pressure field by discretisation, in finite deformation, on one mesh."""
    exact = exact_pressure(LARGE)
    found = [pressure_error(problem(kind, LARGE), exact) for kind in kinds]
    return Curve([int(kind[1:]) for kind in kinds], found, "order", "relative error of the pressure")


@case(
    claim="The pressure between concentric cylinders is uniform, and its error falls with every order of NURBS.",
    tier="gate",
    bounds={
        "curve": SIZE,
        "rise": Bound(at_most=1.0, reason="theory: best approximation, geometry and quadrature all gain with the order"),
        "last": Bound(at_most=2e-5, reason="quadrature: as the flat test at order 5, with as much again for the radial functions"),
    },
)
def pressure_against_order() -> dict[str, object]:
    """Errors of the pressure field for N1 to N5, the largest ratio of neighbours, and the last."""
    found = curve(NURBS)
    errors = np.asarray(found.y)
    return {"curve": found, "rise": float((errors[1:] / errors[:-1]).max()), "last": float(errors[-1])}


@case(
    claim="Lagrange elements carry the pressure between concentric cylinders, with an error that no order takes away.",
    tier="nightly",
    bounds={"curve": SIZE, "margin": Shown("quadrature: slopes of their functions jump inside slave elements at any order")},
)
def lagrange_pressure_against_order() -> dict[str, object]:
    """Errors of the pressure field for L1 to L4, and the last over the smallest."""
    found = curve(LAGRANGE)
    errors = np.asarray(found.y)
    return {"curve": found, "margin": float(errors[-1] / errors.min())}


@case(
    claim="A small interference makes Lamé's pressure.",
    tier="gate",
    grid={"kind": ("N2", "N3")},
    bounds=lambda kind: {
        "pressure": Bound(
            at_most={"N2": 5e-3, "N3": 1e-3}[kind],
            reason="quadrature: as the flat patch test; finite strain adds some 1e-4",
        ),
        "reference": Bound(at_most=1e-3, reason="theory: small strain; terms of second order are some times the strain of 1e-4"),
    },
)
def lame(kind: str) -> dict[str, float]:
    """Relative errors of the pressure field and of the reference in finite deformation against Lamé."""
    exact = lame_pressure(SMALL)
    return {"pressure": pressure_error(problem(kind, SMALL), exact), "reference": abs(exact_pressure(SMALL) / exact - 1.0)}
