"""Bodies in contact that come into each other by faces that have no contact there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from isomortar.geometry.faces import cells
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.stance import nearest
from isomortar.told.before.meeting import heights_above

#: Depth over the size of the smaller body from which a face is in another one: cells are flat, and faces between them are not.
PASSED = 0.01
#: Volume in the other body over that of a face in contact from which on a face is told: with one flank of a wedge in contact the other one
#: had 2.3 to 23 times as much, its ends, where edges that are in contact come in by as much as their elements do not see, up to 0.05.
MORE = 2.0
#: Depth over the largest one from which on faces are as deep as each other, and the first is told: those that mirror each other differ by
#: what Newton's method leaves.
ALIKE = 1.0 - 1e-5
#: Of the cells of a face, row by row, every so manyth one is looked at: 7 goes into none of their usual numbers, so that these are spread
#: over the face, and some hundreds of them do for a volume.
EVERY = 7


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
            deepest = max(depths.values(), default=0.0)
            face = next((face for face, depth in depths.items() if depth > ALIKE * deepest), "")
            if face:
                self._told.add(names)
                yield (
                    f"body {one.name!r} is in body {other.name!r} at the end of stage {stage!r}, by {depths[face]:.3g}, and nothing keeps "
                    f"its face {Face(one.name, face).words} from it: their contact is between other faces, and forces lack what this one "
                    "would bear. Give that face a contact, too, or list it beside the other one"
                )


def _depths(one: Body, other: Body, touching: set[str]) -> Mapping[str, float]:
    """How deep faces of a body without contact are in another one, of those that are in it by more than others in contact are."""
    least = PASSED * min(one.size, other.size)
    free = [face for face in one.outer if face not in touching and _within(one, face, touching, other, least)]
    if not free:
        return {}
    found = _inside(one, [*touching, *free], other)
    held = max(found[face][1] for face in touching)
    return {face: found[face][0] for face in free if found[face][0] > least and found[face][1] > MORE * held}


def _within(one: Body, face: str, touching: set[str], other: Body, least: float) -> bool:
    """Whether control points of a face, but for those at the edges of faces in contact, are in the box around another body."""
    patch = one.patch
    own = np.setdiff1d(patch.face_points(face), np.concatenate([patch.face_points(of).ravel() for of in touching]))
    points, theirs = patch.control_points[own], other.patch.control_points
    return bool(np.any(np.all((points > theirs.min(axis=0) + least) & (points < theirs.max(axis=0) - least), axis=1)))


def _inside(one: Body, faces: Sequence[str], other: Body) -> dict[str, tuple[float, float]]:
    """How deep middles of cells of some faces are in another body at most, and volumes between the faces and what they came through."""
    seen = [cells(one.patch, face) for face in faces]
    points = np.concatenate([side.centres[::EVERY] for side in seen])
    heights, _, beside = heights_above(points, other)
    depths: FloatArray = np.where(beside, 0.0, np.maximum(-heights, 0.0))
    inside = np.flatnonzero(depths > 0.0)
    if len(inside):
        depths[inside] = np.minimum(depths[inside], _below_all(points[inside], other))
    areas = [side.areas[::EVERY] for side in seen]
    of_faces = np.split(depths, np.cumsum([len(own) for own in areas])[:-1])
    return {face: (float(own.max()), float(own @ area)) for face, own, area in zip(faces, of_faces, areas, strict=True)}


def _below_all(points: FloatArray, body: Body) -> FloatArray:
    """How deep points are below those faces of a body that are no farther than a cell more than the nearest one; 0 above one of them.

    Beside an edge the nearest middle of a cell may be of the face round the corner, and what is above one face is below the other one.
    """
    above, away, reach = [], [], []
    for side in (cells(body.patch, face) for face in body.outer):
        found = nearest(points, side.centres)
        arms = points - side.centres[found]
        above.append(np.einsum("ij,ij->i", arms, side.normals[found]))
        away.append(np.linalg.norm(arms, axis=1))
        reach.append(np.sqrt(side.areas[found]))
    near = np.array(away) <= np.min(away, axis=0) + np.array(reach)
    return np.maximum(-np.max(np.where(near, above, -np.inf), axis=0), 0.0)
