"""A side of a contact as a sheet: its face, or its faces joined to one, over the faces opposite them in their bodies.

Where a body is bent round so far that the face opposite is in front, as the ends of a ring with a slit are, that tells no depth: the sheet
is over the row of control points in between that is farthest away.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from isomortar._bindings import PatchArrays
from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.geometry.faces import cells
from isomortar.geometry.net import BESIDE, Net
from isomortar.geometry.patch import Direction, IntArray, Patch, opposite
from isomortar.model import constants
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.numbering import Numbering, patch_arrays
from isomortar.model.remembered import remembered


@frozen
class Sheet:
    """A side of a contact.

    Parameters
    ----------
    patch : Patch
        One element of order 1 across; joined faces have a C0 line at each joint.
    face : str
        Of this patch, the one in contact: w0 or w1, so that its normal is out of the bodies as that of the first of their faces.
    letters : tuple of str
        Names of its surface coordinates in the first of its bodies.
    closed : tuple of bool
        Along which coordinates the face meets itself.
    bodies : tuple of Body
    owner, number : ndarray of int32, shape (control points,)
        For each control point of the patch its body among these, and its number there.
    """

    patch: Patch
    face: str
    letters: tuple[str, str]
    closed: tuple[bool, bool]
    bodies: tuple[Body, ...]
    owner: IntArray
    number: IntArray

    @classmethod
    def of(cls, problem: Problem, place: Face) -> Sheet:
        """A side of a contact of a problem.

        Raises
        ------
        InputError
            Its faces do not join to one, row by row and column by column.
        """
        return _of(problem, place)

    @classmethod
    def of_face(cls, body: Body, face: str) -> Sheet:
        """The sheet of a single face."""
        net = Net.of(body.patch, face)
        first, second = (letter in (body.closed or "") for letter in net.letters)
        tile = _Tile(0, body, face, net)
        return _sheet([[tile]], tile, (body,), (first, second))

    @property
    def directions(self) -> tuple[Direction, Direction]:
        """The two directions of the face."""
        return self.patch.face_directions(self.face)

    @property
    def size(self) -> float:
        """Extent of the largest of its bodies along a coordinate."""
        return max(body.size for body in self.bodies)

    @property
    def element_size(self) -> float:
        """Typical length of its elements along the face."""
        return float(np.sqrt(np.prod([np.median(lengths) for lengths in element_lengths(self.patch)[:2]])))

    @property
    def rigid(self) -> bool:
        """Whether its bodies are rigid: those that are glued are all, or none of them."""
        return self.bodies[0].rigid

    @property
    def outward(self) -> int:
        """Sign of the product of the tangents that points out of the bodies."""
        return 1 if self.face[1] == "1" else -1

    def points(self, numbering: Numbering) -> IntArray:
        """Global numbers of the patch's control points."""
        points = np.empty_like(self.number)
        for k, body in enumerate(self.bodies):
            points[self.owner == k] = numbering.points[body.name][self.number[self.owner == k]]
        return points

    def arrays(self, numbering: Numbering) -> tuple[PatchArrays, int, int]:
        """The patch, with global control points, the axis across the face and its end there, as the kernel takes them."""
        return patch_arrays(self.patch, self.points(numbering)), 3, int(self.face[1])


@remembered
def _of(problem: Problem, place: Face) -> Sheet:
    return _joined(problem, place) if len(place.faces) > 1 else Sheet.of_face(problem.body(place.body), place.face)


@frozen(eq=False)
class _Tile:
    """A face of a side, turned so that it fits to the others; `factor`: of its weights."""

    owner: int
    body: Body
    face: str
    net: Net
    factor: float = 1.0

    def layers(self, end: int) -> IntArray:
        """Numbers of its control points and those below, layer by layer across, its own at the start (0) or the end (1); (2, n2, n1)."""
        axis = "uvw".index(self.face[0])
        through = self._across(axis) * int(np.prod(self.body.patch.shape[:axis]))
        below = self.net.numbers + (through if self.face[1] == "0" else -through)
        return np.stack([below, self.net.numbers] if end else [self.net.numbers, below]).astype(np.int32)

    def _across(self, axis: int) -> int:
        """How many rows of control points away that is which tells how deep the body is below its face (theory 3.19)."""
        patch = self.body.patch
        rows = np.moveaxis(patch.control_points.reshape(*patch.shape, 3, order="F"), axis, 0)
        rows = rows[::-1] if self.face[1] == "1" else rows
        away = np.linalg.norm(rows - rows[0], axis=-1).mean(axis=(1, 2))
        farthest = int(np.argmax(away > (1.0 - constants.NO_PART) * away.max()))
        return farthest if farthest < len(rows) - 1 and _bent_round(patch, self.face) else len(rows) - 1


