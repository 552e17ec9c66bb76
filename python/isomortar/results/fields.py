"""Fields of a load step: positions of each body's control points, and contact quantities on the slave faces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import Direction, FloatArray, IntArray
from isomortar.model.enforcement import METHODS, SlaveFace
from isomortar.model.entities import Contact, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.sheet import Sheet
from isomortar.model.supports import BoolArray
from isomortar.results.bezier import functions_at, rational, rational_gradient
from isomortar.results.footing import Footing
from isomortar.solve.record import ContactResult, ContactState, StepResult


@frozen
class ContactSurface:
    """A slave face with its contact quantities, everything by control point of the face (shape (n,), points (n, 3)).

    The fields are p = sum R^I p^I, for the magnitude of the traction sum R^I |tau^I|, and by `field` any other. `covariant`: control
    tractions tau_alpha^I in the master's coordinates, shape (n, 2); `gap`: control gaps g^I, positive is penetration. `letters`: names of
    the surface coordinates among u, v, w, in the first of several bodies; `outward`: sign of the product of the tangents that points out
    of them; `footing`: where the master is opposite, and fields act.
    """

    contact: Contact
    letters: tuple[str, str]
    directions: tuple[Direction, Direction]
    outward: int
    weights: FloatArray
    reference_points: FloatArray
    points: FloatArray
    pressure: FloatArray
    traction: FloatArray
    covariant: FloatArray
    gap: FloatArray
    status: IntArray
    footing: Footing

    @property
    def lengths(self) -> tuple[float, float]:
        """Mean lengths of the control net along both surface coordinates, in the reference configuration."""
        first, second = self.directions
        net = self.reference_points.reshape(second.count, first.count, 3)
        along = [np.linalg.norm(np.diff(net, axis=axis), axis=-1).sum(axis=axis).mean() for axis in (1, 0)]
        return float(along[0]), float(along[1])

    def fields(self, matrices: tuple[FloatArray, FloatArray]) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Points, shape (m, 3), pressure and traction magnitude, shape (m,), by matrices of `isomortar.results.bezier`.

        Beside the master both are zero (theory 8.7).
        """
        fields = [self.pressure[:, None], self.traction[:, None]]
        points, places, *values = np.split(
            self.field(matrices, np.hstack([self.points, self.reference_points, *fields])), [3, 6, 7], axis=1
        )
        pressure, traction = (self.footing.acting(places, at, control) for at, control in zip(values, fields, strict=True))
        return points, pressure[:, 0], traction[:, 0]

    def field(self, matrices: tuple[FloatArray, FloatArray], control_values: FloatArray) -> FloatArray:
        """The field of control values of shape (n, k), shape (m, k)."""
        return rational(matrices, self.weights, control_values)[0]

    def on_grid(self, parameters: Sequence[FloatArray], control_values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The field of control values of shape (n, k) on a grid of n1 parameters times n2, and its derivatives by them.

        Returns
        -------
        field : ndarray, shape (n2, n1, k)
        gradient : ndarray, shape (n2, n1, k, 2)
        """
        functions = [functions_at(d, x) for d, x in zip(self.directions, parameters, strict=True)]
        field, gradient = rational_gradient(functions, self.weights, control_values)
        shape = (len(parameters[1]), len(parameters[0]), control_values.shape[1])
        return field.reshape(shape), gradient.reshape(*shape, 2)

    def over_master(self, parameters: Sequence[FloatArray]) -> BoolArray:
        """Whether the master is opposite, on a grid of n1 parameters times n2, shape (n2, n1)."""
        return self.footing.at(self.on_grid(parameters, self.reference_points)[0])


def body_points(problem: Problem, positions: FloatArray) -> dict[str, FloatArray]:
    """Positions of the control points of each body's patch, from all control points as in `State`."""
    numbering = Numbering(problem)
    return {body.name: numbering.of_patch(body.name, positions) for body in problem.bodies}


def contact_surfaces(problem: Problem, result: StepResult) -> list[ContactSurface]:
    """The slave face of every contact pair at the end of a load step."""
    numbering = Numbering(problem)
    surfaces = []
    for contact, state, measured in zip(problem.contacts, result.state.contacts, result.contacts, strict=True):
        sheet = Sheet.of(problem, contact.slave)
        face = sheet.patch.face_points(sheet.face)
        points = sheet.points(numbering)[face]
        slave = SlaveFace(contact, problem, numbering)
        side = METHODS[contact.enforcement](slave)
        by_control = {name: side.on_control_points(values)[slave.within] for name, values in _quantities(state, measured).items()}
        surfaces.append(
            ContactSurface(
                contact=contact,
                letters=sheet.letters,
                directions=sheet.directions,
                outward=sheet.outward,
                weights=sheet.patch.weights[face],
                reference_points=sheet.patch.control_points[face],
                points=result.state.positions[points],
                status=measured.status[side.nearest][slave.within],
                footing=Footing.of(side.arrays, slave.within, numbering.reference, _has_foot(contact, state)),
                **by_control,
            )
        )
    return surfaces


def _has_foot(contact: Contact, state: ContactState) -> BoolArray:
    """Which slave quadrature points have a foot; where each has a constraint of its own, that without one has no pressure anyway."""
    return (state.projected > 0) | (not contact.of_averages)


def _quantities(state: ContactState, measured: ContactResult) -> dict[str, FloatArray]:
    """Fields of a surface, by constraint."""
    return {"pressure": state.pressure, "traction": measured.traction_norm, "covariant": state.traction, "gap": measured.gap}
