"""How well Gauss points integrate rational functions: weights that differ much need more of them than a polynomial's order does."""

from __future__ import annotations

import numpy as np

from isomortar import _bindings
from isomortar._arguments import MAX_GAUSS
from isomortar._bindings import BodyArrays
from isomortar.geometry.patch import FACES, FloatArray
from isomortar.model.entities import Body
from isomortar.model.numbering import patch_arrays

#: Weights of conic sections, arcs of up to 120 degrees, are within this ratio of each other; the default points are made for them.
CONIC = 2.0
#: Most quadrature points that a body is tried with, a second of work, and most along a direction of an element.
MOST_POINTS, MOST_ALONG = 500_000, 64

#: Share of the forces that the quadrature of rational functions may be off; more is told.
QUADRATURE_TOLD = 0.01

Rule = tuple[int, int, int]


def quadrature_error(body: Body) -> float:
    """Error of the forces of a uniform stretch by a body's Gauss points (theory 9.2), relative to all; 0 where weights hardly differ.

    These forces are integrals of the functions' derivatives, as those of any state are.

    Raises
    ------
    FoldedElementError
        An element is folded between its Gauss points.
    """
    weights = body.patch.weights
    if not weights.max() > CONIC * weights.min():
        return 0.0
    return _error(body, _stretched(body, body.quadrature), _stretched(body, _twice(body.quadrature)))


def too_few_points(body: Body, error: float, least: float) -> str:
    """A sentence on a body whose quadrature is off by an error, with the number of Gauss points that leave at most another one."""
    enough = points_enough(body, least)
    cure = f"Take bodies.{body.name}.mesh.quadrature = {list(enough)} and as many in its contacts, or bring" if enough else "Bring"
    return (
        f"body {body.name!r}: its weights, from {body.patch.weights.min():g} to {body.patch.weights.max():g}, differ too much for the "
        f"quadrature with {' x '.join(map(str, body.quadrature))} Gauss points an element: forces are off by {100 * error:.2g} % or "
        f"more. {cure} the weights nearer to each other"
    )


def points_enough(body: Body, error: float) -> Rule | None:
    """Numbers of Gauss points that doubling finds to leave at most such an error; None: more than are tried."""
    rule = body.quadrature
    forces = _stretched(body, rule)
    while True:
        finer = _twice(rule)
        if max(finer) > MOST_ALONG or np.prod(finer) * np.prod([d.elements for d in body.patch.directions]) > MOST_POINTS:
            return None
        better = _stretched(body, finer)
        if _error(body, forces, better) <= error:
            return rule
        rule, forces = finer, better


def _twice(rule: Rule) -> Rule:
    """Twice as many points, as far as there are rules."""
    u, v, w = (min(2 * n, MAX_GAUSS) for n in rule)
    return u, v, w


def _error(body: Body, forces: FloatArray, better: FloatArray) -> float:
    """What twice as many points make better, or what is left at control points inside, where nothing pulls: both rules miss sharp peaks."""
    inside = np.ones(len(forces), dtype=bool)
    inside[np.concatenate([body.patch.face_points(face) for face in FACES])] = False
    off = np.array([np.linalg.norm(forces - better), np.linalg.norm(forces[inside])])
    return float(off.max() / np.linalg.norm(better))


def _stretched(body: Body, rule: Rule) -> FloatArray:
    """Forces at the control points of a body that is longer by a hundredth along all directions."""
    points = body.patch.control_points - body.patch.control_points.mean(axis=0)
    forces = np.zeros_like(points)
    patch = patch_arrays(body.patch, np.arange(len(points), dtype=np.int32))
    _bindings.add_body(BodyArrays(patch, rule, points), body.material.arrays, 1.01 * points, forces)
    return forces
