"""Solid bodies drawn with Matplotlib: parallel projection, faces away from the eye left out, the rest painted from back to front."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection, PolyCollection
from matplotlib.path import Path
from numpy.typing import NDArray

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray

#: Left free round what is drawn, as a share of its size.
_MARGIN = 0.01
_EDGE = np.array([0.16, 0.18, 0.22])
#: A sphere is drawn as discs, each within the one before, towards the light and brighter.
_DISCS, _CORNERS = 6, 28


@frozen
class Camera:
    """Direction of view: `azimuth` and `elevation` of the eye in degrees, about the vertical z."""

    azimuth: float
    elevation: float

    @property
    def axes(self) -> FloatArray:
        """Rows: to the right, upwards, towards the eye."""
        a, e = np.radians([self.azimuth, self.elevation])
        eye = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        return np.array([right, np.cross(eye, right), eye])

    def places(self, points: FloatArray) -> FloatArray:
        """Where points of shape (..., 3) appear in the picture, shape (..., 2)."""
        return points @ self.axes[:2].T

    def corners(self, points: FloatArray) -> FloatArray:
        """Lower left and upper right corner of where points of shape (n, 3) appear, with a small margin, shape (2, 2)."""
        return _corners(self.places(points))


class Canvas:
    """Collects surfaces and paints them."""

    def __init__(self, camera: Camera) -> None:
        self._axes = camera.axes
        self._shapes: list[FloatArray] = []
        self._depths: list[FloatArray] = []
        self._colours: list[FloatArray] = []
        self._widths: list[FloatArray] = []

    def add_floor(self, corners: FloatArray, colour: FloatArray) -> None:
        """Add a flat polygon, shape (n, 3), behind everything else."""
        self._add((corners @ self._axes.T)[None], -np.inf, colour[None], 0.0)

    def add_surface(
        self,
        points: FloatArray,
        colours: FloatArray,
        outward: int,
        lines: tuple[NDArray[np.int64], NDArray[np.int64]],
        shading: float = 1.0,
        opacity: float = 1.0,
    ) -> None:
        """Add a surface with its element boundaries.

        Parameters
        ----------
        points : ndarray, shape (m2, m1, 3)
            The surface has a hole where they are NaN.
        colours : ndarray, shape (m2 - 1, m1 - 1, 3)
            Of each small quadrilateral, before shading; NaN: it is left out, the lines along it stay.
        outward : {-1, 0, 1}
            Sign of a1 x a2 along the outward normal: seen from that side only. 0: seen from both sides.
        lines : tuple of ndarray
            Columns and rows of points along which an element boundary is drawn.
        shading : float
            1: as light falls; 0: the colours as they are.
        opacity : float
            Below 1 what lies behind shows through.
        """
        seen = points @ self._axes.T
        corners = np.stack([seen[:-1, :-1], seen[:-1, 1:], seen[1:, 1:], seen[1:, :-1]], axis=2)
        normals = _normals(corners, outward)
        front = normals[..., 2] > 0
        painted = front & np.isfinite(colours).all(axis=-1)
        shaded = _shaded(colours, normals, shading)[painted]
        self._add(corners[painted], 0.0, shaded, 0.3 if opacity == 1.0 else 0.0, opacity)
        self._add_lines(seen, front, lines[1])
        self._add_lines(seen.swapaxes(0, 1), front.T, lines[0])

    def add_polygons(self, corners: FloatArray, colours: FloatArray, shading: float = 1.0) -> None:
        """Add nearly flat polygons that are seen from both sides: corners of shape (n, k, 3), a colour each, shape (n, 3)."""
        seen = corners @ self._axes.T
        self._add(seen, 0.0, _shaded(colours, _normals(seen, 0), shading), 0.3)

    def add_spheres(self, centres: FloatArray, radius: float, colour: FloatArray) -> None:
        """Add spheres, centres of shape (n, 3)."""
        seen = centres @ self._axes.T
        angles = 2 * np.pi * np.arange(_CORNERS) / _CORNERS
        circle = radius * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
        for disc in range(_DISCS):
            share = disc / _DISCS
            middle = seen + radius * share * np.array([-0.32, 0.38, 0.0])
            shapes = middle[:, None] + (1 - share) * circle
            brighter = 0.62 * colour + 0.38 * share * np.ones(3) + 0.38 * (1 - share) * colour * 0.6
            self._add(shapes, radius * (1 + 1e-3 * disc), np.broadcast_to(brighter, (len(shapes), 3)), 0.0)

    def add_segments(self, segments: FloatArray, colour: FloatArray, width: float) -> None:
        """Add straight lines, ends of shape (n, 2, 3)."""
        self._add(segments @ self._axes.T, 0.0, np.broadcast_to(colour, (len(segments), 3)), width)

    def _add_lines(self, seen: FloatArray, front: NDArray[np.bool_], rows: NDArray[np.int64]) -> None:
        """Lines along rows of points, where the surface on one of their sides is seen; nearer to the eye than that surface."""
        beside = np.clip(np.stack([rows - 1, rows]), 0, len(front) - 1)
        segments = np.stack([seen[rows, :-1], seen[rows, 1:]], axis=2)[front[beside].any(axis=0)]
        across = np.linalg.norm(np.diff(seen, axis=0), axis=-1)
        self._add(segments, 1.5 * float(np.nanmedian(across)), np.broadcast_to(_EDGE, (len(segments), 3)), 0.55)

    def limits(self) -> FloatArray:
        """Lower left and upper right corner of all that was added, with a small margin."""
        return _corners(np.concatenate([group.reshape(-1, 3)[:, :2] for group in self._shapes]))

    def paint(self, axes: Axes, limits: FloatArray | None = None) -> None:
        """Paint all that was added, and show the part of it between `limits`, or all of it."""
        depth = np.concatenate(self._depths)
        order = np.argsort(depth)
        shapes = [outline for group in self._shapes for outline in _outlines(group)]
        colours = np.concatenate(self._colours)[order]
        widths = np.concatenate(self._widths)[order]
        collection = PathCollection([shapes[i] for i in order], facecolors=colours, edgecolors=colours, linewidths=widths)
        collection.set_capstyle("round")
        collection.set_joinstyle("round")
        axes.add_collection(collection, autolim=False)
        low, high = self.limits() if limits is None else limits
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
        axes.axis("off")

    def _add(self, shapes: FloatArray, nearer: float, colours: FloatArray, width: float, opacity: float = 1.0) -> None:
        self._shapes.append(shapes)
        self._depths.append(shapes[..., 2].mean(axis=1) + nearer)
        self._colours.append(np.column_stack([np.clip(colours, 0, 1), np.full(len(colours), opacity)]))
        self._widths.append(np.full(len(shapes), width))


def _outlines(corners: FloatArray) -> list[Path]:
    """Closed outlines of polygons (n, k, 3) in a picture; made all at once, which takes a fraction of the time."""
    places: Any = corners[..., :2]  # the types of Matplotlib do not know of arrays here
    return list(PolyCollection(places).get_paths())


def _corners(places: FloatArray) -> FloatArray:
    """Lower left and upper right corner about places in a picture, with a small margin, shape (2, 2)."""
    low, high = places.min(axis=0), places.max(axis=0)
    margin = _MARGIN * (high - low).max()
    return np.array([low - margin, high + margin])


def _normals(corners: FloatArray, outward: int) -> FloatArray:
    """Unit normals of polygons with corners (..., k, 3): `outward` times that of a counter-clockwise turn, or 0: towards the eye."""
    normals = np.cross(corners, np.roll(corners, -1, axis=-2)).sum(axis=-2)
    normals *= outward if outward else np.sign(normals[..., 2:])
    return normals / np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-300)


def _shaded(colours: FloatArray, normals: FloatArray, shading: float) -> FloatArray:
    return colours * (1.0 - shading * (1.0 - _brightness(normals)))[..., None]


def _brightness(normals: FloatArray) -> FloatArray:
    """Brightness by a main light from above left of the eye and a weak one from the right."""
    main, fill = np.array([-0.45, 0.65, 0.61]), np.array([0.7, 0.1, 0.7])
    return 0.52 + 0.42 * np.maximum(normals @ main, 0) + 0.14 * np.maximum(normals @ fill, 0)
