"""Friction that the coordinates of a master lead astray: slips of feet are differences of these, which may turn or stretch on the way."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar import _bindings
from isomortar._bindings import FaceArrays, Projections
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.pairs import Pair
from isomortar.model.shares import percent
from isomortar.solve.contact import PairMechanics, PutOff
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import pole_elements
from isomortar.solve.metric import traction_norms

#: How far slips may point beside the ways of their feet, as a share of their lengths, before it is told: 2.9 degrees. Scenes of flat and
#: dented masters are below 0.015.
BESIDE = 0.05
#: How much tractions may be over what the law takes them for before it is told. Scenes of flat and dented masters are below 1.01.
BORNE = 1.05
#: Degrees by which the master's normal may turn along the way of a foot that is looked at: beyond, as round an edge, a chord is no way.
BENT = 20.0


class Astray:
    """Warnings of friction that does not go as the feet of a contact do; each is given once a contact."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        pairs = enumerate(equilibrium.pairs)
        self._pairs = [(k, p) for k, p in pairs if p.friction.acts and p.pair.master_face.size and not p.pair.contact.averaged]
        self._told = set[tuple[str, str]]()

    def after_step(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to: its last increment, whose slips the tractions of the end come from."""
        for number, mechanics in self._pairs:
            name = mechanics.pair.contact.name
            if {(name, "beside"), (name, "borne")} <= self._told or isinstance(balance.kinematics[number], PutOff):
                continue
            share, borne = astray(mechanics, balance, number)
            if share > BESIDE and (name, "beside") not in self._told:
                self._told.add((name, "beside"))
                yield (
                    f"contact {name!r}, load step {step}: slips are differences of the master's coordinates, which turn along the way: "
                    f"they are off by {np.degrees(2.0 * np.arcsin(0.5 * share)):.2g} degrees, and so is the direction of friction. "
                    f"Take more load steps{_averaged(mechanics)} (docs/theory.md, 9.7)"
                )
            if borne > BORNE and (name, "borne") not in self._told:
                self._told.add((name, "borne"))
                yield (
                    f"contact {name!r}, load step {step}: its tractions are {percent(borne - 1.0)} more than the law of friction "
                    "takes them for: they are components along the master's coordinates, whose lengths change within elements of the "
                    f"slave. Refine the slave, even out the master's weights{_averaged(mechanics)} (docs/theory.md, 9.8)"
                )


def _averaged(mechanics: PairMechanics) -> str:
    """The other cure, where it is allowed: slips are measured in the slave's basis along averaged normals (theory 3.25)."""
    refused = mechanics.summed or bool(pole_elements(mechanics.pair))
    return "" if refused else f', or take contacts.{mechanics.pair.contact.name}.projection = "averaged"'


def astray(mechanics: PairMechanics, balance: Balance, number: int) -> tuple[float, float]:
    """How far slips point beside the ways of their feet, over their lengths, and tractions over what the law sees (theory 9.7, 9.8).

    Parameters
    ----------
    mechanics : PairMechanics
        Of a contact with friction, and feet at nearest points of a face.
    balance : Balance
    number : int
        Of that contact.
    """
    pair, response, projections = mechanics.pair, balance.responses[number], balance.kinematics[number].projections
    acts = np.repeat(np.any(response.state[pair.slave.test.nodes] > 0, axis=1), pair.slave.per_element)
    points = np.flatnonzero(acts & (projections.slips > 0)).astype(np.int32)
    foot, tangents = _surface(pair, balance.positions, projections.xi[points])
    before, tangents_before = _surface(pair, balance.positions, projections.origin[points])
    normals, normals_before = _normals(tangents), _normals(tangents_before)
    plain = np.einsum("qi,qi->q", normals, normals_before) > np.cos(np.radians(BENT))  # and no number where there is no normal
    points, foot, before, tangents = points[plain], foot[plain], before[plain], tangents[plain]
    area = pair.slave.area[points]
    share = _beside(_slips(projections, points, tangents), _along(foot - before, tangents), area, _least(balance.positions))
    return share, _borne(mechanics, balance, number, points, tangents)


def _normals(tangents: FloatArray) -> FloatArray:
    """Unit normals, shape (points, 3); not numbers where tangents are parallel, or have no length."""
    across, lengths = np.cross(tangents[:, 0], tangents[:, 1]), np.linalg.norm(tangents, axis=2).prod(axis=1)
    sizes = np.linalg.norm(across, axis=1)
    return across / np.where(sizes > constants.CLEAR * lengths, sizes, np.nan)[:, None]


def _borne(mechanics: PairMechanics, balance: Balance, number: int, points: IntArray, tangents: FloatArray) -> float:
    """Norms of control tractions by the metric at each point over those that the law sees; 0 without any (theory 9.8)."""
    test, traction = mechanics.pair.slave.test, balance.responses[number].traction
    nodes = test.nodes[points // mechanics.pair.slave.per_element]
    lengths = traction_norms(balance.kinematics[number].control, traction)
    acting = mechanics.pair.slave.area[points, None] * test.values[points]
    metric = np.linalg.inv(np.einsum("qai,qbi->qab", tangents, tangents))
    squares = np.einsum("qna,qab,qnb->qn", traction[nodes], metric, traction[nodes])
    known = float(np.sum(acting * lengths[nodes]))
    return float(np.sum(acting * np.sqrt(np.maximum(squares, 0.0)))) / known if known > 0.0 else 0.0


def _beside(slips: FloatArray, ways: FloatArray, area: FloatArray, least: float) -> float:
    """Root of the mean square of what slips are off vectors of their lengths along the ways, over that of the slips (theory 9.7)."""
    lengths, travelled = np.linalg.norm(slips, axis=1), np.linalg.norm(ways, axis=1)
    moved = travelled > least
    off = slips[moved] - (lengths[moved] / travelled[moved])[:, None] * ways[moved]
    squares = float(area[moved] @ np.square(lengths[moved]))
    return float(np.sqrt(area[moved] @ np.square(off).sum(axis=1) / squares)) if squares > 0.0 else 0.0


def _least(positions: FloatArray) -> float:
    """Way that is nothing: of points that stick, or have hardly moved."""
    return constants.CLEAR * float(np.abs(positions).max())


def _slips(projections: Projections, points: IntArray, tangents: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("qa,qai->qi", projections.slip[points], tangents))


def _along(vectors: FloatArray, tangents: FloatArray) -> FloatArray:
    """Vectors without what is across the surface."""
    lowered = np.einsum("qai,qi->qa", tangents, vectors)
    return np.asarray(np.einsum("qa,qai->qi", _raised(tangents, lowered), tangents))


def _raised(tangents: FloatArray, lowered: FloatArray) -> FloatArray:
    """Components along tangents of vectors whose products with these are given."""
    metric = np.einsum("qai,qbi->qab", tangents, tangents)
    return np.asarray(np.linalg.solve(metric, lowered[:, :, None])[:, :, 0])


def _surface(pair: Pair, positions: FloatArray, xi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places of the master, shape (points, 3), and tangents there, (points, 2, 3)."""
    master = pair.master
    assert isinstance(master, FaceArrays)
    nodes, functions = _bindings.surface_functions(master.patch, master.axis, master.side, np.ascontiguousarray(xi))
    found = np.einsum("qda,qai->qdi", functions[:, :3], positions[pair.master_face[nodes]])
    return found[:, 0], found[:, 1:]
