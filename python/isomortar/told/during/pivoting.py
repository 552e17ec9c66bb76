"""Friction of contact that turns about its normal within few elements: one direction for each control point cancels what turns there."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar import _bindings
from isomortar._bindings import FaceArrays
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Problem
from isomortar.model.pairs import Pair
from isomortar.model.shares import percent
from isomortar.model.sheet import Sheet
from isomortar.solve.contact import PairMechanics, PutOff
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import slave_points

#: Share of its work that friction may lose before it is told: moments of balls that turn on blocks were too small by about as much, with
#: three rows of control points and more by less than a tenth.
LOST = 0.1
#: Share of the slips' squares about their mean that a turn as a whole has, from which on all of a contact turns. Of balls whose middle
#: still sticks it is 0.1 to 0.8, and what slips are there by elastic deformation alone is no work that friction loses.
TURNS = 0.9


@frozen
class Pivot:
    """How a contact that slips turns.

    Attributes
    ----------
    lost : float
        Share of friction's work by the points' own slips that control points, whose slips are means, do not take up.
    turns : float
        Share of the slips' squares about their mean that a turn as a whole has.
    """

    lost: float
    turns: float

    @property
    def too_coarse(self) -> bool:
        """Whether it is told."""
        return self.lost > LOST and self.turns > TURNS


class Pivoting:
    """Warnings of friction that turns within elements; each is given once a contact.

    Constraints at points have each slip as it is, and of dual ones no work can be told by points.
    """

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._problem = equilibrium.problem
        pairs = enumerate(equilibrium.pairs)
        self._watched = {k: pair for k, pair in pairs if pair.friction.acts and pair.pair.contact.enforcement == "mortar"}

    def after_step(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to: its last increment, whose slips the tractions of the end come from."""
        for number, mechanics in list(self._watched.items()):
            if isinstance(balance.kinematics[number], PutOff):
                continue
            found = pivot(mechanics, balance, number)
            if found.too_coarse:
                del self._watched[number]
                yield _sentence(self._problem, mechanics.pair, found, step)


def pivot(mechanics: PairMechanics, balance: Balance, number: int) -> Pivot:
    """How a contact with friction turns in the last increment (theory 9.21).

    Parameters
    ----------
    mechanics : PairMechanics
        Of a contact of averages with the slave's functions.
    balance : Balance
    number : int
        Of that contact.
    """
    pair, kinematics, response = mechanics.pair, balance.kinematics[number], balance.responses[number]
    projections, control = kinematics.projections, kinematics.control
    counts = (projections.found > 0) & (projections.slips > 0)
    bears = pair.slave.area * mechanics.radius(np.maximum(pair.field(response.pressure), 0.0)) * counts
    first, second = projections.slip.T
    squares = np.einsum("qk,qk->q", control.point_metric, np.column_stack([first**2, 2.0 * first * second, second**2]))
    by_points = float(bears @ np.sqrt(np.maximum(squares, 0.0)))
    taken = float(np.sum((response.traction * control.slip)[response.state > 0]))
    lost = 1.0 - taken / by_points if by_points > 0.0 else 0.0
    return Pivot(lost, turning(pair, balance.positions, kinematics.projections, bears) if lost > LOST else 0.0)


def turning(pair: Pair, positions: FloatArray, projections: _bindings.Projections, weights: FloatArray) -> float:
    """Share of the slips' squares about their mean that the nearest turn of all of them has, with weights of points (theory 9.21)."""
    acts = weights > 0.0
    share = weights[acts] / weights[acts].sum()
    slips = slip_vectors(pair, positions, projections)[acts]
    places, ways = (values - share @ values for values in (slave_points(pair, positions)[acts], slips))
    arms = np.einsum("q,qi,qj->ij", share, places, places)
    turn = np.linalg.pinv(np.trace(arms) * np.eye(3) - arms) @ (share @ np.cross(places, ways))
    squares = float(share @ np.square(ways).sum(axis=1))
    return 1.0 - float(share @ np.square(ways - np.cross(turn, places)).sum(axis=1)) / squares if squares > 0.0 else 0.0


def slip_vectors(pair: Pair, positions: FloatArray, projections: _bindings.Projections) -> FloatArray:
    """Slips of a slave's points in the last increment, shape (points, 3)."""
    return np.asarray(np.einsum("qa,qai->qi", projections.slip, _tangents(pair, positions, projections)))


def _tangents(pair: Pair, positions: FloatArray, projections: _bindings.Projections) -> FloatArray:
    """Those that slips are components along, shape (points, 2, 3): of the master, or of the slave along averaged normals (theory 3.25)."""
    master, slave = pair.master, pair.slave
    if pair.contact.averaged:
        nodes = positions[slave.point[np.repeat(slave.shape.nodes, slave.per_element, axis=0)]]
        return np.asarray(np.einsum("qda,qai->qdi", slave.slopes, nodes))
    if isinstance(master, FaceArrays):
        points, functions = _bindings.surface_functions(master.patch, master.axis, master.side, np.ascontiguousarray(projections.xi))
        return np.asarray(np.einsum("qda,qai->qdi", functions[:, 1:3], positions[pair.master_face[points]]))
    first = master.tangent - (master.tangent @ master.normal) * master.normal / (master.normal @ master.normal)
    first = first / np.linalg.norm(first)
    both = np.stack([first, np.cross(master.normal / np.linalg.norm(master.normal), first)])
    return np.broadcast_to(both, (len(projections.xi), 2, 3))


def _sentence(problem: Problem, pair: Pair, found: Pivot, step: int) -> str:
    """The sentence."""
    slave = pair.contact.slave
    return (
        f"contact {pair.contact.name!r}, load step {step}: it turns about its normal, and friction has one direction for each control "
        f"point of its slave {slave.words}: it takes up {percent(found.lost)} less work than at the slips of points, and its moment is too "
        f"small by about that. Take twice as many elements or more along {' and '.join(Sheet.of(problem, slave).letters)} "
        f"(bodies.{slave.body}.mesh.elements), or shorter ones there (mesh.grading)"
    )
