"""Ratios in sentences."""

from __future__ import annotations


def times(ratio: float) -> str:
    """How many times, to three digits, as people read it: 1.33, 15, 10 000; 1e+11 from a thousand millions on."""
    short = f"{ratio:.3g}"
    return f"{float(short):,.0f}".replace(",", " ") if 1e3 <= float(short) < 1e9 else short
