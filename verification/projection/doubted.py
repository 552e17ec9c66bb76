"""Feet that do not follow their points, or cannot slip: refused where contact acts, and nowhere else."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from isomortar._codes import Status
from isomortar.errors import LostProjectionError
from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.feet import Feet
from isomortar.solve.timing import Ledger

#: A slave of four elements in a row on a master.
SCENE = """
format = 1
bodies.slave = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1, elements = [4, 1, 1] } }
bodies.master.geometry = { kind = "box", lower = [-1, -1, -1], upper = [2, 2, 0] }
contacts.c = { slave = "slave.w0", master = "master.w1", friction = FRICTION, projection = "closest" }
supports = { top.face = "slave.w1", below.face = "master.w0" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.1] }]
"""
#: Kinds of doubt that the projection tells, with words of what is said, and whether what does not rub may do with it.
KINDS = (
    (Status.LOST_PROJECTION, "does not settle", False),
    (Status.DEGENERATE_SURFACE, "no direction to press in", False),
    (Status.NO_SLIP, "slips have no measure there", True),
)

#: Where coordinates count from within a run of a scene that is far away, in those of the scene.
ORIGIN = np.array([50.0, -30.0, 0.0])


def gauss_points(count: int) -> np.ndarray:
    """Quadrature points of the slave's face, so many by direction in each of four elements along x, shape (points, 3)."""
    share = 0.5 + 0.5 * np.polynomial.legendre.leggauss(count)[0]
    element, y, x = np.meshgrid(np.arange(4), share, share, indexing="ij")
    return np.column_stack([0.25 * (element + x).ravel(), y.ravel(), np.zeros(x.size)])


