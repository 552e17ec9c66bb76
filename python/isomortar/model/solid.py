"""Internal forces and tangent of all bodies."""

from __future__ import annotations

from collections import Counter

import numpy as np
from scipy import sparse

from isomortar import _bindings
from isomortar.errors import FoldedElementError, InputError
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.pattern import element_points, incidence, pattern_of
from isomortar.model.reduction import Reduction


class Solid:
    """The bodies of a problem.

    Attributes
    ----------
    pattern : Pattern
        Blocks of the tangent, on global control points; fixed for a whole computation. Rigid bodies have those of the diagonal alone, zero.
    diagonal : ndarray of int
        The blocks on its diagonal, one a control point.

    Raises
    ------
    InputError
        An element is folded in the reference configuration.
    """

    def __init__(self, problem: Problem, numbering: Numbering, counts: Counter[str] | None = None) -> None:
        """`counts`, if given, is told of each quadrature point that is visited: "solid points"."""
        self._counts = Counter[str]() if counts is None else counts
        self._numbering = numbering
        self._bodies = problem.deformable
        total = sparse.eye_array(numbering.count, dtype=np.int32, format="csr")
        self._reductions = {body.name: Reduction(body, numbering) for body in self._bodies if body.raised}
        for body in self._bodies:
            if body.raised:
                total = total + self._reductions[body.name].reach
                continue
            elements = incidence(element_points(body.patch, numbering.points[body.name]), numbering.count)
            total = total + elements.T @ elements
        self.pattern = pattern_of(sparse.csr_array(total))
        rows = np.repeat(np.arange(numbering.count), np.diff(self.pattern.start))
        self._last: tuple[FloatArray, FloatArray, FloatArray] | None = None
        self._smallest: tuple[FloatArray, list[float]] | None = None
        self.diagonal = np.flatnonzero(rows == self.pattern.column)
        self._arrays = {body.name: numbering.body_arrays(body, often=True) for body in self._bodies if not body.raised}
        try:
            for body in problem.bodies:
                self._add_body(body, np.zeros_like(numbering.reference), numbering.reference, None)
        except FoldedElementError as error:
            raise InputError(
                f"{error}; check the geometry, the order of its control points, their weights, and the face it is seen from"
            ) from error

    def smallest_jacobians(self, positions: FloatArray) -> list[float]:
        """The smallest J = det F at a quadrature point of each deformable body; see `forces`. Those of the last positions are kept."""
        if self._smallest is not None and self._smallest[0] is positions:
            return self._smallest[1]
        return self._add(np.zeros_like(positions), positions, None)

    def forces(self, positions: FloatArray) -> FloatArray:
        """Internal forces, shape (control points, 3).

        Raises
        ------
        FoldedElementError
            Naming body and element.
        """
        if self._last is not None and self._last[0] is positions:
            return self._last[1]
        forces = np.zeros_like(self._numbering.reference)
        self._add(forces, positions, None)
        return forces

    def forces_and_tangent(self, positions: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Internal forces and tangent blocks, shape (blocks, 3, 3): block, row component, column component.

        Those of the last positions are kept: the start of a load increment asks for them twice, and for the forces again.
        """
        if self._last is None or self._last[0] is not positions:
            forces, tangent = np.zeros_like(positions), np.zeros((len(self.pattern.column), 3, 3))
            self._add(forces, positions, tangent)
            self._last = (positions, forces, tangent)
        return self._last[1], self._last[2]

    def _add(self, forces: FloatArray, positions: FloatArray, tangent: FloatArray | None) -> list[float]:
        """Add forces and tangent; the smallest J of each deformable body."""
        found = [self._add_body(body, forces, positions, tangent) for body in self._bodies]
        self._smallest = positions, found
        return found

    def _add_body(self, body: Body, forces: FloatArray, positions: FloatArray, tangent: FloatArray | None) -> float:
        """Add forces and tangent of a body; its smallest J."""
        pattern = self.pattern if tangent is not None else None
        try:
            if body.raised:
                smallest = self._reductions[body.name].add(positions, forces, pattern, tangent)
            else:
                arrays = self._arrays.get(body.name) or self._numbering.body_arrays(body)  # a rigid one is looked at once
                smallest = _bindings.add_body(arrays, body.material.arrays, positions, forces, pattern, tangent)
        except FoldedElementError as error:
            where = np.unravel_index(error.place, [d.elements for d in body.patch.directions], order="F")
            place = ", ".join(str(int(i)) for i in where)
            raise FoldedElementError(f"body {body.name!r}: {error} (element {place} along u, v, w)", error.place) from error
        self._counts["solid points"] += body.points
        return smallest
