"""Contact zones from near by, through transparent bodies (Fig. 11)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.colors import to_rgb
from paper.figures.picture import Panel, Picture, rendering
from paper.figures.sheet import Mark, Sheet

from isomortar.errors import InputError
from isomortar.geometry.patch import FACES, FloatArray
from isomortar.model.entities import RigidPlane
from isomortar.results import style
from isomortar.results.bezier import functions_at, rational
from isomortar.results.bodies import add_body, plain, plane_corners
from isomortar.results.fields import ContactSurface, body_points, contact_surfaces
from isomortar.results.rendering import Camera, Canvas

_VIEW = Camera(azimuth=-84.0, elevation=7.0)
_OPACITY, _SHADING = 0.3, 0.5
_CONTROL, _KNOT = style.VERMILION, style.BLACK
#: Margin of the floor over the width of the contact: beyond the horizon of the picture.
_FLOOR = 20.0
#: Of a sphere, over the width of the picture.
_RADIUS = 0.009


def draw(panels: Sequence[Panel]) -> Picture:
    """The contact zone of each panel; control points of the slave face as spheres, its knots as small black ones.

    Raises
    ------
    InputError
        Nothing is in contact in a panel.
    """
    canvases, limits = zip(*(_canvas(panel) for panel in panels), strict=True)
    size = np.max([np.ptp(limit, axis=0) for limit in limits], axis=0)
    marks = (Mark("control points of the slave face", "o", _CONTROL), Mark("its knots", ".", _KNOT))
    with style.style():
        sheet = Sheet([panel.title for panel in panels], float(size[0] / size[1]), False, marks)
        for axes, canvas, limit in zip(sheet.panels, canvases, limits, strict=True):
            middle = limit.mean(axis=0)
            canvas.paint(axes, np.array([middle - 0.5 * size, middle + 0.5 * size]))
    return rendering(sheet.figure, f"contact zone: {', '.join(panel.title for panel in panels)}")


def _canvas(panel: Panel) -> tuple[Canvas, FloatArray]:
    """The bodies, and lower left and upper right corner of the contact zone in the picture."""
    problem, record = panel.results.problem, panel.results.step(panel.step)
    surface = contact_surfaces(problem, record)[0]
    active = surface.points[surface.status > 0]
    if not len(active):
        raise InputError(f"nothing is in contact at load step {panel.step}", panel.title)
    seen = _VIEW.places(active)
    width = float(np.ptp(seen[:, 0]))
    limits = np.array([seen.min(axis=0) - width * np.array([0.2, 0.05]), seen.max(axis=0) + width * np.array([0.2, 0.4])])
    canvas = Canvas(_VIEW)
    points = body_points(problem, record.state.positions)
    slave = surface.contact.slave.body
    for contact in problem.contacts:
        if isinstance(contact.master, RigidPlane):
            canvas.add_floor(plane_corners(contact.master, points[slave], _FLOOR * width), np.array(to_rgb(style.PLANE)))
    for body in problem.bodies:
        paint = plain(style.MASTER if body.name == slave else style.SLAVE, _SHADING)
        add_body(canvas, body, points[body.name], paint, FACES, _OPACITY)
    canvas.add_spheres(surface.points, _RADIUS * width, np.array(to_rgb(_CONTROL)))
    canvas.add_spheres(_knots(surface), 0.6 * _RADIUS * width, np.array(to_rgb(_KNOT)))
    return canvas, limits


def _knots(surface: ContactSurface) -> FloatArray:
    """Places of the element corners of the slave face."""
    matrices = [functions_at(d, d.boundaries)[0] for d in surface.directions]
    return rational(matrices, surface.weights, surface.points)[0]
