"""What too few points of a contact make of a uniform pressure, where weights of its slave differ and its body has points enough."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import numpy as np
from solid.too_few_points import in_turn
from told.word_by_word import refused

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene

#: A column with such weights, pressed on a plane or on a block that it meets element by element; nothing is held across.
SCENE = """
format = 1
materials.m = {{ young = 1.0, poisson = 0.0 }}
bodies.column.patch = {{ order = [2, 2, 1], knots = {knots}, control_points = {points}, weights = {weights} }}
bodies.column.mesh.quadrature = [60, 60, 2]
bodies.block = {{ geometry = {{ kind = "box", lower = [0, 0, -1], upper = [1, 1, 0] }}, mesh.elements = [{elements}, {elements}, 1] }}
contacts.c = {{ slave = "column.w0", {master}, friction = 0{more} }}
supports.top = {{ face = "column.w1", components = ["z"] }}
supports.x = {{ face = "column.u0", components = ["x"] }}
supports.y = {{ face = "column.v0", components = ["y"] }}
supports.base = {{ face = "block.w0" }}
stages = [{{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.01] }}]
"""
MASTERS = {"plane": "plane = {}", "block": 'master = "block.w1"'}


def column(contrast: float, master: str, more: str = "") -> Problem:
    """The problem; `more`: keys of its contact."""
    return Scene.from_toml(written(contrast, master, more)).problem()


def written(contrast: float, master: str, more: str = "") -> str:
    """The scene."""
    patch = in_turn(contrast).patch
    return SCENE.format(
        knots=[direction.knots.tolist() for direction in patch.directions],
        points=patch.control_points.tolist(),
        weights=patch.weights.tolist(),
        elements=3,
        master=MASTERS[master],
        more=more,
    )


def off(problem: Problem) -> float:
    """The most that the pressure field is off its mean over the face, which is the force, relative."""
    (result,) = Simulation(problem).run()
    (contact,) = result.contacts
    return float(np.abs(contact.pressure_field / contact.force_slave[2] - 1.0).max())


@case(
    claim="Contacts whose points do not follow the weights of their slave are told how far pressures are off, with a cure.",
    tier="gate",
    grid={"master": list(MASTERS), "contrast": [2.0, 5.0, 20.0]},
    bounds=lambda master, contrast: (
        {"none": Bound(at_most=0.0, reason="definition: weights like those of arcs, for which the points are made")}
        if contrast == 2.0
        else {
            "told": Bound(
                at_most=1.05 if master == "plane" else 2.0,
                at_least=0.95 if master == "plane" else 1.0,
                reason="definition: over the error there is, to two digits; a block that gives way evens pressures out, and some open",
            ),
            "cured": Bound(at_most=0.01, reason="definition: as much as is not told"),
        }
    ),
)
def points_of_a_contact(master: str, contrast: float) -> dict[str, float]:
    """The error that is told over that of the field, and what is left of it with the points that the warning names."""
    problem = column(contrast, master)
    said = [sentence for sentence in Simulation(problem).doubts() if "quadrature points" in sentence]
    if not said:
        return {"none": 0.0}
    (found,) = (re.search(r"off by up to (\S+) %.*quadrature = (\[.*?\])", sentence) for sentence in said)
    assert found is not None, said
    return {
        "told": float(found[1]) / 100.0 / off(problem),
        "cured": off(column(contrast, master, f", quadrature = {found[2]}")),
    }


#: Points along a direction that are told at most.
MOST = 64


@case(
    claim="Where points follow weights along one direction and not along the other, points without end are not told: to bring the "
    "weights nearer to each other is.",
    tier="gate",
    grid={"quadrature": ("3, 40", "40, 3", "4, 6")},
    bounds={
        "silent": Bound(0.0, 0.0, "definition: too few points along a direction are told of"),
        "too many": Bound(0.0, 0.0, "definition: directions along which more points are told"),
        "cures": Bound(0.0, 0.0, "definition: cures by points where there are too many, or none where there are few"),
    },
)
def few_enough(quadrature: str) -> dict[str, float]:
    """Sentences that are missing, directions with too many points, and wrong cures."""
    said = [text for text in Simulation(column(20.0, "plane", f", quadrature = [{quadrature}]")).doubts() if "differ too much" in text]
    told = [json.loads(found[1]) for text in said if (found := re.search(r"quadrature = (\[.*?\])", text))]
    wrong = bool(told) == ("40" in quadrature)
    return {"silent": float(not said), "too many": float(sum(n > MOST for rule in told for n in rule)), "cures": float(wrong)}


#: Contrasts of weights, points of the body, enforcements, and what is said to be off: forces of the body, pressures of the contact.
OF_WHICH = (
    (5.0, "[60, 60, 2]", "points", (False, True)),
    (5.0, "[60, 60, 2]", "knots", (False, False)),
    (5.0, "[4, 4, 2]", "points", (True, False)),
    (5.0, "[4, 4, 2]", "knots", (True, False)),
    (3.0, "[4, 4, 2]", "points", (False, False)),
)


@case(
    claim="Of weights that differ too much for the points of a body that is told, and for those of its contact where the body's follow "
    "them, and averages of these are what acts.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: sentences that are missing, or said of what is followed or does not act")},
)
def of_which() -> dict[str, float]:
    """How many."""
    wrong = 0
    for contrast, points, enforcement, expected in OF_WHICH:
        more = "" if enforcement == "points" else ', enforcement = "knots"'
        problem = column(contrast, "plane", more)
        (body, *others), rule = problem.bodies, json.loads(points)
        said = " ".join(Simulation(replace(problem, bodies=(replace(body, quadrature=tuple(rule)), *others))).doubts())
        found = "forces at its control points are off" in said, "pressures are off" in said
        wrong += sum(one != other for one, other in zip(found, expected, strict=True))
    return {"wrong": float(wrong)}


#: Contrasts of weights, other changes, and what the body is refused with; none: it is taken.
REFUSED: tuple[tuple[float, list[str], str], ...] = (
    (12.0, [], ""),
    (30.0, [], "Take bodies.column.mesh.quadrature = [16, 16, 8] and as many in its contacts, or bring the weights nearer"),
    (100.0, [], "Take bodies.column.mesh.quadrature = [32, 32, 16] and as many in its contacts, or bring the weights nearer"),
    (100.0, ["bodies.column.mesh.elements=[4,4,4]"], "about 25 %. Bring the weights nearer"),
    (300.0, [], "about 23 %. Bring the weights nearer"),
    (1e6, [], "about 24 %. Bring the weights nearer"),
)


@case(
    claim="Bodies whose weights differ far too much for their points are refused, with as many points as would do, where these are not too "
    "many.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: bodies that are taken or refused and should not be, and wrong cures")},
)
def of_bodies() -> dict[str, float]:
    """How many."""
    wrong = 0
    for contrast, changes, words in REFUSED:
        said = refused(written(contrast, "plane"), "bodies.column.mesh.quadrature=[4,4,2]", *changes)
        wrong += bool(said) != bool(words) or words not in said
    return {"wrong": float(wrong)}
