"""Contact patch test of bodies whose functions are of a higher order in the row of control points at the interface alone."""

from __future__ import annotations

from dataclasses import replace

from patch_tests.contact import SLAVE_ELEMENTS, TILTS, errors, problem

from isomortar.geometry.quadrature import volume_points
from isomortar.geometry.refinement import raised_along
from isomortar.harness import Bound, case
from isomortar.harness.cases import Tier
from isomortar.model.entities import Body, Problem, Raised

_ROUND_OFF = "round-off: every integral is exact; Newton's 1e-13 times the basis's condition, 4^p"


def raised(body: Body, face: str, order: int) -> Body:
    """A body with a raised face, and with as many Gauss points as its order there takes."""
    patch = raised_along(body.patch, face, order)
    u, v, w = (volume_points(direction) + 1 for direction in patch.directions)
    return replace(body, patch=patch, quadrature=(u, v, w), raised=Raised(face, body.orders))


def raised_problem(order: int, rise: int, tilt: float) -> Problem:
    """The patch test of two blocks, both with raised interfaces."""
    given = problem(order, order, tilt, 2 * (order + rise) + 1, SLAVE_ELEMENTS)
    slave, master = given.bodies
    bodies = (raised(slave, "w0", order + rise), raised(master, "w1", order + rise))
    return replace(given, bodies=bodies, settings=replace(given.settings, measures=()))


def tier(order: int, rise: int, tilt: float) -> Tier:
    """The gate has half of the products: every two settings in every choice."""
    return "nightly" if (order + rise + TILTS.index(tilt)) % 2 else "gate"


@case(
    claim="A uniform pressure passes an interface of two raised faces to round-off, and bodies of two orders are exact below them.",
    tier=tier,
    grid={"order": (1, 2, 3), "rise": (1, 2), "tilt": TILTS},
    bounds={
        "pressure": Bound(at_most=1e-10, reason=_ROUND_OFF),
        "positions": Bound(at_most=1e-12, reason=_ROUND_OFF),
    },
)
def uniform_pressure_raised(order: int, rise: int, tilt: float) -> dict[str, float]:
    """Error of the pressure field, and of positions over the size of the column."""
    found = errors(raised_problem(order, rise, tilt))
    return {"pressure": found.field, "positions": found.position}
