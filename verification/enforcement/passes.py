"""Two passes, in which each face is slave once: how many constraints are too many, and what becomes of the pressures (theory 10.17)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from enforcement.contact import MESHES, by_method
from extremes.discretisation import masses
from patch_tests.contact import SLAVE_ELEMENTS, default_rule, exact_pressure, problem

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem

PASSES = ("one", "two")


def patch(passes: str, order: int, meshes: str) -> Problem:
    """The flat patch test; in two passes the master's face is slave of a second contact."""
    points, elements = default_rule(order)
    given = by_method(problem(order, order, 0.0, points, elements if meshes == "other" else SLAVE_ELEMENTS), "mortar")
    (contact,) = given.contacts
    assert not isinstance(contact.master, tuple)
    back = replace(contact, name="back", slave=contact.master, master=contact.slave)  # type: ignore[arg-type]
    return replace(given, contacts=(contact, back)[: PASSES.index(passes) + 1], settings=replace(given.settings, max_cuts=2))


def too_many(passes: str, order: int, elements: int) -> int:
    """Constraints beyond their rank, by exact integrals of the functions of both faces (theory 10.17)."""
    own, other = masses(order, SLAVE_ELEMENTS, SLAVE_ELEMENTS), masses(order, SLAVE_ELEMENTS, elements)
    first, second = np.hstack([own, -other]), np.hstack([other.T, -masses(order, elements, elements)])
    matrix = first if passes == "one" else np.vstack([first, second])
    return len(matrix) - int(np.linalg.matrix_rank(matrix, tol=1e-10 * np.linalg.norm(matrix, 2)))


def count_bounds(passes: str, order: int, meshes: str) -> dict[str, Bound]:
    """All constraints of one pass where meshes match, else those of the polynomials, which both faces hold."""
    both = (order + 1) ** 2 if meshes == "other" else (SLAVE_ELEMENTS + order) ** 2
    count = float(both if passes == "two" else 0)
    exact = "theory: pressures that both faces hold can be on either, or shared; a dimension each"
    return {"too many": Bound(at_most=count, at_least=count, reason=exact)}


@case(
    claim="In two passes constraints are too many by all pressures that both faces hold, in one by none.",
    tier="gate",
    grid={"passes": PASSES, "order": (1, 2, 3), "meshes": MESHES},
    bounds=count_bounds,
)
def constraints_of_passes(passes: str, order: int, meshes: str) -> dict[str, float]:
    """Constraints beyond their rank, of two flat faces; SLAVE_ELEMENTS along either direction of one, as many or others of the other."""
    return {"too many": float(too_many(passes, order, default_rule(order)[1] if meshes == "other" else SLAVE_ELEMENTS))}


_SOLVED = Bound(at_most=1e-6, reason="theory: the same penalties and the same gaps on both sides; augmentations stop at 1e-9")


@case(
    claim="Where meshes match two passes have a singular system, and by augmentations each bears half of the pressure.",
    tier="nightly",
    grid={"passes": PASSES, "order": (1, 2, 3)},
    bounds=lambda passes, order: {  # noqa: ARG005
        "missing": Bound(at_least=1.0, reason="theory: multipliers that are not unique have no regular tangent")
        if passes == "two"
        else Bound(at_most=0.0, reason="definition: the one load step is there"),
        "share": _SOLVED,
    },
)
def patch_test_of_passes(passes: str, order: int) -> dict[str, float]:
    """Load steps that are missing with multipliers as unknowns; by augmentations how far each pass is from its share of the pressure."""
    given = patch(passes, order, "matching")
    missing = 0
    try:
        list(Simulation(given).run())
    except ConvergenceError:
        missing = given.total_steps
    (result,) = Simulation(replace(given, settings=replace(given.settings, method="uzawa"))).run()
    shares = np.array([contact.pressure_field for contact in result.contacts]) / exact_pressure()
    return {"missing": float(missing), "share": float(np.abs(shares * len(shares) - 1.0).max())}
