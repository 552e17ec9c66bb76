"""A slave face laid flat, in lengths: as it is where it lies in a coordinate plane, else by the distances along its middle lines."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.results.fields import ContactSurface

#: Share of a face's size up to which it lies in a plane.
_LEVEL = 1e-9
#: Chords along an element by which distances are taken.
_CHORDS = 64

#: Places of shape (n2, n1, 2), and their derivatives by both parameters, (n2, n1, 2, 2), on a grid of n1 parameters times n2.
Placing = Callable[[Sequence[FloatArray]], tuple[FloatArray, FloatArray]]


@frozen
class Laid:
    """Where the points of a face are on a flat picture of its rest; the longer side of the face runs to the right.

    Parameters
    ----------
    labels : tuple of str
        Of the lengths to the right and upwards.
    at : callable
        Places and their derivatives on a grid of parameters.
    """

    labels: tuple[str, str]
    at: Placing


def laid(surface: ContactSurface) -> Laid:
    """A slave face laid flat."""
    size = np.ptp(surface.reference_points, axis=0)
    across = int(size.argmin())
    return _in_its_plane(surface, across) if size[across] <= _LEVEL * size.max() else _rolled_out(surface)


def _in_its_plane(surface: ContactSurface, across: int) -> Laid:
    """As it is, seen along a coordinate."""
    size = np.ptp(surface.reference_points, axis=0)
    right, up = sorted({0, 1, 2} - {across}, key=lambda axis: -float(size[axis]))

    def at(parameters: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
        return surface.on_grid(parameters, surface.reference_points[:, [right, up]])

    return Laid(("xyz"[right], "xyz"[up]), at)


def _rolled_out(surface: ContactSurface) -> Laid:
    """A rectangle; its sides are as long as the lines through the middle of the face."""
    measures = [_distance(surface, axis) for axis in (0, 1)]
    longer = [0, 1] if surface.lengths[0] >= surface.lengths[1] else [1, 0]

    def at(parameters: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
        (first, of_first), (second, of_second) = (measure(x) for measure, x in zip(measures, parameters, strict=True))
        places, gradient = np.zeros((len(second), len(first), 2)), np.zeros((len(second), len(first), 2, 2))
        places[..., 0], places[..., 1] = first, second[:, None]
        gradient[..., 0, 0], gradient[..., 1, 1] = of_first, of_second[:, None]
        return places[..., longer], gradient[..., longer, :]

    right, up = (f"distance along {surface.letters[axis]}" for axis in longer)
    return Laid((right, up), at)


def _distance(surface: ContactSurface, axis: int) -> Callable[[FloatArray], tuple[FloatArray, FloatArray]]:
    """Distances along the middle line of a direction, and their derivatives, by its parameters."""
    middle = [np.array([0.5 * (d.boundaries[0] + d.boundaries[-1])]) for d in surface.directions]

    def line(parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
        along = [parameters if k == axis else middle[k] for k in (0, 1)]
        places, gradient = surface.on_grid(along, surface.reference_points)
        return places.reshape(-1, 3), np.linalg.norm(gradient[..., axis], axis=-1).ravel()

    samples = surface.directions[axis].subdivided(_CHORDS)
    chords = np.linalg.norm(np.diff(line(samples)[0], axis=0), axis=1)
    ends = np.append(0.0, np.cumsum(chords))
    return lambda parameters: (np.interp(parameters, samples, ends), line(parameters)[1])


def directions_of(surface: ContactSurface, flat: Laid, parameters: Sequence[FloatArray], vectors: FloatArray) -> FloatArray:
    """Where tangential vectors point on the flat picture, unit vectors, shape (n2, n1, 2).

    A vector in space, shape (n2, n1, 3), is one of the deformed face: its components along the tangents there are those along the lines
    of the picture.
    """
    _, tangents = surface.on_grid(parameters, surface.points)
    along = np.linalg.pinv(tangents) @ vectors[..., None]
    pointing = (flat.at(parameters)[1] @ along)[..., 0]
    return pointing / np.maximum(np.linalg.norm(pointing, axis=-1, keepdims=True), np.finfo(np.float64).tiny)
