"""Hertz: a sphere pressed on a rigid plane and on a sphere of its kind, both as bodies of revolution.

Hertz's numbers follow from the computed force, P = 4 E* a^3 / (3 R), so that the body's finite size counts by (a / size)^3 only and not
through its approach. Hertz holds at small strain: deviations are of the order of p0 / E* = 2 a / (pi R).

At the edge the pressure is a root of the distance, wherever the edge lies within its element: no order and no refinement of all elements
alike makes the error in L2 fall faster than with the element size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from slopes import fall
from spheres import Cap

from isomortar.geometry.patch import FloatArray
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.harness import Bound, Curve, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, RigidPlane, Stage, Support
from isomortar.results.bezier import rational, sampling_matrix
from isomortar.results.fields import ContactSurface, contact_surfaces
from isomortar.solve.record import ContactResult

#: Radius and expected contact radius in small strain; width and height of the body over the contact radius.
RADIUS, CONTACT, SIZE = 1.0, 0.01, 12.0
#: Elements that are equally long reach this far, in contact radii.
FINE = 1.5
#: Samples of the pressure per element; the edge is where it falls below this share of the peak (at 0.9987 a).
SAMPLES, EDGE = 8, 0.05
#: Elements up to FINE at nightly resolution: 15 over the contact radius.
NIGHTLY = 24
#: Meshes and load steps that the order is taken from.
MESHES, LOADS = (8, 12, 16, 24), 6
#: Load steps to finite strain.
STEPS = 3
#: Two hemispheres of literature: radius, Young's modulus, approach of their equators, and Hertz's peak pressure and contact radius.
HEMISPHERE, YOUNG, APPROACH, PEAK, PUBLISHED_RADIUS = 50.0, 20000.0, 4.0, 2798.3, 10.0

MASTERS = ("plane", "sphere")


def pressed(kind: str, cap: Cap, master: str, approach: float, material: Material, steps: int = 1) -> Problem:
    """A quarter of a body of revolution pressed on a rigid plane or on its mirror image with other elements, in load steps."""
    low = Cap(cap.radius, cap.width, cap.height, cap.fine, cap.elements * 4 // 3, cap.growing)
    patches = {"slave": cap.revolved(kind)} | ({"master": low.revolved(kind, below=True)} if master == "sphere" else {})
    bodies = tuple(
        Body(name, patch, material, tuple(volume_points(d) for d in patch.directions))  # type: ignore[arg-type]
        for name, patch in patches.items()
    )
    held = (("u0", (0, 1)), ("v0", (1,)), ("v1", (0,)))
    planes = [Support(f"{name}-{face}", Face(name, face), (Motion(),), components) for name in patches for face, components in held]
    ends = [Support("top", Face("slave", "w1"), (Motion((0.0, 0.0, -approach)),))]
    if master == "sphere":
        ends.append(Support("bottom", Face("master", "w0"), (Motion(),)))
    along, around = patches["slave"].face_directions("w0")
    other = Face("master", "w1") if master == "sphere" else RigidPlane((0, 0, 0), (0, 0, 1), (1, 0, 0))
    contact = Contact("contact", Face("slave", "w0"), other, 0.0, (contact_points(along), contact_points(around)))
    return Problem("hertz", bodies, (contact,), (*ends, *planes), (Stage("press", steps),))


@dataclass(frozen=True)
class Found:
    """What Hertz speaks of: the force of whole bodies, and by rings of the slave surface radii, pressures per current area, and areas.

    `radii`, `pressure`, `area`: shape (rings,).
    """

    force: float
    radii: FloatArray
    pressure: FloatArray
    area: FloatArray

    @property
    def peak(self) -> float:
        """Largest pressure."""
        return float(self.pressure.max())

    @property
    def edge(self) -> float:
        """Largest radius at which the pressure is above its share of the peak."""
        return float(self.radii[self.pressure > EDGE * self.peak].max())

    def hertz(self, radius: float, modulus: float) -> tuple[float, float]:
        """Contact radius and peak pressure of the force."""
        contact = float(np.cbrt(3 * self.force * radius / (4 * modulus)))
        return contact, 1.5 * self.force / (np.pi * contact**2)

    def distance(self, contact: float, peak: float) -> float:
        """L2 norm of the difference from Hertz's pressures over theirs."""
        exact = peak * np.sqrt(np.maximum(0.0, 1.0 - (self.radii / contact) ** 2))
        return float(np.sqrt(((self.pressure - exact) ** 2 @ self.area) / (exact**2 @ self.area)))


