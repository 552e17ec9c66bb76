"""Spheres pressed together by a force and sheared by another that grows: Cattaneo's and Mindlin's stick radius and tractions."""

from __future__ import annotations

from typing import Any

import numpy as np
from analytic.mindlin import CONTACT, FINE, FRICTION, MATERIAL, RADIUS, Theory, theory
from published.benchmark import Benchmark, Drawing, Known, Quantity
from spheres import Cap

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.results.bezier import rational, sampling_matrix
from isomortar.results.fields import ContactSurface, contact_surfaces
from isomortar.scene import Scene
from isomortar.scene.geometry_file import patch_table
from isomortar.scene.toml_text import dump

#: Shares of the shear that friction bears, and that at which tractions are drawn.
SHARES, DRAWN = (0.25, 0.5, 0.75, 0.9), 0.5
#: The force that makes the contact radius: Hertz's, of two equal spheres whose Poisson's ratio is zero.
FORCE = 4.0 / 3.0 * (MATERIAL.young / 2.0) * CONTACT**3 / (RADIUS / 2.0)
#: Kinds; elements up to FINE contact radii, and beyond. Bodies are as wide and as high as so many contact radii.
MESHES = {"N2 coarse": (6, 3), "N2 fine": (8, 3), "N3 coarse": (6, 3)}
_SIZE = 6.0
#: Tractions in the middle are told by their means up to this share of the contact radius.
MIDDLE = 0.25
#: Samples of the tractions an element.
_SAMPLES = 8


def problem(mesh: str) -> Problem:
    """Halves of both, meshes that match: the upper one is pressed down, then the lower one pulled along."""
    kind, (elements, growing) = mesh.split()[0], MESHES[mesh]
    cap = Cap(RADIUS, _SIZE * CONTACT, _SIZE * CONTACT, FINE * CONTACT, elements, growing)
    scene = {
        "format": 1,
        "name": "sheared",
        "materials": {"both": {"young": MATERIAL.young, "poisson": MATERIAL.poisson}},
        "bodies": {name: {"patch": patch_table(cap.block(kind, below, half=True))} for name, below in (("upper", False), ("lower", True))},
        "contacts": {"face": {"slave": "upper.w0", "master": "lower.w1", "friction": FRICTION}},
        "supports": {
            "top": {"face": "upper.w1", "force": {"z": -FORCE / 2.0}},
            "bottom": {"face": "lower.w0", "force": {"x": FRICTION * FORCE / 2.0}},
            "upper-middle": {"face": "upper.v0", "components": ["y"]},
            "lower-middle": {"face": "lower.v0", "components": ["y"]},
        },
        "stages": [
            {"name": "press", "steps": 2, "loads": {"bottom": 0.0}},
            *({"name": f"shear-{100 * share:g}", "steps": 1, "loads": {"bottom": share}} for share in SHARES),
        ],
    }
    return Scene.from_toml(dump(scene)).problem()


