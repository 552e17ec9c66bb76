"""What is too large, on either side of its limits: memory beside what there is, and what quadrature leaves of forces."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from unittest.mock import patch

from solid.too_few_points import in_turn
from told.either_way import SCENE as BLOCKS
from told.weights import SCENE as COLUMN
from told.weights import column as contact_of_column

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.model.memory import memory_needed
from isomortar.model.rational import quadrature_error
from isomortar.model.rational_faces import pressure_error
from isomortar.scene import Scene

WITHIN, BEYOND = 0.99, 1.01
#: What quadrature may be off by before it is told, and before it is refused.
TOLD, LOST = 0.01, 0.1
#: Share of the memory there is from which on it is told.
NEAR = 0.5
#: Elements of the upper and of the lower block, and the one that takes more.
MESHES = {"above": ("[9, 8, 7]", "[2, 2, 2]"), "below": ("[2, 2, 2]", "[9, 8, 7]")}


def told_with(text: str, changes: tuple[str, ...], there: float) -> tuple[bool, str]:
    """Whether a scene is refused on a machine with so much memory; and why, or what is said of it."""
    with (
        patch("isomortar.model.checks.memory_of_machine", return_value=there),
        patch("isomortar.told.before.doubts.memory_of_machine", return_value=there),
    ):
        try:
            return False, "; ".join(outlook(Scene.from_toml(text, overrides=changes).problem()).warnings)
        except InputError as error:
            return True, str(error)


@case(
    claim="A scene that would take more than twice the memory that there is is refused, by the body that takes most; one that may take "
    "more than there is is told of.",
    tier="gate",
    grid={"largest": tuple(MESHES)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: machines on which something else is said")},
)
def memory(largest: str) -> dict[str, float]:
    """Of four."""
    above, below = MESHES[largest]
    changes = (f"bodies.above.mesh={{order=2,elements={above}}}", f"bodies.below.mesh={{order=2,elements={below}}}")
    needed, wrong = memory_needed(Scene.from_toml(BLOCKS, overrides=changes).problem()), 0
    for share, is_refused, words in (
        (2.0 * BEYOND, True, f"bodies.{largest}.mesh: Gauss points, tangent and factors would take about"),
        (2.0 * WITHIN, False, "Gauss points, tangent and factors may take"),
        (NEAR * BEYOND, False, "Gauss points, tangent and factors may take"),
        (NEAR * WITHIN, False, ""),
    ):
        refused, said = told_with(BLOCKS, changes, needed / share)
        wrong += refused != is_refused or words not in said or ("factors" in said) != bool(words)
    return {"wrong": float(wrong)}


def contrast_of(error: float) -> float:
    """Weights so many times as large as others of which the quadrature of the body leaves that error."""
    low, high = 1.0, 1e4
    while high / low > 1.0 + 1e-6:
        middle = (low * high) ** 0.5
        low, high = (middle, high) if quadrature_error(in_turn(middle)) < error else (low, middle)
    return low


def column(contrast: float, quadrature: list[int]) -> tuple[bool, str]:
    """Whether a column of such weights is refused, and why, or what is said of it."""
    shape = in_turn(contrast).patch
    lists = {"knots": [d.knots.tolist() for d in shape.directions], "points": shape.control_points.tolist()}
    text = COLUMN.format(**lists, weights=shape.weights.tolist(), elements=3, master="plane = {}", more=", quadrature = 30")
    return told_with(text.replace("quadrature = [60, 60, 2]", f"quadrature = {quadrature}"), (), float("inf"))


@case(
    claim="Rational functions that Gauss points miss by more than a tenth are refused, and by more than a hundredth told of; the points "
    "that are named leave less.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: weights of which something else is said, or that what is named does not cure")},
)
def quadrature() -> dict[str, float]:
    """Of four, and two cures."""
    wrong = 0
    for error, is_refused, is_told in (
        (BEYOND * LOST, True, True),
        (WITHIN * LOST, False, True),
        (BEYOND * TOLD, False, True),
        (WITHIN * TOLD, False, False),
    ):
        contrast = contrast_of(error)
        refused, said = column(contrast, list(in_turn(contrast).quadrature))
        cure = re.search(r"Take bodies.column.mesh.quadrature = (\[[\d, ]+\])", said)
        wrong += refused != is_refused or bool(cure) != is_told
        if cure:
            points = json.loads(cure[1])
            u, v, w = points
            wrong += (
                quadrature_error(replace(in_turn(contrast), quadrature=(u, v, w))) > TOLD or "off by about" in column(contrast, points)[1]
            )
    return {"wrong": float(wrong)}


@case(
    claim="Points of a contact that miss more than a hundredth of a uniform pressure are told of.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: weights on either side of that of which something else is said")},
)
def of_a_contact() -> dict[str, float]:
    """Of two."""
    wrong = 0
    for share in (WITHIN, BEYOND):
        low, high = 1.0, 20.0
        while high / low > 1.0 + 1e-6:
            middle = (low * high) ** 0.5
            problem = contact_of_column(middle, "plane")
            low, high = (middle, high) if pressure_error(problem, problem.contacts[0]) < share * TOLD else (low, middle)
        said = Simulation(contact_of_column(low, "plane")).doubts()
        wrong += any("quadrature points" in sentence for sentence in said) != (share > 1.0)
    return {"wrong": float(wrong)}


def of_spans(ratio: float) -> str:
    """The blocks, of which the lower one has two elements on each other, one so many times as high as the other."""
    low = 1.0 / (1.0 + ratio)
    points = [[x, y, z] for z in (-0.5, -0.5 + 0.5 * low, 0.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)]
    knots = [[0, 0, 1, 1], [0, 0, 1, 1], [0, 0, low, 1, 1]]
    start, end = BLOCKS.index("bodies.below.geometry"), BLOCKS.index("contacts.c")
    return f"{BLOCKS[:start]}bodies.below.patch = {{ order = 1, knots = {knots}, control_points = {points} }}\n{BLOCKS[end:]}"


#: How many times as long elements are, and whether that is told.
SPANS = {0.99e7: False, 1.01e7: True}
#: Parts of its force that the upper block's elements of order 1 add by their Poisson's ratio (theory 9.1), and how that is told.
LOCKING = {0.98: "come out some 100 % too large", 1.02: "come out several times too large"}


@case(
    claim="Elements along a direction that are ten million times as long as others are told of, and not less; and how much elements lock "
    "in words where it is more than all of the force.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: blocks of which something else is said")},
)
def of_elements() -> dict[str, float]:
    """Of four."""
    wrong = sum(("lost in round-off" in told_with(of_spans(ratio), (), float("inf"))[1]) != is_told for ratio, is_told in SPANS.items())
    for share, words in LOCKING.items():
        moduli = share / 0.02 + 13.0 / 6.0  # bulk over shear modulus, of elements half as long as the block
        poisson = (3.0 * moduli - 2.0) / (2.0 * (3.0 * moduli + 1.0))
        material = (f"materials={{soft={{young=1,poisson={poisson!r}}}}}", "bodies.above.mesh={order=1,elements=[4,2,2]}")
        wrong += words not in told_with(BLOCKS, material, float("inf"))[1]
    return {"wrong": float(wrong)}
