"""Bodies with weights whose functions are of a higher order at a face: their space, their shape, their weight, and a bulk patch test."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from patch_tests.bulk import GRADIENT, MATERIAL, SHIFT
from patch_tests.raised import raised
from scipy.interpolate import BSpline

from isomortar.geometry.patch import FACES, FloatArray, Patch
from isomortar.geometry.primitives import cap, ring, sphere
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Load, Problem, Stage
from isomortar.model.loads import Loads
from isomortar.model.numbering import Numbering
from isomortar.model.reduction import Reduction

#: Gauss points per direction that integrate these rational functions to round-off.
MANY = 16
BODIES = {
    "cap": cap((0.1, -0.2), 1.0, 0.5, 0.1, 0.9),
    "ring": ring((0.2, 0.1, -0.3), 0.6, 1.0, 0.5, (20.0, 95.0)),
    "sphere": sphere((0.0, 0.3, 0.1), 0.5, 0.9, (-20.0, 40.0), (10.0, 80.0)),
}
_WEIGHT = (0.3, -0.2, -1.1)
_QUADRATURE = "quadrature: enough points for rational functions; round-off of the sums"


def values(patch: Patch, places: FloatArray) -> FloatArray:
    """Rational functions of a patch, as SciPy has their B-splines, at places in the unit cube; shape (places, control points)."""
    rows = [BSpline.design_matrix(at * d.knots[-1], d.knots, d.order).toarray() for at, d in zip(places.T, patch.directions, strict=True)]
    weighted = np.einsum("qk,qj,qi->qkji", *rows[::-1]).reshape(len(places), -1) * patch.weights
    return weighted / weighted.sum(axis=1, keepdims=True)


def exact(patch: Patch, body: Body, face: str, places: FloatArray) -> FloatArray:
    """The functions that a body with that raised face should have: those of `patch` below it, and at it those of the higher order."""
    ends = patch.face_points(face)
    below = np.delete(values(patch, places), ends, axis=1)
    return np.hstack([below, values(body.patch, places)[:, body.patch.face_points(face)]])


@case(
    claim="Bodies with weights are raised at any of their faces: functions, shape and weight are exact, a uniform stress is in balance.",
    tier="gate",
    grid={"body": list(BODIES)},
    bounds={
        "functions": Bound(at_most=1e-13, reason="round-off: of the shares that control points below the face have"),
        "shape": Bound(at_most=1e-14, reason="round-off: control points are those of the body before"),
        "weight": Bound(at_most=1e-13, reason=_QUADRATURE),
        "balance": Bound(at_most=1e-12, reason=_QUADRATURE),
        "force": Bound(at_least=0.1, reason="definition: there is a stress, over the largest force"),
    },
)
def rational(body: str) -> dict[str, float]:
    """Largest errors over all faces.

    Of functions; of control points below the face; of weights over that of the body before; forces inside over the largest one after an
    affine motion; and the least force on a face.
    """
    patch = mesh(BODIES[body], ("N",) * 3, (2, 2, 2), (2, 3, 2))
    plain = Body("body", patch, MATERIAL, (MANY,) * 3)
    before = _weights(plain)[1].sum(axis=0)
    places = np.random.default_rng(4).uniform(size=(20, 3))
    found: dict[str, list[float]] = {name: [] for name in ("functions", "shape", "weight", "balance", "force")}
    for face in FACES:
        given = replace(raised(plain, face, 3), quadrature=(MANY,) * 3)
        numbering, weights = _weights(given)
        rows = numbering.rows["body"]
        found["functions"].append(np.abs(values(given.patch, places) @ rows.into - exact(patch, given, face, places)).max())
        own = np.delete(patch.control_points, patch.face_points(face), axis=0)
        found["shape"].append(np.abs(rows.reference[: len(own)] - own).max())
        found["weight"].append(np.abs(weights.sum(axis=0) / before - 1.0).max())
        forces = np.zeros_like(numbering.reference)
        positions = np.ascontiguousarray(numbering.reference @ GRADIENT.T + SHIFT)
        Reduction(given, numbering).add(positions, forces, None, None)
        outside = np.unique(np.concatenate([patch.face_points(other) for other in FACES]))
        inside = np.isin(np.delete(np.arange(len(patch.weights)), patch.face_points(face)), outside, invert=True)
        inner = forces[: len(own)][inside]
        found["balance"].append(np.abs(inner).max() / np.abs(forces).max())
        found["force"].append(np.abs(forces[len(own) :]).max() / np.abs(forces).max())
    return {name: float(min(errors) if name == "force" else max(errors)) for name, errors in found.items()}


def _weights(body: Body) -> tuple[Numbering, FloatArray]:
    """Weights of a body's control points, shape (control points, 3)."""
    problem = Problem("loaded", (body,), (), (), (Stage("stage", 1),), loads=(Load("weight", "weight", "body", None, _WEIGHT, (1.0,)),))
    numbering = Numbering(problem)
    return numbering, Loads(problem, numbering).forces(numbering.reference, 1.0)[0]
