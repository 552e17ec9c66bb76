"""Picture of the deformed bodies of a scene without contact, by the equivalent stress."""

from __future__ import annotations

from functools import partial

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model.entities import Body, Problem
from isomortar.results import style
from isomortar.results.bezier import inner_places
from isomortar.results.bodies import VIEW, add_body, plain
from isomortar.results.fields import body_points
from isomortar.results.rendering import Canvas
from isomortar.results.stress import cauchy_stress, deformation_gradient, von_mises
from isomortar.solve.record import StepResult

#: Light falls weakly on coloured faces, so that their colours are those of the colour bar.
_SHADING = 0.25
#: Share of its body that a face's stress is taken below it: faces that are one point or line, as in the middle of a ball, have none.
_BELOW = 1e-6


def draw_alone(problem: Problem, step: StepResult) -> Figure:
    """The deformed bodies in colours by the equivalent stress of von Mises, up to the largest one inside."""
    points = body_points(problem, step.state.positions)
    elastic = [body for body in problem.bodies if not body.rigid]
    inside = [_stress(body, points[body.name], [inner_places(d) for d in body.patch.directions]).max() for body in elastic]
    colours = ScalarMappable(Normalize(0.0, max(*inside, 1e-300)), style.field_colours())
    figure = Figure(figsize=(5.6, 4.2), layout="constrained")
    axes, canvas = figure.subplots(), Canvas(VIEW)
    glued = [face for joint in problem.glue for face in joint]
    for body in problem.bodies:
        paint = plain(style.MASTER) if body.rigid else partial(_painted, body, points[body.name], colours)
        add_body(canvas, body, points[body.name], paint, inside=[face.face for face in glued if face.body == body.name])
    canvas.paint(axes)
    axes.set_title(f"{problem.name}, load step {step.step} ({step.stage})", loc="left")
    bar = figure.colorbar(colours, ax=axes, shrink=0.7, aspect=22, pad=0.02, extend="max")
    bar.set_label("von Mises stress (force / area)")
    return figure


def _stress(body: Body, points: FloatArray, parameters: list[FloatArray]) -> FloatArray:
    return von_mises(cauchy_stress(body.material, deformation_gradient(body, points, parameters)))


def _painted(body: Body, points: FloatArray, colours: ScalarMappable, name: str, parts: tuple[int, int]) -> tuple[FloatArray, float]:
    """Colours of the parts of a face by the stress in their middle."""
    axis = "uvw".index(name[0])
    begin, end = body.patch.directions[axis].boundaries[[0, -1]]
    parameters = [np.array([begin + abs(int(name[1]) - _BELOW) * (end - begin)])] * 3
    first, second = (axis + 1) % 3, (axis + 2) % 3  # as `Patch.face_directions` has them
    for along, count in zip((first, second), parts, strict=True):
        parameters[along] = _middles(body.patch.directions[along], count)
    stress = _stress(body, points, parameters).reshape([len(of_axis) for of_axis in parameters], order="F")
    return colours.to_rgba(stress.transpose(second, first, axis)[..., 0])[..., :3], _SHADING


def _middles(direction: Direction, parts: int) -> FloatArray:
    """Middles of equal parts of each element."""
    begin, size = direction.boundaries[:-1, None], np.diff(direction.boundaries)[:, None]
    return (begin + (np.arange(parts) + 0.5) / parts * size).ravel()
