"""Faces that are glued: the same functions at the same points, whatever the units of knots and weights; else refused by what differs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Face, Material, Problem
from isomortar.model.glue import shared_points


def block(low: float, order: int = 2, elements: tuple[int, int, int] = (2, 3, 2)) -> Patch:
    """A block of length one along x from a place on, with weights that differ along y and z alone."""
    patch = mesh(box((low, 0.0, 0.0), (low + 1.0, 1.0, 0.7)), ("N", "N", "N"), (2, order, 2), elements)
    _, y, z = np.indices(patch.shape).reshape(3, -1, order="F")
    return replace(patch, weights=1.0 + 0.1 * np.sin(1.0 + y + 2.0 * z))


def with_weights(change: Callable[[np.ndarray], np.ndarray]) -> Patch:
    """The second block with other weights at its face, shape (4, 5) along y and z."""
    patch = block(1.0)
    weights, face = patch.weights.copy(), patch.face_points("u0")
    weights[face] = change(weights[face])
    return replace(patch, weights=weights)


def with_knots(change: Callable[[np.ndarray], np.ndarray]) -> Patch:
    """The second block with other knots along y."""
    patch = block(1.0)
    u, v, w = patch.directions
    return replace(patch, directions=(u, Direction("N", 2, change(v.knots)), w))


def with_point(number: int, by: float) -> Patch:
    """The second block with a control point of its face, by its number there, moved along y."""
    patch = block(1.0)
    points = patch.control_points.copy()
    points[patch.face_points("u0")[number], 1] += by
    return replace(patch, control_points=points)


def one_more(number: int, factor: float) -> Callable[[np.ndarray], np.ndarray]:
    """A change of one number of an array."""
    return lambda values: values * np.where(np.arange(len(values)) == number, factor, 1.0)


#: Second blocks, and a word of what differs; empty: they are glued.
BLOCKS = {
    "the same": (block(1.0), ""),
    "heavier": (replace(block(1.0), weights=3.0 * block(1.0).weights), ""),
    "lighter": (replace(block(1.0), weights=0.01 * block(1.0).weights), ""),
    "other knots": (with_knots(lambda knots: 5.0 + 0.3 * knots), ""),
    "one heavier": (with_weights(one_more(7, 1.01)), "weights"),
    "one lighter": (with_weights(one_more(7, 0.99)), "weights"),
    "first one lighter": (with_weights(one_more(0, 0.99)), "weights"),
    "last one heavier": (with_weights(one_more(19, 1.01)), "weights"),
    "a knot later": (with_knots(one_more(4, 1.01)), "knots"),
    "a knot earlier": (with_knots(one_more(4, 0.99)), "knots"),
    "a point aside": (with_point(7, 0.01), "control points"),
    "a point aside, back": (with_point(7, -0.01), "control points"),
    "a corner aside": (with_point(19, 0.01), "corners"),
    "order": (block(1.0, order=3), "order"),
    "elements": (block(1.0, elements=(2, 4, 2)), "elements"),
}


def refused(patches: tuple[Patch, Patch], faces: tuple[str, str]) -> str:
    """Why two blocks are refused; empty: they are not."""
    bodies = tuple(Body(name, patch, Material(10.0), (3, 3, 3)) for name, patch in zip("ab", patches, strict=True))
    glue = ((Face("a", faces[0]), Face("b", faces[1])),)
    try:
        one, other = shared_points(Problem("glued", bodies, (), (), (), glue=glue), 0)
    except InputError as error:
        return str(error).split("which do not conform: ")[1].split(". Glued")[0]
    apart = bodies[0].patch.control_points[one] - bodies[1].patch.control_points[other]
    return "" if np.abs(apart).max() < 1e-12 else "points that are apart"


@case(
    claim="Faces are glued whose functions are the same at the same points, in any unit of knots and weights; else it is said what is not.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: pairs that are refused for something else, or for nothing, or should not be")},
)
def misfits() -> dict[str, float]:
    """How many of fifteen pairs, either of them first."""
    wrong = 0
    for other, word in BLOCKS.values():
        for patches, faces in (((block(0.0), other), ("u1", "u0")), ((other, block(0.0)), ("u0", "u1"))):
            found = refused(patches, faces)
            wrong += word not in found if word else bool(found)
    return {"wrong": float(wrong)}


#: What directions along x, y and z can be called; and what a neighbour has otherwise along y, in words of either block.
CALLED = ("uvw", "vwu", "wuv", "vuw", "uwv", "wvu")
ALONG = {"order": (block(1.0, order=3), "order 2", "order 3"), "elements": (block(1.0, elements=(2, 4, 2)), "3 elements", "4 elements")}


def called(patch: Patch, letters: str, backwards: bool) -> Patch:
    """The same body, whose directions along x, y and z are called otherwise, that along z backwards or not; gluing minds no handedness."""
    axes = [letters.index(letter) for letter in "uvw"]
    numbers = np.arange(len(patch.weights)).reshape(patch.shape, order="F")
    order = (numbers[:, :, ::-1] if backwards else numbers).transpose(axes).ravel(order="F")
    x, y, z = patch.directions
    u, v, w = ((x, y, z.reversed() if backwards else z)[axis] for axis in axes)
    return Patch((u, v, w), patch.control_points[order], patch.weights[order])


@case(
    claim="Of faces that are refused it is said along which direction of either body they differ, by the names that these have there.",
    tier="gate",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: sentences with another body, number or direction"),
        "tried": Bound(144.0, 144.0, "definition: two differences, six names of the directions of each body, one of them either way"),
    },
)
def named() -> dict[str, float]:
    """How many of how many."""
    wrong = tried = 0
    for other, here, there in ALONG.values():
        for first, second, backwards in product(CALLED, CALLED, (False, True)):
            found = refused((called(block(0.0), first, False), called(other, second, backwards)), (first[0] + "1", second[0] + "0"))
            wrong += found != f"a has {here} along {first[1]}, b {there} along {second[1]}"
            tried += 1
    return {"wrong": float(wrong), "tried": float(tried)}