def _bent_round(patch: Patch, face: str) -> bool:
    """Whether a body has the face opposite a face of it in front of that."""
    here, there = cells(patch, face), cells(patch, opposite(face))
    ways = np.einsum("ij,ij->i", there.centres - here.centres, here.normals)
    return bool(here.areas @ ways > constants.NO_PART * (here.areas @ here.thickness))


def _joined(problem: Problem, place: Face) -> Sheet:
    twice = [face.words for k, face in enumerate(place.faces) if face in place.faces[:k]]
    if twice:
        raise InputError(f"{place.words}: names {twice[0]} twice; allowed: each face once")
    numbering = Numbering(problem)
    tiles = _arranged(problem, place, numbering)
    columns, rows = ({cell[axis] for cell in tiles} for axis in (0, 1))
    if len(tiles) < len(columns) * len(rows):
        raise InputError(
            f"{place.words}: the faces make no rectangle: in {len(columns)} x {len(rows)} places there are {len(tiles)}. A side is rows "
            "and columns of faces; give those that meet otherwise, such as three at a corner, contacts of their own"
        )
    grid = [[tiles[column, row] for column in sorted(columns)] for row in sorted(rows)]
    _check_joints(place, grid, numbering)
    bodies = tuple(problem.body(name) for name in dict.fromkeys(face.body for face in place.faces))
    owners = {body.name: k for k, body in enumerate(bodies)}
    grid = [[replace(tile, owner=owners[tile.body.name]) for tile in row] for row in grid]
    globally = _tiled([[_global(numbering, tile.body, tile.net) for tile in row] for row in grid])
    closed = bool(np.all(globally[:, 0] == globally[:, -1])), bool(np.all(globally[0] == globally[-1]))
    return _sheet(grid, tiles[0, 0], bodies, closed)


def _arranged(problem: Problem, place: Face, numbering: Numbering) -> dict[tuple[int, int], _Tile]:
    """Faces by column and row, each turned so that its edges are those of its neighbours; the first one lies as it is."""
    first, *others = (
        _Tile(0, problem.body(face.body), face.face, Net.of(problem.body(face.body).patch, face.face)) for face in place.faces
    )
    found, todo = {(0, 0): first}, [(0, 0)]
    while todo:
        here = todo.pop(0)
        for (column, row), mine, theirs in BESIDE:
            there = (here[0] + column, here[1] + row)
            edge = _global(numbering, found[here].body, found[here].net)[mine]
            beside = next(((t, net) for t in others for net in t.net.turned() if _is(edge, _global(numbering, t.body, net)[theirs])), None)
            if beside is not None and there not in found:
                tile, net = beside
                factor = found[here].factor * float((found[here].net.weights[mine] / net.weights[theirs])[0])
                found[there] = replace(tile, net=net, factor=factor)
                others.remove(tile)
                todo.append(there)
    if others:
        name = f"{others[0].body.name}.{others[0].face}"
        raise InputError(
            f"{place.words}: {name} has no whole edge in common with the others; faces of a side are of one body, or of bodies that are "
            "glued where they meet (glue), edge to edge in rows and columns"
        )
    return found


def _is(edge: IntArray, other: IntArray) -> bool:
    """Whether two edges are the same, and no single point."""
    return np.array_equal(edge, other) and bool(np.any(edge != edge[0]))


def _global(numbering: Numbering, body: Body, net: Net) -> IntArray:
    return numbering.points[body.name][net.numbers]


