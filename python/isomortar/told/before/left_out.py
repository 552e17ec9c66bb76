"""What a model may lack: a contact between bodies that meet, what moves a body, the other half."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from isomortar.geometry.patch import FloatArray, Patch
from isomortar.model.constants import SAME_POINT
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.glue import names_together
from isomortar.told.meeting import meet


def of_what_is_left_out(problem: Problem) -> Iterator[str]:
    """Sentences on what a problem may lack."""
    through = without_contact(problem)
    for one, other in through:
        yield (
            f"bodies {one!r} and {other!r} meet, and no contact is between them: nothing keeps them apart. Give them a table "
            "contacts.NAME with slave and master, or glue"
        )
    yield from _idle_bodies(problem, {name for pair in through for name in pair})
    yield from _missing_symmetry(problem)


def _in_contact(problem: Problem) -> list[set[str]]:
    """Names of the bodies of each contact."""
    sides = [[c.slave.faces, getattr(c.master, "faces", ())] for c in problem.contacts]
    return [{face.body for faces in both for face in faces} for both in sides]


def without_contact(problem: Problem) -> list[tuple[str, str]]:
    """Bodies that are at or in each other, or come to be by their supports, and neither in contact nor glued."""
    whole, found = names_together(problem), []
    for one, other in unrelated(problem):
        ways = [np.zeros(3), *(a - b for a, b in zip(_ways(problem, one, whole), _ways(problem, other, whole), strict=True))]
        between = _between(problem, one, other, whole)
        if any(meet(one, other, way, between) for way in np.unique(ways, axis=0)):
            found.append((one.name, other.name))
    return found


def _between(problem: Problem, one: Body, other: Body, whole: list[set[str]]) -> list[Body]:
    """Bodies that no support moves and that are in contact with both of two: these do not come through them to each other.

    What is in contact with one alone may be pushed into the other one.
    """
    sides = [next(names for names in whole if body.name in names) for body in (one, other)]
    touching = [set[str]().union(*(names for names in _in_contact(problem) if names & side)) for side in sides]
    near = {name for names in whole if names not in sides and all(names & touched for touched in touching) for name in names}
    return [body for body in problem.bodies if body.name in near and not np.any(_ways(problem, body, whole))]


def unrelated(problem: Problem) -> Iterator[tuple[Body, Body]]:
    """Pairs of bodies that are neither in contact nor glued."""
    together = (*_in_contact(problem), *names_together(problem))
    for one, other in combinations(problem.bodies, 2):
        if not any({one.name, other.name} <= names for names in together):
            yield one, other


def _ways(problem: Problem, body: Body, whole: list[set[str]]) -> FloatArray:
    """How far the support that goes farthest has taken a body at the end of each stage, turns aside; shape (stages, 3)."""
    names = next(names for names in whole if body.name in names)
    ways = [
        np.cumsum([np.isin(range(3), s.components) * np.asarray(m.translate) for m in s.motions], axis=0)
        for s in problem.supports
        if s.place.body in names
    ]
    return max(ways, key=np.linalg.norm, default=np.zeros((len(problem.stages), 3)))


def _idle_bodies(problem: Problem, told: set[str]) -> Iterator[str]:
    """Bodies that nothing touches, loads or moves; but for some."""
    touched = told | {name for names in _in_contact(problem) for name in names}
    loaded = {load.body for load in problem.loads} | {s.place.body for s in problem.supports if s.moves or s.is_plate}
    if len(problem.bodies) > 1:
        for names in names_together(problem):
            if not names & (touched | loaded):
                yield (
                    f"body {sorted(names)[0]!r} is in no contact, and nothing moves or loads it: it only costs time. Give it a contact, or "
                    "take it out"
                )


def _missing_symmetry(problem: Problem) -> Iterator[str]:
    """A flat end that all bodies have in common, where they would go on smoothly as their mirror images, and that nothing holds."""
    for axis in range(3) if problem.contacts else ():
        low, high = (_cuts(problem, axis, end) for end in (0, 1))
        for cut, opposite in ((low, high), (high, low)):
            bare = [face for face in cut if not _held(problem, face, axis)]
            if bare and not opposite and not any(_taken(problem, face) for face in cut):
                yield (
                    f"all bodies end at one plane across {'xyz'[axis]}, as halves of a whole do, and nothing holds "
                    f"{'them' if bare == cut else bare[0].words if len(bare) == 1 else 'all of them'} there: they bulge "
                    f'through it. If they are halves, give supports with components = ["{"xyz"[axis]}"] to '
                    f"{', '.join(face.words for face in bare)}"
                )


def _cuts(problem: Problem, axis: int, end: int) -> list[Face]:
    """Of every deformable body a face in the one plane across an axis where bodies and contacts end, that goes on smoothly; else none."""
    ends = [float((np.max if end else np.min)(body.patch.control_points[:, axis])) for body in problem.bodies]
    near = SAME_POINT * max(body.size for body in problem.bodies)
    faces = [
        [Face(body.name, face) for face in body.outer if _is_cut(body.patch, face, axis, ends[0], near)] for body in problem.deformable
    ]
    sides = [face for c in problem.contacts for side in (c.slave.faces, getattr(c.master, "faces", ())) for face in side]
    ends += [float((np.max if end else np.min)(_points(problem, side)[:, axis])) for side in sides]
    return [face for found in faces for face in found] if np.ptp(ends) <= near and all(faces) else []


def _points(problem: Problem, face: Face) -> FloatArray:
    patch = problem.body(face.body).patch
    return patch.control_points[patch.face_points(face.face)]


def _is_cut(patch: Patch, face: str, axis: int, place: float, near: float) -> bool:
    """Whether a face lies in a plane across an axis, and the body comes to it at right angles."""
    grid = patch.control_points.reshape(*patch.shape, 3, order="F")
    layers = np.moveaxis(grid, "uvw".index(face[0]), 0)
    edge, inner = (layers[0], layers[1]) if face[1] == "0" else (layers[-1], layers[-2])
    aside = np.delete(inner - edge, axis, axis=-1)
    return bool(np.abs(edge[..., axis] - place).max() <= near and np.abs(aside).max() <= near)


def _held(problem: Problem, face: Face, axis: int) -> bool:
    """Whether a support keeps a face on its plane across an axis, or moves it from there."""
    return any(support.place == face and axis in support.carried for support in problem.supports)


def _taken(problem: Problem, face: Face) -> bool:
    """Whether a face is loaded or in contact; glued to what is beyond it, it would be no end of all bodies."""
    loaded = any(load.face is not None and load.place == face for load in problem.loads)
    touched = any(face in side for c in problem.contacts for side in (c.slave.faces, getattr(c.master, "faces", ())))
    return loaded or touched
