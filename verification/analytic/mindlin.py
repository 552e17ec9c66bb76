"""Cattaneo and Mindlin: round bodies pressed together and sheared by less than friction bears; the middle sticks, the rest slips.

Two equal bodies, so that pressure and shear do not act on each other (Dundurs' second constant is zero, and by symmetry so is the tilt
of finite bodies), of Poisson's ratio zero, so that all slip is along the shear and plane strain needs no supports: then the solution is
exact in small strain. Forces are computed; contact radius a, stick radius c and tractions follow from them:
c = a (1 - Q / mu P)^(1/3) of spheres, ^(1/2) of cylinders.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from spheres import Cap

from isomortar.geometry.patch import FloatArray
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.harness import Bound, Curve, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, Stage, Support
from isomortar.results.bezier import rational, sampling_matrix
from isomortar.results.fields import ContactSurface, contact_surfaces

MATERIAL = Material(10.0, 0.0)
FRICTION, RADIUS, CONTACT = 0.3, 1.0, 0.01
#: Extent of the uniform elements, in contact radii; samples of the tractions per element.
FINE, SAMPLES = 1.25, 8


@dataclass(frozen=True)
class Setting:
    """A shape's bodies: their width and height in contact radii, elements up to FINE and beyond, approach, shear, its law.

    Both bodies have the same elements: the pressing draws their surfaces inwards, equally, and meshes that do not match would make shear
    of the difference. `root`: c / a is this root of 1 - Q / mu P. The shear makes Q about 0.6 mu P.
    """

    size: float
    elements: int
    growing: int
    approach: float
    shear: float
    root: int


SETTINGS = {
    "cylinder": Setting(12.0, 20, 8, 3.0e-4, 5e-5, 2),
    "sphere": Setting(6.0, 6, 3, 2e-4, 2.75e-5, 3),
}


def cap(setting: Setting) -> Cap:
    """Either body."""
    return Cap(RADIUS, setting.size * CONTACT, setting.size * CONTACT, FINE * CONTACT, setting.elements, setting.growing)


def sheared(shape: str, setting: Setting) -> Problem:
    """The upper body is pressed down, then moved along x; the lower one is held."""
    round_body = cap(setting)
    patches = {
        name: round_body.block("N2", below) if shape == "sphere" else round_body.cylinder("N2", CONTACT, below)
        for name, below in (("slave", False), ("master", True))
    }
    bodies = tuple(
        Body(name, patch, MATERIAL, tuple(volume_points(d) for d in patch.directions))  # type: ignore[arg-type]
        for name, patch in patches.items()
    )
    motions = Motion((0.0, 0.0, -setting.approach)), Motion((setting.shear, 0.0, 0.0))
    supports = Support("top", Face("slave", "w1"), motions), Support("bottom", Face("master", "w0"), (Motion(), Motion()))
    along, across = patches["slave"].face_directions("w0")
    points = contact_points(along), contact_points(across)
    contact = Contact("contact", Face("slave", "w0"), Face("master", "w1"), FRICTION, points)
    return Problem("mindlin", bodies, (contact,), supports, (Stage("press", 3), Stage("shear", 2)))


@dataclass(frozen=True)
class Theory:
    """The solution for computed forces: contact and stick radius, and friction times Hertz's peak pressure."""

    contact: float
    stick: float
    peak: float

    def bearable(self, radii: FloatArray) -> FloatArray:
        """Friction times pressure."""
        return self.peak * _root(radii / self.contact)

    def traction(self, radii: FloatArray) -> FloatArray:
        """Tangential traction along the shear."""
        return self.bearable(radii) - self.peak * self.stick / self.contact * _root(radii / self.stick)


