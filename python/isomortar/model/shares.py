"""Shares as people read them."""

from __future__ import annotations


def percent(share: float) -> str:
    """A share in per cent, to two digits, without a power of ten: 150 %, not 1.5e+02 %."""
    return f"{float(f'{100.0 * share:.2g}'):g} %"
