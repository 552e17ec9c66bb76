"""The mixed rule: the slave's forces by the slave's quadrature points, the master's by its own (theory 10.14)."""

from __future__ import annotations

import numpy as np
from patch_tests.contact import functions, knots

from isomortar.geometry.patch import Direction, FloatArray
from isomortar.geometry.quadrature import contact_points
from isomortar.harness import Bound, case

#: Elements of either side of a flat interface; their knots do not meet inside.
_SLAVE, _MASTER = 8, 11
#: Of the slave's length, pressed about its middle.
_PRESSED = 0.6


def rule(elements: int, order: int) -> tuple[FloatArray, FloatArray]:
    """Default Gauss points of a unit interval's elements, and their weights."""
    count = contact_points(Direction("N", order, np.repeat([0.0, 1.0], order + 1)))
    points, weights = np.polynomial.legendre.leggauss(count)
    return ((np.arange(elements)[:, None] + 0.5 * (1.0 + points)) / elements).ravel(), np.tile(0.5 * weights / elements, elements)


def pressures(order: int) -> FloatArray:
    """Control pressures of a contact that is open beside its middle."""
    ends = knots(order, _SLAVE)
    places = np.array([ends[i + 1 : i + order + 1].mean() for i in range(_SLAVE + order)])
    return np.maximum(0.0, 1.0 - (2.0 * (places - 0.5) / _PRESSED) ** 2)


_EXACT = Bound(at_most=1e-13, reason="round-off: of sums over some tens of points")
_INEXACT = Bound(at_least=1e-9, reason="quadrature: points that do not see the other side's knots; far above round-off")


@case(
    claim="The master's own points give its load of a uniform pressure exactly, and break the balance of forces; the slave's keep it.",
    tier="gate",
    grid={"points": ("slave", "master"), "order": (1, 2, 3)},
    bounds=lambda points, order: {  # noqa: ARG005
        "load": _INEXACT if points == "slave" else _EXACT,
        "forces": _EXACT if points == "slave" else _INEXACT,
    },
)
def mixed_rule(points: str, order: int) -> dict[str, float]:
    """Largest error of the master's loads of a uniform pressure; sum of forces where contact is partly open (theory 10.14).

    Both sides are one unit interval, of one order. The master's forces are integrated by some points, the slave's by its own.
    """
    own, theirs = rule(_SLAVE, order), rule(_SLAVE if points == "slave" else _MASTER, order)
    ends = knots(order, _MASTER)
    exact = (ends[order + 1 :] - ends[: -order - 1]) / (order + 1)
    field = pressures(order)
    on_slave, on_master = (float(weights @ (functions(order, _SLAVE, places) @ field)) for places, weights in (own, theirs))
    return {
        "load": float(np.abs(theirs[1] @ functions(order, _MASTER, theirs[0]) / exact - 1.0).max()),
        "forces": abs(on_master / on_slave - 1.0),
    }
