"""Benchmarks: what isomortar costs, where, and beside which other program.

What a benchmark needs is here: ``from isomortar.harness.bench import Plot, Row, benchmark``.
"""

from isomortar.harness.bench.declaration import ASIDE, Plot, Row, benchmark, cpu_seconds

__all__ = ["ASIDE", "Plot", "Row", "benchmark", "cpu_seconds"]
