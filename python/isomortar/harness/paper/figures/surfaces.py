"""Contact pressure and tangential traction as surfaces over the contact patch (Figs. 2, 3, 5, 8)."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from isomortar.geometry.patch import FloatArray
from isomortar.harness.paper.figures.flat import CONTACT_ZONE, FlatPatch, Quantity, lay_flat, region_of_contact
from isomortar.harness.paper.figures.picture import Panel, Picture, beyond, rendering
from isomortar.harness.paper.figures.zones import zones
from isomortar.results import style
from isomortar.results.rendering import Camera, Canvas

_LABELS: dict[Quantity, str] = {
    "pressure": "contact pressure $p$ (force / area)",
    "traction": r"tangential traction $\tau_1/\mu$ (force / area $\times$ length / parameter)",
    "traction_2": r"tangential traction $\tau_2/\mu$ (force / area $\times$ length / parameter)",
    "gap": f"gap $g$ (length) where $p$ > {100 * CONTACT_ZONE:g} % of its peak; positive: penetration",
}
#: Of a sphere, over the longer side of the patch.
_RADIUS = 0.011
_VIEW = Camera(azimuth=-60.0, elevation=27.0)
#: Height of the surfaces over the longer side of the patch.
_HEIGHT = 0.6
_SHADING = 0.55
_NEGATIVE, _SPHERE, _FRAME = (np.array(to_rgb(colour)) for colour in ("#6F7680", style.BLUE, style.GREY))


def draw(panels: Sequence[Panel], quantity: Quantity) -> Picture:
    """A surface a panel, all in one scale of lengths, heights and colours; spheres are the control values of active control points.

    A panel with another `height_scale` says so. Grey: where the pressure is negative.

    Parameters
    ----------
    panels : sequence of Panel
        Of each, the first contact pair is drawn.
    quantity : {"pressure", "traction", "traction_2", "gap"}
        The control pressures' field; a covariant component of the traction over the friction coefficient, as in the paper; the gap at
        each place of the contact zone, spheres the control gaps.
    """
    patches = [lay_flat(panel, quantity) for panel in panels]
    region = region_of_contact(patches)
    patches = [patch.within(region) for patch in patches]
    heights = np.array([panel.height_scale * _range(patch) for panel, patch in zip(panels, patches, strict=True)])
    frame = _Frame(region, min(0.0, float(heights.min())), float(heights.max()))
    colours = _colours([p for p, panel in zip(patches, panels, strict=True) if panel.height_scale == 1.0] or patches, quantity)
    rows = math.ceil(len(panels) / 4)
    columns = math.ceil(len(panels) / rows)
    canvases = [_canvas(panel, patch, colours, frame, quantity) for panel, patch in zip(panels, patches, strict=True)]
    drawn = np.array([canvas.limits() for canvas in canvases])
    limits = frame.with_labels(np.array([drawn[:, 0].min(axis=0), drawn[:, 1].max(axis=0)]))
    across, up = np.ptp(limits, axis=0)
    with style.style():
        figure = Figure(figsize=(10.6, max(2.6, rows * (9.6 / columns * up / across + 0.35))), layout="constrained")
        grid = figure.subplots(rows, columns, squeeze=False).ravel()
        for axes in grid:
            axes.set_axis_off()
        for axes, panel, patch, canvas in zip(grid, panels, patches, canvases, strict=False):
            canvas.paint(axes, limits)
            _draw_height_axis(axes, panel.height_scale, frame)
            _draw_lengths(axes, patch.letters, frame)
            scaled = "" if panel.height_scale == 1.0 else f" (heights times {panel.height_scale:g})"
            axes.set_title(panel.title + scaled, loc="left")
        extend = beyond(np.concatenate([patch.values[np.isfinite(patch.values)] for patch in patches]), colours)
        figure.colorbar(colours, ax=list(grid), shrink=0.85, aspect=26, pad=0.01, extend=extend, label=_LABELS[quantity])
    return rendering(figure, f"{quantity}: {', '.join(panel.title for panel in panels)}")


class _Frame:
    """The box that all panels share: region of the patch, heights from `low` to `high` in values, drawn in one proportion."""

    def __init__(self, region: FloatArray, low: float, high: float) -> None:
        self.region, self.low, self.high = region, low, max(high, low + 1e-300)
        self.size = float(np.ptp(region, axis=0).max())
        self._scale = _HEIGHT * self.size / (self.high - self.low)

    def with_labels(self, limits: FloatArray) -> FloatArray:
        """Lower left and upper right corner of a picture, with room for the height axis and the names of the edges."""
        axis = _VIEW.places(np.array([self.corners(self.low)[0], self.corners(self.high)[0]]))
        low, high = np.minimum(limits[0], axis.min(axis=0)), np.maximum(limits[1], axis.max(axis=0))
        return np.array([low - self.size * np.array([0.17, 0.03]), high])

    def lifted(self, places: FloatArray, values: FloatArray) -> FloatArray:
        """Points over the patch, shape (..., 3), from places (..., 2) and heights in values."""
        return np.concatenate([places, self._scale * values[..., None]], axis=-1)

    def corners(self, height: float) -> FloatArray:
        """Corners of the region, counter-clockwise from the lower one."""
        (x0, y0), (x1, y1) = self.region
        return self.lifted(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]), np.full(4, height))


def _range(patch: FlatPatch) -> FloatArray:
    """Smallest and largest value of the field and of what the spheres show."""
    shown = [patch.values.ravel(), patch.control_values[patch.active]]
    return np.array([np.nanmin(np.concatenate(shown)), np.nanmax(np.concatenate(shown))])


def _colours(patches: Sequence[FlatPatch], quantity: Quantity) -> ScalarMappable:
    if quantity == "pressure":
        return ScalarMappable(Normalize(0.0, max(float(np.nanmax(p.values)) for p in patches)), style.pressure_colours())
    reach = max(float(np.nanmax(np.abs(p.values))) for p in patches)
    return ScalarMappable(Normalize(-reach, reach), style.signed_colours())


def _canvas(panel: Panel, patch: FlatPatch, colours: ScalarMappable, frame: _Frame, quantity: Quantity) -> Canvas:
    canvas = Canvas(_VIEW)
    for height in {0.0, frame.low}:
        canvas.add_segments(_outline(frame.corners(height)), _FRAME, 0.8)
    grid = np.stack(np.meshgrid(*patch.samples), axis=-1)
    _add_field(canvas, frame.lifted(grid, panel.height_scale * patch.values), patch, colours, quantity)
    centres = frame.lifted(patch.points[patch.active], panel.height_scale * patch.control_values[patch.active])
    canvas.add_spheres(centres, _RADIUS * frame.size, _SPHERE)
    return canvas


def _outline(corners: FloatArray) -> FloatArray:
    """The edges between corners, in pieces short enough to be hidden where something is before them."""
    places = np.linspace(0.0, 1.0, 61)[:, None, None]
    edges = (corners + places * (np.roll(corners, -1, axis=0) - corners)).swapaxes(0, 1)
    return np.stack([edges[:, :-1], edges[:, 1:]], axis=2).reshape(-1, 2, 3)


def _add_field(canvas: Canvas, points: FloatArray, patch: FlatPatch, colours: ScalarMappable, quantity: Quantity) -> None:
    """The surface: its zone in colour, the rest grey; of a gap there is no rest."""
    parted = zones(points, patch.zone)
    values = 0.25 * (patch.values[1:, 1:] + patch.values[1:, :-1] + patch.values[:-1, 1:] + patch.values[:-1, :-1])
    if quantity == "pressure":
        values = np.maximum(values, 0.0)
    painted = colours.to_rgba(values)[..., :3]
    cells = np.where(parted.positive[..., None], painted, np.nan)
    canvas.add_polygons(parted.parts[:, 0], painted[parted.cut], _SHADING)
    if quantity != "gap":
        cells[parted.negative] = _NEGATIVE
        canvas.add_polygons(parted.parts[:, 1], np.broadcast_to(_NEGATIVE, (len(parted.parts), 3)), _SHADING)
    canvas.add_surface(points, cells, 0, _lines(patch), _SHADING)


def _lines(patch: FlatPatch) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Columns and rows of samples that lie on element boundaries."""
    columns, rows = (np.searchsorted(s, b - 1e-9).astype(np.int64) for s, b in zip(patch.samples, patch.boundaries, strict=True))
    return columns, rows


