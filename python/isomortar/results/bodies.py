"""Picture of the deformed bodies and of the contact pressure on the slave face."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import Figure

from isomortar._frozen import frozen
from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model.entities import Body, Face, Problem, RigidPlane, unit
from isomortar.results import style
from isomortar.results.bezier import rational, sampling_matrix
from isomortar.results.face_field import CONTACT_FIELDS
from isomortar.results.fields import ContactSurface, body_points, contact_surfaces
from isomortar.results.rendering import Camera, Canvas
from isomortar.solve.record import StepResult

#: Colours of a face's small quadrilaterals (or one for all) and how strongly light falls on them, by name and parts of elements.
Paint = Callable[[str, tuple[int, int]], tuple[FloatArray, float]]

#: Small quadrilaterals along a face, and at least along one of its elements.
FINENESS = (72, 4)
_FINENESS_OF_CONTACT = (144, 8)
VIEW = Camera(azimuth=-62.0, elevation=24.0)


@frozen
class Pressed:
    """A sampled contact face: largest pressure, whether it pulls anywhere, mean outward normal where it presses."""

    peak: float
    pulls: bool
    normal: FloatArray


@frozen
class Scale:
    """What the pictures of several load steps have in common.

    Parameters
    ----------
    face : Pressed
        The largest pressure, and where the eye is that looks at the face.
    near : ndarray, shape (n, 3)
        Control points of the slave bodies: a plane is drawn as far as below all of them.
    whole : ndarray, shape (2, 2)
        Corners of the picture of all bodies.
    size : ndarray, shape (2,)
        Width and height of that of the slave, which goes along with it.
    """

    face: Pressed
    near: FloatArray
    whole: FloatArray
    size: FloatArray


def common_scale(problem: Problem, steps: Iterable[StepResult], number: int) -> Scale:
    """Of some load steps, for a contact pair."""
    faces: list[Pressed] = []
    bodies: list[FloatArray] = []
    slaves: list[FloatArray] = []
    for step in steps:
        surface = contact_surfaces(problem, step)[number]
        points = body_points(problem, step.state.positions)
        faces.append(_face(surface))
        bodies += points.values()
        slaves.append(np.concatenate([points[name] for name in _slaves(surface)]))
    hardest = max(faces, key=lambda face: face.peak)
    face = replace(hardest, pulls=any(face.pulls for face in faces))
    near = np.concatenate(slaves)
    floor = [_floor(surface.contact.master, near)] if isinstance(surface.contact.master, RigidPlane) else []
    towards = _camera_towards(face.normal)
    sizes = np.ptp([towards.corners(points) for points in slaves], axis=1)
    return Scale(face, near, VIEW.corners(np.concatenate([*bodies, *floor])), sizes.max(axis=0))


def draw_bodies(problem: Problem, step: StepResult, number: int, scale: Scale | None = None) -> Figure:
    """The deformed bodies, and beside them the slave body of a contact pair, its contact face coloured by pressure.

    Parameters
    ----------
    problem : Problem
    step : StepResult
    number : int
        Of the contact pair.
    scale : Scale, optional
        That of other load steps too (`common_scale`); default: of this one, as large as the picture allows.
    """
    surface = contact_surfaces(problem, step)[number]
    points = body_points(problem, step.state.positions)
    faces, slaves = surface.contact.slave.faces, _slaves(surface)
    face = scale.face if scale else _face(surface)
    colours = ScalarMappable(Normalize(0.0, face.peak), style.pressure_colours())
    figure = Figure(figsize=(8.6, 4.2), layout="constrained")
    whole, contact = figure.subplots(1, 2, width_ratios=(1.35, 1.0))
    canvas = Canvas(VIEW)
    glued = [face for joint in problem.glue for face in joint]
    for body in problem.bodies:
        colour = style.SLAVE if body.name in slaves else style.MASTER
        add_body(canvas, body, points[body.name], plain(colour), inside=_of_body([*glued, *faces], body))
    _add_contact(canvas, surface, colours)
    if isinstance(surface.contact.master, RigidPlane):
        near = scale.near if scale else np.concatenate([points[name] for name in slaves])
        canvas.add_floor(_floor(surface.contact.master, near), np.array(to_rgb(style.PLANE)))
    canvas.paint(whole, scale.whole if scale else None)
    canvas = Canvas(_camera_towards(face.normal))
    for name in slaves:
        add_body(canvas, problem.body(name), points[name], plain(style.SLAVE), inside=_of_body(faces, problem.body(name)))
    _add_contact(canvas, surface, colours)
    canvas.paint(contact, canvas.limits().mean(axis=0) + np.outer([-0.5, 0.5], scale.size) if scale else None)
    whole.set_title(f"{problem.name}, load step {step.step} ({step.stage})", loc="left")
    contact.set_title(f"{surface.contact.slave.body} from the master's side", loc="left")
    bar = figure.colorbar(colours, ax=contact, shrink=0.7, aspect=22, pad=0.02, extend="min" if face.pulls else "neither")
    bar.set_label(CONTACT_FIELDS["pressure"])
    return figure


def _slaves(surface: ContactSurface) -> list[str]:
    """Names of the bodies whose faces are the slave's side."""
    return sorted({face.body for face in surface.contact.slave.faces})


def _floor(plane: RigidPlane, near: FloatArray) -> FloatArray:
    """Corners of the part of a plane that is drawn below some points."""
    return plane_corners(plane, near, 0.2 * float(np.ptp(near, axis=0).max()))