def measure(problem: Problem) -> list[Found]:
    """Run, and take the pressures along the first radius after every load step; all others are the same by symmetry."""
    return [profile(contact_surfaces(problem, result)[0], result.contacts[0]) for result in Simulation(problem).run()]


def profile(surface: ContactSurface, result: ContactResult) -> Found:
    """Pressures along the first radius of a quarter, whose first surface coordinate is along it."""
    along, around = (sampling_matrix(line, SAMPLES) for line in surface.directions)
    radius = along, around[:1]
    points, pressure, _ = surface.fields(radius)
    before, _ = rational(radius, surface.weights, surface.reference_points)
    area, reference = rings(points), rings(before)
    middle = (pressure[1:] + pressure[:-1]) / 2
    return Found(4 * abs(float(result.force_slave[2])), (points[1:, 0] + points[:-1, 0]) / 2, middle * reference / area, area)


def rings(points: FloatArray) -> FloatArray:
    """Areas of the rings that lie between points of a profile in the plane y = 0, shape (n, 3)."""
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.pi * (points[1:, 0] + points[:-1, 0]) * lengths


def pair(master: str, radius: float, material: Material) -> tuple[float, float]:
    """Hertz's radius and modulus of a sphere on a rigid plane or on its like."""
    modulus = material.young / (1 - material.poisson**2)
    return (radius, modulus) if master == "plane" else (radius / 2, modulus / 2)


