"""All published benchmarks, in the order of the page."""

from __future__ import annotations

from published import cylinders, hemisphere, ironing, nested, punches, roller, sheared, spheres
from published.benchmark import Benchmark

BENCHMARKS: tuple[Benchmark, ...] = (
    *cylinders.BENCHMARKS,
    *roller.BENCHMARKS,
    *spheres.BENCHMARKS,
    *sheared.BENCHMARKS,
    *punches.BENCHMARKS,
    *ironing.BENCHMARKS,
    *hemisphere.BENCHMARKS,
    *nested.BENCHMARKS,
)
