"""Picture of the deformed bodies and of the contact pressure on the slave face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import Figure

from isomortar.geometry.patch import FACES, Direction, FloatArray
from isomortar.model.entities import Body, Problem, RigidPlane, unit
from isomortar.results import style
from isomortar.results.bezier import rational, sampling_matrix
from isomortar.results.fields import ContactSurface, body_points, contact_surfaces
from isomortar.results.rendering import Camera, Canvas
from isomortar.solve.record import StepResult

#: Small quadrilaterals along a face, and at least along one of its elements.
_FINENESS = (72, 4)
_FINENESS_OF_CONTACT = (144, 8)
_VIEW = Camera(azimuth=-62.0, elevation=24.0)
#: Light falls weakly on the contact face, so that its colours are those of the colour bar.
_SHADING_OF_PRESSURE = 0.25


def draw_bodies(problem: Problem, step: StepResult, number: int) -> Figure:
    """The deformed bodies, and beside them the slave body of a contact pair, its contact face coloured by pressure.

    Parameters
    ----------
    problem : Problem
    step : StepResult
    number : int
        Of the contact pair.
    """
    surface = contact_surfaces(problem, step)[number]
    points = body_points(problem, step.state.positions)
    slave = problem.body(surface.contact.slave.body)
    face = _face(surface)
    colours = ScalarMappable(Normalize(0.0, face.peak), style.pressure_colours())
    figure = Figure(figsize=(8.6, 4.2), layout="constrained")
    whole, contact = figure.subplots(1, 2, width_ratios=(1.35, 1.0))
    canvas = Canvas(_VIEW)
    for body in problem.bodies:
        _add_body(canvas, body, points[body.name], surface, colours)
    if isinstance(surface.contact.master, RigidPlane):
        canvas.add_floor(_plane_corners(surface.contact.master, points[slave.name]), np.array(to_rgb(style.PLANE)))
    canvas.paint(whole)
    canvas = Canvas(_camera_towards(face.normal))
    _add_body(canvas, slave, points[slave.name], surface, colours)
    canvas.paint(contact)
    whole.set_title(f"{problem.name}, load step {step.step} ({step.stage})", loc="left")
    contact.set_title(f"{slave.name} from the master's side", loc="left")
    bar = figure.colorbar(colours, ax=contact, shrink=0.7, aspect=22, pad=0.02, extend="min" if face.pulls else "neither")
    bar.set_label("contact pressure (force / area)")
    return figure


@dataclass(frozen=True)
class _Face:
    """A sampled contact face: largest pressure, whether it pulls anywhere, mean outward normal where it presses."""

    peak: float
    pulls: bool
    normal: FloatArray


def _face(surface: ContactSurface) -> _Face:
    matrices = _samplings(surface.directions, _FINENESS_OF_CONTACT)
    points, pressure, _ = surface.fields(matrices)
    shape = (len(matrices[1]), len(matrices[0]))
    grid, corner = points.reshape(*shape, 3), pressure.reshape(shape)[:-1, :-1]
    normals = np.cross(grid[1:, 1:] - grid[:-1, :-1], grid[1:, :-1] - grid[:-1, 1:])
    weight = np.maximum(corner, 0.0) if corner.max() > 0 else np.ones_like(corner)
    normal = (1 if surface.contact.slave.face[1] == "1" else -1) * np.tensordot(weight, normals, axes=2)
    peak = max(float(pressure.max()), 1e-300)
    return _Face(peak, bool(pressure.min() < -1e-9 * peak), normal / np.linalg.norm(normal))


def _camera_towards(normal: FloatArray) -> Camera:
    """A camera that looks onto a face of that outward normal, a little from the side."""
    level = float(np.hypot(normal[0], normal[1]))
    elevation = float(np.degrees(np.arctan2(normal[2], level)))
    azimuth = float(np.degrees(np.arctan2(normal[1], normal[0]))) - 25.0 if level > 0.5 else _VIEW.azimuth
    return Camera(azimuth, 15.0 + 0.6 * elevation)


def _plane_corners(plane: RigidPlane, points: FloatArray) -> FloatArray:
    """Corners of the part of a rigid plane that lies under a body, and somewhat around it."""
    normal, first = unit(plane.normal), unit(plane.tangent)
    along = np.stack([first, np.cross(normal, first)])
    places = (points - plane.point) @ along.T
    low, high = places.min(axis=0), places.max(axis=0)
    low, high = low - 0.2 * (high - low).max(), high + 0.2 * (high - low).max()
    corners = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    return np.asarray(plane.point) + corners @ along


def _parts(direction: Direction, fineness: tuple[int, int]) -> int:
    return max(round(fineness[0] / direction.elements), fineness[1])


def _samplings(directions: tuple[Direction, Direction], fineness: tuple[int, int]) -> tuple[FloatArray, FloatArray]:
    first, second = (sampling_matrix(direction, _parts(direction, fineness)) for direction in directions)
    return first, second


def _add_body(canvas: Canvas, body: Body, points: FloatArray, surface: ContactSurface, colours: ScalarMappable) -> None:
    is_slave = body.name == surface.contact.slave.body
    plain = np.array(to_rgb(style.SLAVE if is_slave else style.MASTER))
    for name in FACES:
        if name[0] == body.closed:
            continue  # the two ends of a ring are inside it
        numbers = body.patch.face_points(name)
        first, second = body.patch.face_directions(name)
        touching = is_slave and name == surface.contact.slave.face
        fineness = _FINENESS_OF_CONTACT if touching else _FINENESS
        matrices = _samplings((first, second), fineness)
        shape = (len(matrices[1]), len(matrices[0]))
        grid = rational(matrices, body.patch.weights[numbers], points[numbers])[0].reshape(*shape, 3)
        if touching:
            pressure = surface.fields(matrices)[1].reshape(shape)
            middle = 0.25 * (pressure[1:, 1:] + pressure[1:, :-1] + pressure[:-1, 1:] + pressure[:-1, :-1])
            cells = colours.to_rgba(np.where(np.abs(middle) < 1e-9 * np.abs(middle).max(), 0.0, middle))[..., :3]
            shading = _SHADING_OF_PRESSURE
        else:
            cells, shading = np.broadcast_to(plain, (shape[0] - 1, shape[1] - 1, 3)), 1.0
        lines = (np.arange(0, shape[1], _parts(first, fineness)), np.arange(0, shape[0], _parts(second, fineness)))
        canvas.add_surface(grid, cells, 1 if name[1] == "1" else -1, lines, shading)