def theory(shape: str, normal: float, shear: float) -> Theory:
    """Hertz's and Cattaneo's radii from the forces of whole bodies; cylinders are CONTACT long."""
    modulus, radius = MATERIAL.young / (1 - MATERIAL.poisson**2) / 2, RADIUS / 2
    if shape == "sphere":
        contact = float(np.cbrt(3 * normal * radius / (4 * modulus)))
        peak = 1.5 * normal / (np.pi * contact**2)
    else:
        contact = float(np.sqrt(4 * normal / CONTACT * radius / (np.pi * modulus)))
        peak = 2 * normal / CONTACT / (np.pi * contact)
    stick = contact * float(np.maximum(0.0, 1 - shear / (FRICTION * normal))) ** (1 / SETTINGS[shape].root)
    return Theory(contact, stick, FRICTION * peak)


def _root(share: FloatArray) -> FloatArray:
    return np.sqrt(np.maximum(0.0, 1.0 - share**2))


def _sampled(surface: ContactSurface, traction: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places in the plane of contact and a field there, by row along x; shapes (rows, n, 2), (rows, n)."""
    u, v = (sampling_matrix(line, SAMPLES) for line in surface.directions)
    values, _ = rational((u, v), surface.weights, np.column_stack([surface.reference_points[:, :2], traction]))
    return values[:, :2].reshape(len(v), len(u), 2), values[:, 2].reshape(len(v), len(u))


@case(
    claim="Of two round bodies sheared by less than friction bears the middle sticks to Cattaneo's and Mindlin's radius within an element.",
    tier="nightly",
    grid={"shape": tuple(SETTINGS)},
    bounds={
        "share": Bound(at_least=0.4, at_most=0.8, reason="definition: partial slip; Q is 0.6 mu P but for the size of the bodies"),
        "stick": Bound(at_most=1.0, reason="discretisation: the border of stick lies somewhere in its element"),
        "slip": Bound(at_most=1.0, reason="discretisation: the border of slip lies somewhere in its element"),
        "along": Shown("discretisation: traction over mu p0 along the shear, against x / a"),
        "exact": Shown("theory: the same, by Cattaneo and Mindlin"),
        "distance": Bound(
            at_most=2.4, reason="theory: roots at both borders, each missed by a third over two elements: 1.2 h / a of mu p in L2"
        ),
    },
)
def partial_slip(shape: str) -> dict[str, object]:
    """Shear over mu P; the outermost stick and innermost slip from the stick radius, in elements; tractions; their distance in L2."""
    given = sheared(shape, SETTINGS[shape])
    result = list(Simulation(given).run())[-1]
    (surface,) = contact_surfaces(given, result)
    shear, _, normal = np.abs(result.contacts[0].force_slave)
    exact = theory(shape, float(normal), float(shear))
    size = FINE * CONTACT / SETTINGS[shape].elements
    along = result.state.contacts[0].traction[:, 0]  # master coordinates are lengths along x and y but for (a / 2R)^2
    places, traction = _sampled(surface, along * np.sign(along.sum()))
    centre = np.array([0.0, 0.0 if shape == "sphere" else np.nan])
    radii = np.sqrt(np.nansum((places - centre) ** 2, axis=2))
    control = np.sqrt(np.nansum((surface.reference_points[:, :2] - centre) ** 2, axis=1))
    zone = radii < FINE * CONTACT
    cells = np.linalg.norm(np.gradient(places, axis=1), axis=2) * np.linalg.norm(np.gradient(places, axis=0), axis=2)
    missed = np.sum((cells * (traction - exact.traction(radii)) ** 2)[zone])
    whole = np.sum((cells * exact.bearable(radii) ** 2)[zone])
    row = len(places) // 2
    x = places[row, zone[row], 0]
    return {
        "share": float(shear / (FRICTION * normal)),
        "stick": abs(float(control[surface.status == 1].max()) - exact.stick) / size,
        "slip": abs(float(control[surface.status == 2].min()) - exact.stick) / size,
        "along": Curve(x / exact.contact, traction[row, zone[row]] / exact.peak, "x / a", "q / mu p0", log_y=False),
        "exact": Curve(x / exact.contact, exact.traction(np.abs(x)) / exact.peak, "x / a", "q / mu p0", log_y=False),
        "distance": float(np.sqrt(missed / whole)) / (size / exact.contact),
    }
