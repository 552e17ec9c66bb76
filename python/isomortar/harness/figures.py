"""What all figures of the reports share: how a kind of elements looks, and figures as SVG text that stands in a page."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from isomortar.accuracy.discretisations import parse_kind
from isomortar.results import style

_COLOURS = ("#E69F00", style.BLUE, style.GREEN, style.VERMILION, "#CC79A7")
_MARKS = ("o", "s", "^", "D", "v")


def look(kind: str) -> dict[str, Any]:
    """Colour and mark tell the order, filling and line the family, so that either is told without colour."""
    family, order = parse_kind(kind)
    colour = _COLOURS[(order - 1) % len(_COLOURS)]
    filling = colour if family == "N" else "white"
    line = "-" if family == "N" else (0, (4, 2))
    mark = _MARKS[(order - 1) % len(_MARKS)]
    return {"color": colour, "linestyle": line, "marker": mark, "markerfacecolor": filling, "markersize": 5.0, "zorder": 3}


@contextmanager
def page_style() -> Iterator[None]:
    """The style of all figures, with text that stays text."""
    with style.style(), mpl.rc_context({"svg.fonttype": "none", "font.family": "sans-serif"}):
        yield


def svg_text(figure: Figure, name: str) -> str:
    """As SVG that stands in a page: no header, names of its own, the same for the same figure."""
    text = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": name}):
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    drawn = text.getvalue()
    return re.sub(r'(width|height)="[\d.]+pt" ', "", drawn[drawn.index("<svg") :], count=2)
