"""Small line plots as SVG text, for pages that must not need anything else.

Not by Matplotlib, which draws the figures of studies (`isomortar.harness.figures`): its plot of five lines takes 0.19 s of the processor
(0.6 s with a layout that finds room for labels) and 23 kB, one from here 0.3 ms and 4 kB; its line over the runs 9 ms, one from here
0.02 ms. The gate's page has some twenty plots and, of 717 cells, up to 2800 such lines: half a minute a page, where `isomortar verify` of
one cell takes seconds, and 0.7 s more to load.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from itertools import pairwise

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray

#: Colours that also colour-blind eyes tell apart (Okabe and Ito), first to last; then dashes set lines apart.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
_DASHES = ("", "6 3", "2 3")

_WIDTH, _HEIGHT = 420, 260
_LEFT, _RIGHT, _TOP, _BOTTOM = 62, 96, 14, 42


@frozen
class Line:
    """Points of a line, its label at its end, and whether it is a guide (grey, no marks)."""

    label: str
    x: FloatArray
    y: FloatArray
    guide: bool = False


@frozen
class _Axis:
    """Maps values to pixels."""

    low: float
    high: float
    begin: float
    end: float
    log: bool

    def __call__(self, value: float) -> float:
        low, high, v = (math.log10(q) if self.log else q for q in (self.low, self.high, value))
        return self.begin + (v - low) / (high - low) * (self.end - self.begin)

    def ticks(self) -> list[float]:
        if not self.log:
            step = 10.0 ** math.floor(math.log10((self.high - self.low) / 2))
            step *= next(f for f in (1, 2, 5, 10) if (self.high - self.low) / (step * f) <= 6)
            return [step * k for k in range(math.ceil(self.low / step), math.floor(self.high / step) + 1)]
        first, last = math.ceil(math.log10(self.low) - 1e-9), math.floor(math.log10(self.high) + 1e-9)
        stride = max(1, math.ceil((last - first + 1) / 6))
        decades = [10.0**k for k in range(first, last + 1, stride)]
        within = [f * 10.0**k for k in range(first - 1, last + 1) for f in (1, 2, 5) if self.low <= f * 10.0**k <= self.high]
        return decades if len(decades) > 1 else within


def plot(lines: Sequence[Line], x_label: str, y_label: str, log_x: bool = True, log_y: bool = True) -> str:
    """Lines with marks, each labelled at its end; points that are not finite (or not positive on a log axis) are left out."""
    kept = [_drawable(line, log_x, log_y) for line in lines]
    kept = [line for line in kept if len(line.x)]
    if not kept:
        return ""
    x = _axis(np.concatenate([line.x for line in kept]), _LEFT, _WIDTH - _RIGHT, log_x)
    y = _axis(np.concatenate([line.y for line in kept]), _HEIGHT - _BOTTOM, _TOP, log_y)
    parts = [f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" class="plot" role="img" aria-label="{escape(y_label)} against {escape(x_label)}">']
    parts += _frame(x, y, x_label, y_label)
    labels = _spread([y(float(line.y[np.argmax(line.x)])) for line in kept])
    colours = iter(range(len(kept)))
    for line, at in zip(kept, labels, strict=True):
        parts += _drawn(line, x, y, "#9aa0a6" if line.guide else "", 0 if line.guide else next(colours), at)
    return "".join([*parts, "</svg>"])


def sparkline(values: Sequence[float], marks: Sequence[int]) -> str:
    """A number over the runs as a small line; a dot for each change, the last value always marked."""
    shown = [(i, v) for i, v in enumerate(values) if math.isfinite(v)]
    if len(shown) < 2:
        return ""
    array = np.array([v for _, v in shown])
    low, high = float(array.min()), float(array.max())
    span = high - low or 1.0
    at = {i: (2 + 86 * i / (len(values) - 1), 16 - 12 * (v - low) / span if high > low else 10.0) for i, v in shown}
    points = " ".join(f"{px:.1f},{py:.1f}" for px, py in at.values())
    dots = "".join(f'<circle cx="{at[i][0]:.1f}" cy="{at[i][1]:.1f}" r="2.6" class="change"/>' for i in marks if i in at)
    last = at[shown[-1][0]]
    title = f"{len(shown)} runs, {low:.4g} to {high:.4g}" + (f", {len(marks)} changes" if marks else "")
    return (
        f'<svg viewBox="0 0 92 20" class="spark"><title>{title}</title><polyline points="{points}"/>{dots}'
        f'<circle cx="{last[0]:.1f}" cy="{last[1]:.1f}" r="1.6"/></svg>'
    )


def _drawable(line: Line, log_x: bool, log_y: bool) -> Line:
    x, y = np.atleast_1d(line.x).astype(float), np.atleast_1d(line.y).astype(float)
    keep = np.isfinite(x) & np.isfinite(y) & ((x > 0) | (not log_x)) & ((y > 0) | (not log_y))
    return Line(line.label, x[keep], y[keep], line.guide)


def _axis(values: FloatArray, begin: float, end: float, log: bool) -> _Axis:
    low, high = float(values.min()), float(values.max())
    if log:
        margin = max((high / low) ** 0.05, 1.15)
        return _Axis(low / margin, high * margin, begin, end, log)
    margin = 0.05 * (high - low) or max(abs(high), 1.0) * 0.1
    return _Axis(low - margin, high + margin, begin, end, log)


def _frame(x: _Axis, y: _Axis, x_label: str, y_label: str) -> list[str]:
    right, bottom = _WIDTH - _RIGHT, _HEIGHT - _BOTTOM
    parts = []
    for tick in y.ticks():
        parts.append(f'<line x1="{_LEFT}" x2="{right}" y1="{y(tick):.1f}" y2="{y(tick):.1f}" class="grid"/>')
        parts.append(f'<text x="{_LEFT - 6}" y="{y(tick) + 4:.1f}" text-anchor="end">{_tick(tick, y.log)}</text>')
    for tick in x.ticks():
        parts.append(f'<line x1="{x(tick):.1f}" x2="{x(tick):.1f}" y1="{bottom}" y2="{bottom + 4}" class="axis"/>')
        parts.append(f'<text x="{x(tick):.1f}" y="{bottom + 17}" text-anchor="middle">{_tick(tick, x.log)}</text>')
    parts.append(f'<path d="M{_LEFT} {_TOP}V{bottom}H{right}" class="axis"/>')
    parts.append(f'<text x="{(_LEFT + right) / 2}" y="{_HEIGHT - 8}" text-anchor="middle" class="label">{escape(x_label)}</text>')
    middle = (_TOP + bottom) / 2
    turned = f'transform="rotate(-90 13 {middle})"'
    parts.append(f'<text x="13" y="{middle}" text-anchor="middle" class="label" {turned}>{escape(y_label)}</text>')
    return parts


def _drawn(line: Line, x: _Axis, y: _Axis, colour: str, number: int, label_y: float) -> list[str]:
    colour = colour or COLOURS[number % len(COLOURS)]
    dash = "4 4" if line.guide else _DASHES[number // len(COLOURS) % len(_DASHES)]
    pixels = [(x(float(a)), y(float(b))) for a, b in zip(line.x, line.y, strict=True)]
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in pixels)
    parts = [f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.6" stroke-dasharray="{dash}"/>']
    if not line.guide:
        parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.8" fill="{colour}"/>' for a, b in pixels]
    if line.label:
        parts.append(f'<text x="{_WIDTH - _RIGHT + 8}" y="{label_y + 4:.1f}" fill="{colour}" class="end">{escape(line.label)}</text>')
    return parts


def _spread(heights: Sequence[float], gap: float = 13.0) -> list[float]:
    """Heights of labels, moved apart until none covers another."""
    order = np.argsort(heights)
    placed = list(heights)
    for before, here in pairwise(order):
        placed[here] = max(placed[here], placed[before] + gap)
    excess = max(0.0, max(placed) - (_HEIGHT - _BOTTOM)) if placed else 0.0
    return [p - excess for p in placed]


def _tick(value: float, log: bool) -> str:
    exponent = round(math.log10(value)) if value > 0 else 0
    if log and math.isclose(value, 10.0**exponent) and abs(exponent) > 2:
        return f'10<tspan dy="-5" font-size="8">{exponent}</tspan>'
    return f"{value:.6g}"
