"""Write what ``isomortar bench`` measured into tables of docs/: ``python tools/document_benchmarks.py results/bench/bench.json``."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pages import Page

from isomortar.harness.report import number

DOCS = Path(__file__).parent.parent / "docs"
_BEGIN, _END = "<!-- table: isomortar bench {} -->\n", "<!-- end of the table -->\n"


def pages(measured: Path) -> Iterator[Page]:
    """A page for each table that a run of benchmarks has the numbers of.

    Raises
    ------
    ValueError
        The benchmarks were only tried, or no page has a table of theirs.
    """
    run = json.loads(measured.read_text())
    if run["quick"]:
        raise ValueError(f"{measured} says nothing about speed: its benchmarks were run with --quick; run them without")
    for benchmark in run["benchmarks"]:
        begin = _BEGIN.format(benchmark["name"])
        places = [path for path in sorted(DOCS.glob("*.md")) if begin in path.read_text()]
        if not places:
            raise ValueError(f"no page of docs/ has a table of {benchmark['name']}: put in {begin.strip()} and {_END.strip()}")
        yield from (Page(path, begin, _END, lambda benchmark=benchmark: table(benchmark)) for path in places)


def table(benchmark: dict[str, Any]) -> str:
    """The rows of a benchmark; those that could not be measured are left out."""
    columns = benchmark["columns"]
    heads = [f"{name}, {unit}" if unit else name for name, unit in columns.items()]
    rows = [[text(row[name]) for name in columns] for row in benchmark["rows"] if "note" not in row]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (heads, ["---"] * len(heads), *rows))


def text(value: float | int | str) -> str:
    """An entry as people read it: three digits of what was measured."""
    return number(float(f"{value:.3g}")) if isinstance(value, float) else str(value)


if __name__ == "__main__":
    for page in pages(Path(sys.argv[1])):
        page.write()
