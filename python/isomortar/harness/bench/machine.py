"""The machine: what it is, and what it can do at most at the moment, which other times are compared with.

``python -m isomortar.harness.bench.machine`` measures in a process of its own.
"""

from __future__ import annotations

import json
import os
import platform
import re
from dataclasses import asdict
from pathlib import Path

import numpy as np
from scipy.linalg import blas

from isomortar._frozen import frozen
from isomortar.harness.bench.declaration import cpu_seconds

#: Rows of the matrices that are multiplied: three of them fill 24 MB.
ROWS = 1000
#: Entries of the vectors that are added: 128 MB each, above all caches.
ENTRIES = 1 << 24
#: The least of so many runs is the limit.
_RUNS = 7


@frozen
class Machine:
    """Model of the processor, number of cores, memory in bytes."""

    processor: str
    cores: int
    memory: float


@frozen
class MachineLimits:
    """What one core did at most, in CPU time: GF/s of dgemm, GB/s of y + a x; and how many processes wanted to run meanwhile."""

    dgemm: float
    triad: float
    load: float


def machine() -> Machine:
    """What this machine is."""
    try:
        found = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
    except OSError:
        found = None
    memory = float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    return Machine(found.group(1) if found else platform.processor(), os.cpu_count() or 1, memory)


def dgemm_rate() -> float:
    """GF/s of a product of square matrices by NumPy's linear algebra library."""
    one, other = np.random.default_rng(1).standard_normal((2, ROWS, ROWS))
    return float(2e-9 * ROWS**3 / cpu_seconds(lambda: one @ other, _RUNS)[1])


def triad_rate() -> float:
    """GB/s of y + a x in place: two vectors are read and one is written."""
    x, y = np.ones((2, ENTRIES))
    return float(24e-9 * ENTRIES / cpu_seconds(lambda: blas.daxpy(x, y, a=0.5), _RUNS)[1])


def limits() -> MachineLimits:
    """Measure in a process of its own, with one thread."""
    from isomortar.harness.bench.processes import fresh

    with fresh("-m", __name__) as process:
        return MachineLimits(**json.loads(process.line() or b""))


if __name__ == "__main__":
    print(json.dumps(asdict(MachineLimits(dgemm_rate(), triad_rate(), os.getloadavg()[0]))))
