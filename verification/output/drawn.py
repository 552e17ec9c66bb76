"""What is drawn: lines of curves, maps of slave faces, and the nets of a page to look at, against the load steps and SciPy's functions."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from matplotlib.collections import LineCollection, QuadMesh
from matplotlib.figure import Figure
from matplotlib.quiver import Quiver
from output import exported, records
from rational_functions import nodes_of, shares

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Problem
from isomortar.model.numbering import Numbering
from isomortar.results.abscissa import abscissa
from isomortar.results.curves import draw_curve, draw_reactions, moving_supports
from isomortar.results.face_field import face_field
from isomortar.results.maps import draw_map
from isomortar.results.paraview import states
from isomortar.results.reader import Results
from isomortar.results.vectors import contact_vectors
from isomortar.results.view import of_bodies
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

_ROUND_OFF = "round-off: sums of products of polynomials of orders up to four"


@dataclass(frozen=True)
class Curve:
    """A curve that is asked for."""

    name: str
    support: str
    quantity: str
    component: str


def lines(figure: Figure) -> list[FloatArray]:
    """Lines of a figure through more than two places, shape (places, 2) each."""
    return [np.asarray(line.get_xydata()) for axes in figure.axes for line in axes.lines if len(np.asarray(line.get_xydata())) > 2]


def component(values: FloatArray, name: str) -> FloatArray:
    """A component, or the norm, of vectors over load steps, with the rest before them."""
    return np.append(0.0, np.linalg.norm(values, axis=1) if name == "norm" else values[:, ["x", "y", "z"].index(name)])


def abscissae(steps: list[StepResult], support: int, name: str) -> dict[str, FloatArray]:
    """What curves can be drawn over, by its words."""
    way = np.array([step.reactions[support].displacement for step in steps])
    return {
        "time": np.append(0.0, [step.time for step in steps]),
        f"displacement of {name}": component(way, "norm"),
        **{f"displacement {letter} of {name}": component(way, letter) for letter in "xyz"},
        f"rotation of {name}": np.append(0.0, [step.reactions[support].rotation for step in steps]),
    }


@case(
    claim="Curves are those of the load steps, from rest on, over whatever they are drawn; a scene draws all of its supports that move.",
    tier="gate",
    bounds={
        "reactions": Bound(at_most=0.0, reason="definition: the numbers of the load steps"),
        "curves": Bound(at_most=0.0, reason="definition: the numbers of the load steps; their norms"),
        "lines": Bound(96.0, 96.0, "definition: of two supports 6 lines of reactions over each of 6 abscissae, and 12 curves"),
        "names": Bound(
            at_most=0.0, reason="definition: supports, curves and stages that are shown, or are not, and should not be, or should"
        ),
    },
)
def curves() -> dict[str, float]:
    """Largest differences of lines, how many there are, and wrong names; of a support that moves and one that a force moves."""
    scene = Scene.from_toml(records.SCENE)
    problem = scene.problem()
    steps = records.load_steps(problem)
    worst, count, turned = {"reactions": 0.0, "curves": 0.0}, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.h5"
        records.recorded(path, problem, steps, "last")
        with Results(path) as results:
            names = [support.name for support in moving_supports(results)]
            for name in ("ground", "push"):
                number = [support.name for support in problem.supports].index(name)
                told = {kind: np.array([getattr(s.reactions[number], kind) for s in steps]) for kind in ("force", "moment", "displacement")}
                over = abscissae(steps, number, name)
                for words, values in over.items():
                    turned += abscissa(results, words).one_way != (sorted(values) in (list(values), list(values[::-1])))
                drawn = [line for words in over for line in lines(draw_reactions(results, name, abscissa(results, words)))]
                expected = [
                    np.column_stack([v, component(told[kind], k)]) for v in over.values() for kind in ("force", "moment") for k in "xyz"
                ]
                worst["reactions"] = np.maximum(worst["reactions"], _apart(drawn, expected))
                wanted = [Curve("curve", name, kind, k) for kind in told for k in ("x", "y", "z", "norm")]
                single = [line for curve in wanted for line in lines(draw_curve(results, curve))]
                expected = [np.column_stack([over["time"], component(told[c.quantity], c.component)]) for c in wanted]
                worst["curves"] = np.maximum(worst["curves"], _apart(single, expected))
                count += len(drawn) + len(single)
    own = {(curve.support, curve.quantity, curve.component) for curve in scene.curves()}
    wrong = own ^ {
        (name, kind, k) for name in ("ground", "push") for kind in told for k in "xyz" if (name, kind) != ("ground", "displacement")
    }
    return {
        **{k: float(v) for k, v in worst.items()},
        "lines": float(count),
        "names": float(len(wrong) + turned + (names != ["ground", "push"])),
    }


def _apart(drawn: list[FloatArray], expected: list[FloatArray]) -> float:
    return float(np.max([np.abs(one - other).max() for one, other in zip(drawn, expected, strict=True)]))


def centres(direction: Direction) -> FloatArray:
    """Where functions of a direction belong: means of their inner knots; nodes of Lagrange elements."""
    p = direction.order
    if direction.family == "N":
        return np.array([direction.knots[i + 1 : i + 1 + p].mean() for i in range(direction.count)])
    return nodes_of(direction)


#: Besides the flat slave faces one that is round: it is laid flat by distances.
_MAPPED = exported.SCENE.replace(
    "friction = 0 }",
    'friction = 0.4 }\nround = { slave = "wheel.v1", plane = { point = [0, 4, -1], normal = [0, 0, 1] }, friction = 0.2 }',
)
_CENTRE, _RADIUS = (0.5, 0.0), 0.4


def _laid_within(contact: int) -> Bound:
    """How far places may be off, relative to the longer side."""
    if contact < 2:
        return Bound(at_most=1e-12, reason="round-off: flat faces are drawn where they lie")
    return Bound(at_most=5e-5, reason="theory: of 64 chords of a quarter of a turn (pi / 128)^2 / 24")


@case(
    claim="Maps show the pressure and the states of control points where they are on the slave face, in its lengths.",
    tier="gate",
    grid={"contact": (0, 1, 2)},
    bounds=lambda contact: {
        "pressure": Bound(at_most=1e-12, reason=_ROUND_OFF),
        **dict.fromkeys(("places", "control points", "outline"), _laid_within(contact)),
        "longer": Bound(1.0, 1.0, "definition: the longer side runs to the right"),
    },
)
def maps(contact: int) -> dict[str, float]:
    """Largest errors of the pressure, relative to the largest, and of places, relative to the longer side."""
    problem, step = _mapped(contact)
    pressure = np.abs(step.state.contacts[contact].pressure) + 1.0
    given = replace(
        step,
        state=replace(step.state, contacts=_with(step.state.contacts, contact, replace(step.state.contacts[contact], pressure=pressure))),
    )
    axes = draw_map(problem, given, face_field(problem, given, contact)).axes[0]
    directions, weights, control_points = _slave(problem, contact)
    mesh = next(drawn for drawn in axes.collections if isinstance(drawn, QuadMesh))
    coordinates = np.asarray(mesh.get_coordinates())
    samples = _on_grid([_parts(d, (n - 1) // d.elements) for d, n in zip(directions, coordinates.shape[1::-1], strict=True)])
    functions = shares(directions, weights, samples)
    exact = functions @ np.resize(pressure, len(control_points))  # the wheel's last ones are its first
    shown = np.ma.getdata(mesh.get_array()).ravel()  # type: ignore[arg-type]
    laid = _laid(contact, functions @ control_points, control_points[0])
    belongs = _laid(contact, shares(directions, weights, _on_grid([centres(d) for d in directions])) @ control_points, control_points[0])
    marks = [np.asarray(line.get_xydata()) for line in axes.lines[-3:]]
    status, size = np.resize(step.contacts[contact].status, len(control_points)), np.ptp(laid, axis=0)
    lines = np.concatenate([np.concatenate(drawn.get_segments()) for drawn in axes.collections if isinstance(drawn, LineCollection)])
    return {
        "pressure": float(np.abs(shown - exact).max() / np.abs(exact).max()),
        "places": float(np.abs(coordinates.reshape(-1, 2) - laid).max() / size[0]),
        "control points": float(np.max([_farthest(mark, belongs[status == k]) for k, mark in enumerate(marks)]) / size[0]),
        "outline": float(np.abs(np.array([lines.min(axis=0) - laid.min(axis=0), lines.max(axis=0) - laid.max(axis=0)])).max() / size[0]),
        "longer": float(size[0] >= size[1] and axes.get_aspect() == 1.0),
    }


@case(
    claim="Arrows on maps are the friction on the slave: on a face at rest its components along the two lengths of the map.",
    tier="gate",
    grid={"contact": (0, 1, 2)},
    bounds=lambda contact: {
        "arrows": Bound(at_most=1e-10, reason="round-off: inverse tangents"),
        "places": _laid_within(contact),
    },
)
def arrows(contact: int) -> dict[str, float]:
    """Largest error of the arrows, relative to the longest, and of where they begin, relative to the longer side."""
    problem, step = _mapped(contact)
    sticks = np.ones_like(step.contacts[contact].status)
    given = replace(
        step,
        state=replace(step.state, positions=Numbering(problem).reference),
        contacts=_with(step.contacts, contact, replace(step.contacts[contact], status=sticks)),
    )
    directions, weights, control_points = _slave(problem, contact)
    axes = draw_map(problem, given, face_field(problem, given, contact, "traction")).axes[0]
    quiver = next(drawn for drawn in axes.collections if isinstance(drawn, Quiver))
    drawn, places = np.column_stack([quiver.U, quiver.V]), np.column_stack([quiver.X, quiver.Y])
    counts = [len(np.unique(of_axis.round(9))) for of_axis in places.T]
    if contact != 0:  # the second direction runs to the right
        counts = counts[::-1]
    middles = [np.interp((np.arange(n) + 0.5) / n, [0.0, 1.0], d.boundaries[[0, -1]]) for d, n in zip(directions, counts, strict=True)]
    functions = shares(directions, weights, _on_grid(middles))
    points, tractions = functions @ control_points, functions @ contact_vectors(problem, given, None)[contact].traction
    exact = np.stack([np.einsum("nc,nc->n", tractions, along) for along in _along(contact, points, control_points[0])], axis=1)
    exact *= (np.linalg.norm(tractions, axis=1) / np.linalg.norm(exact, axis=1))[:, None]  # they are along the plane, not along the wheel
    laid = _laid(contact, points, control_points[0])
    return {
        "arrows": float(np.abs(drawn - exact).max() / np.linalg.norm(exact, axis=1).max()),
        "places": float(np.abs(places - laid).max() / np.ptp(laid[:, 0])),
    }


def _mapped(contact: int) -> tuple[Problem, StepResult]:
    """Bodies of which no two directions have parameters as long, and a load step with all states on the slave face, all over its master."""
    problem = _in_other_parameters(Scene.from_toml(_MAPPED).problem())
    step = records.over_master(records.load_steps(problem)[0])
    status = np.arange(len(step.contacts[contact].status), dtype=np.int32) % 3
    return problem, replace(step, contacts=_with(step.contacts, contact, replace(step.contacts[contact], status=status)))


def _slave(problem: Problem, contact: int) -> tuple[tuple[Direction, Direction], FloatArray, FloatArray]:
    """Directions, weights and control points of a slave face."""
    slave = problem.contacts[contact].slave
    patch = problem.body(slave.body).patch
    points = patch.face_points(slave.face)
    return patch.face_directions(slave.face), patch.weights[points], patch.control_points[points]


def _on_grid(parameters: Sequence[FloatArray]) -> FloatArray:
    return np.stack(np.meshgrid(*parameters), axis=-1).reshape(-1, 2)


def _parts(direction: Direction, count: int) -> FloatArray:
    """Ends of equal parts of each element."""
    return np.interp(np.arange(count * direction.elements + 1) / count, np.arange(direction.elements + 1), direction.boundaries)


def _laid(contact: int, points: FloatArray, corner: FloatArray) -> FloatArray:
    """Points of a slave face at rest on its map: two of their coordinates, or ways round the wheel and along it from a corner."""
    if contact < 2:
        return points[:, [(0, 1), (2, 1)][contact]]
    from_centre = np.concatenate([corner[None], points]) - [_CENTRE[0], 0.0, _CENTRE[1]]
    turned = np.unwrap(np.arctan2(from_centre[:, 0], from_centre[:, 2]))[1:] - np.arctan2(from_centre[0, 0], from_centre[0, 2])
    return np.abs(np.column_stack([_RADIUS * turned, points[:, 1] - corner[1]]))


def _along(contact: int, points: FloatArray, corner: FloatArray) -> FloatArray:
    """Unit vectors along both lengths of the map, shape (2, n, 3); round the wheel turns count from z to x, as its angles do."""
    if contact < 2:
        return np.broadcast_to(np.eye(3)[[(0, 1), (2, 1)][contact], None], (2, len(points), 3))
    outward = (points - [_CENTRE[0], 0.0, _CENTRE[1]]) * [1.0, 0.0, 1.0] / _RADIUS
    across = np.broadcast_to([0.0, np.sign(points[:, 1].mean() - corner[1]), 0.0], points.shape)
    return np.stack([np.cross([0.0, 1.0, 0.0], outward), across])


def _farthest(drawn: FloatArray, exact: FloatArray) -> float:
    return float(np.abs(drawn - exact).max(initial=0.0))


def _in_other_parameters(problem: Problem) -> Problem:
    """The same bodies; no two of their directions have parameters as long."""
    bodies = []
    for body in problem.bodies:
        u, v, w = (Direction(d.family, d.order, (k + 2) * d.knots) for k, d in enumerate(body.patch.directions))
        bodies.append(replace(body, patch=Patch((u, v, w), body.patch.control_points, body.patch.weights)))
    return replace(problem, bodies=tuple(bodies))


def _with(entries: tuple, number: int, entry: object) -> tuple:  # type: ignore[type-arg]
    return (*entries[:number], entry, *entries[number + 1 :])


@case(
    claim="A page to look at has the outer faces of all bodies, where these are after each load step, each once.",
    tier="gate",
    bounds={
        "places": Bound(at_most=1e-12, reason=_ROUND_OFF),
        "faces": Bound(22.0, 22.0, "definition: six of each of four bodies, but for the two of the ring that are one, inside"),
    },
)
def pages() -> dict[str, float]:
    """Largest error of places at parts of elements, and number of faces."""
    problem = Scene.from_toml(exported.SCENE).problem()
    steps, worst, count = records.load_steps(problem), 0.0, 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.h5"
        records.recorded(path, problem, steps, "last")
        with Results(path) as results:
            for _, number, grids in states(results):
                positions = steps[number - 1].state.positions if number else Numbering(problem).reference
                surfaces = list(of_bodies(problem, grids["bodies"]))
                count = len(surfaces)
                named = [(body, face) for body in problem.bodies for face in body.outer]
                for surface, (body, face) in zip(surfaces, named, strict=True):
                    found = surface.sampled(surface.rows[0][:3], 3)
                    worst = float(np.maximum(worst, np.abs(found - _of_face(problem, body, face, positions)).max()))
    return {"places": worst, "faces": float(count)}


def _of_face(problem: Problem, body: Body, face: str, positions: FloatArray) -> FloatArray:
    """Places at thirds of the elements of a body's face, the first direction fastest."""
    directions, points = body.patch.face_directions(face), body.patch.face_points(face)
    parts = [np.interp(np.arange(3 * d.elements + 1) / 3, np.arange(d.elements + 1), d.boundaries) for d in directions]
    places = np.stack(np.meshgrid(*parts), axis=-1).reshape(-1, 2)
    return shares(directions, body.patch.weights[points], places) @ Numbering(problem).of_patch(body.name, positions)[points]
