"""The study of published benchmarks: what is computed here, how sure it is, and what others have published."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from published import page
from published.benchmark import Benchmark
from published.benchmarks import BENCHMARKS

from isomortar.harness.collection import collect
from isomortar.harness.runner import Result, select
from isomortar.harness.study import Conclusion, Study


def study(folder: Path) -> Study:
    """All cases of the family's folder."""
    cells = tuple(select(collect(folder.parent), "nightly", folder.name))
    return Study(cells, partial(_written, BENCHMARKS))


def _written(benchmarks: Sequence[Benchmark], folder: Path, results: Sequence[Result], started: datetime) -> Conclusion:
    """Write ``published.html``."""
    return page.write(folder, benchmarks, results, started)