def _sampled(surface: ContactSurface) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Places in the plane of contact, pressures and tractions along the shear, by row along x; shapes (rows, n, 2) and twice (rows, n)."""
    u, v = (sampling_matrix(line, _SAMPLES) for line in surface.directions)
    fields = np.column_stack([surface.reference_points[:, :2], surface.pressure, surface.covariant[:, 0]])
    values = rational((u, v), surface.weights, fields)[0].reshape(len(v), len(u), 4)
    return values[..., :2], values[..., 2], np.abs(values[..., 3])


def stick(surface: ContactSurface) -> float:
    """Stick radius over contact radius, by tractions in the middle.

    They are friction times Hertz's pressures less those of the stick radius, which are as much smaller as that is.
    """
    places, pressure, traction = _sampled(surface)
    middle = np.hypot(*np.moveaxis(places, 2, 0)) < MIDDLE * CONTACT
    return 1.0 - float(traction[middle].sum() / (FRICTION * pressure[middle].sum()))


def _exact(share: float) -> float:
    """Stick radius over contact radius."""
    return float(np.cbrt(1.0 - share))


@case(
    claim="Spheres that are sheared by a force stick within Cattaneo's and Mindlin's radius, to a quarter of an element.",
    tier="nightly",
    grid={"mesh": tuple(MESHES)},
    bounds={
        "forces": Bound(at_most=1e-8, reason="theory: equilibrium, to the tolerance of Newton's method times ten"),
        "off": Bound(
            at_most=0.25, reason="discretisation: where stick ends within an element tractions have a kink, which spreads over it"
        ),
        **{f"stick at {share:g}": Shown("radius over the contact radius, by tractions in the middle") for share in SHARES},
        "shares": Shown("of the shear that friction bears"),
        "sticks": Shown("radius over the contact radius"),
        "places": Shown("x over the contact radius"),
        "tractions": Shown("along the shear, over friction times Hertz's peak pressure"),
    },
)
def sheared_by_force(mesh: str) -> dict[str, Any]:
    """Forces of the contact off those prescribed; stick radii off the exact ones, the largest, in elements; tractions."""
    given = problem(mesh)
    steps = list(Simulation(given).run())[-len(SHARES) :]
    surfaces = [contact_surfaces(given, step)[0] for step in steps]
    wanted = FORCE / 2.0 * np.array([[FRICTION * share, 1.0] for share in SHARES])
    found = np.array([np.abs(step.contacts[0].force_slave[[0, 2]]) for step in steps])
    sticks = np.array([stick(surface) for surface in surfaces])
    places, _, traction = _sampled(surfaces[SHARES.index(DRAWN)])
    near = np.abs(places[0, :, 0]) < 1.2 * CONTACT
    return {
        "forces": float(np.abs(found - wanted).max() / FORCE),
        "off": float(np.abs(sticks - np.cbrt(1.0 - np.array(SHARES))).max() * MESHES[mesh][0] / FINE),
        **{f"stick at {share:g}": float(value) for share, value in zip(SHARES, sticks, strict=True)},
        "shares": np.array(SHARES),
        "sticks": sticks,
        "places": places[0, near, 0] / CONTACT,
        "tractions": traction[0, near] / _THEORY.peak,
    }


_THEORY: Theory = theory("sphere", FORCE, DRAWN * FRICTION * FORCE)
_SOURCE = "Cattaneo, Mindlin"
_ALONG, _GROWING = np.linspace(-1.2, 1.2, 121), np.linspace(0.0, 1.0, 101)
_TRACTIONS = np.column_stack([_ALONG, _THEORY.traction(_ALONG * CONTACT) / _THEORY.peak])
_WITHIN = "within a quarter of an element, which is a sixth of the contact radius"
BENCHMARKS = (
    Benchmark(
        "sheared_by_force",
        "Cattaneo and Mindlin by force",
        f"Two equal spheres are pressed together by the force P of Hertz's contact radius a, a hundredth of theirs, and sheared by a force "
        f"Q that grows at constant P, friction {FRICTION:g}, Poisson's ratio 0: what sticks has the radius c = a (1 - Q / mu P)^(1/3).",
        "Stick radii are told by the tractions in the middle, which are 1 - c / a of what friction bears: by elements that slip they would "
        "be known to an element only.",
        ("N2 fine", "N3 coarse"),
        tuple(
            Quantity(f"stick at {share:g}", f"c / a at Q = {share:g} mu P", "", (Known(_SOURCE, _exact(share)),), _WITHIN)
            for share in SHARES
        ),
        (
            Drawing("shares", "sticks", "Q / mu P", "c / a", {_SOURCE: np.column_stack([_GROWING, np.cbrt(1.0 - _GROWING)])}),
            Drawing("places", "tractions", "x / a", f"traction over mu p0, Q = {DRAWN:g} mu P", {_SOURCE: _TRACTIONS}),
        ),
        "GetFEM and CalculiX are told here of no supports by force, and tell positions and forces of supports, but no tractions.",
    ),
)
