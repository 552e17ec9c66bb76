"""Two cylinders whose tractions are known, by every way: pressed (Hertz), then sheared (Cattaneo and Mindlin; see `analytic/mindlin`)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from time import process_time
from typing import Any

import numpy as np
from analytic.mindlin import CONTACT, FINE, FRICTION, MATERIAL, RADIUS, SETTINGS, Theory, cap, sheared, theory
from enforcement.contact import IN_CELLS, enforcement_of
from enforcement.plan import AUGMENTED, MORTAR
from numpy.typing import NDArray
from patch_tests.subcells import SUBCELLS

from isomortar.accuracy.measures import relative_error, roughness
from isomortar.errors import ConvergenceError
from isomortar.geometry.patch import FloatArray
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.harness.cases import Bound, Cell, Shown, Words, measured
from isomortar.march.simulation import Simulation
from isomortar.model.enforcement import slave_side
from isomortar.model.enforcement.side import PointSide
from isomortar.model.entities import Contact, Problem, Stage
from isomortar.model.numbering import Numbering
from isomortar.solve.record import StepResult

#: Ways at order two; at the others those that stand for a method.
WAYS: tuple[str, ...] = (
    MORTAR, "mortar, averaged", IN_CELLS, "mortar, elastic slip", "mortar, smooth", "dual", "dual, averaged",
    "greville", "greville, averaged", "demko", "demko, averaged", "knots", "knots, averaged", "kts",
)  # fmt: skip
OF_ORDERS: tuple[str, ...] = (MORTAR, IN_CELLS, "dual", "greville", "demko", "knots")
#: Families and orders across the contact; Lagrange elements have no abscissae of Demko's.
KINDS = ("L1", "N2", "N3", "N4", "N5")
KIND = "N2"
SCENES = {
    "hertz": "Hertz: two cylinders, pressed; meshes that do not match",
    "mindlin": "Cattaneo and Mindlin: two cylinders, pressed and sheared; meshes that match",
}
#: Half of the elements of `analytic/mindlin`: eight over the contact radius.
COARSE = replace(SETTINGS["cylinder"], elements=10, growing=4)
#: Elastic slip over the contact radius, and pressure times distance over that and Hertz's peak pressure: as much as in the scenes.
SMOOTH = 1e-3
#: Hertz's peak pressure where the contact radius is CONTACT.
PEAK = MATERIAL.young / (1.0 - MATERIAL.poisson**2) / 2.0 * CONTACT / RADIUS
#: Elements of Hertz's master over those of the slave.
FINER = (4, 3)
#: Roughness is measured up to this share of the contact radius, and of the stick radius: beyond them the exact tractions have kinks.
INSIDE = 0.8
#: What roots in their elements cost, over the norm: 1.2 h / a at the edge (see `analytic/hertz`), as much again where stick begins.
STRIPS = {scene: share * FINE / COARSE.elements for scene, share in (("hertz", 1.2), ("mindlin", 2.4))}


def cells(scenes: Sequence[str] = tuple(SCENES)) -> Iterator[Cell]:
    """Scenes by every way, those of one kind after the other."""
    for scene in scenes:
        for kind in KINDS:
            for way in WAYS if kind == KIND else OF_ORDERS:
                if (kind[0], way) != ("L", "demko") and (scene, way) != ("hertz", "mortar, elastic slip"):  # there is no friction
                    yield Cell(tractions, {"scene": scene, "way": way, "kind": kind})


def of_kind(given: Problem, kind: str) -> Problem:
    """The same cylinders of another family and order."""
    found = cap(COARSE)
    patches = {body.name: found.cylinder(kind, CONTACT, below=body.name == "master") for body in given.bodies}
    points_of = {name: tuple(volume_points(d) for d in patch.directions) for name, patch in patches.items()}
    bodies = tuple(replace(body, patch=patches[body.name], quadrature=points_of[body.name]) for body in given.bodies)  # type: ignore[arg-type]
    along, across = patches["slave"].face_directions("w0")
    points = contact_points(along), contact_points(across)
    return replace(given, bodies=bodies, contacts=(replace(given.contacts[0], quadrature=points),))


def problem(scene: str, way: str, kind: str = KIND) -> Problem:
    """A scene, enforced in some way."""
    given = of_kind(sheared("cylinder", COARSE), kind)
    contact, settings = given.contacts[0], given.settings
    if scene == "hertz":
        finer = replace(COARSE, elements=COARSE.elements * FINER[0] // FINER[1], growing=COARSE.growing * FINER[0] // FINER[1])
        slave, master = given.bodies
        supports = tuple(replace(support, motions=support.motions[:1]) for support in given.supports)
        bodies = (slave, replace(master, patch=cap(finer).cylinder(kind, CONTACT, below=True)))
        given = replace(given, bodies=bodies, supports=supports, stages=(Stage("press", 3),))
        contact = replace(contact, friction=0.0)
    if way == "kts":
        settings = replace(settings, **AUGMENTED)  # type: ignore[arg-type]
    return replace(given, contacts=(enforced(contact, way),), settings=settings)


def enforced(contact: Contact, way: str) -> Contact:
    """A contact by its way."""
    changed = replace(contact, enforcement=enforcement_of(way))
    if way == IN_CELLS:
        return replace(changed, subcells=SUBCELLS)
    if way.endswith("elastic slip"):
        return replace(changed, elastic_slip=SMOOTH * CONTACT)
    if way.endswith("smooth"):
        return replace(changed, smoothing=SMOOTH * CONTACT * PEAK)
    return replace(changed, projection="averaged") if way.endswith("averaged") else changed


@dataclass(frozen=True)
class Line:
    """A traction across the contact. `places`: shape (n,), ascending; `values` there, and `areas` that they stand for, shape (n,)."""

    places: FloatArray
    values: FloatArray
    areas: FloatArray


def line(given: Problem, values: FloatArray) -> Line:
    """Across the contact, at one end of the cylinder: nothing changes along it. Fields are taken at Greville's abscissae."""
    contact, numbering = given.contacts[0], Numbering(given)
    averages = contact.of_averages
    side = slave_side(replace(contact, enforcement="greville", subcells=0) if averages else contact, given, numbering)
    assert isinstance(side, PointSide)
    found = side.carriers @ values if averages else values
    places = side.carriers @ numbering.reference[side.arrays.point]
    end = np.flatnonzero(np.isclose(places[:, 1], places[:, 1].min(), atol=1e-6 * CONTACT))
    end = end[np.argsort(places[end, 0])]
    return Line(places[end, 0], found[end], side.area[end])