def _check_joints(place: Face, grid: list[list[_Tile]], numbering: Numbering) -> None:
    """Refuse faces that follow each other with functions of another family or order, or without a common edge."""
    lines = [(0, row) for row in grid] + [(1, list(column)) for column in zip(*grid, strict=True)]
    for axis, (one, other) in [(axis, pair) for axis, line in lines for pair in pairwise(line)]:
        first, second = one.net.directions[axis], other.net.directions[axis]
        names = [f"{tile.body.name}.{tile.face}" for tile in (one, other)]
        if (first.family, first.order) != (second.family, second.order):
            raise InputError(
                f"{place.words}: {names[0]} has order {first.order} ({first.family}) along {one.net.letters[axis]}, and {names[1]}, which "
                f"goes on from there, order {second.order} ({second.family}) along {other.net.letters[axis]}; give both the same"
            )
        _, mine, theirs = BESIDE[2 * axis]
        if not np.array_equal(_global(numbering, one.body, one.net)[mine], _global(numbering, other.body, other.net)[theirs]):
            raise InputError(
                f"{place.words}: {names[0]} and {names[1]} would follow each other, and have no edge in common; glue their bodies"
            )


def _sheet(grid: list[list[_Tile]], first: _Tile, bodies: tuple[Body, ...], closed: tuple[bool, bool]) -> Sheet:
    """Tiles in rows and columns as a sheet, which is named and looks out as the first of them."""
    u = _chained([tile.net for tile in grid[0]], 0)
    v = _chained([row[0].net for row in grid], 1)
    layers = [[tile.layers(int(first.face[1])) for tile in row] for row in grid]
    tiles = [list(zip(*both, strict=True)) for both in zip(grid, layers, strict=True)]
    weights = _tiled([[tile.factor * tile.body.patch.weights[numbers] for tile, numbers in row] for row in tiles], 1)
    owner = _tiled([[np.full_like(numbers, tile.owner) for tile, numbers in row] for row in tiles], 1)
    number = _tiled(layers, 1)
    points = np.empty((number.size, 3))
    for k, body in enumerate(bodies):
        points[owner.ravel() == k] = body.patch.control_points[number.ravel()[owner.ravel() == k]]
    across = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    patch = Patch((u, v, across), points, weights.ravel())
    letters = (first.net.letters[0], first.net.letters[1])
    return Sheet(patch, "w" + first.face[1], letters, closed, bodies, owner.ravel(), number.ravel())


def _tiled(blocks: Sequence[Sequence[np.ndarray]], axis: int = 0) -> np.ndarray:
    """Blocks in rows and columns as one array, with what is the same on both sides of a joint once; rows are along `axis`."""
    rows = [np.concatenate([_cut(block, axis + 1, k > 0) for k, block in enumerate(row)], axis=axis + 1) for row in blocks]
    return np.concatenate([_cut(row, axis, k > 0) for k, row in enumerate(rows)], axis=axis)


def _cut(block: np.ndarray, axis: int, first: bool) -> np.ndarray:
    """A block, without its first line along an axis if that is there already."""
    return np.delete(block, 0, axis) if first else block


def _chained(nets: list[Net], axis: int) -> Direction:
    """Directions one after the other with C0 lines between, as long in each as makes coordinates go on at the same speed (theory 2.11)."""
    chain, speed = nets[0].directions[axis], _speed(nets[0], axis, -1)
    for net in nets[1:]:
        knots = net.directions[axis].knots
        factor = _speed(net, axis, 0) / speed
        moved = chain.knots[-1] + factor * (knots - knots[0])
        kept = (chain.knots[:-1], moved[chain.order + 1 :]) if chain.family == "N" else (chain.knots, moved[1:])
        chain, speed = replace(chain, knots=np.concatenate(kept)), _speed(net, axis, -1) / factor
    return chain


def _speed(net: Net, axis: int, end: int) -> float:
    """Length by coordinate at an end (0, -1) of a direction, the mean along the edge; 1 where that is a point."""
    direction = net.directions[axis]
    points, weights = (np.moveaxis(array, 1 - axis, 0) for array in (net.points, net.weights))
    beside = 1 if end == 0 else -2
    steps = np.linalg.norm(points[beside] - points[end], axis=-1) * weights[beside] / weights[end]
    span = np.diff(direction.boundaries)[end]
    return float(direction.order * steps.mean() / span)
