"""Contact pressure and tangential traction as surfaces over the contact patch (Figs. 2, 3, 5, 8)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgb
from matplotlib.ticker import MaxNLocator
from paper.figures.flat import CONTACT_ZONE, FlatPatch, Quantity, lay_flat
from paper.figures.picture import Panel, Picture, rendering
from paper.figures.sheet import Mark, Sheet
from paper.figures.zones import corners_of, zones

from isomortar.geometry.patch import FloatArray
from isomortar.results import style
from isomortar.results.rendering import Camera, Canvas

_LABELS: dict[Quantity, str] = {
    "pressure": "contact pressure $p$\n(force / area)",
    "traction": "tangential traction $\\tau_1/\\mu$\n(force / area $\\times$ length / parameter)",
    "traction_2": "tangential traction $\\tau_2/\\mu$\n(force / area $\\times$ length / parameter)",
    "gap": f"gap $g$ (length), positive: penetration;\nwhere $p$ is above {100 * CONTACT_ZONE:g} % of its peak",
}
_SPHERES: dict[Quantity, str] = {
    "pressure": "control pressures $p^I$",
    "traction": "control tractions $\\tau_1^I/\\mu$",
    "traction_2": "control tractions $\\tau_2^I/\\mu$",
    "gap": "control gaps $g^I$",
}
#: Of a sphere, over the longer side of the patch.
_RADIUS = 0.011
_VIEW = Camera(azimuth=-60.0, elevation=27.0)
#: Height of the surfaces over the longer side of the patch.
_HEIGHT = 0.6
_SHADING = 0.55
_NEGATIVE, _SPHERE = "#6F7680", style.BLUE


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
    patches, region = lay_flat(panels, quantity)
    heights = np.array([panel.height_scale * _range(patch) for panel, patch in zip(panels, patches, strict=True)])
    frame = _Frame(region, min(0.0, float(heights.min())), float(heights.max()))
    colours = _colours([p for p, panel in zip(patches, panels, strict=True) if panel.height_scale == 1.0] or patches, quantity)
    canvases = [_canvas(panel, patch, colours, frame, quantity) for panel, patch in zip(panels, patches, strict=True)]
    drawn = np.array([canvas.limits() for canvas in canvases])
    limits = frame.with_labels(np.array([drawn[:, 0].min(axis=0), drawn[:, 1].max(axis=0)]))
    across, up = np.ptp(limits, axis=0)
    marks = [Mark(_SPHERES[quantity], "o", _SPHERE)]
    if any(patch.whole and patch.zone.min() < 0 for patch in patches):
        marks.append(Mark("negative contact pressure", "s", _NEGATIVE))
    with style.style():
        sheet = Sheet([_title(panel) for panel in panels], float(across / up), True, marks)
        for axes, panel, patch, canvas in zip(sheet.panels, panels, patches, canvases, strict=True):
            canvas.paint(axes, limits)
            _draw_height_axis(axes, panel.height_scale, frame)
            _draw_lengths(axes, patch.letters, frame)
        sheet.add_bar(colours, _LABELS[quantity], np.concatenate([patch.shown for patch in patches]))
    return rendering(sheet.figure, f"{quantity}: {', '.join(panel.title for panel in panels)}")


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
        return np.array([low - self.size * np.array([0.17, 0.05]), high + self.size * np.array([0.08, 0.0])])

    def lifted(self, places: FloatArray, values: FloatArray) -> FloatArray:
        """Points over the patch, shape (..., 3), from places (..., 2) and heights in values."""
        return np.concatenate([places, self._scale * values[..., None]], axis=-1)

    def corners(self, height: float) -> FloatArray:
        """Corners of the region, counter-clockwise from the lower one."""
        (x0, y0), (x1, y1) = self.region
        return self.lifted(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]]), np.full(4, height))


def _title(panel: Panel) -> str:
    return panel.title if panel.height_scale == 1.0 else f"{panel.title} (heights times {panel.height_scale:g})"


def _range(patch: FlatPatch) -> FloatArray:
    """Smallest and largest value of the field and of what the spheres show."""
    shown = np.concatenate([patch.shown, patch.control_values])
    return np.array([shown.min(), shown.max()])


def _colours(patches: Sequence[FlatPatch], quantity: Quantity) -> ScalarMappable:
    if quantity == "pressure":
        return ScalarMappable(Normalize(0.0, max(float(p.shown.max()) for p in patches)), style.pressure_colours())
    reach = max(float(np.abs(p.shown).max()) for p in patches)
    return ScalarMappable(Normalize(-reach, reach), style.signed_colours())


def _canvas(panel: Panel, patch: FlatPatch, colours: ScalarMappable, frame: _Frame, quantity: Quantity) -> Canvas:
    canvas = Canvas(_VIEW)
    for height in {0.0, frame.low}:
        canvas.add_segments(_outline(frame.corners(height)), np.array(to_rgb(style.GREY)), 0.8)
    grid = np.stack(np.meshgrid(*patch.samples), axis=-1)
    _add_field(canvas, frame.lifted(grid, panel.height_scale * patch.values), patch, colours, quantity)
    centres = frame.lifted(patch.points, panel.height_scale * patch.control_values)
    canvas.add_spheres(centres, _RADIUS * frame.size, np.array(to_rgb(_SPHERE)))
    return canvas


def _outline(corners: FloatArray) -> FloatArray:
    """The edges between corners, in pieces short enough to be hidden where something is before them."""
    places = np.linspace(0.0, 1.0, 61)[:, None, None]
    edges = (corners + places * (np.roll(corners, -1, axis=0) - corners)).swapaxes(0, 1)
    return np.stack([edges[:, :-1], edges[:, 1:]], axis=2).reshape(-1, 2, 3)


def _add_field(canvas: Canvas, points: FloatArray, patch: FlatPatch, colours: ScalarMappable, quantity: Quantity) -> None:
    """The surface, its zone in colour and the rest grey or left out, knot lines included."""
    parted = zones(points, patch.zone)
    values = 0.25 * (patch.values[1:, 1:] + patch.values[1:, :-1] + patch.values[:-1, 1:] + patch.values[:-1, :-1])
    if quantity == "pressure":
        values = np.maximum(values, 0.0)
    painted, grey = colours.to_rgba(values)[..., :3], np.array(to_rgb(_NEGATIVE))
    cells = np.where(parted.positive[..., None], painted, np.nan)
    canvas.add_polygons(parted.parts[:, 0], painted[parted.cut], _SHADING)
    if patch.whole:
        cells[parted.negative] = grey
        canvas.add_polygons(parted.parts[:, 1], np.broadcast_to(grey, (len(parted.parts), 3)), _SHADING)
    else:
        points = np.where(corners_of(parted.positive)[..., None], points, np.nan)
    canvas.add_surface(points, cells, 0, patch.lines, _SHADING)


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
        axes.text(x, y - 0.02 * frame.size, f" ${letters[number]}$ \n length {size:.2f} ", ha=side, va="top", fontsize=8)