def small(kind: str, master: str, elements: int, steps: int = 1) -> list[tuple[Found, float, float]]:
    """Contact in small strain, by load step: what is found, Hertz's contact radius and peak pressure of its force."""
    cap = Cap(RADIUS, SIZE * CONTACT, SIZE * CONTACT, FINE * CONTACT, elements, max(4, elements // 3))
    approach = CONTACT**2 / RADIUS * (1 if master == "plane" else 2)
    runs = measure(pressed(kind, cap, master, approach, Material(), steps))
    return [(found, *found.hertz(*pair(master, RADIUS, Material()))) for found in runs]


_PEAK = "theory: Hertz, small strain: p0 / E* = 0.006, finite size (1 / 12)^3; the rest is for the discretisation"
_LIMIT = "theory: terms of second order, twice the product of the strains, 0.06 and 0.03; the rest is for the discretisation"
_EDGE = "discretisation: the edge lies somewhere in its element"
_STRIP = "theory: a root at the edge, missed by a third over two elements: 1.2 h / a in L2"
_INTERVAL = "theory: the 95 % interval holds order 1, and neither 0 (no fall) nor 2 (no root)"


@case(
    claim="A sphere has Hertz's peak pressure within 1 % and his contact radius within an element, on a plane and on a sphere.",
    tier=lambda kind, master: "gate" if kind == "N2" else "nightly",  # noqa: ARG005
    grid={"kind": ("N2", "N3", "N4"), "master": MASTERS},
    bounds={
        "peak": Bound(at_most=0.01, reason=_PEAK),
        "radius": Bound(at_most=1.0, reason=_EDGE),
        "profile": Shown("discretisation: pressure over Hertz's peak against radius over Hertz's"),
        "distance": Bound(at_most=1.2, reason=_STRIP),
    },
)
def hertz(kind: str, master: str) -> dict[str, object]:
    """Relative error of the peak, error of the radius in elements, profile, and its distance from Hertz's in L2 over h / a."""
    ((found, contact, peak),) = small(kind, master, NIGHTLY)
    size = FINE * CONTACT / NIGHTLY
    inside = found.radii < FINE * contact
    return {
        "peak": abs(found.peak / peak - 1.0),
        "radius": abs(found.edge - contact) / size,
        "profile": Curve(found.radii[inside] / contact, found.pressure[inside] / peak, "r / a", "p / p0", log_y=False),
        "distance": found.distance(contact, peak) / (size / contact),
    }


@case(
    claim="The pressure approaches Hertz's with the element size, not faster at higher order: the edge is a root.",
    tier="nightly",
    grid={"kind": ("N1", "N2", "N3", "N4")},
    bounds={
        "curve": Bound(at_most=1.0, reason="theory: a consistent method has no error of the size of the solution"),
        "order": Bound(
            at_least=0.5, at_most=1.5, reason="theory: order 1 in L2 at the root; the edge's place in its element scatters it by a half"
        ),
        "low": Bound(at_least=0.0, at_most=1.0, reason=_INTERVAL),
        "high": Bound(at_least=1.0, at_most=2.0, reason=_INTERVAL),
    },
)
def hertz_against_elements(kind: str) -> dict[str, object]:
    """Distance from Hertz's pressures in L2 by elements over the contact radius, its order, and the ends of the order's interval.

    Each mesh gives six contact radii, so that the edge comes to lie in many places of its element.
    """
    found = []
    for count in MESHES:
        for run, contact, peak in small(kind, "plane", count, LOADS):
            found.append((contact * count / (FINE * CONTACT), run.distance(contact, peak)))
    places, errors = np.array(sorted(found)).T
    return {"curve": Curve(places, errors, "elements over a", "relative error in L2", log_x=True), **fall(places, errors)}


@case(
    claim="Two hemispheres (R = 50, E = 20000, nu = 0.3) come to Hertz's numbers as their approach becomes small against 4.",
    tier="nightly",
    bounds={
        "formula": Bound(at_most=5e-5, reason="reference: p0 = 2798.3 and a = 10 follow from Hertz's formulas for an approach of 4"),
        "force": Shown("theory: terms of first order in the strain, p0 / E*, which is 0.25 at first: their factor"),
        "approach": Shown("theory: the same, and the size of the body, whose share falls with a too"),
        "limit by force": Bound(at_most=5e-3, reason=_LIMIT),
        "limit by approach": Bound(at_most=5e-3, reason=_LIMIT),
        "peak": Shown("theory: peak pressure over 2798.3 at an approach of 4: finite strain, where Hertz does not hold"),
        "radius": Shown("theory: contact radius over 10 at an approach of 4"),
    },
)
def hemispheres() -> dict[str, object]:
    """Deviations of the peak from Hertz's, for the force and for the approach, over p0 / E*, for approaches from 4 to 4 / 64.

    And what is left of them in the limit of no strain, by the last two: terms of first order fall by half from the one to the other.
    Each is pressed on a rigid plane, their plane of symmetry, by half the approach. The rims are cut to a cylinder of 0.96 radii.
    """
    material = Material(YOUNG, 0.3)
    radius, modulus = pair("plane", HEMISPHERE, material)
    approaches = APPROACH / 4.0 ** np.arange(4)
    contacts = np.sqrt(radius * approaches / 2)
    peaks = 2 * modulus * contacts / (np.pi * radius)
    runs = []
    for approach, contact in zip(approaches, contacts, strict=True):
        cap = Cap(HEMISPHERE, 1.5 * HEMISPHERE, HEMISPHERE, FINE * contact, NIGHTLY, NIGHTLY // 2)
        runs.append(measure(pressed("N2", cap, "plane", float(approach / 2), material, STEPS))[-1])
    strain = peaks / modulus
    found = np.array([run.peak for run in runs])
    by_force = np.array([run.peak / run.hertz(radius, modulus)[1] for run in runs])
    formula = float(np.maximum(abs(peaks[0] / PEAK - 1.0), abs(contacts[0] / PUBLISHED_RADIUS - 1.0)))
    return {
        "formula": float(formula),
        "force": Curve(approaches, np.abs(by_force - 1.0) / strain, "approach", "deviation over p0 / E*", log_x=True),
        "approach": Curve(approaches, np.abs(found / peaks - 1.0) / strain, "approach", "deviation over p0 / E*", log_x=True),
        "limit by force": abs(2.0 * by_force[-1] - by_force[-2] - 1.0),
        "limit by approach": abs(2.0 * found[-1] / peaks[-1] - found[-2] / peaks[-2] - 1.0),
        "peak": float(found[0] / PEAK),
        "radius": runs[0].edge / PUBLISHED_RADIUS,
    }