@case(
    claim="A doubtful foot is refused by its point, in words of its doubt, where contact acts; one that cannot slip, with friction alone.",
    tier="gate",
    grid={"friction": (0.0, 0.3)},
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: feet that are refused for something else, or for nothing, or should not be"),
        "places": Bound(at_most=0.0051, reason="definition: where points are in the coordinates of the scene; four digits are told"),
    },
)
def doubted(friction: float) -> dict[str, float]:
    """How many, of every point by every doubt, under contact in every element alone; how far told places are off."""
    equilibrium = Equilibrium(Scene.from_toml(SCENE.replace("FRICTION", str(friction))).problem(), Ledger())
    positions, pair = equilibrium.numbering.reference, equilibrium.pairs[0]
    found = pair.kinematics(positions, equilibrium.initial_state().contacts[0]).projections
    feet, nodes, points = Feet(pair.pair, ORIGIN), pair.pair.slave.test.nodes, len(found.found)
    wrong, off, places = 0, 0.0, ORIGIN + gauss_points(round(np.sqrt(pair.pair.slave.per_element)))
    for status, words, without_slips in KINDS:
        for q in range(points):
            doubt = np.zeros(points, dtype=np.int32)
            doubt[q] = status
            for element in range(-1, len(nodes)):
                state = np.isin(np.arange(pair.pair.slave.test.count), nodes[element] if element >= 0 else []).astype(np.int32)
                acts = bool(state[nodes[q // pair.pair.slave.per_element]].any())
                refused = acts and not (without_slips and friction == 0.0)
                try:
                    feet.check(positions, replace(found, doubt=doubt), SimpleNamespace(state=state))  # type: ignore[arg-type]
                    wrong += refused
                except LostProjectionError as error:
                    wrong += not refused or error.place != q or words not in str(error)
                    told = re.search(r" at \((\S+), (\S+), (\S+)\), with a gap of", str(error))
                    off = float(np.maximum(off, np.abs(np.array(told.groups(), float) - places[q]).max() if told else np.inf))
    return {"wrong": float(wrong), "places": off}


@case(
    claim="Forces of a contact are refused where a foot does not follow its point, and not where nothing acts.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: doubts that forces are made of, or that are refused where nothing acts")},
)
def asked() -> dict[str, float]:
    """Of how many kinds, with contact all over and with none."""
    equilibrium = Equilibrium(Scene.from_toml(SCENE.replace("FRICTION", "0.3")).problem(), Ledger())
    positions, pair, start = equilibrium.numbering.reference, equilibrium.pairs[0], equilibrium.initial_state().contacts[0]
    kinematics, wrong = pair.kinematics(positions, start), 0
    for status, _, _ in KINDS:
        doubt = np.full(len(kinematics.projections.found), status, dtype=np.int32)
        doubtful = replace(kinematics, projections=replace(kinematics.projections, doubt=doubt))
        for acts in (True, False):
            response = pair.bearing(replace(start, pressure=np.full(len(start.pressure), float(acts))))
            try:
                pair.add_forces(positions, doubtful, response, np.zeros_like(positions))
                wrong += acts
            except LostProjectionError:
                wrong += not acts
    return {"wrong": float(wrong)}


#: A slave on a ball, or a disc, of which all elements end at a pole, or of which those next to the slave do not.
ON_A_BALL = """
format = 1
bodies.slave.geometry = { kind = "box", lower = [-0.1, -0.1, 1], upper = [0.1, 0.1, 1.2] }
bodies.ball = { geometry = { kind = "sphere", outer = 1, axis = "y" }, mesh.elements = [4, 1, ELEMENTS], rigid = true }
contacts.c = { slave = "slave.w0", master = "ball.v1", friction = FRICTION, projection = "closest" }
supports.top.face = "slave.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.1] }]
"""
_AT_POLE = "ends at a pole"


def said_of(feet: Feet, positions: np.ndarray, *given: object) -> str:
    """Why feet are refused; nothing, where they are not."""
    try:
        feet.check(positions, *given)  # type: ignore[arg-type]
    except LostProjectionError as error:
        return str(error)
    return ""


@case(
    claim="Feet in elements that end at a pole are refused with friction alone, and other doubts of them are told as they are.",
    tier="gate",
    grid={"friction": (0.0, 0.3), "elements": (2, 6)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: doubts of which something else is said")},
)
def at_poles(friction: float, elements: int) -> dict[str, float]:
    """Of no doubt, and each kind of it."""
    equilibrium = Equilibrium(
        Scene.from_toml(ON_A_BALL.replace("FRICTION", str(friction)).replace("ELEMENTS", str(elements))).problem(), Ledger()
    )
    positions, pair = equilibrium.numbering.reference, equilibrium.pairs[0]
    found = pair.kinematics(positions, equilibrium.initial_state().contacts[0]).projections
    feet, acts = Feet(pair.pair, ORIGIN), SimpleNamespace(state=np.ones(pair.pair.slave.test.count, dtype=np.int32))
    wrong = 0
    for status, words, without_slips in ((0, _AT_POLE if elements == 2 else "", True), *KINDS):
        said = said_of(feet, positions, replace(found, doubt=np.full(len(found.found), status, dtype=np.int32)), acts)
        expected = "" if without_slips and friction == 0.0 else words
        wrong += expected not in said or bool(said) != bool(expected)
    return {"wrong": float(wrong)}


@case(
    claim="A point that the projection gives up is told with its contact and where it is, round-off as zero; of positions that are no "
    "numbers without that.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: points of which something else is said")},
)
def given_up() -> dict[str, float]:
    """Of three: as it is, next to zero, and nowhere."""
    equilibrium = Equilibrium(Scene.from_toml(SCENE.replace("FRICTION", "0.3")).problem(), Ledger())
    positions, pair = equilibrium.numbering.reference, equilibrium.pairs[0].pair
    x, y, _ = gauss_points(round(np.sqrt(pair.slave.per_element)))[0]
    places = (
        (positions, f", at ({x:.4g}, {y:.4g}, 0)"),
        (positions + 1e-13, f", at ({x:.4g}, {y:.4g}, 0)"),
        (positions + 1e-6, f", at ({x:.4g}, {y:.4g}, 1e-06)"),
        (positions * np.nan, ""),
    )
    feet, error = Feet(pair, np.zeros(3)), LostProjectionError("it is lost", 0)
    said = [str(feet.named(error, at)) for at, _ in places]
    return {"wrong": float(sum(one != f"contact 'c': it is lost{where}" for one, (_, where) in zip(said, places, strict=True)))}
