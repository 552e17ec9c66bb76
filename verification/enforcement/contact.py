"""Contact enforced by every method: tangents, balance, patch tests, and too many or too few constraints."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from enforcement.tables import POINTWISE, at_points, duals
from extremes.discretisation import compliance, equilibrium_of
from patch_tests.contact import ORDERS, SLAVE_ELEMENTS, STRETCH, default_rule, errors, functions, pressure_limit, problem
from patch_tests.subcells import SUBCELLS
from scipy import linalg
from supports import symmetry
from tangents.placed import placed

from isomortar.harness import Bound, Shown, case
from isomortar.harness.tangents import BOUND, PARTS, SYMMETRY_BOUND
from isomortar.harness.tangents import measure as tangent_errors
from isomortar.harness.visits import PairVisit, Visit
from isomortar.model.enforcement import slave_side
from isomortar.model.entities import Enforcement, Problem
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

METHODS: tuple[Enforcement, ...] = ("mortar", "dual", *POINTWISE)
#: Of the face of which constraints are counted, by direction.
ELEMENTS = 4

#: A bowl over a block; its face is inside the master's, or over the rim of it.
_SCENE = """
format = 1

[bodies.slave]
geometry = {{ kind = "bowl", centre = [{x}, 0.02], half_width = 0.35, bottom = 0, rise = 0.06, top = 0.4 }}
mesh = {{ order = [2, 2, 1], elements = [2, 3, 1] }}

[bodies.master]
geometry = {{ kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.7, 0.65, 0] }}
mesh = {{ order = [{order}, {order}, 1], elements = [4, 3, 1] }}

[contacts.interface]
slave = "slave.w0"
master = "master.w1"
projection = "{projection}"
friction = 0.3
quadrature = {points}
enforcement = "{method}"

[supports.top]
face = "slave.w1"

[supports.floor]
face = "master.w0"

[solver]
method = "uzawa"

