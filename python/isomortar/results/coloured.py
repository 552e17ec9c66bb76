"""Picture of the deformed bodies in colours by one of their fields."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from isomortar._frozen import frozen
from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model.entities import Body, Problem
from isomortar.results import style
from isomortar.results.bezier import functions_at, inner_places, rational_gradient
from isomortar.results.bodies import VIEW, add_body, plain
from isomortar.results.fields import body_points
from isomortar.results.ranges import Dimension, narrowest
from isomortar.results.rendering import Canvas
from isomortar.results.stress import cauchy_stress, deformation_gradient, von_mises
from isomortar.solve.record import StepResult

#: Values of a field on a grid of parameters of a body whose control points are at some places.
BodyValues = Callable[[Body, FloatArray, Sequence[FloatArray]], FloatArray]

#: Share of its body that a face's field is taken below it: faces that are one point or line, as in the middle of a ball, have none.
_BELOW = 1e-6


def stress(body: Body, points: FloatArray, parameters: Sequence[FloatArray]) -> FloatArray:
    """The equivalent stress of von Mises, per deformed area."""
    return von_mises(cauchy_stress(body.material, deformation_gradient(body, points, parameters)))


def jacobian(body: Body, points: FloatArray, parameters: Sequence[FloatArray]) -> FloatArray:
    """J = det F."""
    return np.linalg.det(deformation_gradient(body, points, parameters))


def displacement(body: Body, points: FloatArray, parameters: Sequence[FloatArray]) -> FloatArray:
    """The size of the displacement."""
    functions = [functions_at(d, x) for d, x in zip(body.patch.directions, parameters, strict=True)]
    moved, _ = rational_gradient(functions, body.patch.weights, points - body.patch.control_points)
    return np.linalg.norm(moved, axis=1)


@frozen
class BodyField:
    """A field of bodies: how a colour bar names it, what it measures, its values, and whether colours begin at zero."""

    label: str
    dimension: Dimension
    values: BodyValues
    from_zero: bool = True


#: Fields of bodies by name.
BODY_FIELDS = {
    "stress": BodyField("von Mises stress (force / deformed area)", Dimension.STRESS, stress),
    "J": BodyField("J (volume / volume at rest)", Dimension.RATIO, jacobian, from_zero=False),
    "displacement": BodyField("displacement (length)", Dimension.LENGTH, displacement),
}


def draw_coloured(problem: Problem, step: StepResult, name: str = "stress") -> Figure:
    """The deformed bodies in colours by one of `BODY_FIELDS`, over the range that it has inside; rigid ones are plain."""
    shown, points = BODY_FIELDS[name], body_points(problem, step.state.positions)
    inside = np.concatenate(
        [
            shown.values(body, points[body.name], [inner_places(direction) for direction in body.patch.directions])
            for body in problem.bodies
            if not body.rigid
        ]
    )
    lowest = 0.0 if shown.from_zero else float(inside.min())
    colours = ScalarMappable(
        Normalize(lowest, max(float(inside.max()), lowest + narrowest(problem, shown.dimension))), style.field_colours()
    )
    figure = Figure(figsize=(5.6, 4.2), layout="constrained")
    axes, canvas = figure.subplots(), Canvas(VIEW)
    glued = [face for joint in problem.glue for face in joint]
    for body in problem.bodies:
        paint = plain(style.MASTER) if body.rigid else partial(_painted, body, points[body.name], shown.values, colours)
        add_body(canvas, body, points[body.name], paint, inside=[face.face for face in glued if face.body == body.name])
    canvas.paint(axes)
    axes.set_title(f"{problem.name}, load step {step.step} ({step.stage})", loc="left")
    bar = figure.colorbar(colours, ax=axes, shrink=0.7, aspect=22, pad=0.02, extend="max" if shown.from_zero else "both")
    bar.set_label(shown.label)
    return figure


def _painted(
    body: Body, points: FloatArray, values: BodyValues, colours: ScalarMappable, name: str, parts: tuple[int, int]
) -> tuple[FloatArray, float]:
    """Colours of the parts of a face by the field in their middle; no light falls on it, so that they are those of the colour bar."""
    axis = "uvw".index(name[0])
    begin, end = body.patch.directions[axis].boundaries[[0, -1]]
    parameters = [np.array([begin + abs(int(name[1]) - _BELOW) * (end - begin)])] * 3
    first, second = (axis + 1) % 3, (axis + 2) % 3  # as `Patch.face_directions` has them
    for along, count in zip((first, second), parts, strict=True):
        parameters[along] = _middles(body.patch.directions[along], count)
    found = values(body, points, parameters).reshape([len(of_axis) for of_axis in parameters], order="F")
    return colours.to_rgba(found.transpose(second, first, axis)[..., 0])[..., :3], 0.0


def _middles(direction: Direction, parts: int) -> FloatArray:
    """Middles of equal parts of each element."""
    begin, size = direction.boundaries[:-1, None], np.diff(direction.boundaries)[:, None]
    return (begin + (np.arange(parts) + 0.5) / parts * size).ravel()
