"""What who says nothing gets: the keys of the published schema with their defaults, and Gauss points by order, as documented."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from told.wrong.choices import NEEDED, PROJECTIONS
from told.wrong.contacts import PAIR

import isomortar.scene
from isomortar.geometry.patch import Direction, Family
from isomortar.geometry.primitives import bowl
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, RigidPlane, Stage, Support
from isomortar.results.comparison import differences
from isomortar.scene import Scene, json_schema

PUBLISHED = Path(isomortar.scene.__file__).parent / "scene.schema.json"

#: No word on the solver, the material, the quadrature, friction, and what a support holds.
SILENT = """
format = 1
name = "quiet"
[bodies.block]
geometry = { kind = "bowl", half_width = 0.5, bottom = 0.0, rise = 0.1, top = 0.6 }
mesh = { order = [2, 3, 1], elements = [3, 2, 1] }
[contacts.floor]
slave = "block.w0"
plane = {}
[supports.top]
face = "block.w1"
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0, 0, -0.1]
[[stages]]
name = "hold"
steps = 1
"""
#: The same as docs say that it is.
SPOKEN = (
    SILENT.replace(
        "elements = [3, 2, 1] }",
        'elements = [3, 2, 1], family = "N", quadrature = [4, 6, 2], grading = [1, 1, 1] }\nrigid = false\nmaterial = "m"',
    )
    .replace("half_width", "centre = [0, 0], half_width")
    .replace(
        "plane = {}",
        'friction = 0.3\ncohesion = 0\nelastic_slip = 0\nsmoothing = 0\nenforcement = "mortar"\nprojection = "closest"\nquadrature = '
        "[6, 6]\nsubcells = 0\nplane = { point = [0, 0, 0], normal = [0, 0, 1], tangent = [1, 0, 0] }",
    )
    .replace('face = "block.w1"', 'face = "block.w1"\ncomponents = ["x", "y", "z"]\ncentre = [0, 0, 0]\naxis = [0, 0, 1]')
    .replace("translate = [0, 0, -0.1]", "translate = [0, 0, -0.1]\nmotions.top.rotate = 0")
    + """
