"""Bodies whose weights differ much: what their quadrature is said to be off, and the points that are said to be enough."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar import _bindings
from isomortar._bindings import BodyArrays
from isomortar.geometry.patch import FACES, Direction, FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Material
from isomortar.model.layers import LinePoints, in_layers
from isomortar.model.numbering import patch_arrays
from isomortar.model.rational import forces_of_stretch, points_enough, quadrature_error

#: Gauss points along each direction of an element that leave nothing but round-off.
MANY = 40
#: By name orders, elements, points of an element and the largest weight; no two directions alike.
BODIES = {
    "gentle": ((2, 1, 1), (2, 1, 1), (3, 2, 2), 4.0),
    "steep": ((1, 2, 1), (1, 2, 1), (2, 3, 2), 20.0),
    "inside": ((3, 2, 2), (1, 1, 2), (4, 3, 3), 60.0),
    "peak": ((2, 3, 2), (2, 1, 2), (3, 4, 3), 1000.0),
}


def made(name: str) -> Body:
    """A box about a place far away, one of whose control points within has that weight."""
    orders, elements, rule, heavy = BODIES[name]
    patch = mesh(box((5.0, -3.0, 1.0), (6.0, -1.0, 1.5)), ("N",) * 3, orders, elements)
    weights = np.ones(len(patch.weights))
    weights[np.ravel_multi_index(tuple(n // 2 for n in reversed(patch.shape)), patch.shape[::-1])] = heavy
    return Body("body", Patch(patch.directions, patch.control_points, weights), Material(young=2.0, poisson=0.2), rule)


def forces(body: Body, rule: tuple[int, int, int]) -> FloatArray:
    """Of a body that is longer by a hundredth along all directions."""
    points = np.ascontiguousarray(body.patch.control_points)
    found = np.zeros_like(points)
    arrays = BodyArrays(patch_arrays(body.patch, np.arange(len(points), dtype=np.int32)), rule, points)
    _bindings.add_body(arrays, body.material.arrays, points + 0.01 * (points - points.mean(axis=0)), found)
    return found


def off(body: Body, rule: tuple[int, int, int], exact: FloatArray) -> float:
    """How much forces by a rule are off, or are left inside where nothing pulls, by the size of all."""
    found = forces(body, rule)
    inside = np.setdiff1d(np.arange(len(found)), np.concatenate([body.patch.face_points(face) for face in FACES]))
    return float(np.max([np.linalg.norm(found - exact), np.linalg.norm(found[inside])]) / np.linalg.norm(exact))


@case(
    claim="The error of a body's quadrature is told within a half, and the points that are said to be enough are, and not many more.",
    tier="gate",
    grid={"body": list(BODIES)},
    bounds=lambda body: {
        "told": Bound(at_most=1.5, at_least=0.67, reason="quadrature: twice the points leave a part of the error, over the true one"),
        "round": Bound(at_most=0.0, reason="definition: weights like those of arcs, for which the default is made"),
        **(
            {"none": Bound(1.0, 1.0, "definition: more points than are tried")}
            if body == "peak"
            else {
                "enough": Bound(
                    at_most=1.1, reason="quadrature: the error with as many points as are said to be enough, over that allowed"
                ),
                "half": Bound(at_least=0.9, reason="definition: half of these points are too few: doubling found them"),
            }
        ),
    },
)
def told(body: str) -> dict[str, float]:
    """The error that is told over the true one; true errors with the points that are enough, and half of them, over that allowed."""
    given = made(body)
    exact = forces(given, (MANY,) * 3)
    true = off(given, given.quadrature, exact)
    allowed = 1e-3 * true
    rule = points_enough(given, allowed)
    conic = replace(given, patch=replace(given.patch, weights=3.0 * np.minimum(given.patch.weights, 2.0)))
    found = {"told": quadrature_error(given) / true, "round": quadrature_error(conic)}
    if rule is None:
        return found | {"none": 1.0}
    half = (rule[0] // 2, rule[1] // 2, rule[2] // 2)
    return found | {"enough": off(given, rule, exact) / allowed, "half": off(given, half, exact) / allowed}


def in_turn(contrast: float) -> Body:
    """A cube with two weights in turn along u and v, control points where those of a polynomial cube are."""
    across, up = Direction("N", 2, np.array([0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0])), Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    grid = np.meshgrid(across.greville, across.greville, up.greville, indexing="ij")
    points = np.stack([axis.ravel(order="F") for axis in grid], axis=1)
    odd = np.sum(np.indices(grid[0].shape)[:2], axis=0).ravel(order="F") % 2
    return Body("body", Patch((across, across, up), points, contrast**odd), Material(young=2.0, poisson=0.2), (4, 4, 2))


@case(
    claim="However much weights differ, layers integrate their functions, and a resultant that Gauss points miss by a per cent is told of.",
    tier="gate",
    grid={"contrast": [4.0, 1e2, 1e4, 1e6, 1e9, 1e12]},
    bounds=lambda contrast: {
        "layers": Bound(at_most=2e-4, reason="quadrature: Gauss points of a layer in which weights differ by four"),
        "told": Bound(at_least=0.01 if contrast > 4.0 else 0.0, reason="definition: told from a hundredth on"),
        "beside": Bound(at_least=1.0, reason="theory: a resultant is off by less than the forces that it is of"),
    },
)
def in_layers_of_weights(contrast: float) -> dict[str, float]:
    """Errors of the resultant on the upper face, exactly its area, in layers and by Gauss points; the latter beside the error told."""
    body = in_turn(contrast)
    top = body.patch.face_points("w1")
    better = forces_of_stretch(body.patch, in_layers(body.patch.directions, body.patch.weights))[top, 2].sum()
    gauss = [LinePoints.of(direction.boundaries, points) for direction, points in zip(body.patch.directions, body.quadrature, strict=True)]
    found = forces_of_stretch(body.patch, gauss)[top, 2].sum()
    told = quadrature_error(body)
    return {"layers": abs(better - 1.0), "told": told, "beside": told / max(abs(found - 1.0), 1e-3)}