def compared(found: Line, exact: FloatArray, scale: FloatArray, smooth: NDArray[np.bool_]) -> dict[str, Any]:
    """Distance from what is exact over the norm of a scale, largest value, and roughness over that of what is exact, where it is smooth."""
    near = np.abs(found.places) < FINE * CONTACT
    off = relative_error((found.values - exact + scale)[near], scale[near], found.areas[near])
    curved, its_own = (roughness(found.places[smooth], values[smooth], np.zeros(smooth.sum())) for values in (found.values, exact))
    return {
        "off": off,
        "peak": float(found.values.max() / exact.max()),
        "roughness": curved / its_own,
        "places": found.places[near],
        "values": found.values[near],
        "exact": exact[near],
    }


def pressure(given: Problem, result: StepResult, exact: Theory) -> dict[str, Any]:
    """Pressures beside Hertz's, per unit of their peak."""
    found = line(given, result.state.contacts[0].pressure * FRICTION / exact.peak)
    hertz = exact.bearable(found.places) / exact.peak
    return compared(found, hertz, hertz, np.abs(found.places) < INSIDE * exact.contact)


def shear(given: Problem, result: StepResult, exact: Theory) -> dict[str, Any]:
    """Tractions beside Cattaneo's and Mindlin's; errors as shares of what friction bears, where all is stick."""
    along = result.state.contacts[0].traction[:, 0]
    found = line(given, along * np.sign(along.sum()) / exact.peak)
    radii = np.abs(found.places)
    return compared(found, exact.traction(radii) / exact.peak, exact.bearable(radii) / exact.peak, radii < INSIDE * exact.stick)


@measured(
    claim="The scene comes to its end.",
    bounds={
        "missing": Bound(at_most=0, reason="definition: load steps that are not there were not computed"),
        "words": Shown("where a load step does not converge"),
        "off": Shown("distance from the exact tractions in L2, over the norm of the pressures, or of what friction bears"),
        "peak": Shown("largest traction over the exact one"),
        "roughness": Shown("second-difference energy over that of the exact tractions, where these are smooth"),
        "places": Shown("across the contact"),
        "values": Shown("tractions there, over the peak pressure, or what friction bears of it"),
        "exact": Shown("the same by theory"),
        "solves": Shown("linear solves of all load steps"),
        "cuts": Shown("load increments that did not converge and were cut"),
        "cpu_seconds": Shown("of the computation"),
    },
)
def tractions(scene: str, way: str, kind: str) -> dict[str, Any]:
    """Tractions at the end, beside those of theory for the forces that were found."""
    given = problem(scene, way, kind)
    words, steps, start = "", list[StepResult](), process_time()
    try:
        steps.extend(Simulation(given).run())
    except ConvergenceError as error:
        words = str(error)
    cost = {
        "missing": given.total_steps - len(steps),
        "words": Words(words),
        "solves": sum(step.counters["solves"] for step in steps),
        "cuts": sum(step.cuts for step in steps),
        "cpu_seconds": process_time() - start,
    }
    if cost["missing"]:
        return cost
    across, _, normal = np.abs(steps[-1].contacts[0].force_slave)
    exact = theory("cylinder", float(normal), float(across) if scene == "mindlin" else 0.0)
    return cost | (shear if scene == "mindlin" else pressure)(given, steps[-1], exact)
