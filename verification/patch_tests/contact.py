"""Contact patch test: two blocks of one material, cut by a plane, shrink alike in all directions.

The stress is a uniform pressure, so it is in balance across a plane of any tilt, without friction and whatever the meshes. Shape
functions and control quantities of the slave are integrated exactly; the master's are not, because master knots fall inside slave
elements and the integrals are not segmented: what is left is the error of that quadrature.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import BSpline

from isomortar.geometry.patch import Direction, Family, FloatArray, Patch
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, Curve, Matches, Shown, case
from isomortar.harness.cases import Tier
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, Stage, Support
from isomortar.model.settings import SolverSettings

#: All lengths become this many times as long.
STRETCH = 0.95
MATERIAL = Material()
#: Elements of the slave along and across; a master of twice as many has its knots on slave element boundaries or in their middle.
SLAVE_ELEMENTS = 3
ORDERS = (1, 2, 3, 4, 5)
TILTS = (0.0, 30.0)


def exact_pressure() -> float:
    """Contact pressure per reference area of P = A1 ln J F^-T with F = STRETCH times the identity (theory 8.3)."""
    return -3.0 * MATERIAL.bulk * float(np.log(STRETCH)) / STRETCH


def wedge(slope: float, part: str, families: str, order: int, elements: int) -> Patch:
    """The part below or above the plane z = 1/2 + slope (y - 1/2) of the unit square's column between z = 0 and z = 1."""
    x, y = np.array([0.0, 1.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0, 1.0])
    cut = 0.5 + slope * (y - 0.5)
    heights = (np.zeros(4), cut) if part == "below" else (cut, np.ones(4))
    points = np.vstack([np.column_stack([x, y, z]) for z in heights])
    straight = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    family: Family = "L" if families == "L" else "N"
    return mesh(Patch((straight,) * 3, points, np.ones(8)), (family,) * 3, (order, order, 1), (elements, elements, 2))


def shrink(body: str, face: str) -> Support:
    """Hold the normal component of a face and move it towards the origin, which stays where it is."""
    axis, end = "uvw".index(face[0]), int(face[1])
    motion = [0.0, 0.0, 0.0]
    motion[axis] = (STRETCH - 1.0) * end
    return Support(f"{body}-{face}", Face(body, face), (Motion((motion[0], motion[1], motion[2])),), components=(axis,))


def problem(slave_order: int, master_order: int, tilt: float, points: int, master_elements: int, family: str = "N") -> Problem:
    """The two blocks, held at all faces but the interface in their normal components.

    Parameters
    ----------
    slave_order, master_order : int
        Along the interface; across it both are linear.
    tilt : float
        Of the interface, in degrees.
    points : int
        Quadrature points per slave element and direction.
    master_elements : int
        Along either direction of the interface; the slave has SLAVE_ELEMENTS.
    family : {"N", "L"}
    """
    slope = float(np.tan(np.radians(tilt)))
    patches = {
        "slave": wedge(slope, "above", family, slave_order, SLAVE_ELEMENTS),
        "master": wedge(slope, "below", family, master_order, master_elements),
    }
    bodies = tuple(
        Body(name, patch, MATERIAL, tuple(volume_points(d) + 1 for d in patch.directions))  # type: ignore[arg-type]
        for name, patch in patches.items()
    )
    outer = {"slave": ("u0", "u1", "v0", "v1", "w1"), "master": ("u0", "u1", "v0", "v1", "w0")}
    return Problem(
        name="contact-patch-test",
        bodies=bodies,
        contacts=(Contact("interface", Face("slave", "w0"), Face("master", "w1"), 0.0, (points, points)),),
        supports=tuple(shrink(body, face) for body, faces in outer.items() for face in faces),
        stages=(Stage("shrink", 1),),
        settings=SolverSettings(newton_tolerance=1e-13),
    )


@dataclass(frozen=True)
class PatchErrors:
    """Relative errors: pressure field at the quadrature points, control pressures, positions over the size of the column."""

    field: float
    control: float
    position: float


def errors(given: Problem) -> PatchErrors:
    """Run a patch test and measure its distance from the uniform state."""
    simulation = Simulation(given)
    (result,) = simulation.run()
    pressure = exact_pressure()
    field: FloatArray = result.contacts[0].pressure_field
    positions = result.state.positions - STRETCH * simulation.equilibrium.numbering.reference
    return PatchErrors(
        field=float(np.abs(field / pressure - 1.0).max()),
        control=float(np.abs(result.state.contacts[0].pressure / pressure - 1.0).max()),
        position=float(np.abs(positions).max()),
    )


