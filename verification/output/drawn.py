"""What is drawn: lines of curves, maps of slave faces, and the nets of a page to look at, against the load steps and SciPy's functions."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure
from output import exported, records
from rational_functions import nodes_of, shares

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Problem
from isomortar.model.numbering import Numbering
from isomortar.results.abscissa import abscissa
from isomortar.results.curves import draw_curve, draw_reactions, moving_supports
from isomortar.results.maps import draw_map
from isomortar.results.paraview import states
from isomortar.results.reader import Results
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
        "names": Bound(at_most=0.0, reason="definition: supports and curves that are drawn, or are not, and should not be, or should"),
    },
)
def curves() -> dict[str, float]:
    """Largest differences of lines, how many there are, and wrong names; of a support that moves and one that a force moves."""
    scene = Scene.from_toml(records.SCENE)
    problem = scene.problem()
    steps = records.load_steps(problem)
    worst, count = {"reactions": 0.0, "curves": 0.0}, 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.h5"
        records.recorded(path, problem, steps, "last")
        with Results(path) as results:
            names = [support.name for support in moving_supports(results)]
            for name in ("ground", "push"):
                number = [support.name for support in problem.supports].index(name)
                told = {kind: np.array([getattr(s.reactions[number], kind) for s in steps]) for kind in ("force", "moment", "displacement")}
                over = abscissae(steps, number, name)
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
    return {**{k: float(v) for k, v in worst.items()}, "lines": float(count), "names": float(len(wrong) + (names != ["ground", "push"]))}


def _apart(drawn: list[FloatArray], expected: list[FloatArray]) -> float:
    return float(np.max([np.abs(one - other).max() for one, other in zip(drawn, expected, strict=True)]))


def centres(direction: Direction) -> FloatArray:
    """Where functions of a direction belong: means of their inner knots; nodes of Lagrange elements."""
    p = direction.order
    if direction.family == "N":
        return np.array([direction.knots[i + 1 : i + 1 + p].mean() for i in range(direction.count)])
    return nodes_of(direction)


@case(
    claim="Maps show the pressure and the states of control points where they are on the slave face, in its proportions.",
    tier="gate",
    grid={"contact": (0, 1)},
    bounds={
        "pressure": Bound(at_most=1e-12, reason=_ROUND_OFF),
        "control points": Bound(at_most=1e-14, reason="round-off: means of knots"),
        "aspect": Bound(at_most=1e-12, reason="definition: lengths of the face's sides; round-off"),
        "longer": Bound(1.0, 1.0, "definition: the longer side runs to the right"),
    },
)
def maps(contact: int) -> dict[str, float]:
    """Largest errors of the pressure, relative to the largest, of places and of the proportions of the picture."""
    problem = _in_other_parameters(Scene.from_toml(exported.SCENE).problem())
    step = records.load_steps(problem)[0]
    status = step.contacts[contact].status % 3
    pressure = np.abs(step.state.contacts[contact].pressure) + 1.0
    given = replace(
        step,
        state=replace(step.state, contacts=_with(step.state.contacts, contact, replace(step.state.contacts[contact], pressure=pressure))),
        contacts=_with(step.contacts, contact, replace(step.contacts[contact], status=status)),
    )
    axes = draw_map(problem, given, contact).axes[0]
    slave = problem.contacts[contact].slave
    patch = problem.body(slave.body).patch
    directions, points = patch.face_directions(slave.face), patch.face_points(slave.face)
    grid = patch.control_points[points].reshape(directions[1].count, directions[0].count, 3)
    sides = [float(np.linalg.norm(grid[0, -1] - grid[0, 0])), float(np.linalg.norm(grid[-1, 0] - grid[0, 0]))]
    first, second = (0, 1) if sides[0] >= sides[1] else (1, 0)
    mesh = next(drawn for drawn in axes.collections if isinstance(drawn, QuadMesh))
    places = np.asarray(mesh.get_coordinates()).reshape(-1, 2)[:, [first, second]]
    shown = np.ma.getdata(mesh.get_array()).ravel()  # type: ignore[arg-type]
    exact = shares(directions, patch.weights[points], places) @ pressure
    belongs = np.stack(np.meshgrid(*map(centres, directions)), axis=-1).reshape(-1, 2)
    marks = [np.asarray(line.get_xydata())[:, [first, second]] for line in axes.lines[-3:]]
    ends = [float(np.ptp(d.boundaries)) for d in directions]
    aspect = (sides[second] / ends[second]) / (sides[first] / ends[first])
    return {
        "pressure": float(np.abs(shown - exact).max() / np.abs(exact).max()),
        "control points": float(np.max([np.abs(mark - belongs[status == k]).max(initial=0.0) for k, mark in enumerate(marks)])),
        "aspect": abs(float(axes.get_aspect()) / aspect - 1.0),
        "longer": float(sides[first] >= sides[second]),
    }


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
