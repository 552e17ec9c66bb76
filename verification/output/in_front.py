"""What is in front in pictures of bodies: the face that a ray towards the eye leaves last, of boxes whose faces are told by hand."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.colors import to_rgb
from output.records import load_steps, over_master

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering
from isomortar.results import style
from isomortar.results.bodies import common_scale, draw_bodies
from isomortar.results.coloured import draw_coloured
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: A slave below a smaller master, or beside a plane; both are moved and stretched when they are drawn.
SCENE = """
format = 1
bodies.slave = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.8, 0.5] }, mesh = { order = [2, 1, 1], elements = [2, 1, 2] } }
bodies.master = { geometry = { kind = "box", lower = [0.3, 0.1, 0.5], upper = [1.2, 0.5, 0.9] }, mesh = { elements = 1 } }
contacts.c = { slave = "slave.FACE", MASTER, friction = 0 }
supports = { slave.face = "slave.v0", master.face = "master.w1" }
stages = [{ name = "one", steps = 2 }]
"""
#: By side of the slave: its master, the axis and the end of the face, azimuth and elevation in degrees of the eye that looks at it, and how
#: many load steps there are.
SIDES: dict[str, tuple[str, tuple[int, int], tuple[float, float], int]] = {
    "w1": ('master = "master.w0"', (2, 1), (-62.0, 69.0), 2),
    "u1": ("plane = { point = [1.4, 0, 0], normal = [-1, 0, 0] }", (0, 1), (-25.0, 15.0), 2),
}
#: From where all bodies are seen.
WHOLE = (-62.0, 24.0)
#: Where the plane is.
PLANE = 1.4
STRETCH, SHIFT = np.array([1.1, 0.9, 1.2]), np.array([0.2, -0.1, 0.3])
#: A pressure that grows along x, y and z: control pressures are those at Greville's abscissae of straight boxes.
GRADIENT = np.array([0.5, 0.3, 0.7])


def axes_of(azimuth: float, elevation: float) -> FloatArray:
    """Unit vectors to the right, upwards and towards the eye."""
    a, e = np.radians([azimuth, elevation])
    level = np.array([np.cos(a), np.sin(a), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    return np.array([[-np.sin(a), np.cos(a), 0.0], np.cos(e) * up - np.sin(e) * level, np.cos(e) * level + np.sin(e) * up])


@dataclass(frozen=True)
class Seen:
    """Where a ray leaves a box last: which box, the axis and the end of the face, and the place."""

    box: str
    axis: int
    end: int
    place: FloatArray


def last_left(boxes: dict[str, FloatArray], frame: FloatArray, place: FloatArray) -> Seen | None:
    """What the eye sees at a place of the picture; boxes are lower and upper corners, shape (2, 3), of no depth what lies behind all."""
    found, nearest = None, -np.inf
    start, eye = place @ frame[:2], frame[2]
    for name, corners in boxes.items():
        ways = np.sort((corners - start) / eye, axis=0)
        enters, leaves = ways[0].max(), ways[1].min()
        before = leaves if name != "floor" else -1e9
        if enters <= leaves + 1e-12 and before > nearest:
            nearest, axis = before, int(np.argmin(ways[1]))
            found = Seen(name, axis, int(eye[axis] > 0.0), start + leaves * eye)
    return found


def drawn_at(axes: Axes, places: FloatArray) -> list[FloatArray | None]:
    """The colour of the last polygon that was painted over each place; None: there is none."""
    (collection,) = (c for c in axes.collections if isinstance(c, PathCollection))
    colours, paths = np.asarray(collection.get_facecolor()), collection.get_paths()
    outlines = [np.asarray(path.vertices) for path in paths]
    four = [number for number, outline in enumerate(outlines) if len(outline) == 5]  # the first again; lines have fewer
    corners = np.array([outlines[number][:4] for number in four])
    sides = np.roll(corners, -1, axis=1) - corners
    found: list[FloatArray | None] = []
    for place in places:
        to = place - corners
        turns = sides[..., 0] * to[..., 1] - sides[..., 1] * to[..., 0]
        over = np.flatnonzero(np.all(turns > 0.0, axis=1) | np.all(turns < 0.0, axis=1))
        found.append(np.asarray(colours[four[over[-1]]])[:3] if len(over) else None)
    return found


def moved(problem: Problem, step: StepResult, factor: float) -> tuple[StepResult, dict[str, FloatArray]]:
    """The load step with boxes that are moved, under a known pressure; and the boxes."""
    numbering = Numbering(problem)
    contact = problem.contacts[0]
    patch = problem.body("slave").patch
    pressure = factor * (1.0 + patch.control_points[patch.face_points(contact.slave.face)] @ GRADIENT)
    positions = numbering.reference * STRETCH + factor * SHIFT
    state = replace(step.state, positions=positions, contacts=(replace(step.state.contacts[0], pressure=pressure),))
    points = {body.name: numbering.of_patch(body.name, positions) for body in problem.bodies}
    return replace(step, state=state), {name: np.array([p.min(axis=0), p.max(axis=0)]) for name, p in points.items()}


def floor(side: str, slaves: list[FloatArray]) -> dict[str, FloatArray]:
    """The part of a plane that is drawn: a fifth of what slaves take up beyond them, or nothing, where the master is a body."""
    axis, _ = SIDES[side][1]
    if side == "w1":
        return {}
    corners = np.array([np.min(slaves, axis=(0, 1)), np.max(slaves, axis=(0, 1))])
    corners += 0.2 * np.ptp(corners, axis=0).max() * np.array([[-1.0], [1.0]])
    corners[:, axis] = PLANE
    return {"floor": corners}


def pressure_at(place: FloatArray) -> float:
    """The pressure of the first load step at a place of the slave."""
    return float(1.0 + ((place - SHIFT) / STRETCH) @ GRADIENT)


def off(seen: Seen | None, drawn: FloatArray | None, side: str, peak: float) -> float:
    """By how much a colour is off what belongs there: that of the pressure, or of the body as bright as may be."""
    if seen is None or drawn is None:
        return float((seen is None) != (drawn is None))
    if seen.box == "floor":
        return float(np.abs(drawn - to_rgb(style.PLANE)).max())
    if (seen.box, seen.axis, seen.end) == ("slave", *SIDES[side][1]):
        exact = np.array(style.pressure_colours()(pressure_at(seen.place) / peak))[:3]
        return float(np.abs(drawn - exact).max())
    colour = np.array(to_rgb(style.SLAVE if seen.box == "slave" else style.MASTER))
    brightness = float(drawn @ colour / (colour @ colour))
    return float(np.abs(drawn / brightness - colour).max()) if 0.5 < brightness < 1.1 else 1.0


def limits(boxes: list[FloatArray], frame: FloatArray) -> FloatArray:
    """Lower left and upper right corner of a picture of boxes, with a margin of a hundredth of the longer side."""
    places = np.concatenate([np.stack(np.meshgrid(*of.T, indexing="ij"), axis=-1).reshape(-1, 3) for of in boxes]) @ frame[:2].T
    low, high = places.min(axis=0), places.max(axis=0)
    margin = 0.01 * (high - low).max()
    return np.array([low - margin, high + margin])


@case(
    claim="Pictures of bodies show the face that is nearest to the eye, the contact face in the colour of its pressure there, from the "
    "master's side in the second one; pictures of several load steps have one scale, on which all of them are whole.",
    tier="gate",
    grid={"side": tuple(SIDES)},
    bounds={
        "colours": Bound(at_most=0.02, reason="discretisation: an eighth of an element has one colour; edges of boxes are left out"),
        "seen": Bound(at_least=25.0, reason="definition: places at which there is a body"),
        "limits": Bound(at_most=1e-12, reason="definition: corners of all that is drawn, and a hundredth of their distance"),
    },
)
def in_front(side: str) -> dict[str, float]:
    """Largest errors over random places of both pictures."""
    master, (axis, end), eye, steps = SIDES[side]
    problem = Scene.from_toml(SCENE.replace("FACE", side).replace("MASTER", master)).problem()
    made = [moved(problem, over_master(step), factor) for step, factor in zip(load_steps(problem)[:steps], (1.0, 2.0), strict=False)]
    step, boxes = made[0]
    figure = draw_bodies(problem, step, 0, common_scale(problem, [of for of, _ in made], 0) if steps > 1 else None)
    slaves = [of["slave"] for _, of in made]
    ground = floor(side, slaves)
    peak = steps * pressure_at(np.where(np.arange(3) == axis, boxes["slave"][end], boxes["slave"][1]))
    own, looked_at = limits([boxes["slave"]], axes_of(*eye)), [limits([slave], axes_of(*eye)) for slave in slaves]
    sizes = np.max([np.ptp(corners, axis=0) for corners in looked_at], axis=0)
    corners = [
        limits([*(box for _, of in made for box in of.values()), *ground.values()], axes_of(*WHOLE)),
        own.mean(axis=0) + np.outer([-0.5, 0.5], sizes),
    ]
    worst, count, apart, random = 0.0, 0, 0.0, np.random.default_rng(0)
    for axes, at, shown, exact in zip(figure.axes, (WHOLE, eye), ({**boxes, **ground}, {"slave": boxes["slave"]}), corners, strict=False):
        found, places = _seen(shown, axes_of(*at), exact, random)
        colours = drawn_at(axes, places)
        worst = np.max([worst, *(off(of, colour, side, peak) for of, colour in zip(found, colours, strict=True))])
        count += sum(of is not None for of in found)
        apart = np.maximum(apart, np.abs(np.array([axes.get_xlim(), axes.get_ylim()]).T - exact).max())
    return {"colours": float(worst), "seen": float(count), "limits": float(apart)}


def _seen(
    boxes: dict[str, FloatArray], frame: FloatArray, corners: FloatArray, random: np.random.Generator
) -> tuple[list[Seen | None], FloatArray]:
    """What is seen at random places of a picture, and these, but for those beside edges."""
    size = np.ptp(corners, axis=0)
    places = corners[0] + random.random((50, 2)) * size
    beside = 0.015 * size.max() * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]])
    found = [last_left(boxes, frame, place) for place in places]
    inside = [
        number
        for number, (place, seen) in enumerate(zip(places, found, strict=True))
        if all(_face(last_left(boxes, frame, place + way)) == _face(seen) for way in beside)
    ]
    return [found[number] for number in inside], places[inside]


def _face(seen: Seen | None) -> tuple[str, int, int] | None:
    return (seen.box, seen.axis, seen.end) if seen else None


@case(
    claim="Bodies in colours show, at each place, the field there: how far a point has gone, by the colour bar.",
    tier="gate",
    bounds={
        "colours": Bound(at_most=0.02, reason="discretisation: a 72nd of a face has one colour; edges of boxes are left out"),
        "range": Bound(at_most=0.1, reason="definition: of the longest way, which is at a corner, a tenth and less is missed inside"),
        "seen": Bound(at_least=15.0, reason="definition: places at which there is a body"),
    },
)
def coloured_in_front() -> dict[str, float]:
    """Largest error of colours at random places, what the bar lacks of the longest way, and how many places there are."""
    problem = Scene.from_toml(SCENE.replace("FACE", "w1").replace("MASTER", SIDES["w1"][0])).problem()
    step, boxes = moved(problem, load_steps(problem)[0], 1.0)
    figure = draw_coloured(problem, step, "displacement")
    axes, bar = figure.axes
    _, most = bar.get_ylim()
    found, places = _seen(boxes, axes_of(*WHOLE), limits(list(boxes.values()), axes_of(*WHOLE)), np.random.default_rng(1))
    worst = 0.0
    for seen, drawn in zip(found, drawn_at(axes, places), strict=True):
        if seen is None or drawn is None:
            worst = np.maximum(worst, float((seen is None) != (drawn is None)))
        else:
            exact = np.array(style.field_colours()(_gone(seen.place) / most))[:3]
            worst = np.maximum(worst, np.abs(drawn - exact).max())
    corners = [_gone(np.array([of[i, 0], of[j, 1], of[k, 2]])) for of in boxes.values() for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    return {"colours": float(worst), "range": float(np.abs(1.0 - most / np.max(corners))), "seen": float(sum(s is not None for s in found))}


def _gone(place: FloatArray) -> float:
    """How far the point that is at a place has gone."""
    return float(np.linalg.norm(place - (place - SHIFT) / STRETCH))
