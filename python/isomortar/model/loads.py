"""Loads: their forces at control points, and how those of pressures change with the positions."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar import _bindings
from isomortar._bindings import Pattern
from isomortar.geometry.patch import FloatArray, IntArray, Patch
from isomortar.geometry.quadrature import load_points
from isomortar.model.entities import Body, Load, Problem
from isomortar.model.numbering import Numbering, body_arrays, patch_arrays
from isomortar.model.pattern import incidence, pattern_of
from isomortar.model.supports import factor_at


class Loads:
    """All loads of a problem; `forces` and `tangents` are those of a load time."""

    def __init__(self, problem: Problem, numbering: Numbering) -> None:
        self._problem = problem
        self._parts = [_part(load, problem.body(load.body), numbering) for load in problem.loads]

    def forces(self, positions: FloatArray, time: float) -> list[FloatArray]:
        """Forces of each load on its body, shape (control points, 3)."""
        parts = zip(self._problem.loads, self._parts, strict=True)
        return [factor_at(self._problem.stages, load.factors, time) * part.forces(positions) for load, part in parts]

    def tangents(self, positions: FloatArray, time: float) -> Iterator[tuple[Pattern, FloatArray]]:
        """Derivatives of the forces of each pressure by the positions, shape (blocks, 3, 3), with their patterns (theory 5.16)."""
        for load, part in zip(self._problem.loads, self._parts, strict=True):
            if isinstance(part, Pressure):
                yield part.pattern, factor_at(self._problem.stages, load.factors, time) * part.tangent(positions)


class _Dead:
    """A load that does not follow its body."""

    def __init__(self, shares: FloatArray, value: tuple[float, ...], body: Body, numbering: Numbering) -> None:
        """`shares`: area or volume of each control point of the body's patch."""
        self._forces = np.zeros_like(numbering.reference)
        numbering.add_of_patch(body.name, shares[:, None] * np.array(value), self._forces)

    def forces(self, positions: FloatArray) -> FloatArray:  # noqa: ARG002  they stay
        """Forces on the body, shape (control points, 3) (theory 5.14)."""
        return self._forces


class Pressure:
    """A pressure of a given size on a face, along the normal of where it is.

    Attributes
    ----------
    pattern : Pattern
        Blocks of its tangent: control points that share an element of the face.
    """

    def __init__(self, size: float, body: Body, face: str, numbering: Numbering) -> None:
        nodes, self._values, self._slopes, area = _face_tables(body.patch, face)
        self._points, self._count = numbering.face_points(body, face)[nodes], numbering.count
        inwards = 1.0 if face[1] == "0" else -1.0
        stretch = np.linalg.norm(np.cross(*self._tangents(numbering.reference)), axis=2)
        self._pressing = inwards * size * np.divide(area, stretch, out=np.zeros_like(area), where=stretch > 0.0)
        members = incidence(self._points, numbering.count)
        self.pattern = pattern_of(members.T @ members)
        rows = np.repeat(np.arange(numbering.count), np.diff(self.pattern.start))
        wanted = self._points[:, :, None].astype(np.int64) * numbering.count + self._points[:, None, :]
        self._places = np.searchsorted(rows * numbering.count + self.pattern.column, wanted.ravel())

    def forces(self, positions: FloatArray) -> FloatArray:
        """Forces on the body, shape (control points, 3) (theory 5.15)."""
        first, second = self._tangents(positions)
        pressing = self._pressing[:, :, None] * np.cross(first, second)
        shares = self._values.transpose(0, 2, 1) @ pressing
        forces = [np.bincount(self._points.ravel(), shares[..., i].ravel(), minlength=self._count) for i in range(3)]
        return np.asarray(forces, dtype=np.float64).T

    def tangent(self, positions: FloatArray) -> FloatArray:
        """Derivatives of the forces by the positions, shape (blocks, 3, 3) (theory 5.16)."""
        first, second = self._tangents(positions)
        along, across = self._slopes[:, 0, :, :, None], self._slopes[:, 1, :, :, None]
        turning = across * first[:, :, None] - along * second[:, :, None]  # (elements, points, functions, 3)
        pressing = (self._pressing[:, :, None] * self._values).transpose(0, 2, 1)
        shares = (pressing @ turning.reshape(*turning.shape[:2], -1)).reshape(-1, 3)
        blocks = np.zeros((len(self.pattern.column), 3, 3))
        for (i, j), share in zip(((2, 1), (0, 2), (1, 0)), shares.T, strict=True):  # of the matrix of a product with x, y, z
            blocks[:, i, j] = np.bincount(self._places, share, minlength=len(blocks))
            blocks[:, j, i] = -blocks[:, i, j]
        return blocks

    def _tangents(self, positions: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Tangent vectors of the face at its quadrature points, each of shape (elements, points, 3)."""
        points = positions[self._points]
        return self._slopes[:, 0] @ points, self._slopes[:, 1] @ points


def _part(load: Load, body: Body, numbering: Numbering) -> Pressure | _Dead:
    if load.kind == "pressure":
        return Pressure(load.value[0], body, load.place.face, numbering)
    shares = control_volumes(body) if load.kind == "weight" else control_areas(body.patch, load.place.face)
    return _Dead(shares, load.value, body, numbering)


def control_volumes(body: Body) -> FloatArray:
    """Integrals of the functions of a body's patch over its reference volume, shape (control points of the patch,)."""
    return _bindings.control_volumes(body_arrays(body))


def control_areas(patch: Patch, face: str) -> FloatArray:
    """The same over the reference area of a face (theory 5.14)."""
    nodes, values, _, area = _face_tables(patch, face)
    shares = np.einsum("eqa,eq->ea", values, area)
    numbers = patch.face_points(face)[nodes]
    return np.asarray(np.bincount(numbers.ravel(), shares.ravel(), minlength=len(patch.weights)), dtype=np.float64)


def _face_tables(patch: Patch, face: str) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """Of a face by elements: control points within it; functions, (elements, points, functions); slopes, (elements, 2, ...); areas."""
    arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
    first, second = patch.face_directions(face)
    rule = (load_points(first), load_points(second))
    nodes, values, slopes, area = _bindings.slave_tables(arrays, "uvw".index(face[0]) + 1, int(face[1]), rule, patch.control_points)
    shape = (len(nodes), -1, nodes.shape[1])
    both = np.ascontiguousarray(slopes.reshape(len(nodes), -1, *slopes.shape[1:]).swapaxes(1, 2))
    return nodes, values.reshape(shape), both, area.reshape(shape[:2])
