"""A problem as programs of finite elements see it: nodes, elements and faces of Lagrange bodies, and what is prescribed when."""

from __future__ import annotations

from collections.abc import Collection
from functools import cached_property

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import FACES, FloatArray, IntArray
from isomortar.model.checks import check
from isomortar.model.entities import Body, Contact, Face, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.pattern import element_points
from isomortar.model.supports import Supports, factor_at


class LagrangeProblem:
    """The problem in terms of nodes, for a program that has these laws of material.

    Parameters
    ----------
    problem : Problem
    program : str
        Its name, for what is said of what it cannot express.
    laws : collection of str
        Laws of material that it has.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        Reference positions; the numbers of `Numbering` count them.
    prescribed : ndarray of int, shape (m,)
        Prescribed unknowns, 3 * node + component, sorted.

    Raises
    ------
    InputError
        No program of Lagrange elements has this, or not this one: NURBS, weights, elements of which an edge is a point, another law of
        material, glue, loads other than pressures, rigid bodies and planes, friction other than Coulomb's.
    """

    def __init__(self, problem: Problem, program: str, laws: Collection[str]) -> None:
        check(problem)
        self.problem, self._program = problem, program
        if problem.glue:
            raise self.refuse("is not told of glued bodies", "glue")
        for load in problem.loads:
            if load.kind != "pressure":
                raise self.refuse("is told of no loads but pressures", f"loads.{load.name}.{load.kind}")
        for support in problem.supports:
            if support.is_plate:
                raise self.refuse("is not told of forces of supports", f"supports.{support.name}.force")
            if support.stages is not None:
                raise self.refuse("is not told of supports of some stages", f"supports.{support.name}.stages")
        self._numbering = Numbering(problem)
        self._supports = Supports(problem, self._numbering)
        self.nodes, self.prescribed = self._numbering.reference, self._supports.prescribed
        for body in problem.bodies:
            self._check_body(body, laws)
        for contact in problem.contacts:
            self._check_contact(contact)

    def elements(self, body: Body) -> IntArray:
        """Nodes of each element, the first direction fastest in both, shape (elements, nodes of an element)."""
        return element_points(body.patch, self._numbering.points[body.name])

    def touching(self, place: Face) -> IntArray:
        """Numbers of a body's elements on a face, in ascending order."""
        counts = [direction.elements for direction in self.problem.body(place.body).patch.directions]
        numbers = np.arange(np.prod(counts), dtype=np.int32).reshape(counts, order="F")
        number = FACES.index(place.face)
        return np.sort(np.take(numbers, -(number % 2), axis=number // 2), axis=None)

    @cached_property
    def displacements(self) -> FloatArray:
        """What is prescribed at the end of each load step, shape (load steps, m)."""
        places = np.array([self._supports.place(time) for time in self._times]).reshape(-1, len(self.nodes) * 3)
        return (places - self.nodes.ravel())[:, self.prescribed]

    @cached_property
    def pressures(self) -> FloatArray:
        """Sizes of the loads, all pressures, at the end of each load step, shape (load steps, loads)."""
        stages = self.problem.stages
        sizes = [[load.value[0] * factor_at(stages, load.factors, time) for load in self.problem.loads] for time in self._times]
        return np.array(sizes).reshape(len(self._times), len(self.problem.loads))

    @property
    def _times(self) -> list[float]:
        """Load time at the end of each load step."""
        return [float(step) for step in range(1, self.problem.total_steps + 1)]

    @property
    def thinnest(self) -> float:
        """Smallest extent of any body along a coordinate."""
        return float(min(np.ptp(body.patch.control_points, axis=0).min() for body in self.problem.bodies))

    @property
    def stiffest(self) -> float:
        """Largest Young's modulus."""
        return max(body.material.young for body in self.problem.bodies)

    def refuse(self, what: str, field: str) -> InputError:
        """The error that names what the program cannot express."""
        return InputError(f"{self._program} {what}", field)

    def _check_body(self, body: Body, laws: Collection[str]) -> None:
        place = f"bodies.{body.name}"
        if body.rigid:
            raise self.refuse("is not told of rigid bodies; take a deformable one with supports", f"{place}.rigid")
        if any(direction.family != "L" for direction in body.patch.directions):
            raise self.refuse('has no NURBS; take Lagrange elements: mesh.family = "L"', f"{place}.mesh.family")
        if np.ptp(body.patch.weights) != 0.0:
            raise self.refuse("has no rational functions: weights must be equal", f"{place}.patch.weights")
        nodes = np.sort(self.elements(body), axis=1)
        if np.any(nodes[:, 1:] == nodes[:, :-1]):
            raise self.refuse("takes no elements of which an edge is a point", f"{place}.patch.control_points")
        if body.material.law not in laws:
            raise self.refuse(f"has no law {body.material.law!r}; it has {', '.join(sorted(laws))}", f"{place}.material.law")

    def _check_contact(self, contact: Contact) -> None:
        place = f"contacts.{contact.name}"
        if not isinstance(contact.master, Face):
            raise self.refuse("is not told of rigid planes; take a body as the master", f"{place}.plane")
        for side, faces in (("slave", contact.slave), ("master", contact.master)):
            if len(faces.faces) > 1:
                raise self.refuse("is not told of sides of several faces", f"{place}.{side}")
        if contact.cohesion:
            raise self.refuse("has no friction with a cohesion", f"{place}.cohesion")
        if contact.traction_max is not None:
            raise self.refuse("is not told of a largest traction", f"{place}.traction_max")
        if contact.smoothing:
            raise self.refuse("is not told of smooth contact", f"{place}.smoothing")
        if contact.elastic_slip:
            raise self.refuse("is not told of elastic slip", f"{place}.elastic_slip")
