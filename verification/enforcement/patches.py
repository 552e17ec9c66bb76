"""Patch tests by every method: along averaged normals on flat faces, and on curved ones by both projections."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from enforcement.contact import IN_CELLS, METHODS, by_method, enforcement_of, patch_bounds
from enforcement.tables import duals
from patch_tests import curved
from patch_tests.contact import ORDERS, default_rule, errors, functions, pressure_limit, problem
from patch_tests.subcells import SUBCELLS

from isomortar.harness import Bound, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem, Projection

ROWS: tuple[str, ...] = ("mortar", IN_CELLS, *METHODS[1:])
#: At order 5 averaged normals take as long as all other orders.
AVERAGED_ORDERS = ORDERS[:-1]
#: No spline of order 1 is curved.
CURVED_ORDERS = ORDERS[1:]
#: Of the cylinders: so far behind their master points have feet along averaged normals too.
INTERFERENCE = 0.1
PROJECTIONS: tuple[Projection, ...] = ("closest", "averaged")
#: Multipliers of quadrature points are dependent: augmentations stop at the paper's tolerance.
_ROUGHLY = 1e-2


def enforced(given: Problem, method: str, projection: Projection) -> Problem:
    """A patch test whose meshes do not match, by a method and a projection."""
    found = by_method(given, enforcement_of(method))
    contact = replace(found.contacts[0], projection=projection, subcells=SUBCELLS if method == IN_CELLS else 0)
    settings = replace(found.settings, augmentation_tolerance=_ROUGHLY) if method == "kts" else found.settings
    return replace(found, contacts=(contact,), settings=settings)


def averaged_bounds(method: str, order: int) -> dict[str, Bound | Shown]:
    """Those of closest points: the face is flat."""
    return {"pressure": patch_bounds(method, order, "other")["pressure"]}


@case(
    claim="Along averaged normals flat faces whose meshes do not match pass the patch test as by closest points, whatever is constrained.",
    tier="nightly",
    grid={"method": ROWS, "order": AVERAGED_ORDERS},
    bounds=averaged_bounds,
)
def averaged_patch_test(method: str, order: int) -> dict[str, float]:
    """Largest error of the pressures where they are constrained or integrated, as in `patch_test`."""
    points, elements = default_rule(order)
    return {"pressure": errors(enforced(problem(order, order, 0.0, points, elements), method, "averaged")).field}


def curved_bounds(method: str, projection: Projection, order: int) -> dict[str, Bound]:
    """What quadrature misses, of averages by closest points; of normals that are averaged, and of points, no more than all of it."""
    if projection == "averaged" or method not in ("mortar", IN_CELLS, "dual"):
        return {"pressure": Bound(at_most=1.0, reason="theory: a consistent method has no error of the size of the solution")}
    tests = duals if method == "dual" else functions
    missing = pressure_limit(order, order, curved.MASTER_ELEMENTS["N"], default_rule(order)[0], tests)
    return {"pressure": Bound(at_most=missing, reason="quadrature: as on flat faces whose meshes do not match; splines hold the rest")}


@case(
    claim="On curved faces whose meshes do not match averages by closest points pass the patch test as on flat ones.",
    tier=lambda method, projection, order: "gate" if (projection, order) == ("closest", 2) else "nightly",  # noqa: ARG005
    grid={"method": ROWS, "projection": PROJECTIONS, "order": CURVED_ORDERS},
    bounds=curved_bounds,
)
def curved_patch_test(method: str, projection: Projection, order: int) -> dict[str, float]:
    """Largest error of the pressures between two cylinders, one too large for the other (see `patch_tests/curved`)."""
    given = enforced(curved.problem(f"N{order}", INTERFERENCE), method, projection)
    (result,) = Simulation(given).run()
    exact = curved.exact_pressure(INTERFERENCE)
    return {"pressure": float(np.abs(result.contacts[0].pressure_field / exact - 1.0).max())}
