"""Bodies with known shapes: sectors of cylinders, tori and spherical shells, coarse and exact with their volumes and areas; a roof."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh

_LINE = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
_ARC = Direction("N", 2, np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]))


def cylinder_sector(inner: float, outer: float, angle: float, height: float) -> Patch:
    """Sector about the z-axis from the x-axis; u, v, w run along radius, angle and height."""
    points, weights = [], []
    for z in (0.0, height):
        for direction, weight in zip(*_arc(0.0, angle), strict=True):
            points += [(*(radius * direction), z) for radius in (inner, outer)]
            weights += [weight, weight]
    return Patch((_LINE, _ARC, _LINE), np.array(points), np.array(weights))


def cylinder_volume(inner: float, outer: float, angle: float, height: float) -> float:
    """Volume of `cylinder_sector`."""
    return (outer**2 - inner**2) * angle * height / 2


def turned_sector(major: float, inner: float, outer: float, section: tuple[float, float], turn: float) -> Patch:
    """Sector of a hollow torus about the z-axis; of a spherical shell where `major` is 0.

    Parameters
    ----------
    major : float
        Distance of the centre of the section from the axis.
    inner, outer : float
        Radii of the section.
    section : two floats
        Angles of the section, 0 in the plane z = 0 away from the axis; u runs along them, v along the radius.
    turn : float
        Angle about the axis, from the x-axis; w runs along it.
    """
    points, weights = [], []
    for along, turn_weight in zip(*_arc(0.0, turn), strict=True):
        for radius in (inner, outer):
            for (cosine, sine), weight in zip(*_arc(*section), strict=True):
                points.append((*((major + radius * cosine) * along), radius * sine))
                weights.append(weight * turn_weight)
    return Patch((_ARC, _LINE, _ARC), np.array(points), np.array(weights))


def dome(inner: float, outer: float, start: float) -> Patch:
    """Spherical shell about the z-axis from a latitude to the pole, all round; u along the latitude, v along the radius, w round the axis.

    Its last row along w is the first one; at the end of u, the pole, all control points along w are one.
    """
    quarter = turned_sector(0.0, inner, outer, (start, np.pi / 2), np.pi / 2)
    points, weights = quarter.control_points.reshape(3, 6, 3).copy(), quarter.weights.reshape(3, 6)
    points[:, 2::3, :2] = 0.0
    turn = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    slices = [points[k % 2] @ np.linalg.matrix_power(turn, k // 2) for k in range(9)]
    round_it = Direction("N", 2, np.array([0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0]))
    return Patch((_ARC, _LINE, round_it), np.concatenate(slices), np.concatenate([weights[k % 2] for k in range(9)]))


def turned_volume(major: float, inner: float, outer: float, section: tuple[float, float], turn: float) -> float:
    """Volume of `turned_sector`."""
    flat = major * (outer**2 - inner**2) / 2 * (section[1] - section[0])
    return turn * (flat + (outer**3 - inner**3) / 3 * float(np.diff(np.sin(section))[0]))


def turned_area(major: float, outer: float, section: tuple[float, float], turn: float) -> float:
    """Area of the outer face, v1, of `turned_sector`."""
    return turn * outer * (major * (section[1] - section[0]) + outer * float(np.diff(np.sin(section))[0]))


def _arc(start: float, end: float) -> tuple[FloatArray, FloatArray]:
    """Control points, shape (3, 2), and weights of an arc of the unit circle, less than half of it."""
    half = (end - start) / 2
    angles = np.array([start, start + half, end])
    weights = np.array([1.0, np.cos(half), 1.0])
    return np.column_stack([np.cos(angles), np.sin(angles)]) / weights[:, None], weights


def roof(order: int, slope: float, across: int = 0) -> Patch:
    """Two by two Lagrange elements below z = slope |x| (curved a little at order 2), -1 < x < 1, 0 < y < 1: bent along x = 0.

    `across` is the surface coordinate that runs across the bend: with 1, x and y change places.
    """
    low, high = ((-1.0, 0.0, -1.0), (1.0, 1.0, 0.0)) if across == 0 else ((0.0, -1.0, -1.0), (1.0, 1.0, 0.0))
    patch = mesh(box(low, high), ("L", "L", "L"), (order, order, 1), (2, 2, 1))
    points = patch.control_points.copy()
    x, top = np.abs(points[:, across]), points[:, 2] > -0.5
    points[top, 2] = (slope * x + (order - 1) * 0.05 * x**2)[top]
    return replace(patch, control_points=points)
