"""Ratios in sentences."""

from __future__ import annotations


def times(ratio: float, digits: int = 3) -> str:
    """How many times, as people read it: 1.33, 15, 10 000; 1e+11 from a thousand millions on."""
    short = f"{ratio:.{digits}g}"
    return f"{float(short):,.0f}".replace(",", " ") if 10**digits <= float(short) < 1e9 else short