def tier(slave_order: int, master_order: int, tilt: float) -> Tier:
    """All pairs of orders up to three are seconds; of the higher ones the equal pairs, level, stand for the others at the gate."""
    low = max(slave_order, master_order) <= 3
    return "gate" if low or (slave_order == master_order and tilt == 0.0) else "nightly"


def nested_bounds(slave_order: int, master_order: int, tilt: float) -> dict[str, Bound]:  # noqa: ARG001
    """Round-off, and what the basis makes of it: control pressures of order p are as much as 4^p as sensitive as the field."""
    limit = max(1e-11, 1e-13 * 4.0 ** max(slave_order, master_order))
    return {"pressure": Bound(at_most=limit, reason="round-off: every integral is exact; Newton's 1e-13 times the basis's condition, 4^p")}


@case(
    claim="A uniform pressure passes an interface whose master knots fall on slave element boundaries, to round-off.",
    tier=tier,
    grid={"slave_order": ORDERS, "master_order": ORDERS, "tilt": TILTS},
    bounds=nested_bounds,
)
def uniform_pressure_nested(slave_order: int, master_order: int, tilt: float) -> dict[str, float]:
    """Error of the pressure field, master of one element per slave element."""
    given = problem(slave_order, master_order, tilt, slave_order + master_order + 1, SLAVE_ELEMENTS)
    settings = replace(given.settings, measures=())  # a tangent for every solve: the last one goes far below the tolerance
    return {"pressure": errors(replace(given, settings=settings)).field}


def default_rule(slave_order: int) -> tuple[int, int]:
    """Default quadrature points of the slave, and elements of the master.

    Four of them on three slave elements. Under an odd rule the point in the middle of the middle slave element would lie on a knot line of
    the master, and a tilt that differs by 1e-10 degrees would decide the last per cent of the error: five then.
    """
    points = contact_points(Direction("N", slave_order, np.repeat([0.0, 1.0], slave_order + 1)))
    return points, SLAVE_ELEMENTS + (2 if points % 2 else 1)


#: Functions along a direction by order, elements and places, shape (places, functions).
Functions = Callable[[int, int, FloatArray], FloatArray]


def knots(order: int, elements: int) -> FloatArray:
    """Of a direction of a face, over its length."""
    return np.concatenate([np.zeros(order), np.linspace(0.0, 1.0, elements + 1), np.ones(order)])


def functions(order: int, elements: int, places: FloatArray) -> FloatArray:
    """SciPy's functions of that direction, shape (places, functions)."""
    return np.asarray(BSpline.design_matrix(places, knots(order, elements), order).toarray())


def pressure_limit(slave_order: int, master_order: int, elements: int, points: int, tests: Functions = functions) -> float:
    """Largest error of the pressure, from what the load of the master's functions misses in both directions.

    The slave's Gauss points do not see the master's knots, so that a uniform pressure does not give every function the exact load. The
    pressure, in the slave's functions or in `tests`, changes to put that right: by the errors' size times the norm of the loads' inverse.
    """
    places, weights = np.polynomial.legendre.leggauss(points)
    where = ((np.arange(SLAVE_ELEMENTS)[:, None] + (places + 1) / 2) / SLAVE_ELEMENTS).ravel()
    master = functions(master_order, elements, where) * np.tile(weights / (2 * SLAVE_ELEMENTS), SLAVE_ELEMENTS)[:, None]
    ends = knots(master_order, elements)
    exact = (ends[master_order + 1 :] - ends[: -master_order - 1]) / (master_order + 1)
    missing = float(np.abs(master.sum(axis=0) / exact - 1.0).max())
    loads = master.T @ tests(slave_order, SLAVE_ELEMENTS, where) / exact[:, None]
    pressures = tests(slave_order, SLAVE_ELEMENTS, np.linspace(0.0, 1.0, 500)) @ np.linalg.pinv(loads)
    return 2.0 * missing * float(np.abs(pressures).sum(axis=1).max())


def kink(master_order: int) -> str:
    """What the slave's Gauss points miss."""
    jumping = ("slope", "curvature", "third derivative", "fourth derivative", "fifth derivative")[master_order - 1]
    return f"the {jumping} of master functions jumps inside slave elements"


def default_bounds(slave_order: int, master_order: int, tilt: float) -> dict[str, Bound | Matches]:  # noqa: ARG001
    """From the error of the load; how the bodies answer to it is not known as well, but must stay as it was."""
    points, elements = default_rule(slave_order)
    limit = pressure_limit(slave_order, master_order, elements, points)
    return {
        "pressure": Bound(
            at_most=limit, reason=f"quadrature: {kink(master_order)}; error of the master's load, times the norm of the loads' inverse"
        ),
        "errors": Matches(
            "contact_patch_test",
            reason="reference: this program's own errors, as a rule more than a twentieth of their limit; Newton's 1e-13 times the basis's "
            "condition",
            allowance=1e-13 * 4.0 ** max(slave_order, master_order) / (0.05 * limit),
        ),
    }


