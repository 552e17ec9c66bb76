"""The outside of a body: how high points are above it, which of them are in it, and how deep."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import cached_property

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.faces import Cells, cells_of
from isomortar.geometry.grids import grid
from isomortar.geometry.heights import heights_above
from isomortar.geometry.patch import FloatArray, Patch

#: A face of less than this share of the largest one's area is a line or a point: the axis of a cylinder, a pole of a ball.
NO_AREA = 1e-9
#: Points that are looked at of those that seem to be in a body: so many of the deepest, as by sharp corners some dozens seem to be and are
#: not, and as many of the others.
LOOKED = 60
#: How often the outside goes round a place from which on that is within, halfway between never and once.
HALF_ROUND = 0.5


@frozen
class Outside:
    """Faces that enclose a body.

    Parameters
    ----------
    patch : Patch
    sides : mapping of str to Cells
        Cells of faces that have an area, by the faces' names: others are lines and points, on these or within the body, and tell no way
        out.
    """

    patch: Patch
    sides: Mapping[str, Cells]

    @classmethod
    def of(cls, patch: Patch, faces: Collection[str]) -> Outside:
        """By the names of all faces at which a body does not meet itself."""
        sides = cells_of(patch, faces)
        least = NO_AREA * np.max([side.areas.sum() for side in sides.values()])
        return cls(patch, {face: side for face, side in sides.items() if side.areas.sum() >= least})

    @property
    def sagitta(self) -> float:
        """How far the faces are from their cells at most, about, but for kinks."""
        return float(np.max([side.sagitta for side in self.sides.values()]))

    @cached_property
    def triangles(self) -> FloatArray:
        """Corners of two triangles for each cell, shape (2 n, 3, 3), seen from out of the body counter-clockwise."""
        found = []
        for face in self.sides:
            points = grid(self.patch, face)
            if face[1] == "1":
                points = points[::-1]
            a, b, c, d = (part.reshape(-1, 3) for part in (points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]))
            found += [np.stack([a, c, b], axis=1), np.stack([a, d, c], axis=1)]
        return np.concatenate(found)

    def heights(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How high points, (n, 3), are above it, and the outward normals nearest to them; which side is told may be wrong (`deepest`)."""
        return heights_above(points, self.sides.values())

    def turns(self, place: FloatArray) -> float:
        """How often it goes round a place (van Oosterom and Strackee 1983): once, if that is within."""
        a, b, c = np.moveaxis(self.triangles - place, 1, 0)
        x, y, z = (np.linalg.norm(of, axis=1) for of in (a, b, c))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c))
        rest = x * y * z + np.einsum("ij,ij->i", a, b) * z + np.einsum("ij,ij->i", b, c) * x + np.einsum("ij,ij->i", c, a) * y
        return float(np.arctan2(volume, rest).sum()) / (2.0 * np.pi)

    def deepest(self, points: FloatArray, least: float) -> float:
        """How deep the deepest of some points, (n, 3), is in the body, that it goes round; 0 if by no more than the least."""
        if not len(points):
            return 0.0
        depths = -self.heights(points)[0]
        order = np.argsort(-depths, kind="stable")[: np.count_nonzero(depths > least)]
        order = np.append(order[:LOOKED], order[LOOKED :: 1 + len(order) // LOOKED])
        return next((float(depths[k]) for k in order if self.turns(points[k]) > HALF_ROUND), 0.0)
