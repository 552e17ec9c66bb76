"""The compiled kernel, loaded with the BLAS routines that fit the processor.

Debian's OpenBLAS takes a processor that is younger than itself for a very old one: matrix products, and with them assembly and
factorisation, are then two to ten times slower. The right choice follows from the processor's flags; OpenBLAS reads it
from the environment while it is loaded. A choice that the user has made stands.
"""

from __future__ import annotations

import os
from pathlib import Path

_CHOICE = "OPENBLAS_CORETYPE"


def processor_kind(flags: frozenset[str]) -> str | None:
    """OpenBLAS's name for the best routines that a processor with these flags can run; None: leave it to OpenBLAS."""
    if {"avx512f", "avx512dq", "avx512bw", "avx512vl"} <= flags:
        return "SkylakeX"
    if {"avx2", "fma"} <= flags:
        return "Haswell"
    return None


def _processor_flags() -> frozenset[str]:
    """Flags of the first processor, from the system; empty where the system does not tell."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return frozenset()
    return frozenset(next((line for line in lines if line.startswith("flags")), "").split())


_kind = processor_kind(_processor_flags()) if _CHOICE not in os.environ else None
if _kind is not None:
    os.environ[_CHOICE] = _kind
from isomortar import _kernel as kernel

if _kind is not None:
    del os.environ[_CHOICE]

__all__ = ["kernel", "processor_kind"]
