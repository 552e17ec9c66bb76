"""The built-in bodies beside their exact shapes in coordinates of their own: whole, in part, solid, hollow, with poles and without."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from shapes import turned_area

from isomortar.geometry.patch import Closed, FloatArray, Patch
from isomortar.geometry.primitives import cap, ring, sphere, torus, wedge
from isomortar.geometry.refinement import mesh

#: Points by direction and piece of the exact shape: polynomials of sines over a quarter of a circle are integrated to round-off.
_POINTS, _PIECES = 12, 4
#: From coordinates in a unit cube to places, with the rate of volume; each shape (n,) or (n, 3).
Exact = Callable[[FloatArray, FloatArray, FloatArray], tuple[FloatArray, FloatArray]]


@dataclass(frozen=True)
class Built:
    """A body as it is built, its exact shape, and of its face `curved` the area, and how far a point is from where it should be."""

    patch: Patch
    exact: Exact
    curved: str
    area: float
    off: Callable[[FloatArray], FloatArray]
    closed: Closed | None = None

    def moments(self) -> tuple[float, FloatArray, FloatArray]:
        """Volume, its first moments, shape (3,), and its second ones, shape (3, 3), of the exact shape."""
        line, weight = np.polynomial.legendre.leggauss(_POINTS)
        places = ((np.arange(_PIECES)[:, None] + 0.5 * (1.0 + line)) / _PIECES).ravel()
        rate = np.tile(0.5 * weight / _PIECES, _PIECES)
        x, volume = self.exact(*(axis.ravel() for axis in np.meshgrid(places, places, places, indexing="ij")))
        volume = volume * np.einsum("i,j,k->ijk", rate, rate, rate).ravel()
        return float(volume.sum()), volume @ x, np.einsum("q,qi,qj->ij", volume, x, x)


def _turned(
    section: Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray, FloatArray]],
    angles: tuple[float, float],
    axis: str,
    centre: tuple[float, float, float],
) -> Exact:
    """Turned about an axis: `section` gives distance from the axis, height along it, and its rate of area."""
    up, (start, end) = "xyz".index(axis), np.radians(angles)

    def exact(a: FloatArray, b: FloatArray, c: FloatArray) -> tuple[FloatArray, FloatArray]:
        radius, height, rate = section(b, c)
        angle = start + a * (end - start)
        points = np.roll(np.column_stack([height, radius * np.cos(angle), radius * np.sin(angle)]), up, axis=1)
        return points + centre, (end - start) * radius * rate

    return exact


def _rectangle(inner: float, outer: float, width: float) -> Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray, FloatArray]]:
    return lambda b, c: (inner + b * (outer - inner), (c - 0.5) * width, np.full_like(b, (outer - inner) * width))


def _round(
    major: float, inner: float, outer: float, latitudes: tuple[float, float]
) -> Callable[[FloatArray, FloatArray], tuple[FloatArray, FloatArray, FloatArray]]:
    low, high = np.radians(latitudes)

    def section(b: FloatArray, c: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        rho, latitude = inner + b * (outer - inner), low + c * (high - low)
        return major + rho * np.cos(latitude), rho * np.sin(latitude), (outer - inner) * (high - low) * rho

    return section


def _ring(inner: float, outer: float, width: float, angles: tuple[float, float], axis: str, closed: Closed | None = None) -> Built:
    centre, up = (0.1, -0.2, 0.3), "xyz".index(axis)
    exact = _turned(_rectangle(inner, outer, width), angles, axis, centre)
    patch = ring(centre, inner, outer, width, angles, axis)  # type: ignore[arg-type]
    area = outer * width * float(np.radians(angles[1] - angles[0]))
    return Built(patch, exact, "v1", area, lambda x: np.linalg.norm(np.delete(x - centre, up, axis=1), axis=1) - outer, closed)


def _round_body(
    major: float,
    radii: tuple[float, float],
    latitudes: tuple[float, float],
    angles: tuple[float, float],
    axis: str,
    closed: Closed | None = None,
) -> Built:
    """Part of a sphere (`major` 0) or a torus."""
    centre, up = (0.1, -0.2, 0.3), "xyz".index(axis)
    exact = _turned(_round(major, *radii, latitudes), angles, axis, centre)
    patch = torus(centre, major, *radii, latitudes, angles, axis) if major else sphere(centre, *radii, latitudes, angles, axis)  # type: ignore[arg-type]

    def off(x: FloatArray) -> FloatArray:
        x = x - centre
        return np.hypot(np.linalg.norm(np.delete(x, up, axis=1), axis=1) - major, x[:, up]) - radii[1]

    section, turn = (float(np.radians(latitudes[0])), float(np.radians(latitudes[1]))), float(np.radians(angles[1] - angles[0]))
    return Built(patch, exact, "v1", turned_area(major, radii[1], section, turn), off, closed)


def _cap(radius: float, half_width: float, bottom: float, top: float) -> Built:
    """In coordinates of the plane that the sphere is projected from."""
    end = 2.0 * half_width / (1.0 + np.sqrt(1.0 - (half_width / radius) ** 2))

    def exact(a: FloatArray, b: FloatArray, c: FloatArray) -> tuple[FloatArray, FloatArray]:
        s, t = end * (2.0 * a - 1.0), end * (2.0 * b - 1.0)
        share = (s**2 + t**2) / (4.0 * radius**2)
        low = bottom + 2.0 * radius * share / (1.0 + share)
        points = np.column_stack([s / (1.0 + share), t / (1.0 + share), low + c * (top - low)])
        return points, 4.0 * end**2 * (1.0 - share) / (1.0 + share) ** 3 * (top - low)

    line, weight = np.polynomial.legendre.leggauss(40)
    squares = (end * line[:, None]) ** 2 + (end * line) ** 2
    area = float(weight @ (1.0 + squares / (4.0 * radius**2)) ** -2 @ weight) * end**2

    def off(x: FloatArray) -> FloatArray:
        return np.linalg.norm(x - [0.0, 0.0, bottom + radius], axis=1) - radius

    return Built(cap((0.0, 0.0), radius, half_width, bottom, top), exact, "w0", area, off)


def _wedge(bottom: tuple[float, float], top: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Built:
    def exact(a: FloatArray, b: FloatArray, c: FloatArray) -> tuple[FloatArray, FloatArray]:
        low, high = (1.0 - c) * bottom[0] + c * top[0], (1.0 - c) * bottom[1] + c * top[1]
        points = np.column_stack([low + a * (high - low), y[0] + b * (y[1] - y[0]), z[0] + c * (z[1] - z[0])])
        return points, (high - low) * (y[1] - y[0]) * (z[1] - z[0])

    slope = np.array([top[1] - bottom[1], z[1] - z[0]])
    across = np.array([slope[1], -slope[0]]) / np.linalg.norm(slope)
    return Built(
        wedge(bottom, top, y, z),
        exact,
        "u1",
        float(np.linalg.norm(slope)) * (y[1] - y[0]),
        lambda x: (x[:, [0, 2]] - [bottom[1], z[0]]) @ across,
    )


BODIES = {
    "pipe": _ring(0.5, 0.8, 0.4, (0.0, 360.0), "y", "u"),
    "half pipe": _ring(0.5, 0.8, 0.4, (-180.0, 0.0), "y"),
    "cylinder": _ring(0.0, 0.8, 0.4, (0.0, 360.0), "z", "u"),
    "sector": _ring(0.0, 0.8, 0.4, (20.0, 140.0), "x"),
    "octant": _round_body(0.0, (0.0, 0.9), (-90.0, 0.0), (0.0, 90.0), "z"),
    "ball": _round_body(0.0, (0.0, 0.9), (-90.0, 90.0), (0.0, 360.0), "z", "u"),
    "shell": _round_body(0.0, (0.5, 0.9), (-90.0, -40.0), (0.0, 360.0), "z", "u"),
    "hemisphere": _round_body(0.0, (0.5, 0.9), (-90.0, 90.0), (-180.0, 0.0), "x"),
    "torus": _round_body(1.2, (0.0, 0.5), (-180.0, 180.0), (0.0, 360.0), "y", "uw"),
    "rounded edge": _round_body(0.4, (0.6, 0.9), (-90.0, -20.0), (10.0, 100.0), "z"),
    "cap": _cap(1.0, 0.8, -0.2, 1.5),
    "wedge": _wedge((0.1, 0.1), (-0.7, 0.9), (0.2, 1.4), (-0.5, 0.6)),
}  # fmt: skip


@cache
def refined(body: str, kind: str, grading: float = 1.0) -> Patch:
    """A body of that kind, or of its own order where that is higher, with two elements for each of its own; graded along all directions."""
    patch = BODIES[body].patch
    family, order = kind[0], int(kind[1:])
    orders = [order if family == "L" else max(order, d.order) for d in patch.directions]
    return mesh(patch, (family,) * 3, orders, [2 * d.elements for d in patch.directions], (grading,) * 3)  # type: ignore[arg-type]
