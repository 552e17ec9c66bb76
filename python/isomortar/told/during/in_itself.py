"""Bodies that have come into themselves while they deformed: strips whose ends pass each other, rings that are pressed flat."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from isomortar.geometry.faces import spread
from isomortar.geometry.nearest import product
from isomortar.geometry.patch import FloatArray
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Body, Problem

#: Cells of a body's outside that are looked at, about as many, spread over it: a sixtieth of a face stands for each.
SOME = 400
#: Distance of such cells, over the root of the area that each stands for, up to which they are near.
NEAR = 2.0
#: What is left of the distance of parts that have come to each other: bodies are hardly ever squeezed to a third.
LEFT = 0.3
#: Places that are looked at of those where a body may be in itself, about as many: each takes a millisecond or two.
PLACES = 40
#: Depth over the body's thickness by which parts of it have to be in others: what only touches is less.
DEEP = 0.02
#: How often the outside goes round a place from which on that is in the body twice, halfway between once and twice.
TWICE = 1.5


class InItself:
    """Warnings of bodies that are in themselves; each is told of once.

    Attributes
    ----------
    needed : bool
        Whether there are bodies that may come to be: such as deform, and no faces of which are in contact with each other.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        sides = [(c.slave.faces, getattr(c.master, "faces", ())) for c in problem.contacts]
        kept = {one.body for slave, master in sides for one in slave for other in master if one.body == other.body}
        self._left = {body.name for body in problem.deformable} - kept
        self.needed = bool(self._left)

    def after_stage(self, deformed: Sequence[Body], stage: str) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to."""
        for body in deformed:
            place = _in_itself(body, self._problem.body(body.name)) if body.name in self._left else None
            if place is not None:
                self._left.discard(body.name)
                x, y, z = (f"{part:.3g}" for part in place)
                yield (
                    f"body {body.name!r} is in itself at the end of stage {stage!r}, about ({x}, {y}, {z}): nothing keeps its parts from "
                    "each other. End the motions earlier; or, if it is two of its faces that meet, give these a table contacts.NAME with "
                    "slave and master"
                )


def _in_itself(body: Body, before: Body) -> FloatArray | None:
    """A place in a body that is in it by more than the part below whose outside it is; None if there is none."""
    return next((place for place in _come_near(body, before) if body.outside.turns(place) > TWICE), None)


def _come_near(body: Body, before: Body) -> FloatArray:
    """Places a little below those of a body's outside that are near others which were far from them."""
    faces = [face for face in body.outside.sides if face in before.outside.sides]
    every = spread(sum(len(body.outside.sides[face].areas) for face in faces), SOME)
    points, normals, areas = (_some(body, faces, name, every) for name in ("centres", "normals", "areas"))
    first = _some(before, faces, "centres", every)
    now, then = _squares(points), _squares(first)
    near = np.flatnonzero(np.any((now < LEFT**2 * then) & (now < NEAR**2 * every * areas[:, None]), axis=1))
    near = near[:: max(1, len(near) // PLACES)]
    deep = DEEP * float(np.min([lengths.sum() for lengths in element_lengths(body.patch)]))
    return np.asarray(points[near] - deep * normals[near])


def _some(body: Body, faces: Sequence[str], name: str, every: int) -> FloatArray:
    """Of every so manyth cell of a body's outside."""
    return np.concatenate([getattr(body.outside.sides[face], name) for face in faces])[::every]


def _squares(points: FloatArray) -> FloatArray:
    """Of the distances of each from each."""
    points = points - points.mean(axis=0)
    squares = np.einsum("ij,ij->i", points, points)
    return np.asarray(squares[:, None] + squares - 2.0 * product(points, points.T))
