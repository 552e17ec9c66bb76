"""Flat map of a slave face: a field of it, control points and their state."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model.entities import Problem
from isomortar.results import style
from isomortar.results.face_field import FaceField
from isomortar.results.fields import ContactSurface
from isomortar.results.laid import Laid, directions_of, laid
from isomortar.results.ranges import Dimension, narrowest
from isomortar.solve.record import StepResult

#: By status of a control point: marker, filling, label.
_STATES = (("o", "none", "open"), ("s", style.BLUE, "stick"), ("^", "white", "slip"))
#: Samples along a face, and arrows along the longer side of what is seen of it.
_SAMPLES, _ARROWS = 240, 24
#: Height of what is seen over its length below which the colour bar is under it: beside it, it would be shorter than its label.
_LONG = 0.4


def draw_map(problem: Problem, step: StepResult, field: FaceField) -> Figure:
    """A slave face laid flat, in colours by a field, with arrows where that is one of vectors.

    Control points stand where the face's functions have their Greville abscissae (Lagrange: their nodes).
    """
    surface, flat = field.surface, laid(field.surface)
    figure = Figure(figsize=(6.4, 4.4))
    axes = figure.subplots()
    _draw_material(axes, surface, flat)
    seen = _seen(surface)
    _draw_states(axes, surface, flat)
    axes.set(xlabel=flat.labels[0], ylabel=flat.labels[1], aspect="equal")
    axes.set_title(f"{problem.name}, {surface.contact.name}, load step {step.step} ({step.stage})", loc="left", pad=24)
    axes.legend(ncols=3, loc="lower right", bbox_to_anchor=(1.0, 1.0), handletextpad=0.2, columnspacing=1.2)
    low, high = (end(flat.at(seen)[0], axis=(0, 1)) for end in (np.min, np.max))
    is_long = high[1] - low[1] < _LONG * (high[0] - low[0])
    figure.set_layout_engine("compressed" if is_long else "constrained")
    _draw_field(axes, field, flat, seen, narrowest(problem, Dimension.LENGTH) if field.signed else 1e-300, is_long)
    margin = 0.03 * (high - low)
    axes.set(xlim=(low[0] - margin[0], high[0] + margin[0]), ylim=(low[1] - margin[1], high[1] + margin[1]))
    if field.values.shape[1] > 1:
        _draw_arrows(axes, field, flat, seen)
    return figure


def _draw_material(axes: Axes, surface: ContactSurface, flat: Laid) -> None:
    """Knot lines on bare material, which is seen where nothing presses."""
    first, second = surface.directions
    along, across = _samples(first), _samples(second)
    upright = flat.at((first.boundaries, across))[0].swapaxes(0, 1)
    level = flat.at((along, second.boundaries))[0]
    outline = np.concatenate([level[0], upright[-1], level[-1][::-1], upright[0][::-1]])
    axes.add_patch(Polygon(outline, facecolor=style.SLAVE, linewidth=0, zorder=0))
    axes.add_collection(LineCollection([*upright, *level], colors=style.BLACK, linewidths=0.4, alpha=0.6))


def _draw_field(axes: Axes, field: FaceField, flat: Laid, seen: tuple[FloatArray, FloatArray], least: float, is_long: bool) -> None:
    """Colours, up to the largest value of what is seen, or `least` where that is round-off, and their bar: below a map that is long."""
    samples = [_samples(direction) for direction in field.surface.directions]
    sizes, values = (_sizes(field, parameters) for parameters in (seen, samples))
    known = field.surface.over_master(seen)
    peak = max(float((np.abs(sizes[known]) if field.signed else sizes).max(initial=0.0)), least)
    pulls = not field.signed and bool(values.min() < -style.NOTHING * peak)
    unseen = ~field.surface.over_master(samples) if field.signed else np.abs(values) < style.UNSEEN * peak
    shown = np.ma.masked_where(unseen, values)
    x, y = np.moveaxis(flat.at(samples)[0], -1, 0)
    lowest = -peak if field.signed else 0.0
    image = axes.pcolormesh(x, y, shown, shading="gouraud", cmap=field.colours, vmin=lowest, vmax=peak, rasterized=True)
    place = {"ax": axes, "location": "bottom", "aspect": 40} if is_long else {"cax": axes.inset_axes((1.02, 0.0, 0.025, 1.0))}
    bar = axes.figure.colorbar(image, **place, extend="min" if pulls else "neither")
    bar.set_label(field.label)


def _sizes(field: FaceField, parameters: Sequence[FloatArray]) -> FloatArray:
    """Values on a grid of parameters, or the norms of vectors, shape (n2, n1)."""
    values = _values(field, parameters)
    return values[..., 0] if values.shape[-1] == 1 else np.linalg.norm(values, axis=-1)


def _values(field: FaceField, parameters: Sequence[FloatArray]) -> FloatArray:
    """Values on a grid of parameters, shape (n2, n1, k): what acts of them (theory 8.7), and gaps as they are."""
    surface = field.surface
    values, places = (surface.on_grid(parameters, control)[0] for control in (field.values, surface.reference_points))
    return values if field.signed else surface.footing.acting(places, values, field.values)


def _draw_states(axes: Axes, surface: ContactSurface, flat: Laid) -> None:
    points = flat.at([direction.greville for direction in surface.directions])[0].reshape(-1, 2)
    for state, (marker, filling, label) in enumerate(_STATES):
        mine = points[surface.status == state]
        axes.plot(*mine.T, marker, color=style.BLACK, markerfacecolor=filling, markeredgewidth=0.8, markersize=4.5, label=label)


def _draw_arrows(axes: Axes, field: FaceField, flat: Laid, seen: tuple[FloatArray, FloatArray]) -> None:
    """Vectors on a grid of places, the longest as long as these are apart."""
    surface = field.surface
    ends = flat.at([x[[0, -1]] for x in seen])[0]
    lengths = np.array([np.linalg.norm(ends[0, 1] - ends[0, 0]), np.linalg.norm(ends[1, 0] - ends[0, 0])])
    counts = np.maximum(np.round(_ARROWS * lengths / lengths.max()), 2).astype(int)
    grid = [_middles(x[0], x[-1], count) for x, count in zip(seen, counts, strict=True)]
    vectors = _values(field, grid)
    sizes = np.linalg.norm(vectors, axis=-1)
    arrows = sizes[..., None] * directions_of(surface, flat, grid, vectors)
    places, felt = flat.at(grid)[0], sizes > style.UNSEEN * max(float(sizes.max()), 1e-300)
    if felt.any():
        scale = float(sizes.max()) * _ARROWS / lengths.max()
        axes.quiver(*places[felt].T, *arrows[felt].T, angles="xy", scale_units="xy", scale=scale, color=style.BLACK, width=2.5e-3)


def _samples(direction: Direction) -> FloatArray:
    return direction.subdivided(max(4, _SAMPLES // direction.elements))


def _middles(low: float, high: float, count: int) -> FloatArray:
    return low + (np.arange(count) + 0.5) / count * (high - low)


def _seen(surface: ContactSurface) -> tuple[FloatArray, FloatArray]:
    """Samples of the part of the face that is in contact and two elements around it; of the whole face if nothing is."""
    points = np.stack(np.meshgrid(*(direction.greville for direction in surface.directions)), axis=-1).reshape(-1, 2)
    active = points[surface.status > 0]
    first, second = (_within(direction, active[:, axis]) for axis, direction in enumerate(surface.directions))
    return first, second


def _within(direction: Direction, active: FloatArray) -> FloatArray:
    ends, samples = direction.boundaries, _samples(direction)
    if not len(active):
        return samples
    first, last = np.searchsorted(ends, [active.min(), active.max()])
    low, high = ends[max(first - 2, 0)], ends[min(last + 2, len(ends) - 1)]
    return samples[(samples >= low) & (samples <= high)]
