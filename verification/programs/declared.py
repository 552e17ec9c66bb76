"""What other programs are told of a problem, and what is made of what they say, without running any of them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from isomortar.geometry.patch import FACES, FloatArray
from isomortar.harness import Bound, case
from isomortar.model.entities import Face, Problem
from isomortar.model.numbering import Numbering
from isomortar.program.calculix import LAWS, deck
from isomortar.program.declaration import LoadStep, ended, load_step
from isomortar.program.lagrange import LagrangeProblem
from isomortar.program.process import Ending
from isomortar.scene import Scene

#: Two blocks, each long, wide and high in its own way, one of them on the other.
SCENE = """
format = 1
[materials]
soft = { law = "LAW", young = 3, poisson = 0.2 }
hard = { law = "LAW", young = 70, poisson = 0.35 }
[bodies.lower]
material = "hard"
geometry = { kind = "box", lower = [-1, -2, -3], upper = [2, 3, 0] }
mesh = { family = "L", order = ORDER, elements = [2, 3, 1] }
[bodies.upper]
material = "soft"
geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.5, 2] }
mesh = { family = "L", order = ORDER, elements = [2, 1, 3] }
[contacts.between]
slave = "upper.w0"
master = "lower.w1"
friction = 0.25
[supports]
floor = { face = "lower.w0", centre = [0.5, -1, 2] }
top = { face = "upper.w1", centre = [1, 2, 3] }
[loads]
side = { face = "upper.FACE", pressure = 0.5 }
[[stages]]
name = "press"
steps = 2
motions.top = { translate = [0.1, 0, -0.4] }
[[stages]]
name = "drag"
steps = 1
loads.side = 3
motions = { top.translate = [0.3, 0.2, 0], floor.translate = [0, 0, 0.1] }
"""
#: Corners of the faces of a hexahedron in CalculiX' manual, by the number of the face, from 1.
SIDES = {"S1": (1, 2, 3, 4), "S2": (5, 8, 7, 6), "S3": (1, 5, 6, 2), "S4": (2, 6, 7, 3), "S5": (3, 7, 8, 4), "S6": (4, 8, 5, 1)}
#: Ends of the edges of its middle nodes there, the ninth to the twentieth.
EDGES = ((1, 2), (2, 3), (3, 4), (4, 1), (5, 6), (6, 7), (7, 8), (8, 5), (1, 5), (2, 6), (3, 7), (4, 8))
ROUND_OFF = Bound(at_most=1e-11, reason="round-off: numbers of thirteen digits as text, over the size of the scene")
WRONG = Bound(0.0, 0.0, "definition: what the program's manual calls it, and how many there are")


def problem(law: str = "neo-hookean-j", order: int = 1, face: str = "u0") -> Problem:
    """The scene with a law, elements of an order, and the pressure on a face."""
    return Scene.from_toml(SCENE.replace("LAW", law).replace("ORDER", str(order)).replace("FACE", face)).problem()


def on_face(points: FloatArray, name: str, corners: FloatArray) -> FloatArray:
    """Which points of a box are on its face."""
    axis, end = divmod(FACES.index(name), 2)
    return points[:, axis] == (corners.max(axis=0) if end else corners.min(axis=0))[axis]


@case(
    claim="A problem of Lagrange elements is its nodes, elements on faces, and what is prescribed at the end of each load step.",
    tier="gate",
    grid={"order": (1, 2)},
    bounds={
        "prescribed": Bound(at_most=1e-14, reason="round-off: straight motions over load steps; pressures times factors"),
        "touching": Bound(0.0, 0.0, "definition: the elements that have nodes there, where coordinates say so"),
        "sizes": Bound(0.0, 0.0, "definition: thinnest body and stiffest material of the scene"),
    },
)
def told(order: int) -> dict[str, float]:
    """Largest difference; elements that are told to be on faces and are not, or the other way; wrong sizes."""
    given = problem(order=order)
    of, numbering, wrong = LagrangeProblem(given, "it", LAWS), Numbering(given), 0
    for body in given.bodies:
        points = of.nodes[of.elements(body)]
        corners = body.patch.control_points
        for name in FACES:
            there = {k for k, nodes in enumerate(points) if on_face(nodes, name, corners).any()}
            wrong += set(of.touching(Face(body.name, name)).tolist()) != there
    ways = np.array([[0.05, 0.0, -0.2], [0.1, 0.0, -0.4], [0.4, 0.2, -0.4]]), np.array([[0.0, 0, 0], [0, 0, 0], [0, 0, 0.1]])
    exact = np.zeros((3, *of.nodes.shape))
    for body, name, way in ((given.bodies[1], "w1", ways[0]), (given.bodies[0], "w0", ways[1])):
        mine = numbering.points[body.name]
        exact[:, mine[on_face(of.nodes[mine], name, body.patch.control_points)]] = way[:, None]
    off = np.abs(of.displacements - exact.reshape(3, -1)[:, of.prescribed]).max()
    held = np.zeros(len(of.nodes) * 3, bool)
    held[of.prescribed] = True
    wrong += int(np.abs(exact.reshape(3, -1)[:, ~held]).max() > 0.0)
    pressures = np.array([[0.25], [0.5], [1.5]])
    return {
        "prescribed": float(np.maximum(off, np.abs(of.pressures - pressures).max())),
        "touching": float(wrong),
        "sizes": float((of.thinnest != 0.5) + (of.stiffest != 70.0)),
    }


def words(lines: list[str], heading: str) -> Iterator[tuple[str, list[str]]]:
    """Heading and lines of each part of a deck that begins with it; lines that go on are one."""
    starts = [k for k, line in enumerate(lines) if line.startswith("*")] + [len(lines)]
    for begin, end in pairwise(starts):
        if lines[begin].startswith(heading):
            yield lines[begin], re.sub(r",\n", ", ", "\n".join(lines[begin + 1 : end])).split("\n")


@case(
    claim="The deck that CalculiX is given has the nodes where they are, elements and faces in its order, moduli in its terms, and of each "
    "load step what is prescribed at its end.",
    tier="gate",
    grid={"law": LAWS, "order": (1, 2)},
    bounds={"nodes": ROUND_OFF, "middles": ROUND_OFF, "moduli": ROUND_OFF, "prescribed": ROUND_OFF, "wrong": WRONG},
)
def decks(law: str, order: int) -> dict[str, float]:
    """Largest differences of numbers; how many faces, volumes and parts are others."""
    given = problem(law, order, "u0")
    of = LagrangeProblem(given, "it", LAWS)
    lines = "\n".join(deck(of, 123.0, 45.0)).split("\n")
    ((_, rows),) = words(lines, "*NODE, ")
    nodes = {int(number): np.array(place, float) for number, *place in (row.split(",") for row in rows)}
    off = {"nodes": max_of(np.abs(place - of.nodes[number - 1]).max() for number, place in nodes.items())}
    elements: dict[int, list[int]] = {}
    wrong = 0
    for _, rows in words(lines, "*ELEMENT"):
        elements |= {int(number): [int(n) for n in named] for number, *named in (row.split(",") for row in rows)}
    wrong += sorted(elements) != list(range(1, 13)) or {len(named) for named in elements.values()} != {8 if order == 1 else 20}
    corners = {number: np.array([nodes[n] for n in named]) for number, named in elements.items()}
    edges = {number: (places[1] - places[0], places[3] - places[0], places[4] - places[0]) for number, places in corners.items()}
    wrong += sum(float(np.linalg.det(of_element)) <= 0.0 for of_element in edges.values())
    volume = sum(float(np.linalg.det(of_element)) for of_element in edges.values())
    wrong += abs(volume - (3 * 5 * 3 + 1.0)) > 1e-9
    middles = [
        np.abs(places[8 + k] - 0.5 * (places[a - 1] + places[b - 1])).max()
        for places in corners.values()
        for k, (a, b) in enumerate(EDGES)
        if order == 2
    ]
    off["middles"] = max_of([0.0, *middles])
    planes = {"SLAVE0": (2, 0.0, 2), "MASTER0": (2, 0.0, 6), "LOAD0": (0, 0.0, 3)}
    found = {heading.rpartition("=")[2]: rows for heading, rows in words(lines, "*SURFACE, NAME")}
    wrong += found.keys() != planes.keys()
    for name, (axis, place, count) in planes.items():
        sides = [row.split(", ") for row in found[name]]
        at = [corners[int(element)][np.array(SIDES[side]) - 1, axis] for element, side in sides]
        wrong += len(sides) != count or any(np.any(side != place) for side in at)
    heading = "*ELASTIC" if law == "linear-elastic" else "*HYPERELASTIC"
    moduli = [np.array(row.split(","), float) for _, (row,) in words(lines, heading)]
    exact = [
        (e, nu) if law == "linear-elastic" else (e / (4 * (1 + nu)), 6 * (1 - 2 * nu) / e) for e, nu in ((70.0, 0.35), (3.0, 0.2))
    ]  # C10 = G/2 and D1 = 2/K
    off["moduli"] = float(np.abs(np.divide(moduli, exact) - 1.0).max())
    steps = [dict(prescribed_of(rows)) for _, rows in words(lines, "*BOUNDARY")]
    wrong += len(steps) != 3 or any(step.keys() != {int(u) for u in of.prescribed if u // 3 + 1 in nodes} for step in steps)
    apart = [
        abs(value - of.displacements[k, np.searchsorted(of.prescribed, unknown)])
        for k, step in enumerate(steps)
        for unknown, value in step.items()
    ]
    pressed = [float(row.split(",")[2]) for _, (row,) in words(lines, "*DSLOAD")]
    off["prescribed"] = max_of([*apart, *np.abs(np.subtract(pressed, [0.25, 0.5, 1.5]))])
    ((_, rubbed),) = words(lines, "*FRICTION")
    ((_, pushed),) = words(lines, "*SURFACE BEHAVIOR")
    wrong += [float(x) for x in rubbed[0].split(",")] != [0.25, 45.0] or float(pushed[0]) != 123.0
    large = [heading for heading, _ in words(lines, "*STEP")]
    wrong += len(large) != 3 or any(("NLGEOM" in heading) != (law != "linear-elastic") for heading in large)
    return {**off, "wrong": float(wrong)}


def max_of(values: object) -> float:
    """The largest, of which one that is not a number is larger than all."""
    return float(np.max(list(values)))  # type: ignore[call-overload]


def prescribed_of(rows: list[str]) -> Iterator[tuple[int, float]]:
    """Unknowns and their values."""
    for row in rows:
        node, component, last, value = row.split(",")
        assert component == last
        yield 3 * (int(node) - 1) + int(component) - 1, float(value)


@case(
    claim="Of forces at nodes each support has the sum of those on its face, and their moment about its moving centre; a run was measured "
    "where all load steps are there, and never where they are not.",
    tier="gate",
    bounds={
        "error": Bound(at_most=1e-13, reason="round-off: sums of a few cross products, over the largest"),
        "wrong": Bound(0.0, 0.0, "definition: endings by the load steps that are there"),
    },
)
def reactions() -> dict[str, float]:
    """Largest relative difference of forces and moments; how many endings are others."""
    given, random, worst = problem(), np.random.default_rng(7), [0.0]
    numbering = Numbering(given)
    centres = {
        "floor": [(0.5, -1.0, 2.0)] * 2 + [(0.5, -1.0, 2.1)],
        "top": [(1.05, 2.0, 2.8), (1.1, 2.0, 2.6), (1.4, 2.2, 2.6)],
    }
    for step in (1, 2, 3):
        positions, forces = numbering.reference + 0.1 * random.normal(size=(numbering.count, 3)), random.normal(size=(numbering.count, 3))
        found = load_step(given, step, positions, forces)
        for support, reaction, (body, face) in zip(given.supports, found.reactions, (("lower", "w0"), ("upper", "w1")), strict=True):
            mine = numbering.points[body]
            there = mine[on_face(numbering.reference[mine], face, numbering.reference[mine])]
            centre = np.array(centres[support.name][step - 1])
            turning = sum(np.cross(positions[k] - centre, forces[k]) for k in there)
            worst += [np.abs(reaction.force - forces[there].sum(axis=0)).max() / np.abs(reaction.force).max()]
            worst += [np.abs(reaction.moment - turning).max() / np.abs(turning).max(), np.abs(reaction.centre - centre).max()]
    one = LoadStep(1, numbering.reference, ())
    endings: tuple[Ending, ...] = ("measured", "not converged", "crashed", "timed out")
    whole = sum(ended([one] * 3, given, ending, "so") != ("measured", "") for ending in endings)
    part = sum(
        ended([one] * count, given, ending, "so") != ("crashed" if ending == "measured" else ending, "so")
        for ending in endings
        for count in (0, 2)
    )
    return {"error": max_of(worst), "wrong": float(whole + part)}
