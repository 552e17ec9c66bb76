"""Control gaps by the mass matrix, and what may press them shut: multipliers that do work on these gaps and on nothing else."""

from __future__ import annotations

import numpy as np
from enforcement.contact import ELEMENTS
from extremes.discretisation import compliance, masses
from patch_tests.contact import knots
from scipy.interpolate import make_interp_spline

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, Shown, case

#: Depth and curvature of a paraboloid that is pressed into the middle of a unit square, so that about a third of it touches.
_DEPTH, _CURVATURE = 0.08, 1.0


def paraboloid(order: int) -> FloatArray:
    """Control values of its depth on the square, shape (n,); exact above order 1."""
    ends = knots(order, ELEMENTS)
    places = np.array([ends[i + 1 : i + order + 1].mean() for i in range(ELEMENTS + order)])
    line = make_interp_spline(places, 0.5 * _CURVATURE * (places - 0.5) ** 2, k=order, t=ends).c
    return _DEPTH - np.add.outer(line, line).ravel()


def pressed(gaps: FloatArray, forces: FloatArray, yielding: FloatArray, start: FloatArray) -> FloatArray:
    """Forces on the control points where constraints' gaps are closed by multipliers that press, by active sets.

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
    return np.asarray(forces @ multipliers)


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
    """Work of the pressure on the gap over force times depth, of a paraboloid pressed into an elastic cube; small deformations."""
    mass, yielding, start = masses(order, ELEMENTS, ELEMENTS), compliance(order, ELEMENTS, 1.0), paraboloid(order)
    areas = mass.sum(axis=1)
    averages, control_gaps = mass / areas[:, None], np.eye(len(mass))
    ways = {"mortar": (averages, mass), "dual": (control_gaps, np.diag(areas)), "mixed": (control_gaps, mass)}
    found = {name: pressed(*way, yielding, start) for name, way in ways.items()}
    forces = found[form]
    return {
        "work": abs(float(forces @ (start - yielding @ forces))) / (float(forces.sum()) * _DEPTH),
        "force": float(forces.sum() / found["mortar"].sum()),
    }
