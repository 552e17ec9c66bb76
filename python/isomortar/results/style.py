"""How every figure looks: one set of type sizes and of colours that also colour-blind eyes tell apart (Okabe and Ito)."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.colors import Colormap

BLUE, ORANGE, GREEN, VERMILION, BLACK, GREY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#222222", "#8A8F98"
#: Shares of the largest pressure: one that is round-off, and one that is drawn as none, as nobody could see it.
NOTHING, UNSEEN = 1e-9, 2e-3
SLAVE, MASTER, PLANE = "#D9DDE3", "#B9CCE4", "#EDEDEB"

_STYLE: Any = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.labelsize": 9.0,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#444444",
    "xtick.color": "#444444",
    "ytick.color": "#444444",
    "xtick.labelcolor": "black",
    "ytick.labelcolor": "black",
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "figure.dpi": 100,
    "savefig.dpi": 220,
    "pdf.fonttype": 42,
}


@contextmanager
def style() -> Iterator[None]:
    """The style of our figures, for the block that follows; nothing is said there of letters no font has, and of wide labels."""
    with mpl.rc_context(_STYLE), warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        yield


def pressure_colours() -> Colormap:
    """From pale (little pressure) to dark red; bare material where there is none, grey below zero, where the contact would pull."""
    return mpl.colormaps["YlOrRd"].with_extremes(under="#6F7680", bad=SLAVE)


def signed_colours() -> Colormap:
    """From blue (negative) over white to red."""
    return mpl.colormaps["RdBu_r"]


def field_colours() -> Colormap:
    """From pale (low) to dark blue (high), for fields of bodies."""
    return mpl.colormaps["YlGnBu"]
