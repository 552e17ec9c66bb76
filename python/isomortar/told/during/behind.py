"""Bodies that have come behind a rigid plane with faces that are not in contact with it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.faces import cells
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.entities import Body, Face, Problem, RigidPlane, unit

#: Depth over the size of a body from which it is behind a plane: faces in contact are, too, by less than their elements see.
PASSED = 0.01
#: Decimals of heights of planes, over the largest size of a body, in which those of one plane by different points of it are the same.
DIGITS = 9


class Behind:
    """Warnings of bodies that nothing keeps from a plane which they were in front of; each is told of once.

    Attributes
    ----------
    needed : bool
        Whether there are planes.
    """

    def __init__(self, problem: Problem) -> None:
        self._planes = _planes(problem)
        self.needed = bool(self._planes)
        self._told = set[tuple[str, str]]()

    def after_stage(self, deformed: Sequence[Body], stage: str) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to."""
        for plane in self._planes:
            depths = {body.name: plane.depths(body) for body in deformed}
            held = max((depth for found in depths.values() for face, depth in found.items() if face in plane.touching), default=0.0)
            for body in (body for body in deformed if body.name in plane.before and (body.name, plane.name) not in self._told):
                free = {face: depth for face, depth in depths[body.name].items() if face not in plane.touching}
                face = max(free, key=free.__getitem__, default=None)
                if face and free[face] - held > PASSED * body.size:
                    self._told.add((body.name, plane.name))
                    yield (
                        f"body {body.name!r} is behind the plane of contact {plane.name!r} at the end of stage {stage!r}, by "
                        f"{free[face]:.3g}, and nothing keeps its face {face.words} from it. Give that face a contact with the plane, too"
                    )


@frozen
class _Plane:
    """A rigid plane by a contact that has it, all faces in contact with such a plane, and bodies that begin in front of it."""

    name: str
    plane: RigidPlane
    touching: frozenset[Face]
    before: frozenset[str]

    def depths(self, body: Body) -> dict[Face, float]:
        """How far behind the plane each face of a body is; none of a body that is in front."""
        if _heights(body.patch.control_points, self.plane).min() >= 0.0:  # a body is within the box of its control points
            return {}
        lowest = {face: float(_heights(cells(body.patch, face).centres, self.plane).min()) for face in body.outer}
        return {Face(body.name, face): max(0.0, -height) for face, height in lowest.items()}


def _planes(problem: Problem) -> list[_Plane]:
    """The rigid planes of a problem, each once, by whatever point; a face that touches one that looks the same way has its own floor."""
    planes = [(contact, contact.master) for contact in problem.contacts if isinstance(contact.master, RigidPlane)]
    found, size = dict[tuple[float, object], _Plane](), max(body.size for body in problem.bodies)
    for contact, plane in planes:
        touching = frozenset(face for other, level in planes if level.normal == plane.normal for face in other.slave.faces)
        before = [b.name for b in problem.bodies if _heights(b.patch.control_points, plane).min() >= -constants.NO_PART * b.size]
        height = round(float(_heights(np.zeros(3), plane)) / size, DIGITS)
        found.setdefault((height, plane.normal), _Plane(contact.name, plane, touching, frozenset(before)))
    return list(found.values())


def _heights(points: FloatArray, plane: RigidPlane) -> FloatArray:
    """How far points are in front of a plane."""
    return np.asarray((points - plane.point) @ unit(plane.normal))
