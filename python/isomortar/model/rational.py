"""How well Gauss points integrate rational functions: weights that differ much need more of them than a polynomial's order does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy import sparse

from isomortar.errors import FoldedElementError
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.model.entities import Body
from isomortar.model.layers import LinePoints, in_layers, unlike
from isomortar.model.lines import along, functions_along, quotient
from isomortar.model.shares import percent

#: Most quadrature points that a body is tried with, a second of work, and most along a direction of an element.
MOST_POINTS, MOST_ALONG = 500_000, 64
#: Points that are computed in one go.
AT_ONCE = 50_000
#: Volume, over the largest one, below which an element is folded: where one control point outweighs all others round-off is left of it.
FOLDED = -1e-6

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
    if not unlike(body.patch.directions, body.patch.weights):
        return 0.0
    return _error(forces_of_stretch(body.patch, _gauss(body)), _forces_in_layers(body.patch))


def too_few_points(body: Body, error: float, least: float) -> str:
    """A sentence on a body whose quadrature is off by an error, with the number of Gauss points that leave at most another one."""
    enough = points_enough(body, least)
    cure = f"Take bodies.{body.name}.mesh.quadrature = {list(enough)} and as many in its contacts, or bring" if enough else "Bring"
    return (
        f"body {body.name!r}: its weights, from {body.patch.weights.min():g} to {body.patch.weights.max():g}, differ too much for the "
        f"quadrature with {' x '.join(map(str, body.quadrature))} Gauss points an element: forces at its control points are off by "
        f"about {percent(error)}. {cure} the weights nearer to each other"
    )


def points_enough(body: Body, error: float) -> Rule | None:
    """Numbers of Gauss points that doubling finds to leave at most such an error; None: more than are tried."""
    rule, better = body.quadrature, _forces_in_layers(body.patch)
    while max(rule) <= MOST_ALONG and np.prod(rule) * np.prod([d.elements for d in body.patch.directions]) <= MOST_POINTS:
        if _error(forces_of_stretch(body.patch, _gauss(replace(body, quadrature=rule))), better) <= error:
            return rule
        u, v, w = (2 * n for n in rule)
        rule = (u, v, w)
    return None


def _error(forces: FloatArray, better: FloatArray) -> float:
    """How much forces are off, relative to all."""
    return float(np.linalg.norm(forces - better) / np.linalg.norm(better))


def _forces_in_layers(patch: Patch) -> FloatArray:
    """Forces of the stretch, whatever the weights."""
    return forces_of_stretch(patch, in_layers(patch.directions, patch.weights))


def _gauss(body: Body) -> list[LinePoints]:
    """The Gauss points of a body, by direction."""
    return [LinePoints.of(direction.boundaries, points) for direction, points in zip(body.patch.directions, body.quadrature, strict=True)]


def forces_of_stretch(patch: Patch, lines: Sequence[LinePoints]) -> FloatArray:
    """Integrals of the gradients of a patch's functions, shape (control points, 3): forces of a stress of one.

    Raises
    ------
    FoldedElementError
        An element is folded.
    """
    net = np.column_stack([(patch.control_points - patch.control_points.mean(axis=0)) * patch.weights[:, None], patch.weights])
    net = net.reshape((*patch.shape[::-1], 4))
    tables = [functions_along(direction, line.places) for direction, line in zip(patch.directions, lines, strict=True)]
    forces = np.zeros((*net.shape[:3], 3))
    u, v, w = lines
    each = max(1, AT_ONCE // (len(u.places) * len(v.places)))
    for first in range(0, len(w.places), each):
        rows = slice(first, first + each)
        tables_here = [tables[0], tables[1], (tables[2][0][rows], tables[2][1][rows])]
        value, *slopes = (_product(tables_here, net, axis) for axis in (None, 0, 1, 2))
        a, b, c = (quotient(slope, value) for slope in slopes)
        areas = np.cross(b, c), np.cross(c, a), np.cross(a, b)
        measure = w.weights[rows, None, None] * v.weights[:, None] * u.weights
        _check_volumes(patch, lines, first, np.einsum("...x,...x->...", a, areas[0]))
        share = (measure / value[..., 3])[..., None]
        transposed = [(here.T, slope.T) for here, slope in tables_here]
        forces += sum(_product(transposed, share * area, axis) for axis, area in enumerate(areas))
        forces -= _product(transposed, share / value[..., 3:] * sum(s[..., 3:] * area for s, area in zip(slopes, areas, strict=True)), None)
    return patch.weights[:, None] * forces.reshape(-1, 3)


def _check_volumes(patch: Patch, lines: Sequence[LinePoints], first: int, volumes: FloatArray) -> None:
    """Refuse folded elements by the volumes (w, v, u) at places from the `first` along w on."""
    if volumes.min() >= FOLDED * volumes.max():
        return
    at = np.unravel_index(volumes.argmin(), volumes.shape)[::-1] + np.array([0, 0, first])
    u, v, w = (int(np.searchsorted(d.boundaries, line.places[k])) - 1 for d, line, k in zip(patch.directions, lines, at, strict=True))
    number = u + patch.directions[0].elements * (v + patch.directions[1].elements * w)
    raise FoldedElementError(f"element {u}, {v}, {w} along u, v, w is folded", number)


def _product(tables: Sequence[tuple[sparse.csr_array, sparse.csr_array]], net: FloatArray, slope: int | None) -> FloatArray:
    """Tables of functions times a net (w, v, u), derivatives along the direction of that number."""
    for axis, (here, derivative) in enumerate(tables):
        net = along(derivative if axis == slope else here, net, 2 - axis)
    return net
