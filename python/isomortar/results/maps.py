"""Flat map of a slave face: contact pressure, control points and their state."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model.entities import Problem
from isomortar.results import style
from isomortar.results.bezier import sampling_matrix
from isomortar.results.fields import contact_surfaces
from isomortar.solve.record import StepResult

#: By status of a control point: marker, filling, label.
_STATES = (("o", "none", "open"), ("s", style.BLUE, "stick"), ("^", "white", "slip"))
_SAMPLES = 240


def draw_map(problem: Problem, step: StepResult, number: int) -> Figure:
    """The slave face of contact pair `number`, laid flat in its surface coordinates.

    Control points stand where the face's functions have their Greville abscissae (Lagrange: their nodes).
    """
    surface = contact_surfaces(problem, step)[number]
    letters = surface.letters
    directions = surface.directions
    lengths = surface.lengths
    parts = [max(4, _SAMPLES // d.elements) for d in directions]
    samples = [d.subdivided(n) for d, n in zip(directions, parts, strict=True)]
    _, field, _ = surface.fields((sampling_matrix(directions[0], parts[0]), sampling_matrix(directions[1], parts[1])))
    grid = field.reshape(len(samples[1]), len(samples[0]))
    points = np.stack(np.meshgrid(directions[0].greville, directions[1].greville), axis=-1).reshape(-1, 2)
    if lengths[0] < lengths[1]:  # the longer coordinate runs to the right
        samples, grid, points = samples[::-1], grid.T, points[:, ::-1]
        directions, letters, lengths = directions[::-1], letters[::-1], lengths[::-1]
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    peak = max(float(field.max()), 1e-300)
    shown = np.ma.masked_where(np.abs(grid) < style.UNSEEN * peak, grid)
    image = axes.pcolormesh(*samples, shown, shading="gouraud", cmap=style.pressure_colours(), vmin=0.0, vmax=peak, rasterized=True)
    pulls = bool(grid.min() < -style.NOTHING * peak)
    bar = figure.colorbar(image, cax=axes.inset_axes((1.02, 0.0, 0.025, 1.0)), extend="min" if pulls else "neither")
    bar.set_label("contact pressure (force / area)")
    _draw_elements(axes, directions)
    for state, (marker, filling, label) in enumerate(_STATES):
        mine = points[surface.status == state]
        axes.plot(*mine.T, marker, color=style.BLACK, markerfacecolor=filling, markeredgewidth=0.8, markersize=4.5, label=label)
    axes.set(xlabel=f"surface coordinate {letters[0]}", ylabel=f"surface coordinate {letters[1]}")
    axes.set_title(f"{problem.name}, {surface.contact.name}, load step {step.step} ({step.stage})", loc="left", pad=24)
    axes.legend(ncols=3, loc="lower right", bbox_to_anchor=(1.0, 1.0), handletextpad=0.2, columnspacing=1.2)
    ranges = [np.ptp(d.boundaries) for d in directions]
    axes.set_aspect((lengths[1] / ranges[1]) / (lengths[0] / ranges[0]))
    _look_at_contact(axes, directions, points[surface.status > 0])
    return figure


def _draw_elements(axes: Axes, directions: tuple[Direction, Direction]) -> None:
    """Knot lines on bare material, which is seen where nothing presses."""
    (left, right), (bottom, top) = (d.boundaries[[0, -1]] for d in directions)
    axes.add_patch(Rectangle((left, bottom), right - left, top - bottom, color=style.SLAVE, linewidth=0, zorder=0))
    axes.vlines(directions[0].boundaries, bottom, top, color=style.BLACK, linewidth=0.4, alpha=0.6)
    axes.hlines(directions[1].boundaries, left, right, color=style.BLACK, linewidth=0.4, alpha=0.6)


def _look_at_contact(axes: Axes, directions: tuple[Direction, Direction], active: FloatArray) -> None:
    """Show the part of the face that is in contact and two elements around it; the whole face if nothing is."""
    axes.set_xlim(_limits(directions[0], active[:, 0]))
    axes.set_ylim(_limits(directions[1], active[:, 1]))


def _limits(direction: Direction, active: FloatArray) -> tuple[float, float]:
    ends = direction.boundaries
    low, high = ends[0], ends[-1]
    if len(active):
        first, last = np.searchsorted(ends, [active.min(), active.max()])
        low, high = ends[max(first - 2, 0)], ends[min(last + 2, len(ends) - 1)]
    margin = 0.03 * (high - low)
    return float(low - margin), float(high + margin)
