"""Control gaps by the mass matrix, and what may press them shut: multipliers that do work on these gaps and on nothing else."""

from __future__ import annotations

import numpy as np
from enforcement.contact import ELEMENTS
from extremes.discretisation import compliance, masses
from patch_tests.contact import knots
from scipy.interpolate import make_interp_spline
from scipy.optimize import nnls

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, Shown, case

#: Depth and curvature of a paraboloid that is pressed into the middle of a unit square, so that about a third of it touches.
_DEPTH, _CURVATURE = 0.08, 1.0


def paraboloid(order: int) -> FloatArray:
    """Control values of its depth on the square, shape (n,); consistent ones (theory 10.11), exact above order 1."""
    ends = knots(order, ELEMENTS)
    places = np.array([ends[i + 1 : i + order + 1].mean() for i in range(ELEMENTS + order)])
    line = make_interp_spline(places, 0.5 * _CURVATURE * (places - 0.5) ** 2, k=order, t=ends).c
    return _DEPTH - np.add.outer(line, line).ravel()


def pressed(gaps: FloatArray, forces: FloatArray, yielding: FloatArray, start: FloatArray) -> FloatArray:
    """Multipliers that press constraints' gaps shut, by active sets, shape (n,).

    Parameters
    ----------
    gaps, forces : ndarray, shape (n, n)
        From gaps of control points to those of constraints, and from multipliers to forces.
    yielding : ndarray, shape (n, n)
        The compliance.
    start : ndarray, shape (n,)
        Depths of the control points that nothing presses.
    """
    closing, multipliers = gaps @ yielding @ forces, np.zeros(len(start))
    active = gaps @ start > 0.0
    for _ in range(50):
        multipliers = np.zeros(len(start))
        multipliers[active] = np.linalg.solve(closing[np.ix_(active, active)], (gaps @ start)[active])
        trial = multipliers + (gaps @ start - closing @ multipliers) / np.diag(closing)
        if np.array_equal(trial > 0.0, active):
            break
        active = trial > 0.0
    return multipliers


_NOTHING = Bound(at_most=1e-12, reason="theory: multipliers press where what they do work on is closed, and there alone")
_SOMETHING = Bound(at_least=1e-3, reason="theory: control pressures of closed gaps press on open neighbours; far above round-off")


@case(
    claim="Averages closed by control pressures, and control gaps closed by dual functions, leave no work at open gaps; control gaps "
    "closed by control pressures do.",
    tier="gate",
    grid={"form": ("mortar", "dual", "mixed"), "order": (2, 3)},
    bounds=lambda form, order: {  # noqa: ARG005
        "work": _SOMETHING if form == "mixed" else _NOTHING,
        "force": Shown("discretisation: over that of the mortar method"),
    },
)
def work(form: str, order: int) -> dict[str, float]:
    """Work of the pressure on the gap over force times depth, of a paraboloid pressed into an elastic cube; small deformations.

    In `mixed` control gaps (theory 10.11) are closed by control pressures.
    """
    mass, yielding, start = masses(order, ELEMENTS, ELEMENTS), compliance(order, ELEMENTS, 1.0), paraboloid(order)
    areas = mass.sum(axis=1)
    averages, control_gaps = mass / areas[:, None], np.eye(len(mass))
    ways = {"mortar": (averages, mass), "dual": (control_gaps, np.diag(areas)), "mixed": (control_gaps, mass)}
    found = {name: way[1] @ pressed(*way, yielding, start) for name, way in ways.items()}
    forces = found[form]
    return {
        "work": abs(float(forces @ (start - yielding @ forces))) / (float(forces.sum()) * _DEPTH),
        "force": float(forces.sum() / found["mortar"].sum()),
    }


@case(
    claim="What augmentations with averages come to stays with the consistent mass matrix, if pressures are projected in its norm, and not "
    "if one by one.",
    tier="gate",
    grid={"projection": ("in its norm", "one by one"), "order": (2, 3)},
    bounds=lambda projection, order: {  # noqa: ARG005
        "moved": Bound(at_most=1e-9, reason="round-off: times the condition of the mass matrix, 1e5 at order 3")
        if projection == "in its norm"
        else Bound(at_least=1e-2, reason="theory: another problem; far above round-off")
    },
)
def metric(projection: str, order: int) -> dict[str, float]:
    """How far another augmentation moves the mortar method's pressures, over their norm (theory 10.12)."""
    mass, yielding, start = masses(order, ELEMENTS, ELEMENTS), compliance(order, ELEMENTS, 1.0), paraboloid(order)
    pressures = pressed(mass / mass.sum(axis=1)[:, None], mass, yielding, start)
    trial = pressures + (start - yielding @ mass @ pressures) / np.diag(yielding @ mass).mean()
    root = np.linalg.cholesky(mass).T
    after = nnls(root, root @ trial)[0] if projection == "in its norm" else np.maximum(trial, 0.0)
    return {"moved": float(np.linalg.norm(after - pressures) / np.linalg.norm(pressures))}
