"""What figures are made of and what they become."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from html import escape
from pathlib import Path

from matplotlib.figure import Figure

from isomortar.harness.figures import page_style, svg_text
from isomortar.results.reader import Results
from isomortar.results.style import style

_DPI_OF_PAGE, _DPI_OF_FILE = 140, 300
#: Width of a plot on the page for an inch of the figure.
_PIXELS_OF_PAGE = 108


@dataclass(frozen=True)
class Panel:
    """A load step of a run as one panel of a figure. Heights of its surface are drawn `height_scale` times those of the others."""

    title: str
    results: Results
    step: int
    height_scale: float = 1.0


@dataclass(frozen=True)
class Picture:
    """A figure: as HTML that needs nothing else, and to be saved in publication quality.

    `vector`: a plot, SVG in the page and PDF as a file; else a rendering, PNG in both.
    """

    html: str
    figure: Figure
    vector: bool

    def save(self, stem: Path) -> Path:
        """Write the file, `stem` with its ending added; returns its path."""
        path = stem.with_name(stem.name + (".pdf" if self.vector else ".png"))
        with style():
            self.figure.savefig(path, dpi=_DPI_OF_FILE)
        return path


def plot(figure: Figure, title: str) -> Picture:
    """A picture of lines."""
    with page_style():
        text = svg_text(figure, title)
    width = _PIXELS_OF_PAGE * figure.get_figwidth()  # so that letters are of one size on the page
    label = f'<svg role="img" style="width: {width:.0f}px" aria-label="{escape(title, quote=True)}"'
    return Picture(text.replace("<svg", label, 1), figure, vector=True)


def rendering(figure: Figure, title: str) -> Picture:
    """A picture of many small areas."""
    with style():
        content = io.BytesIO()
        figure.savefig(content, format="png", dpi=_DPI_OF_PAGE, pil_kwargs={"optimize": True})
    data = base64.b64encode(content.getvalue()).decode()
    return Picture(f'<img alt="{escape(title, quote=True)}" src="data:image/png;base64,{data}">', figure, vector=False)
