"""What pages show of the built-in bodies: their outer faces, once each, where they are, with the stress that they are under."""

from __future__ import annotations

import numpy as np
from geometry.bodies import BODIES, refined
from geometry.exact import MANY, gauss, sampled
from patch_tests.bulk import GRADIENT, MATERIAL, SHIFT

from isomortar.geometry.patch import FACES, Direction
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Problem
from isomortar.results.bezier import functions_at, rational_gradient
from isomortar.results.paraview import body_grid
from isomortar.results.stress import cauchy_stress, von_mises
from isomortar.results.view import Surface, of_bodies


def below(surface: Surface) -> float:
    """Integral of x . n / 3 over a surface, n as its coordinates turn: from its net alone."""
    knots = [np.repeat(np.arange(elements + 1.0), order) for order, elements in zip(surface.orders, surface.elements, strict=True)]
    directions = [Direction("N", p, np.pad(places, 1, mode="edge")) for p, places in zip(surface.orders, knots, strict=True)]
    rules = [gauss(direction, MANY) for direction in directions]
    functions = [functions_at(direction, places) for direction, (places, _) in zip(directions, rules, strict=True)]
    points, slopes = rational_gradient(functions, surface.weights, surface.rows[0][:3].T)
    normals = np.cross(slopes[:, :, 0], slopes[:, :, 1]) * np.outer(rules[1][1], rules[0][1]).ravel()[:, None]
    return float(np.sum(points * normals)) / 3.0


@case(
    claim="A page shows a body's outer faces, and no seam: they enclose its volume, under the stress that it is under.",
    tier="gate",
    grid={"body": list(BODIES), "kind": ["N2", "L2"]},
    bounds={
        "volume": Bound(at_most=1e-13, reason="round-off: a sum over all quadrature points"),
        "seams": Bound(at_least=0.0, at_most=0.0, reason="definition: where a body meets itself there is nothing to be seen"),
        "J": Bound(at_most=1e-9, reason="round-off: beside a pole, of places of less and less volume"),
        "stress": Bound(at_most=1e-9, reason="round-off: as above"),
    },
)
def outside(body: str, kind: str) -> dict[str, float]:
    """Of a body that is deformed alike everywhere, relative errors of volume, rate of volume and stress; faces too many."""
    built, patch = BODIES[body], refined(body, kind)
    whole = Body("body", patch, MATERIAL, (3, 3, 3), built.closed)
    grid = body_grid(0, whole, patch.control_points @ GRADIENT.T + SHIFT)
    surfaces = list(of_bodies(Problem("page", (whole,), (), (), ()), [grid]))
    growth, outer = float(np.linalg.det(GRADIENT)), [face for face in FACES if face[0] not in (built.closed or "")]
    volume = sum((1.0 if face[1] == "1" else -1.0) * below(surface) for face, surface in zip(outer, surfaces, strict=False))
    stress = float(von_mises(cauchy_stress(MATERIAL, GRADIENT[None]))[0])
    rates, stresses = (np.concatenate([s.rows[0][s.columns.index(name)] for s in surfaces]) for name in ("J", "von Mises stress"))
    return {
        "volume": abs(volume / (growth * float(sampled(patch, (MANY,) * 3)[2].sum())) - 1.0),
        "seams": float(len(surfaces) - len(outer)),
        "J": float(np.abs(rates / growth - 1.0).max()),
        "stress": float(np.abs(stresses / stress - 1.0).max()),
    }
