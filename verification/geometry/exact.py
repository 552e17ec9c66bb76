"""The built-in bodies are exact: volume, area and inertia as integrated, and points of their faces, however they are discretised."""

from __future__ import annotations

import numpy as np
from basis.geometry import area, surface, volume
from geometry.bodies import BODIES, refined

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.quadrature import volume_points
from isomortar.harness import LAGRANGE, NURBS, Bound, case
from isomortar.results.bezier import functions_at, rational_gradient

#: Points per direction that integrate a quarter of a circle to round-off, the square of a coordinate times the volume, too.
MANY = 16
_SUM = "round-off: a sum over all quadrature points, whose own number is enough for it"


def gauss(direction: Direction, count: int) -> tuple[FloatArray, FloatArray]:
    """Parameters of the Gauss points of all elements of a direction, and their shares of it."""
    line, weight = np.polynomial.legendre.leggauss(count)
    half = 0.5 * np.diff(direction.boundaries)[:, None]
    return (direction.boundaries[:-1, None] + half * (1.0 + line)).ravel(), (half * weight).ravel()


def sampled(patch: Patch, counts: tuple[int, int, int]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Points of a body at Gauss points, shape (n, 3), determinants of its map there, and these times the shares, shape (n,)."""
    rules = [gauss(direction, count) for direction, count in zip(patch.directions, counts, strict=True)]
    functions = [functions_at(direction, places) for direction, (places, _) in zip(patch.directions, rules, strict=True)]
    points, gradient = rational_gradient(functions, patch.weights, patch.control_points)
    determinant = np.linalg.det(gradient)
    shares = np.einsum("k,j,i->kji", *(share for _, share in rules[::-1])).ravel()
    return points, determinant, determinant * shares


@case(
    claim="Volume, first and second moments, and the area of the curved face are those of the exact body, of any order.",
    grid={"body": list(BODIES), "kind": NURBS, "grading": [1.0, 0.3]},
    tier=lambda body, kind, grading: "gate" if kind in ("N2", "N5") and (kind == "N2" or grading != 1.0) else "nightly",  # noqa: ARG005
    bounds={
        "volume": Bound(at_most=1e-13, reason=_SUM),
        "area": Bound(at_most=1e-13, reason=_SUM),
        "centre": Bound(at_most=1e-13, reason=_SUM),
        "inertia": Bound(at_most=1e-13, reason=_SUM),
    },
)
def exact_measure(body: str, kind: str, grading: float) -> dict[str, float]:
    """Relative errors; moments over the volume times the body's size and its square."""
    built, patch = BODIES[body], refined(body, kind, grading)
    exact, first, second = built.moments()
    points, _, shares = sampled(patch, (MANY,) * 3)
    size = float(np.linalg.norm(np.ptp(patch.control_points, axis=0)))
    return {
        "volume": abs(volume(patch, (MANY,) * 3) / exact - 1),
        "area": abs(area(patch, built.curved, (MANY,) * 2) / built.area - 1),
        "centre": float(np.abs(shares @ points - first).max()) / (exact * size),
        "inertia": float(np.abs(np.einsum("q,qi,qj->ij", shares, points, points) - second).max()) / (exact * size**2),
    }


@case(
    claim="Points of curved faces, and nodes of Lagrange elements, are on the exact surface, and no element is folded, poles or not.",
    grid={"body": list(BODIES), "kind": NURBS + LAGRANGE},
    tier=lambda body, kind: "gate" if kind in ("N2", "L1", "L2") else "nightly",  # noqa: ARG005
    bounds={
        "off": Bound(at_most=1e-14, reason="round-off: of the control points, as a share of the body's size"),
        "folded": Bound(at_least=1e-7, reason="definition: of the map at the Gauss points of all elements; beside a pole it is small"),
    },
)
def on_the_surface(body: str, kind: str) -> dict[str, float]:
    """Largest distance over the body's size, and the smallest determinant over the largest."""
    built, patch = BODIES[body], refined(body, kind)
    if kind[0] == "N":
        ends = [direction.boundaries[[0, -1]] for direction in patch.face_directions(built.curved)]
        points = surface(patch, built.curved, np.column_stack([np.random.default_rng(3).uniform(low, high, 60) for low, high in ends]))
    else:
        points = patch.control_points[patch.face_points(built.curved)]
    u, v, w = (volume_points(direction) for direction in patch.directions)
    determinant = sampled(patch, (u, v, w))[1]
    size = float(np.linalg.norm(np.ptp(patch.control_points, axis=0)))
    return {"off": float(np.abs(built.off(points)).max()) / size, "folded": float(determinant.min() / determinant.max())}