[[stages]]
name = "press"
steps = 1
motions.top = {{ translate = [0, 0, -0.05] }}
"""
#: Trial pressures and lengths of trial tractions: open, sticking and slipping in turn.
_PRESSURE, _LENGTH = (-1.0, 1.0, 0.7), (0.0, 0.5, 2.0)


def tangent_bounds(method: Enforcement, master: str) -> dict[str, Bound]:  # noqa: ARG001
    """A bound for every part that there is, and for the balances."""
    absent = ("symmetry", "tangential, projection") if master == "averaged" else ()
    parts = {
        part: Bound(
            at_most=SYMMETRY_BOUND if part == "symmetry" else BOUND,
            reason="round-off: products of double precision against differences of a twin in extended precision",
        )
        for part in PARTS
        if part not in absent
    }
    balance = Bound(at_most=1e-12, reason="round-off: both sides' forces are opposite, and act along the way from point to foot")
    return parts | {"forces": balance, "moments": balance}


@case(
    claim="Whatever is constrained, the tangent is exact in every part, and forces and moments are in balance.",
    tier="gate",
    grid={"method": METHODS, "master": ("closest", "averaged", "over the rim")},
    bounds=tangent_bounds,
)
def tangents(method: Enforcement, master: str) -> dict[str, float]:
    """Largest relative error of each part, and of the balances."""
    projection = "averaged" if master == "averaged" else "closest"
    scene = _SCENE.format(
        method=method, projection=projection, x=0.33 if master == "over the rim" else 0.03, order=2, points=3 if method == "dual" else 2
    )
    given = Scene.from_toml(scene).problem()
    equilibrium = Equilibrium(given, Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    positions = state.positions + 0.007 * np.random.default_rng(1).standard_normal(state.positions.shape)
    positions[equilibrium.numbering.points["slave"]] += np.array([0.03, 0.02, -0.02])
    n = pair.pair.slave.test.count
    law = pair.law(np.array([20.0, 10.0]), np.zeros(n), np.zeros((n, 2)))
    pressure, length = (np.resize(np.array(pattern), n) for pattern in (_PRESSURE, _LENGTH))
    visit = placed(pair, positions, PairVisit(state.contacts[0], law), pressure, length)
    kinematics = pair.kinematics(positions, state.contacts[0])
    result = pair.result(positions, kinematics, pair.respond(kinematics, visit.law), np.zeros(2))
    report = tangent_errors(given, 1, [Visit(positions, (visit,))], directions=1, length=1e-3)
    sums = (result.force_slave, result.force_master), (result.moment_slave, result.moment_master)
    forces, moments = (float(np.abs(slave + main).max() / np.abs(slave).max()) for slave, main in sums)
    return {row.part: row.error for row in report.rows if row.part in PARTS} | {"forces": forces, "moments": moments}


def by_method(given: Problem, method: Enforcement) -> Problem:
    """A problem with its contacts enforced by a method; quadrature points have multipliers by augmentations alone."""
    solver = "uzawa" if method == "kts" else "monolithic"
    settings = replace(given.settings, method=solver, augmentation_tolerance=_EXACTLY, newton_tolerance=1e-12)  # type: ignore[arg-type]
    return replace(given, contacts=tuple(replace(c, enforcement=method) for c in given.contacts), settings=settings)


#: Of the patch test: master elements on knot lines of the slave's, and elsewhere (see `patch_tests/uniform_pressure`).
MESHES = ("matching", "other")
#: The mortar method with contact elements cut along the master's knot lines.
IN_CELLS = "mortar, subcells"
#: Where constraints are too many augmentations go on; they stop at the paper's tolerance.
_ROUGHLY, _EXACTLY = 1e-2, 1e-9
_UNIFORM = Bound(
    at_most=_EXACTLY, reason="theory: the state is uniform and every constraint holds in it; Newton's 1e-12 times the basis's condition"
)
_NOT_UNIFORM = Bound(at_least=1e3 * _EXACTLY, reason="theory: forces of a uniform pressure are inexact; far above the solver's tolerance")

_LARGE = "round-off: of a strain that sums of order + 1 positions tell, times the sizes of the dual functions at a place, or the tolerance"


def size_of_duals(order: int) -> float:
    """The largest sum of the dual functions' sizes at a place of the slave's face."""
    return float(np.abs(duals(order, SLAVE_ELEMENTS, np.linspace(0.0, 1.0, 500))).sum(axis=1).max() ** 2)


def patch_bounds(method: str, order: int, meshes: str) -> dict[str, Bound | Shown]:
    """Nothing, where all integrals are exact; what quadrature misses, of averages; more, of points."""
    exact = method != "knots" or order == 1 if meshes == "matching" else method == IN_CELLS
    limit = _UNIFORM if exact else _NOT_UNIFORM
    if method == "dual" and exact:
        lost = (order + 1) * float(np.finfo(float).eps) / abs(math.log(STRETCH))
        limit = Bound(at_most=max(_EXACTLY, lost * size_of_duals(order)), reason=_LARGE)
    if method in ("mortar", "dual") and meshes == "other":
        points, elements = default_rule(order)
        missing = pressure_limit(order, order, elements, points, duals if method == "dual" else functions)
        limit = Bound(at_most=missing, reason="quadrature: error of the master's load, times the norm of the loads' inverse")
    return {"pressure": limit, "position": _UNIFORM if exact else Shown("theory: what pressures that are not uniform make of it")}


@case(
    claim="On meshes that match every method that has enough constraints passes the patch test; on others averages alone do, as exactly as "
    "their quadrature is.",
    tier=lambda method, order, meshes: "gate" if order == 2 else "nightly",  # noqa: ARG005
    grid={"method": (*METHODS, IN_CELLS), "order": ORDERS, "meshes": MESHES},
    bounds=patch_bounds,
)
def patch_test(method: str, order: int, meshes: str) -> dict[str, float]:
    """Largest errors of the pressures where they are constrained or integrated, and of positions; flat, of one order on either side."""
    points, elements = default_rule(order)
    given = by_method(problem(order, order, 0.0, points, elements if meshes == "other" else SLAVE_ELEMENTS), enforcement_of(method))
    if method == IN_CELLS:
        given = replace(given, contacts=(replace(given.contacts[0], subcells=SUBCELLS),))
    if method == "kts" and meshes == "other":
        given = replace(given, settings=replace(given.settings, augmentation_tolerance=_ROUGHLY))
    found = errors(given)
    return {"pressure": found.field, "position": found.position}


def enforcement_of(method: str) -> Enforcement:
    """What constrains, of a method and what is changed of it."""
    name: Enforcement = method.partition(",")[0]  # type: ignore[assignment]
    return name


@case(
    claim="With friction, a half or a quarter of a symmetric body is that of the whole body, whatever is constrained.",
    tier=lambda method, part: "gate" if (method, part) == ("greville", "quarter") else "nightly",
    grid={"method": ("dual", "knots", "greville", "demko"), "part": tuple(symmetry.PARTS)},
    bounds={
        "force": Bound(at_most=1e-9, reason="theory: the same equations by symmetry; Newton's method stops at 1e-12"),
        "positions": Bound(at_most=1e-9, reason="theory: the same equations by symmetry; Newton's method stops at 1e-12"),
        "mixed": Bound(at_least=1.0, reason="definition: points stick and slip at once in some load step"),
    },
)
def part_of_whole(method: Enforcement, part: str) -> dict[str, float]:
    """Errors as those of `supports/part_of_whole`, on a plane whose coordinates go along no edge."""
    return symmetry.apart(part, "oblique", "monolithic", method)


def count_bounds(method: Enforcement, order: int) -> dict[str, Bound | Shown]:
    """Numbers by theory: as many constraints as control points, more, or fewer."""
    control_points = (ELEMENTS + order) ** 2
    constraints = {"kts": (ELEMENTS * (order + 1)) ** 2, "knots": (ELEMENTS + 1) ** 2}.get(method, control_points)
    many, few = (float(np.maximum(0, more)) for more in (constraints - control_points, control_points - constraints))
    exact = "definition: constraints less their rank, and control points less their rank"
    return {
        "too many": Bound(at_most=many, at_least=many, reason=exact),
        "too few": Bound(at_most=few, at_least=few, reason=exact),
        "inf-sup": Shown("theory: positive; of the constraints that are not too many"),
        "condition": Shown("theory: finite; of the constraints that are not too many"),
    }


@case(
    claim="Mortar, dual functions, Greville's and Demko's abscissae give as many constraints as there are control points, "
    "quadrature points too many, knots above order 1 too few.",
    tier=lambda method, order: "gate" if order == 2 else "nightly",  # noqa: ARG005
    grid={"method": METHODS, "order": ORDERS},
    bounds=count_bounds,
)
def constraints(method: Enforcement, order: int) -> dict[str, float]:
    """Constraints beyond their rank, control points beyond it; inf-sup constant (see `extremes/stability`) and condition of the rest.

    The condition is that of the matrix that makes mean gaps of the constraints of gaps of the control points.
    """
    equilibrium = equilibrium_of(order, (ELEMENTS, ELEMENTS, 2), 1.0)
    contact = replace(equilibrium.problem.contacts[0], enforcement=method, quadrature=(order + 1, order + 1))
    side = slave_side(contact, equilibrium.problem, equilibrium.numbering)
    shape, test = (at_points(functions) for functions in (side.arrays.shape, side.arrays.test))
    weighted = side.arrays.area[:, None] * test
    matrix, norm = weighted.T @ shape, weighted.T @ test / ELEMENTS
    values = linalg.eigh(matrix @ compliance(order, ELEMENTS, 1.0) @ matrix.T, norm, eigvals_only=True)
    there = values > 1e-10 * values.max()
    rank = int(np.count_nonzero(there))
    sizes = linalg.svdvals(matrix / matrix.sum(axis=1)[:, None])
    return {
        "too many": float(len(matrix) - rank),
        "too few": float(matrix.shape[1] - rank),
        "inf-sup": float(np.sqrt(values[there].min())),
        "condition": float(sizes[0] / sizes[rank - 1]),
    }