[materials.m]
young = 10.0
poisson = 0.3
law = "neo-hookean"
[solver]
method = "monolithic"
slip_sum = "local"
penalty_normal = 100
penalty_tangential = 10
penalty_growth = 2
penalty_growth_max = 200
augmentation_tolerance = 0.01
augmentation_norm = "separate"
newton_tolerance = 1e-9
complementarity_tolerance = 1e-8
max_augmentations = 100
max_iterations = 30
max_cuts = 8
measures = ["forgiving", "margin", "reversal", "halving", "keeping", "extrapolation"]
engine = "own"
compression = 0
"""
)
#: Gauss points by order, from 1 on, of elements and of slave elements: Table 1 of the paper, and beyond it the order and two.
POINTS: dict[Family, tuple[tuple[int, ...], ...]] = {
    "N": ((2, 4, 6, 6, 7, 8, 9), (4, 6, 6, 6, 7, 8, 9)),
    "L": ((2, 4, 4, 6), (4, 4, 9, 12)),
}


def one_element(family: Family, order: int) -> Direction:
    """A direction of one element."""
    ends = [0.0, 1.0] if family == "L" else [0.0] * (order + 1) + [1.0] * (order + 1)
    return Direction(family, order, np.array(ends))


def by_hand() -> Problem:
    """The scene made in Python of what it must be given."""
    patch = mesh(bowl((0.0, 0.0), 0.5, 0.0, 0.1, 0.6), ("N", "N", "N"), (2, 3, 1), (3, 2, 1))
    return Problem(
        name="quiet",
        bodies=(Body("block", patch, Material(), (4, 6, 2)),),
        contacts=(Contact("floor", Face("block", "w0"), RigidPlane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)), 0.3, (6, 6)),),
        supports=(Support("top", Face("block", "w1"), (Motion((0.0, 0.0, -0.1)), Motion())),),
        stages=(Stage("press", 2), Stage("hold", 1)),
    )


def of_two_orders(low: int, high: int) -> bool:
    """Whether a body of an order and a higher one at its contact has other numbers of Gauss points."""
    mesh = ["bodies.block.geometry={ kind = 'box', lower = [0, 0, 0], upper = [1, 1, 1] }", f"bodies.block.mesh.order=[{low}, {low}, 1]"]
    (block,) = Scene.from_toml(SILENT, overrides=[*mesh, f"bodies.block.mesh.contact_order={high}"]).problem().bodies
    points = int(np.maximum(POINTS["N"][0][low - 1], high + 1))
    return block.quadrature != (points, points, POINTS["N"][0][0])


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """What a schema says, by where."""
    if isinstance(value, dict):
        for key, entry in value.items():
            yield from leaves(entry, f"{path}/{key}")
    else:
        yield path, repr(value)


@case(
    claim="Keys of scene files, what they allow and mean, and what they are where nothing is said are those of the published schema.",
    tier="gate",
    bounds={
        "others": Bound(0.0, 0.0, "definition: words and numbers of the schema that differ"),
        "said": Bound(at_least=500.0, reason="definition: or nothing is compared"),
    },
)
def keys() -> dict[str, float]:
    """How many."""
    published, own = (dict(leaves(schema)) for schema in (json.loads(PUBLISHED.read_text(encoding="utf-8")), json_schema()))
    others = [path for path in published.keys() | own.keys() if published.get(path) != own.get(path)]
    return {"others": float(len(others)), "said": float(len(published))}


@case(
    claim="A scene that says nothing is the one that says what is documented, and that made in Python of what it must be given; Gauss "
    "points are those of the paper's table.",
    tier="gate",
    bounds={
        "scene": Bound(0.0, 0.0, "definition: what differs where all is said"),
        "by hand": Bound(0.0, 0.0, "definition: what differs from what is made in Python"),
        "points": Bound(0.0, 0.0, "definition: orders with other numbers of Gauss points"),
        "two orders": Bound(
            0.0, 0.0, "definition: bodies of two orders with other numbers: those of the lower one, and one more than the higher"
        ),
    },
)
def silence() -> dict[str, float]:
    """How much differs."""
    silent, spoken = (Scene.from_toml(text).problem() for text in (SILENT, SPOKEN))
    wrong = 0
    for family, rules in POINTS.items():
        for rule, points in zip((volume_points, contact_points), rules, strict=True):
            lines = [one_element(family, order) for order in range(1, len(points) + 1)]
            wrong += sum(rule(line) != count for line, count in zip(lines, points, strict=True))
    return {
        "scene": float(len(differences(silent, spoken))),
        "by hand": float(len(differences(silent, by_hand())) + (silent.settings != by_hand().settings)),
        "points": float(wrong),
        "two orders": float(sum(of_two_orders(low, high) for low in range(1, 4) for high in range(low + 1, 7))),
    }


@case(
    claim="A contact that says nothing of projection, points and cells takes what its master's lines need: averaged normals beside lines "
    "inside, unless the paper's slip sum or a pole is there; cells that come down to its elements.",
    tier="gate",
    bounds={
        "projections": Bound(0.0, 0.0, "definition: contacts that take another one, or say that somebody asked for it"),
        "cells": Bound(0.0, 0.0, "definition: contacts with other cells or points"),
    },
)
def by_itself() -> dict[str, float]:
    """How many take something else."""
    projections = cells = 0
    for change, projection, by_default in PROJECTIONS:
        (contact,) = Scene.from_toml(PAIR, overrides=change).problem().contacts
        projections += (contact.projection, contact.by_default) != (projection, by_default)
    for changes, subcells, points in NEEDED:
        (contact,) = Scene.from_toml(PAIR, overrides=changes).problem().contacts
        cells += (contact.subcells, contact.quadrature) != (subcells, points)
    return {"projections": float(projections), "cells": float(cells)}