def _draw_height_axis(axes: Axes, height_scale: float, frame: _Frame) -> None:
    """Values at the corner that stands farthest to the left."""
    low, high, tick = frame.low / height_scale, frame.high / height_scale, 0.02 * frame.size
    foot, top = _VIEW.places(np.array([frame.corners(frame.low)[0], frame.corners(frame.high)[0]]))
    axes.plot([foot[0], top[0]], [foot[1], top[1]], color=style.BLACK, linewidth=0.8)
    values = np.asarray(MaxNLocator(4, steps=(1, 2, 2.5, 5, 10)).tick_values(low, high))
    for value in values[(values >= low) & (values <= high)]:
        x, y = _VIEW.places(frame.corners(value * height_scale)[0])
        axes.plot([x - tick, x], [y, y], color=style.BLACK, linewidth=0.8)
        axes.text(x - 1.5 * tick, y, f"{value:g}", ha="right", va="center", fontsize=8)


def _draw_lengths(axes: Axes, letters: tuple[str, str], frame: _Frame) -> None:
    """Name and length of the two front edges, beside them."""
    corners = _VIEW.places(frame.corners(frame.low))
    for number, side in enumerate(("right", "left")):
        x, y = 0.5 * (corners[number] + corners[number + 1])
        size = float(np.ptp(frame.region, axis=0)[number])
        axes.text(x, y - 0.02 * frame.size, f" ${letters[number]}$, length {size:.3g} ", ha=side, va="top", fontsize=8)