@case(
    claim="A uniform pressure passes a non-matching interface to the accuracy of the paper's quadrature in whole elements.",
    tier=tier,
    grid={"slave_order": ORDERS, "master_order": ORDERS, "tilt": TILTS},
    bounds=default_bounds,
)
def uniform_pressure(slave_order: int, master_order: int, tilt: float) -> dict[str, object]:
    """Error of the pressure field, and with it those of control pressures and positions; the points of Table 1."""
    points, elements = default_rule(slave_order)
    found = errors(problem(slave_order, master_order, tilt, points, elements))
    return {"pressure": found.field, "errors": [found.field, found.control, found.position]}


def averaged_tier(slave_order: int, master_order: int, tilt: float, elements: str) -> Tier:
    """The gate has half of the products: any three settings in every choice."""
    return "nightly" if (slave_order + master_order + TILTS.index(tilt) + (elements == "other")) % 2 else "gate"


def averaged_bounds(slave_order: int, master_order: int, tilt: float, elements: str) -> dict[str, Bound]:
    """Round-off where knots are nested; elsewhere as far from closest points as the interface is from flat."""
    if elements == "nested":
        return nested_bounds(slave_order, master_order, tilt)
    bent = "discretisation: facets turn by the error of positions, 3e-3, over an element, 0.01; pressures by its square, times ten"
    return {"apart": Bound(at_most=1e-3, reason=bent)}


@case(
    claim="A uniform pressure passes an interface along averaged normals of Lagrange elements as well as by closest points.",
    tier=averaged_tier,
    grid={"slave_order": (1, 2), "master_order": (1, 2), "tilt": TILTS, "elements": ("nested", "other")},
    bounds=averaged_bounds,
)
def along_averaged_normals(slave_order: int, master_order: int, tilt: float, elements: str) -> dict[str, float]:
    """Error of the pressure field, nested; else its difference from that by closest points, with the default quadrature."""
    points, count = (slave_order + master_order + 1, SLAVE_ELEMENTS) if elements == "nested" else default_rule(slave_order)
    closest = problem(slave_order, master_order, tilt, points, count, "L")
    closest = replace(closest, settings=replace(closest.settings, measures=()))  # as above
    averaged = errors(replace(closest, contacts=(replace(closest.contacts[0], projection="averaged"),))).field
    return {"pressure": averaged} if elements == "nested" else {"apart": abs(averaged - errors(closest).field)}


def fall_bounds(slave_order: int, master_order: int, tilt: float) -> dict[str, Bound | Shown]:  # noqa: ARG001
    """By Euler and Maclaurin a jump of derivative p costs (1 / points)^(p + 1), and between nothing and all of that by its place."""
    return {
        "curve": Shown(reason="quadrature: error against points; it falls unevenly, as knots come to lie nearer to points or not"),
        "share": Bound(
            at_most=1.0, reason=f"quadrature: {kink(master_order)}; error of the master's load, times the norm of the loads' inverse"
        ),
        "order": Bound(
            at_least=float(master_order),
            reason="theory: order p + 1 at a jump of derivative p; its place between the points scatters it by less than one",
        ),
    }


@case(
    claim="The error of the contact patch test falls with the number of quadrature points, as that of the master's load does.",
    tier="nightly",
    grid={"slave_order": ORDERS, "master_order": ORDERS, "tilt": TILTS},
    bounds=fall_bounds,
)
def pressure_against_points(slave_order: int, master_order: int, tilt: float) -> dict[str, object]:
    """Errors of the pressure field for 4 to 24 points per slave element and direction, over their limits, and the order of their fall.

    The numbers are even: none of the points lies on a master knot. Limits fall with the order of theory from the largest one: by chance the
    loads are nearly exact with some numbers of points.
    """
    points, elements = [4, 6, 8, 12, 16, 24], SLAVE_ELEMENTS + 1
    found = [errors(problem(slave_order, master_order, tilt, n, elements)).field for n in points]
    fall = np.array(points, float) ** -(master_order + 1)
    largest = np.max([pressure_limit(slave_order, master_order, elements, n) for n in points] / fall)
    shares = found / (largest * fall)
    return {
        "curve": Curve(points, found, "points per direction", "relative error of the pressure", log_x=True),
        "share": Curve(points, shares, "points per direction", "error over its limit", log_x=True),
        "order": -float(np.polyfit(np.log(points), np.log(found), 1)[0]),
    }
