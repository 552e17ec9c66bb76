"""Bodies in contact that come into each other by faces that have no contact there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from isomortar.geometry.faces import Cells, spread
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body, Face, Problem
from isomortar.told.meeting import in_box, least_depth

#: Volume in the other body over that of a face in contact from which on a face is told: with one flank of a wedge in contact the other one
#: had 2.3 to 23 times as much, its ends, where edges that are in contact come in by as much as their elements do not see, up to 0.05.
MORE = 2.0
#: Depth over the largest one from which on faces are as deep as each other, and the first is told: those that mirror each other differ by
#: what Newton's method leaves.
ALIKE = 1.0 - 1e-5
#: Cells of a face that are looked at, about as many, spread over it: so many do for a volume, of which a factor of two is asked.
SOME = 320


class OtherFaces:
    """Warnings of faces without a contact that are in a body with which their own body is in contact by others; each pair is told of once.

    Attributes
    ----------
    needed : bool
        Whether there are bodies in contact with each other.
    """

    def __init__(self, problem: Problem) -> None:
        self._touching = dict[tuple[str, str], set[str]]()
        for contact in problem.contacts:
            for one in contact.slave.faces:
                for other in getattr(contact.master, "faces", ()):
                    for mine, theirs in ((one, other), (other, one)) if one.body != other.body else ():
                        self._touching.setdefault((mine.body, theirs.body), set()).add(mine.face)
        self.needed = bool(self._touching)
        self._told = set[tuple[str, str]]()

    def after_stage(self, deformed: Sequence[Body], stage: str) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to."""
        bodies = {body.name: body for body in deformed}
        for names, touching in self._touching.items():
            if names in self._told:
                continue
            one, other = (bodies[name] for name in names)
            depths = _depths(one, other, touching)
            most = max(depths.values(), default=0.0)
            face = next((face for face, depth in depths.items() if depth > ALIKE * most), "")
            if face:
                self._told.add(names)
                yield (
                    f"body {one.name!r} is in body {other.name!r} at the end of stage {stage!r}, by {depths[face]:.3g}, and nothing keeps "
                    f"its face {Face(one.name, face).words} from it: their contact is between other faces, and forces lack what this one "
                    "would bear. Give that face a contact, too, or list it beside the other one"
                )


def _depths(one: Body, other: Body, touching: set[str]) -> Mapping[str, float]:
    """How deep faces of a body without contact are in another one, of those that are in it by more than others in contact are."""
    least = least_depth(one, other)
    free = {face: _some(side) for face, side in one.outside.sides.items() if face not in touching}
    found = {face: other.outside.deepest(points[in_box(points, other, -least)], least) for face, (points, _) in free.items()}
    deep = {face: depth for face, depth in found.items() if depth > 0.0}
    if not deep:
        return {}
    held = max((_volume(*_some(side), other) for face, side in one.outside.sides.items() if face in touching), default=0.0)
    return {face: depth for face, depth in deep.items() if _volume(*free[face], other) > MORE * held}


def _some(side: Cells) -> tuple[FloatArray, FloatArray]:
    """Middles of some cells of a face, and the areas that they stand for."""
    every = spread(len(side.areas), SOME)
    return side.centres[::every], every * side.areas[::every]


def _volume(middles: FloatArray, areas: FloatArray, other: Body) -> float:
    """Volume between a face in another body and what it came through, by some places and the areas that they stand for."""
    near = in_box(middles, other, 0.0)
    return float(np.maximum(-other.outside.heights(middles[near])[0], 0.0) @ areas[near]) if len(near) else 0.0
