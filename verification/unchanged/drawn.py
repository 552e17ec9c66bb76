"""Figures in words: what stands in them, and not how a machine's fonts lay it out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any
from unittest.mock import patch

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.cm import ScalarMappable
from matplotlib.collections import Collection, QuadMesh
from matplotlib.colors import to_hex, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.quiver import Quiver
from matplotlib.spines import Spine
from matplotlib.text import Annotation, Text
from PIL import Image
from unchanged.written import PRINTED, numbers

#: A picture that stands for all that are drawn, where a type of file is written as text: figures of pages are SVG.
_STANDS = '<svg width="1pt" height="1pt" ><g/></svg>'


@contextmanager
def watched() -> Iterator[list[str]]:
    """Figures that are saved meanwhile, in words; the files hold pictures that stand for them, no two in a row alike."""
    said: list[str] = []

    def save(figure: Figure, path: Any, **options: Any) -> None:
        kind = str(options.get("format") or str(path).rpartition(".")[2])
        said.extend(figure_lines(figure))
        told = {name: value for name, value in sorted(options.items()) if name != "metadata"}
        said.append(f"saved as {kind}, {told}")
        if kind == "png":
            Image.new("RGB", (4, 4), (len(said) * 37 % 256, len(said) * 11 % 256, 90)).save(path, "PNG")
        elif kind == "svg" and hasattr(path, "write"):
            path.write(_STANDS)
        else:
            path.write_bytes(b"drawn")

    with ExitStack() as stack:
        stack.enter_context(patch.object(Figure, "savefig", save))
        yield said


def figure_lines(figure: Figure) -> Iterator[str]:
    """A figure: its size, and what is in its axes."""
    yield f"figure {numbers(figure.get_size_inches())} {type(figure.get_layout_engine()).__name__}"
    for artist in (*figure.texts, *figure.legends, *figure.patches, *figure.lines):
        yield from artist_lines(artist)
    for axes in figure.axes:
        yield from axes_lines(axes)


def axes_lines(axes: Axes) -> Iterator[str]:
    """Axes: titles, labels, limits, ticks, what is drawn in them, and axes within."""
    titles = [axes.get_title(loc) for loc in ("left", "center", "right")]
    spines = [name for name, spine in axes.spines.items() if spine.get_visible()]
    yield f"axes {titles} x {axes.get_xlabel()!r} {axes.get_xscale()} y {axes.get_ylabel()!r} {axes.get_yscale()}"
    yield f"axes limits {numbers([*axes.get_xlim(), *axes.get_ylim()])} aspect {axes.get_aspect()} on {axes.axison} spines {spines}"
    yield from (f"ticks {name} {_ticks(axis)}" for name, axis in (("x", axes.xaxis), ("y", axes.yaxis)))
    for artist in axes.get_children():
        if not isinstance(artist, Axes | Axis | Spine) and artist is not axes.patch:
            yield from artist_lines(artist)
    for child in axes.child_axes:
        if isinstance(child, Axes):
            yield from axes_lines(child)


def _ticks(axis: Axis) -> str:
    params, named = axis.get_tick_params(), axis.get_major_formatter().format_ticks(axis.get_majorticklocs().tolist())
    return f"{numbers(axis.get_majorticklocs())} {named[:PRINTED]} grid {params.get('gridOn')} {params.get('grid_color')}"


def artist_lines(artist: Artist) -> Iterator[str]:
    """One thing that is drawn: its kind, its look, and its numbers."""
    for kind, say in _SAYS.items():
        if isinstance(artist, kind):
            if (said := say(artist)) is not None:
                label = artist.get_label()
                look = f"zorder {artist.get_zorder():g} alpha {artist.get_alpha()} visible {artist.get_visible()}"
                named = f" label {label!r}" if label and not str(label).startswith("_") else ""
                yield f"{type(artist).__name__} {look}{named}: {said}"
                if isinstance(artist, ScalarMappable) and artist.get_array() is not None:
                    yield _mapped(artist)
            return
    yield type(artist).__name__


def _mapped(artist: Any) -> str:
    """Values in colours, and which."""
    ends = [to_hex(artist.cmap(value)) for value in (-1.0, 0.0, 0.5, 1.0, 2.0)]
    return f"colours {artist.cmap.name} {ends} from {numbers(artist.get_clim())}: {numbers(np.ma.filled(artist.get_array(), np.nan))}"


def _line(line: Line2D) -> str:
    marks = f"{line.get_marker()!r} {line.get_markersize():g} {_hex(line.get_markerfacecolor())} {line.get_markeredgewidth():g}"
    style = f"{_hex(line.get_color())} {line.get_linestyle()!r} {line.get_linewidth():g} {line.get_drawstyle()} marks {marks}"
    return f"{style} x {numbers(line.get_xdata())} y {numbers(line.get_ydata())}"


def _text(text: Text) -> str | None:
    if not text.get_text():
        return None
    place = text.xy if isinstance(text, Annotation) else text.get_position()
    side = f"{text.get_horizontalalignment()} {text.get_verticalalignment()} {text.get_rotation():g}"
    side += f" {text.get_fontsize():g} {text.get_fontweight()}"
    return f"{text.get_text()!r} at {numbers([float(p) for p in place])} {_hex(text.get_color())} {side}"


def _patch(shape: Patch) -> str:
    corners = shape.get_patch_transform().transform(shape.get_path().vertices)
    look = f"{_hex(shape.get_facecolor())} {_hex(shape.get_edgecolor())} {shape.get_linewidth():g} {shape.get_hatch()}"
    return f"{look} {numbers(corners)}"


def _collection(shapes: Collection) -> str:
    paths = [path.vertices for path in shapes.get_paths()]
    corners = np.concatenate(paths) if paths else np.zeros((0, 2))
    colours = f"faces {numbers(shapes.get_facecolor())} edges {numbers(shapes.get_edgecolor())} widths {numbers(shapes.get_linewidth())}"
    return f"{len(paths)} paths {numbers(corners)} at {numbers(shapes.get_offsets())} {colours}"


def _mesh(mesh: QuadMesh) -> str:
    return f"{numbers(mesh.get_coordinates())} edges {numbers(mesh.get_edgecolor())}"


def _arrows(arrows: Quiver) -> str:
    look = f"{arrows.angles} {arrows.scale_units} {arrows.width} {numbers(arrows.get_facecolor())}"
    return f"scale {numbers([arrows.scale or 0.0])} {look} x {numbers(arrows.U)} y {numbers(arrows.V)} at {numbers(arrows.XY)}"


def _legend(legend: Any) -> str:
    return f"{[text.get_text() for text in legend.get_texts()]} columns {legend._ncols}"


def _hex(colour: Any) -> str:
    """A colour as people write it; none is no colour."""
    found = to_rgba_array(colour)
    return to_hex(found[0], keep_alpha=True) if len(found) else "none"


#: What is said of each kind of thing that is drawn, the more special kinds first: arrows and meshes are collections too.
_SAYS: dict[type[Artist], Callable[[Any], str | None]] = {
    Quiver: _arrows,
    QuadMesh: _mesh,
    Collection: _collection,
    Line2D: _line,
    Text: _text,
    Legend: _legend,
    Patch: _patch,
}
