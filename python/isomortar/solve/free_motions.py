"""Rigid motions that supports leave bodies, with all that is glued to them, where these are; and how some of them together are told."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Problem
from isomortar.model.glue import named
from isomortar.model.numbering import Numbering
from isomortar.model.rank import extent, motions_left, moved
from isomortar.model.supports import Supports

#: A motion is a turn where the body's ends go this share of its way apart.
TURNS = 0.01
#: Bodies go along where they go this share of the farthest one's way.
GOES = 0.1


@frozen
class FreeMotion:
    """A rigid motion that supports leave a piece.

    Attributes
    ----------
    piece : int
        Its number.
    amounts : ndarray, shape (6,)
        Along the axes, and about them by its size: see `moved`.
    displacement : ndarray, shape (control points, 3)
        What it does to all control points.
    """

    piece: int
    amounts: FloatArray
    displacement: FloatArray


def free_motions(problem: Problem, numbering: Numbering, supports: Supports, positions: FloatArray) -> list[FreeMotion]:
    """Those of all pieces at some positions of all control points, as the supports of a stage leave them."""
    found = []
    for k, piece in enumerate(numbering.pieces):
        own = np.concatenate([numbering.points[body.name] for body in piece])
        for amounts in motions_left(problem, piece, supports.stage):
            displacement = np.zeros_like(positions)
            displacement[own] = moved(piece, amounts, positions[own])
            found.append(FreeMotion(k, amounts, displacement))
    return found


def loaded_motions(problem: Problem, numbering: Numbering, supports: Supports, positions: FloatArray) -> list[FreeMotion]:
    """The same; none where no loads act."""
    return free_motions(problem, numbering, supports, positions) if problem.loads or supports.plates else []


@frozen
class Going:
    """Bodies that go on some way together, by the one that goes farthest: shift, turn about its middle, shapes (3,), and size."""

    bodies: str
    shift: FloatArray
    turn: FloatArray
    middle: FloatArray
    size: float

    @property
    def turns(self) -> bool:
        """Whether it turns more than it goes."""
        return bool(self.turn.any())

    def through(self, origin: FloatArray) -> str:
        """A point of the axis that it turns about, by coordinates less an origin, in words: to a thousandth of its size."""
        place = self.middle + np.cross(self.turn, self.shift) / (self.turn @ self.turn) + origin
        unit = 10.0 ** (np.floor(np.log10(self.size)) - 3.0)
        return ", ".join(f"{value:.10g}" for value in np.round(place / unit) * unit + 0.0)


def going(numbering: Numbering, motions: Sequence[FreeMotion], way: FloatArray) -> Going:
    """What goes by shares of motions."""
    goes = np.zeros((len(numbering.pieces), 6))
    for share, motion in zip(way, motions, strict=True):
        goes[motion.piece] += share * motion.amounts
    lengths = np.linalg.norm(goes, axis=1)
    first = numbering.pieces[int(np.argmax(lengths))]
    bodies = [named(piece, piece[0].name) for piece, length in zip(numbering.pieces, lengths, strict=True) if length > GOES * lengths.max()]
    shift, turn = goes[np.argmax(lengths)].reshape(2, 3)
    middle, size = extent(first)
    turns = np.linalg.norm(turn) > TURNS * np.linalg.norm(shift)
    return Going(" and ".join(bodies), shift, turn / size if turns else np.zeros(3), middle, size)


def direction(rates: FloatArray) -> str:
    """Where a motion goes, or the axis that it turns about, in words."""
    return ", ".join(f"{value:g}" for value in np.round(rates / np.linalg.norm(rates), 2) + 0.0)
