"""Control points of very different weight <R^I>: each is measured by its own, and what is not a number stays so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import bowl

from isomortar import _bindings
from isomortar._bindings import Control, Law
from isomortar._codes import PointState
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, RigidPlane, Stage, Support
from isomortar.model.settings import SolverSettings


def graded(span: float) -> Patch:
    """A unit block of order 2 whose first knot span along x and y is as given, with no strain in its control points."""
    knots = np.array([0.0, 0.0, 0.0, span, 0.5, 1.0, 1.0, 1.0])
    deep = np.array([0.0, 0.5, 1.0])
    fine, whole = Direction("N", 2, knots), Direction("N", 2, np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]))
    z, y, x = np.meshgrid(deep, fine.greville, fine.greville, indexing="ij")  # the functions then reproduce the coordinates
    return Patch((fine, fine, whole), np.column_stack([x.ravel(), y.ravel(), z.ravel()]), np.ones(x.size))


def pressed(patch: Patch) -> Problem:
    """A block pressed on a plane without friction, free to widen."""
    still = (Motion(),)
    return Problem(
        "graded",
        (Body("block", patch, Material(), (4, 4, 4)),),
        (Contact("floor", Face("block", "w0"), RigidPlane((0.0,) * 3, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)), 0.0, (6, 6)),),
        (
            Support("top", Face("block", "w1"), (Motion((0.0, 0.0, -0.2)),), components=(2,)),
            Support("x", Face("block", "u0"), still, components=(0,)),
            Support("y", Face("block", "v0"), still, components=(1,)),
        ),
        (Stage("press", 1),),
        SolverSettings(newton_tolerance=1e-12, complementarity_tolerance=1e-11),
    )


@case(
    claim="A uniform pressure is uniform whatever the ratio of the knot spans.",
    tier="gate",
    grid={"span": (0.25, 1e-2, 1e-4, 2e-6)},
    bounds=lambda span: {
        "spread": Bound(
            at_most=max(1e-10, 1e-12 / span**2),
            reason="round-off: Newton leaves 1e-12 of the force, on a control point that carries the square of the span of it",
        )
    },
)
def spans(span: float) -> dict[str, float]:
    """Largest less smallest value of the pressure field over the largest."""
    *_, last = Simulation(pressed(graded(span))).run()
    low, high = last.contacts[0].pressure_field
    return {"spread": float((high - low) / high)}


@case(
    claim="What is not a number makes pressure or traction of its control point none either: nothing opens, sticks or slips for it.",
    tier="gate",
    grid={"slip_sum": ("local", "paper"), "friction": (0.0, 0.3)},
    bounds={"hidden": Bound(at_most=0.0, reason="definition: control points that are open, or whose response is finite")},
)
def not_numbers(slip_sum: str, friction: float) -> dict[str, float]:
    """At the end of a run, one control quantity or multiplier after the other is spoiled at every active control point by itself."""
    problem = bowl("block", friction, slip_sum=slip_sum)
    simulation = Simulation(problem)
    *_, before, last = simulation.run()
    pair = simulation.equilibrium.pairs[0]
    state = last.state.contacts[0]
    control = pair.kinematics(last.state.positions, before.state.contacts[0]).control
    law = pair.law(np.array([1.0, 1.0]), state.pressure, state.traction)
    active = np.flatnonzero(state.pressure > 0.0)
    spoiled = ("gap", "weight", *(("slip", "metric", "square") if friction > 0 else ()))
    return {"hidden": float(sum(_hidden(pair.pair.slave, control, law, name, int(point)) for name in spoiled for point in active))}


def _hidden(slave: _bindings.SlaveArrays, control: Control, law: Law, name: str, point: int) -> bool:
    """Whether a control point is open, or its response finite, where one of its control quantities is not a number."""
    values: FloatArray = getattr(control, name).copy()
    values[point] = np.nan
    response = _bindings.augmented_multipliers(slave, replace(control, **{name: values}), law)
    finite = np.isfinite(response.pressure[point]) and np.isfinite(response.traction[point]).all()
    return bool(finite or response.state[point] == PointState.OPEN)


@case(
    claim="A control point answers to its mean gap and slip however small its share over the master is, down to where it has left that.",
    grid={"friction": (0.0, 0.3), "share": (0.3, 1e-3, 1e-9, 1e-11)},
    bounds=lambda friction, share: {  # noqa: ARG005
        "changed": Bound(at_most=1e-12, reason="round-off: of means; or definition: of what has left nothing is closed"),
        "active": Bound(at_least=1.0, reason="definition: or nothing is tried"),
    },
)
def shares(friction: float, share: float) -> dict[str, float]:
    """Largest change, over the largest, of pressures and tractions of points closed at the end of a run, by a share of their integrals.

    Below a share of 1e-10 there is none of either left (theory 4.1).
    """
    simulation = Simulation(bowl("block", friction))
    *_, before, last = simulation.run()
    pair, state = simulation.equilibrium.pairs[0], last.state.contacts[0]
    control = pair.kinematics(last.state.positions, before.state.contacts[0]).control
    fewer = replace(control, **{name: share * getattr(control, name) for name in ("weight", "square", "gap", "slip", "metric")})
    law = pair.law(np.array([1.0, 1.0]), state.pressure, state.traction)
    whole, part = (_bindings.augmented_multipliers(pair.pair.slave, found, law) for found in (control, fewer))
    left = 1.0 if share > 1e-10 else 0.0
    changes = [(part.pressure - left * whole.pressure) / whole.pressure.max()]
    if friction > 0.0:
        changes += list((part.traction - left * whole.traction).T / np.abs(whole.traction).max())
    return {"changed": float(np.abs(changes).max()), "active": float(np.count_nonzero(whole.state))}
