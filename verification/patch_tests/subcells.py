"""Quadrature that sees the master: cells of the slave's elements, cut where knot lines of the master cross them."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import patch

import numpy as np
from patch_tests.contact import ORDERS, TILTS, default_rule, errors, nested_bounds, problem
from transforms import oriented

from isomortar.geometry.patch import Direction, FloatArray
from isomortar.harness import Bound, Shown, case
from isomortar.harness.cases import Tier
from isomortar.model import constants, pairs
from isomortar.model.enforcement import SlaveFace, slave_side
from isomortar.model.enforcement.integration import integrated
from isomortar.model.enforcement.subcells import Subcells
from isomortar.model.entities import Face, Problem
from isomortar.model.numbering import Numbering

#: Master elements on the three of the slave: up to three knot lines cross one, nowhere where halving would find them.
MASTER_ELEMENTS = 7
#: Enough for these: a cut each way leaves half of the lines on either side.
SUBCELLS = 2
#: Cuts after which cells over an oblique mesh are compared.
FEW, MANY = 3, 5
#: The slave of oblique meshes is turned by so many degrees, about its middle: well across, and so little that cells become slivers.
TURNS = [20.0, 1.0, 0.01]
#: It is this much smaller than its master.
SHARE = 0.6
#: Master elements of tests whose lines have moved, and by which shares of these along both directions: nowhere onto points of a cell.
SLID = (2, 4, 7)
PLACES = ((0.13, -0.21), (0.3, 0.42), (-0.4, 0.08), (0.45, 0.25), (-0.07, -0.33))


def tier(slave_order: int, master_order: int, tilt: float) -> Tier:
    """Equal orders and the first with the third stand for the others at the gate."""
    shown = slave_order == master_order <= 4 or {slave_order, master_order} == {1, 3}
    return "gate" if shown and tilt == TILTS[-1] else "nightly"


@case(
    claim="With contact elements cut along the master's knot lines a uniform pressure passes a non-matching interface, to round-off.",
    tier=tier,
    grid={"slave_order": ORDERS, "master_order": ORDERS, "tilt": TILTS},
    bounds=nested_bounds,
)
def uniform_pressure_in_cells(slave_order: int, master_order: int, tilt: float) -> dict[str, float]:
    """Error of the pressure field; as many points a cell as the product of both sides' functions needs."""
    given = problem(slave_order, master_order, tilt, (slave_order + master_order) // 2 + 1, MASTER_ELEMENTS)
    contact = replace(given.contacts[0], subcells=SUBCELLS)
    settings = replace(given.settings, measures=())  # a tangent for every solve: the last one goes far below the tolerance
    return {"pressure": errors(replace(given, contacts=(contact,), settings=settings)).field}


def by_default_tier(slave_order: int, master_order: int, elements: int) -> Tier:
    """Orders that are equal up to three, and the first with the others, stand for all of them at the gate."""
    low = max(slave_order, master_order) <= 3 and (slave_order == master_order or 1 in (slave_order, master_order))
    return "gate" if low and elements in (5, 7) else "nightly"


@case(
    claim="What a contact takes that says nothing of quadrature passes a non-matching interface to round-off, whatever orders and meshes.",
    tier=by_default_tier,
    grid={"slave_order": ORDERS, "master_order": ORDERS, "elements": (2, 4, 5, 7, 13)},
    bounds=lambda slave_order, master_order, elements: nested_bounds(slave_order, master_order, TILTS[-1]),  # noqa: ARG005
)
def uniform_pressure_by_default(slave_order: int, master_order: int, elements: int) -> dict[str, float]:
    """Error of the pressure field by cells and points that the program chooses."""
    given = problem(slave_order, master_order, TILTS[-1], default_rule(slave_order)[0], elements)
    contact = integrated(given.contacts[0], given)
    settings = replace(given.settings, measures=())  # as above
    return {"pressure": errors(replace(given, contacts=(contact,), settings=settings)).field}


def moved(given: Problem, by: tuple[float, float]) -> Problem:
    """A level test whose master's knot lines lie farther along both directions by shares of its elements; its shape is what it was."""
    contact = given.contacts[0]
    assert isinstance(contact.master, Face)
    master = given.body(contact.master.body)
    shape = master.patch
    directions = list(shape.directions)
    points = shape.control_points.reshape(*shape.shape[::-1], 3).copy()
    for axis in (0, 1):
        direction = directions[axis]
        inner = slice(direction.order + 1, -direction.order - 1)
        lines = direction.knots.copy()
        lines[inner] += by[axis] / direction.elements
        directions[axis] = Direction(direction.family, direction.order, lines)
        points[..., axis] = np.expand_dims(directions[axis].greville, (0, 1) if axis == 0 else (0, 2))
    other = replace(shape, directions=(directions[0], directions[1], directions[2]), control_points=points.reshape(-1, 3))
    return replace(given, bodies=tuple(replace(master, patch=other) if body is master else body for body in given.bodies))


def by_default(order: int, elements: int) -> Problem:
    """A level test of one order, integrated as the program chooses."""
    given = problem(order, order, 0.0, default_rule(order)[0], elements)
    return replace(given, contacts=(integrated(given.contacts[0], given),))


@case(
    claim="Where bodies have slid since cells were cut, errors are about those of whole elements by the paper's points.",
    tier=lambda order, elements: "gate" if elements == SLID[1] and order < 3 else "nightly",
    grid={"order": ORDERS[:3], "elements": SLID},
    bounds={
        "cells": Shown("quadrature: median of the pressures' largest errors, in cells"),
        "whole": Shown("quadrature: the same in whole elements"),
        "ratio": Bound(at_most=2.0, reason="quadrature: either rule misses kinks, by points that are about as dense"),
    },
)
def uniform_pressure_after_sliding(order: int, elements: int) -> dict[str, float]:
    """Median errors of the pressure field with the master's lines at five places, in cells that were cut at another one, and without."""
    cut = by_default(order, elements)
    whole = problem(order, order, 0.0, default_rule(order)[0], elements)
    side = slave_side(cut.contacts[0], cut, Numbering(cut))
    found = []
    for by in PLACES:
        with patch.object(pairs, "slave_side", return_value=side):
            in_cells = errors(moved(cut, by)).field
        found.append([in_cells, errors(moved(whole, by)).field])
    in_cells, in_whole = np.median(found, axis=0).tolist()
    return {"cells": in_cells, "whole": in_whole, "ratio": in_cells / in_whole}


def rotation(turn: float) -> FloatArray:
    """By which the slave of oblique meshes is turned."""
    angle = np.deg2rad(turn)
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def turned(subcells: int, turn: float) -> Problem:
    """The lower block's upper face as a master of linear elements, and a smaller slave on it, turned."""
    given = problem(1, 1, 0.0, 2, MASTER_ELEMENTS)
    contact = replace(given.contacts[0], subcells=subcells)
    slave = given.body(contact.slave.body)
    points = slave.patch.control_points.copy()
    points[:, :2] = 0.5 + SHARE * (points[:, :2] - 0.5) @ rotation(turn).T
    moved = replace(slave, patch=replace(slave.patch, control_points=points))
    return replace(given, bodies=tuple(moved if body is slave else body for body in given.bodies), contacts=(contact,))


def crossed(subcells: int, turn: float) -> tuple[float, float, float]:
    """Share of the face in cells over several elements of the master; error of the sum of all areas; the least length of a cell.

    Of a cell counts what is twice the margin away from its bounds: lines nearer to them are left alone.
    """
    given = turned(subcells, turn)
    face = SlaveFace(given.contacts[0], given, Numbering(given))
    cells = Subcells(face)
    inset = 2.0 * constants.CELL_MARGIN * np.array([1.0 / direction.elements for direction in face.directions])
    low = cells.low + inset
    size = np.maximum(cells.high - inset - low, 0.0)
    line = np.linspace(0.0, 1.0, 9)
    at = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    places = 0.5 + SHARE * (low[:, None] + size[:, None] * at - 0.5) @ rotation(turn).T
    below = np.floor(MASTER_ELEMENTS * places)
    several = np.any(below != below[:, :1], axis=(1, 2))
    lengths = cells.high - cells.low
    share = float(np.prod(lengths, axis=1)[several].sum())
    return share, abs(float(cells.gauss()[3].sum()) / SHARE**2 - 1.0), float(lengths.min())


@case(
    claim="Over an oblique mesh cells fill the face, each inside the one it was cut from, and close in on the master's knot lines.",
    grid={"turn": TURNS},
    bounds={
        "shortest": Bound(at_least=1e-7, reason="definition: a cell that reached beyond the one it was cut from has a negative length"),
        "areas": Bound(at_most=1e-13, reason="round-off: cells do not overlap, and leave nothing out"),
        "left": Bound(
            at_most=0.75 ** (MANY - FEW), reason="theory: of the four parts of a cell that a line crosses one at least lies beside it"
        ),
    },
)
def cells_over_an_oblique_mesh(turn: float) -> dict[str, float]:
    """Error of the sum of areas, the least length; what two more cuts leave of the area of cells over several elements of the master."""
    few, many = crossed(FEW, turn), crossed(MANY, turn)
    return {"shortest": many[2], "areas": max(few[1], many[1]), "left": many[0] / few[0]}


@case(
    claim="Of two lines that a cell's edges meet the one nearer to its middle cuts it, both if they are as near: cells are the same "
    "whichever way the slave's coordinates run.",
    grid={"turn": TURNS, "stands": ("askew", "in the middle")},
    bounds=lambda turn, **_: {
        "apart": Bound(
            at_most=2e-15 / np.tan(np.deg2rad(turn)), reason="round-off: of coordinates of size one, over the slope of the lines"
        ),
    },
)
def cells_either_way(turn: float, stands: str) -> dict[str, float]:
    """Largest distance of bounds of cells, after two cuts, from those of a slave whose coordinates run the other way.

    In the middle of its master, whose mesh is its own image there, lines come in pairs that are as near.
    """
    given = turned(2, turn)
    (contact,) = given.contacts
    slave = given.body(contact.slave.body)
    points = slave.patch.control_points + (np.array([0.0131, 0.0273, 0.0]) if stands == "askew" else 0.0)
    askew = tuple(replace(body, patch=replace(body.patch, control_points=points)) if body is slave else body for body in given.bodies)
    one = replace(given, bodies=askew)
    cells, other = (Subcells(SlaveFace(p.contacts[0], p, Numbering(p))) for p in (one, oriented(one, slave.name, (0, 1, 2), (0, 1))))
    found = np.column_stack([cells.low, cells.high]), np.column_stack([1.0 - other.high, 1.0 - other.low])
    assert len(found[0]) == len(found[1]), "as many cells"
    ordered = [bounds[np.lexsort(np.round(bounds, 9).T)] for bounds in found]
    return {"apart": float(np.abs(ordered[0] - ordered[1]).max())}