def _face(surface: ContactSurface) -> Pressed:
    matrices = _samplings(surface.directions, face_parts(surface.directions, _FINENESS_OF_CONTACT))
    points, pressure, _ = surface.fields(matrices)
    shape = (len(matrices[1]), len(matrices[0]))
    grid, corner = points.reshape(*shape, 3), pressure.reshape(shape)[:-1, :-1]
    normals = np.cross(grid[1:, 1:] - grid[:-1, :-1], grid[1:, :-1] - grid[:-1, 1:])
    weight = np.maximum(corner, 0.0) if corner.max() > 0 else np.ones_like(corner)
    normal = surface.outward * np.tensordot(weight, normals, axes=2)
    peak = max(float(pressure.max()), 1e-300)
    return Pressed(peak, bool(pressure.min() < -style.NOTHING * peak), normal / np.linalg.norm(normal))


def towards(surface: ContactSurface) -> Camera:
    """A camera that looks onto a slave face from the master's side."""
    return _camera_towards(_face(surface).normal)


def _camera_towards(normal: FloatArray) -> Camera:
    """A camera that looks onto a face of that outward normal, a little from the side."""
    level = float(np.hypot(normal[0], normal[1]))
    elevation = float(np.degrees(np.arctan2(normal[2], level)))
    azimuth = float(np.degrees(np.arctan2(normal[1], normal[0])) - 25.0) % 360.0 if level > 0.5 else VIEW.azimuth
    return Camera(azimuth, 15.0 + 0.6 * elevation)


def plane_corners(plane: RigidPlane, points: FloatArray, margin: float) -> FloatArray:
    """Corners of the part of a rigid plane that lies under a body, and `margin` around it."""
    normal, first = unit(plane.normal), unit(plane.tangent)
    along = np.stack([first, np.cross(normal, first)])
    places = (points - plane.point) @ along.T
    low, high = places.min(axis=0), places.max(axis=0)
    low, high = low - margin, high + margin
    corners = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    return np.asarray(plane.point) + corners @ along


def face_parts(directions: tuple[Direction, Direction], fineness: tuple[int, int]) -> tuple[int, int]:
    """Equal parts of each element along both directions: about `fineness[0]` along a face, at least `fineness[1]` an element."""
    first, second = (max(round(fineness[0] / direction.elements), fineness[1]) for direction in directions)
    return first, second


def _samplings(directions: tuple[Direction, Direction], parts: tuple[int, int]) -> tuple[FloatArray, FloatArray]:
    first, second = (sampling_matrix(direction, count) for direction, count in zip(directions, parts, strict=True))
    return first, second


def add_body(
    canvas: Canvas,
    body: Body,
    points: FloatArray,
    paint: Paint,
    fine: Collection[str] = (),
    opacity: float = 1.0,
    inside: Collection[str] = (),
) -> None:
    """Add the faces of a deformed body with its knot lines.

    Parameters
    ----------
    canvas : Canvas
    body : Body
    points : ndarray, shape (n, 3)
        Positions of the patch's control points.
    paint : callable
        Colours and shading of a face, from its name and the equal parts that elements are cut into along its two directions.
    fine : collection of str
        Faces that are cut twice as finely.
    opacity : float
        Below 1 the body is seen through, and faces from their inner sides too.
    inside : collection of str
        Faces that are not drawn: what is glued to them hides them.
    """
    for name in body.outer:
        if name in inside:
            continue
        numbers = body.patch.face_points(name)
        directions = body.patch.face_directions(name)
        parts = face_parts(directions, _FINENESS_OF_CONTACT if name in fine else FINENESS)
        matrices = _samplings(directions, parts)
        places = rational(matrices, body.patch.weights[numbers], points[numbers])[0]
        outward = 0 if opacity < 1 else 1 if name[1] == "1" else -1
        _add_face(canvas, matrices, parts, places, paint(name, parts), outward, opacity)


def _add_face(
    canvas: Canvas,
    matrices: tuple[FloatArray, FloatArray],
    parts: tuple[int, int],
    places: FloatArray,
    painted: tuple[FloatArray, float],
    outward: int,
    opacity: float = 1.0,
) -> None:
    """Add a face, sampled at `places`, with its knot lines, in colours and with shading as of a `Paint`."""
    shape = (len(matrices[1]), len(matrices[0]))
    lines = (np.arange(0, shape[1], parts[0]), np.arange(0, shape[0], parts[1]))
    cells = np.broadcast_to(painted[0], (shape[0] - 1, shape[1] - 1, 3))
    canvas.add_surface(places.reshape(*shape, 3), cells, outward, lines, painted[1], opacity)


def _of_body(faces: Sequence[Face], body: Body) -> list[str]:
    """Those of some faces that are of a body."""
    return [face.face for face in faces if face.body == body.name]


def plain(colour: str, shading: float = 1.0) -> Paint:
    """All faces in one colour."""
    rgb = np.array(to_rgb(colour))
    return lambda _name, _parts: (rgb, shading)


def _add_contact(canvas: Canvas, surface: ContactSurface, colours: ScalarMappable) -> None:
    """Add the contact face, by its pressure; no light falls on it, so that its colours are those of the colour bar."""
    parts = face_parts(surface.directions, _FINENESS_OF_CONTACT)
    matrices = _samplings(surface.directions, parts)
    places, pressure, _ = surface.fields(matrices)
    grid = pressure.reshape(len(matrices[1]), len(matrices[0]))
    middle = 0.25 * (grid[1:, 1:] + grid[1:, :-1] + grid[:-1, 1:] + grid[:-1, :-1])
    cells = colours.to_rgba(np.ma.masked_where(np.abs(middle) <= style.UNSEEN * np.abs(middle).max(), middle))
    _add_face(canvas, matrices, parts, places, (cells[..., :3], 0.0), surface.outward)
