"""The augmented law at control points against itself written down anew, and its slopes against derivatives of that by complex steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from small_scenes import bowl

from isomortar import _bindings
from isomortar._bindings import Control, FrictionArrays, Law
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

PENALTIES = np.array([30.0, 7.0])
#: Laws of friction, and none; the capped one bears its largest traction from a pressure of 0.6 on.
FRICTION: Final = {"coulomb": FrictionArrays(1, np.array([0.4])), "capped": FrictionArrays(2, np.array([0.4, 0.1, 0.34]))}
NONE = FrictionArrays(0, np.zeros(0))
#: Imaginary step of the derivatives, which have no error of their own.
STEP = 1e-30
#: Quantities, multipliers and options of the law; the first two tractions and slips have a component that is zero.
VARIANTS = (
    *("plain", "first tractions zero", "second tractions zero", "margin", "held", "forgiving", "supported", "frictionless"),
    *("elastic", "elastic, held", "elastic, supported"),
)

#: Real, or complex where a derivative is formed.
Numbers = NDArray[Any]


@dataclass(frozen=True)
class Point:
    """What the law says of one control point: pressure, traction, state (0 open, 1 stick, 2 slip)."""

    pressure: float
    traction: FloatArray
    state: int


def length(traction: Numbers, metric: Numbers) -> Any:
    """Norm of covariant components in a metric of 11, 12, 22."""
    matrix = np.array([[metric[0], metric[1]], [metric[1], metric[2]]])
    return np.sqrt(traction @ np.linalg.solve(matrix, traction))


def radius(pressure: Any, friction: FrictionArrays) -> Any:
    """What a law of friction bears under a pressure above 0."""
    coefficient, cohesion, most = (*friction.parameters, 0.0, np.inf)[:3]
    below = cohesion + coefficient * pressure
    return below if np.real(below) <= most else most


def returned(pressure: Any, trial: Numbers, metric: Numbers, friction: FrictionArrays) -> Numbers:
    """The slipping traction of a trial."""
    return radius(pressure, friction) * trial / length(trial, metric)


def elastic(pressure: Any, stretch: Numbers, metric: Numbers, friction: FrictionArrays) -> Numbers:
    """The traction of a stretch."""
    size = length(stretch, metric)
    return radius(pressure, friction) * stretch * (2.0 - size if np.real(size) < 1.0 else 1.0 / size)


def law_at(trial_pressure: float, trial: FloatArray, metric: FloatArray, law: Law, held: bool) -> Point:
    """What becomes of trials."""
    if trial_pressure <= 0.0:
        return Point(0.0, np.zeros(2), 0)
    if not law.friction.acts:
        return Point(trial_pressure, np.zeros(2), 1)
    if law.elastic:
        return Point(trial_pressure, elastic(trial_pressure, trial, metric, law.friction), 1 if length(trial, metric) < 1.0 else 2)
    if held or length(trial, metric) <= radius(trial_pressure, law.friction) * (1.0 - law.slip_margin):
        return Point(trial_pressure, trial, 1)
    return Point(trial_pressure, returned(trial_pressure, trial, metric, law.friction), 2)


def slopes_at(point: Point, trial: FloatArray, metric: FloatArray, law: Law, radial: FloatArray, held: bool) -> FloatArray:
    """Derivatives of the traction by pressure, trial (2) and metric (3), shape (6, 2), of the law's branch.

    A forgiving law has `radial`, no longer than the radius, in place of the traction where the trial's length changes; an elastic one
    that is held the slope of no stretch.
    """
    if point.state == 0 or not law.friction.acts:
        return np.zeros((6, 2))
    if point.state == 1 and not law.elastic:
        return np.vstack([np.zeros((1, 2)), np.eye(2), np.zeros((3, 2))])
    at = np.concatenate([[point.pressure], trial, metric])

    def change(function: Callable[[Numbers], Any]) -> FloatArray:
        return np.array([np.imag(function(at + step)) / STEP for step in 1j * STEP * np.eye(6)])

    answer = elastic if law.elastic else returned
    exact = change(lambda v: answer(v[0], v[1:3], v[3:6], law.friction))
    if law.elastic and held:
        return np.vstack([exact[:1], 2.0 * radius(point.pressure, law.friction) * np.eye(2), np.zeros((3, 2))])
    if not law.forgiving:
        return exact
    shortened = radial * min(1.0, radius(point.pressure, law.friction) / length(radial, metric))
    stretch = change(lambda v: length(v[1:3], v[3:6])) / length(trial, metric)
    return exact + np.outer(stretch, point.traction - shortened)


@case(
    claim="Pressures, tractions and states are those of the law, their slopes its derivatives, with every option, in every state.",
    grid={"variant": VARIANTS, "summed": (False, True), "law": tuple(FRICTION)},
    bounds=lambda variant, summed, law: {  # noqa: ARG005
        "pressure": Bound(at_most=1e-14, reason="round-off: a sum of two products"),
        "traction": Bound(at_most=1e-13, reason="round-off: sums of some products, and a quotient"),
        "states": Bound(0.0, 0.0, "definition: the same states"),
        "slopes": Bound(at_most=1e-11, reason="round-off: products of some numbers, over lengths of trials of a hundredth and more"),
        "radius": Bound(0.0, 0.0, "definition: control points with another limit of their tractions, and one without a pressure"),
        "present": Bound(at_least=2.0 if variant == "frictionless" else 3.0, reason="definition: open, stick and slip all occur"),
        **(
            {"capped": Bound(0.9, 0.1, "definition: some slip at the largest traction, some below")}
            if law == "capped" and variant != "frictionless"
            else {}
        ),
    },
)
def control_points(variant: str, summed: bool, law: str) -> dict[str, float]:
    """Largest differences; wrong limits; number of different states; share of what slips that bears the largest traction."""
    pair = Equilibrium(bowl("plane"), Ledger()).pairs[0].pair
    random = np.random.default_rng(17)
    n, points = len(pair.slave.point), len(pair.slave.area)
    weight, square = random.uniform(0.2, 1.0, n), random.uniform(0.2, 1.0, n)
    weight[:2] = 0.0  # nothing of these projects on the master
    gap = weight * random.uniform(-0.05, 0.05, n)
    control = Control(
        weight, square, gap, 0.03 * random.standard_normal((n, 2)), metrics(random, n) * square[:, None], metrics(random, points)
    )
    traction = 0.4 * random.standard_normal((n, 2))
    if "zero" in variant:
        traction[:, 0 if variant.startswith("first") else 1] = 0.0
        control.slip[:, 0 if variant.startswith("first") else 1] = 0.0
    bears, free = np.ones(n, dtype=np.int32), np.tile(np.eye(2), (n, 1, 1))
    if "supported" in variant:  # some bear nothing, others have no traction along a direction
        bears[::4] = 0
        free[::2] -= random.standard_normal((len(free[::2]), 2, 1)) @ random.standard_normal((len(free[::2]), 1, 2))
    slip = 1.0 / PENALTIES[1] if "elastic" in variant else 0.0
    made = Law(
        PENALTIES, NONE if variant == "frictionless" else FRICTION[law], random.uniform(-0.5, 1.5, n), traction, summed, bears, free,
        (np.arange(n) % 3 == 0).astype(np.int32) * ("held" in variant), slip_margin=0.2 * (variant == "margin"),
        forgiving=variant == "forgiving", elastic_slip=slip, stretch=traction.copy() if slip else None,
    )  # fmt: skip
    response = _bindings.augmented_multipliers(pair.slave, control, made)

    present = np.where(weight > 0.0, weight, 1.0)
    pressure = np.where((weight > 0.0) & (bears > 0), made.pressure + PENALTIES[0] * gap / present, 0.0)
    metric = control.metric / square[:, None]
    slips = np.where((pressure > 0.0)[:, None], control.slip / present[:, None], 0.0)
    element = np.repeat(pair.slave.test.nodes, pair.slave.per_element, axis=0)
    at_points = product(control.point_metric, np.einsum("qa,qab->qb", pair.slave.test.values, slips[element]))
    totals = np.zeros((n, 2))
    np.add.at(totals, element, (pair.slave.test.values * pair.slave.area[:, None])[..., None] * at_points[:, None, :])
    sums = totals if summed else product(metric, control.slip)
    trial = np.einsum("iba,ib->ia", free, traction + PENALTIES[1] * sums / present[:, None])
    found = [law_at(pressure[i], trial[i], metric[i], made, bool(made.held[i])) for i in range(n)]
    slopes = np.array([slopes_at(found[i], trial[i], metric[i], made, traction[i], bool(made.held[i])) for i in range(n)])
    slopes[:, 1:3] = free @ slopes[:, 1:3]
    slope = np.where(np.array([point.state for point in found]) > 0, PENALTIES[0] / present, 0.0)
    limits = _bindings.friction_radius(made.friction, np.append(pressure, np.nan))
    borne = [radius(p, made.friction) if p > 0.0 and made.friction.acts else 0.0 for p in pressure]
    borne.append(np.nan if made.friction.acts else 0.0)
    differences = {
        "pressure": float(np.abs(response.pressure - [point.pressure for point in found]).max()),
        "traction": float(np.abs(response.traction - [point.traction for point in found]).max()),
        "states": float(np.count_nonzero(response.state != [point.state for point in found])),
        "slopes": float(np.maximum(np.abs(response.traction_slope - slopes).max(), np.abs(response.pressure_slope - slope).max())),
        "radius": float(np.count_nonzero(~np.isclose(limits, borne, rtol=1e-14, atol=0.0, equal_nan=True))),
        "present": float(len(set(response.state))),
    }
    slipping = [point.pressure for point in found if point.state == 2]
    if law != "capped" or not slipping:
        return differences
    return differences | {"capped": float(np.mean([radius(p, made.friction) == made.friction.parameters[-1] for p in slipping]))}


@case(
    claim="What is no number makes what follows from it at its control point none, and nothing of another one: it is not taken for open.",
    tier="gate",
    grid={"of": ("gap", "pressure", "slip", "traction"), "law": tuple(FRICTION)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: pressures and tractions that are numbers and should not be, or are none and should be")},
)
def no_number(of: str, law: str) -> dict[str, float]:
    """How many, where each control point presses and one of its quantities, or multipliers, is none."""
    pair = Equilibrium(bowl("plane"), Ledger()).pairs[0].pair
    random, n, points = np.random.default_rng(18), len(pair.slave.point), len(pair.slave.area)
    slip, metric = 0.03 * random.standard_normal((n, 2)), metrics(random, n)
    control = Control(np.ones(n), np.ones(n), random.uniform(0.0, 0.05, n), slip, metric, metrics(random, points))
    traction = 0.4 * random.standard_normal((n, 2))
    made = Law(
        PENALTIES, FRICTION[law], np.ones(n), traction, False, np.ones(n, np.int32), np.tile(np.eye(2), (n, 1, 1)), np.zeros(n, np.int32)
    )
    spoiled = {"gap": control.gap, "pressure": made.pressure, "slip": control.slip[:, 0], "traction": traction[:, 1]}[of]
    spoiled[::2] = np.nan
    response = _bindings.augmented_multipliers(pair.slave, control, made)
    none = np.arange(n) % 2 == 0
    pressures, tractions = np.isnan(response.pressure), np.isnan(response.traction).any(axis=1)
    return {"wrong": float(np.sum(pressures != (none & (of in ("gap", "pressure")))) + np.sum(tractions != none))}


#: Share of its functions that a control point has over the master, up to which it has as good as none.
LEAST_WEIGHT = 1e-10


@case(
    claim="A control point with next to nothing of its functions over the master bears nothing, and one with a little more does.",
    tier="gate",
    grid={"summed": (False, True)},
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: control points on either side of the least share that are open or closed and should not be")
    },
)
def next_to_no_weight(summed: bool) -> dict[str, float]:
    """How many, where each would press."""
    pair = Equilibrium(bowl("plane"), Ledger()).pairs[0].pair
    random, n = np.random.default_rng(19), len(pair.slave.point)
    whole = np.zeros(n)
    element = np.repeat(pair.slave.test.nodes, pair.slave.per_element, axis=0)
    np.add.at(whole, element, pair.slave.test.values * pair.slave.area[:, None])
    share = np.where(np.arange(n) % 2 == 0, 0.9, 1.1)
    weight, metric = LEAST_WEIGHT * share * whole, metrics(random, n)
    control = Control(weight, np.ones(n), 0.01 * weight, np.zeros((n, 2)), metric, metrics(random, len(pair.slave.area)))
    stays, free = np.zeros(n, dtype=np.int32), np.tile(np.eye(2), (n, 1, 1))
    made = Law(PENALTIES, NONE, np.ones(n), np.zeros((n, 2)), summed, np.ones(n, dtype=np.int32), free, stays)
    closed = _bindings.augmented_multipliers(pair.slave, control, made).pressure > 0.0
    return {"wrong": float(np.count_nonzero(closed != (share > 1.0)))}


def metrics(random: np.random.Generator, count: int) -> FloatArray:
    """Positive definite metrics 11, 12, 22 of size one, not diagonal, shape (count, 3)."""
    tangents = np.eye(2) + 0.3 * random.standard_normal((count, 2, 2))
    matrices = tangents @ tangents.swapaxes(1, 2) + 0.2 * np.eye(2)
    return np.ascontiguousarray(matrices[:, [0, 0, 1], [0, 1, 1]])


def product(metric: FloatArray, vector: FloatArray) -> FloatArray:
    """Covariant components of contravariant ones."""
    (m11, m12, m22), (first, second) = metric.T, vector.T
    return np.column_stack([m11 * first + m12 * second, m12 * first + m22 * second])
