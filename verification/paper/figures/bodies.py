"""Deformed bodies at chosen load steps, with knot lines, coloured by stress or stretch (Figs. 1, 4, 7, 10)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgb
from paper.figures.picture import Picture, rendering
from paper.figures.sheet import Sheet

from isomortar.errors import InputError
from isomortar.geometry.patch import FACES, FloatArray
from isomortar.model.entities import Body, Contact, Problem, RigidPlane
from isomortar.results import style
from isomortar.results.bodies import FINENESS, Paint, add_body, face_parts, plain, plane_corners
from isomortar.results.fields import body_points
from isomortar.results.reader import Results
from isomortar.results.rendering import Camera, Canvas
from isomortar.results.stress import deformation_gradient, first_piola_stress
from isomortar.solve.record import StepResult

Field = Literal["stress", "stretch"]

_LABELS: dict[Field, str] = {"stress": "stress $\\Vert\\mathbf{P}\\Vert$\n(force / reference area)", "stretch": "stretch $F_{33}$"}
_VIEW, _VIEW_OF_A_RING = Camera(azimuth=-62.0, elevation=24.0), Camera(azimuth=-76.0, elevation=14.0)
#: Light falls weakly on coloured faces, so that their colours are those of the colour bar.
_SHADING = 0.4
#: Share of the small quadrilaterals whose values the colour bar spans: single corners do not stretch it.
_SHOWN = 98.0

#: Field at the middle of each small quadrilateral of a face, by body and face.
_Values = dict[tuple[str, str], FloatArray]


def draw(results: Results, steps: Sequence[int], field: Field | None) -> Picture:
    """The bodies at the end of each of `steps`, from one place of view and in one scale of colours.

    Parameters
    ----------
    results : Results
    steps : sequence of int
    field : {"stress", "stretch"} or None
        Norm of the first Piola-Kirchhoff stress, or F33; None: bodies in their colours.

    Raises
    ------
    InputError
        No step is given.
    """
    if not steps:
        raise InputError("is empty: at least one load step is drawn", "steps")
    problem = results.problem
    records = [results.step(number) for number in steps]
    values = [_values(problem, record, field) for record in records]
    colours = _colours(values, field) if field else None
    canvases = [_canvas(problem, record, value, colours, records) for record, value in zip(records, values, strict=True)]
    limits = np.stack([canvas.limits() for canvas in canvases])
    limits = np.array([limits[:, 0].min(axis=0), limits[:, 1].max(axis=0)])
    across, up = np.ptp(limits, axis=0)
    with style.style():
        titles = [f"load step {record.step} ({record.stage})" for record in records]
        sheet = Sheet(titles, float(across / up), colours is not None)
        for axes, canvas in zip(sheet.panels, canvases, strict=True):
            canvas.paint(axes, limits)
        if colours and field:
            sheet.add_bar(colours, _LABELS[field], _all(values))
    return rendering(sheet.figure, f"{problem.name}: deformed bodies at load steps {', '.join(map(str, steps))}")


def _values(problem: Problem, record: StepResult, field: Field | None) -> _Values:
    if field is None:
        return {}
    points = body_points(problem, record.state.positions)
    return {
        (b.name, face): _face_values(b, points[b.name], face, field)
        for b in problem.bodies
        for face in FACES
        if face[0] not in (b.closed or "")
    }


def _face_values(body: Body, points: FloatArray, face: str, field: Field) -> FloatArray:
    """Values by rows and columns of the face's small quadrilaterals."""
    axis = "uvw".index(face[0])
    along = ((axis + 1) % 3, (axis + 2) % 3)
    directions = body.patch.directions
    parameters = [d.boundaries[[0 if face[1] == "0" else -1]] for d in directions]
    for number, count in zip(along, face_parts(body.patch.face_directions(face), FINENESS), strict=True):
        places = directions[number].subdivided(count)
        parameters[number] = 0.5 * (places[:-1] + places[1:])
    f = deformation_gradient(body, points, parameters)
    values = f[:, 2, 2] if field == "stretch" else np.linalg.norm(first_piola_stress(body.material, f), axis=(1, 2))
    grid = values.reshape([len(p) for p in parameters], order="F")
    return np.take(grid, 0, axis=axis).T if along[0] < along[1] else np.take(grid, 0, axis=axis)


def _all(values: Sequence[_Values]) -> FloatArray:
    return np.concatenate([cells.ravel() for step in values for cells in step.values()])


def _colours(values: Sequence[_Values], field: Field) -> ScalarMappable:
    everything = _all(values)
    low, high = np.percentile(everything, (100 - _SHOWN, _SHOWN))
    if field == "stress":
        return ScalarMappable(Normalize(0.0, float(high)), style.field_colours())
    return ScalarMappable(Normalize(float(low), float(high)), style.field_colours().reversed())


def _canvas(problem: Problem, record: StepResult, values: _Values, colours: ScalarMappable | None, records: Sequence[StepResult]) -> Canvas:
    points = body_points(problem, record.state.positions)
    canvas = Canvas(_VIEW_OF_A_RING if any(body.closed for body in problem.bodies) else _VIEW)
    slaves = {contact.slave.body for contact in problem.contacts}
    for contact in problem.contacts:
        if isinstance(contact.master, RigidPlane):
            canvas.add_floor(_floor(problem, contact, contact.master, records), np.array(to_rgb(style.PLANE)))
    for body in problem.bodies:
        unpainted = plain(style.SLAVE if body.name in slaves else style.MASTER)
        add_body(canvas, body, points[body.name], _by_field(body.name, values, colours) if colours else unpainted)
    return canvas


def _floor(problem: Problem, contact: Contact, plane: RigidPlane, records: Sequence[StepResult]) -> FloatArray:
    """The same floor under the slave body at all load steps."""
    everywhere = [body_points(problem, record.state.positions)[contact.slave.body] for record in records]
    return plane_corners(plane, np.concatenate(everywhere), 0.15 * float(np.ptp(everywhere[0], axis=0).max()))


def _by_field(body: str, values: _Values, colours: ScalarMappable) -> Paint:
    return lambda face, _parts: (colours.to_rgba(values[body, face])[..., :3], _SHADING)
