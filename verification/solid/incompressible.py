"""What near incompressibility costs: a displacement without change of volume, to first order, at Poisson's ratios up to 0.4999.

Displacement elements have no remedy against locking. Lagrange elements of order 2 and more keep enough motions without change of volume to
lose no more than a power of the element size, whatever Poisson's ratio; those of order 1 and, the smoother the more, NURBS do not. Of these
theory says no more than that they stay where they are at worst, and Cea's root of the ratio of stiffnesses, 71: what they lose is shown.
"""

from __future__ import annotations

import numpy as np
from solid.manufactured import ANGLE, INNER, OUTER, Solution, discretised, errors, norms

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, Curve, Shown, case
from isomortar.model.entities import Material

#: Size of the stream function; strains reach 1e-4, so that changes of volume, of second order, make no more stress than shear does.
SIZE = 5e-6
POISSON = (0.3, 0.49, 0.499, 0.4999)
#: Elements a side.
COUNT = 8


def swirl(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Displacement (d psi / dy, -d psi / dx, 0) of psi = SIZE sin^2 sin^2, zero where it is held; slopes by complex steps."""
    step = 1e-30
    gradient = np.zeros((len(x), 3, 3))
    for k in (0, 1):
        gradient[:, :, k] = _curl(x + 1j * step * np.eye(3)[k]).imag / step
    return _curl(x.astype(complex)).real, gradient


def _curl(x: FloatArray) -> FloatArray:
    radius, angle = np.sqrt(x[:, 0] ** 2 + x[:, 1] ** 2), np.arctan(x[:, 1] / x[:, 0])
    s, t = np.pi * (radius - INNER) / (OUTER - INNER), np.pi * angle / ANGLE
    outward = SIZE * np.pi / (OUTER - INNER) * np.sin(2 * s) * np.sin(t) ** 2
    around = SIZE * np.pi / ANGLE * np.sin(s) ** 2 * np.sin(2 * t) / radius
    cosine, sine = x[:, 0] / radius, x[:, 1] / radius
    return np.stack([outward * sine + around * cosine, around * sine - outward * cosine, 0 * s], axis=1)


def limits(kind: str) -> dict[str, Bound | Shown]:
    """What may be lost, by order and family."""
    loss: Bound | Shown = Shown("theory: without the motions that keep the volume nothing but Cea's root, 71, limits it")
    if kind in ("L2", "L3", "L4"):
        loss = Bound(at_most=2.0 * COUNT, reason="theory: one power of h, times a constant for which 2 is allowed")
    return {"error": Bound(at_most=1.0, reason="theory: an element that locks altogether stays where it is"), "loss": loss}


@case(
    claim="Near incompressibility costs Lagrange elements of order 2 and more a power of the element size; none does worse than to stay "
    "where it is.",
    tier="nightly",
    grid={"kind": ("N1", "N2", "N3", "N4", "L1", "L2", "L3", "L4")},
    bounds=limits,
)
def near_incompressibility(kind: str) -> dict[str, object]:
    """Errors of displacement in L2 over its norm by 1 - 2 nu; error of its gradient at nu = 0.4999 over that at nu = 0.3."""
    patch = discretised(kind, COUNT, deep=False)
    points = np.arange(len(patch.weights), dtype=np.int32)
    gauss = (int(kind[1:]) + 4,) * 2 + (2,)
    whole = norms(Solution(swirl), patch, points, np.zeros_like(patch.control_points), gauss)[0]
    found = np.array([errors(Solution(swirl, Material(10.0, nu)), kind, COUNT)[0] for nu in POISSON])
    curve = Curve([1 - 2 * nu for nu in POISSON], found[:, 0] / whole, "1 - 2 nu", "relative error in L2", log_x=True)
    return {"error": curve, "loss": float(found[-1, 1] / found[0, 1])}
