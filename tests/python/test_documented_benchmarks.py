"""Tables of benchmarks in the documentation: each is of one that there is, with its columns, and is written from what was measured."""

from __future__ import annotations

import importlib
import json
import re
from pathlib import Path
from typing import Any

import pytest

from isomortar.harness.bench.collection import collect
from isomortar.harness.bench.page import headings

ROOT = Path(__file__).parents[2]
BENCHMARKS = {one.name: one for one in collect(ROOT / "verification")}
PLACE = re.compile(r"<!-- table: isomortar bench (\w+) -->\n\n(\|.*)\n")
PLACES = [(path, *found) for path in sorted((ROOT / "docs").glob("*.md")) for found in PLACE.findall(path.read_text())]


@pytest.fixture
def tool(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Any:
    """The tool, whose documentation is one page with a table of the benchmark `sizes` and one of `mumps`."""
    monkeypatch.syspath_prepend(ROOT / "tools")
    module = importlib.import_module("document_benchmarks")
    monkeypatch.setattr(module, "DOCS", tmp_path)
    tables = "".join(f"<!-- table: isomortar bench {name} -->\n\nold {name}\n<!-- end of the table -->\n\n" for name in ("sizes", "mumps"))
    (tmp_path / "sizes.md").write_text(f"before\n\n{tables}after\n")
    return module


def measured(path: Path, name: str = "sizes", quick: bool = False) -> Path:
    rows = [{"unknowns": 768, "a step": 0.12345}, {"unknowns": 10, "note": "not measured"}, {"unknowns": 4, "a step": 1105.2}]
    benchmark = {"name": name, "columns": {"unknowns": "", "a step": "s"}, "rows": rows}
    path.write_text(json.dumps({"quick": quick, "benchmarks": [benchmark]}))
    return path


@pytest.mark.parametrize(("path", "name", "heads"), PLACES)
def test_a_table_has_the_columns_of_its_benchmark(path: Path, name: str, heads: str) -> None:
    assert heads == f"| {' | '.join(headings(BENCHMARKS[name]))} |", f"measure anew for {path.name}: isomortar bench {name}"


def test_there_are_tables() -> None:
    assert {name for _, name, _ in PLACES} >= {"sizes", "multigrid", "mumps"}


def test_numbers_come_in_place_of_old_ones_and_all_else_stays(tool: Any, tmp_path: Path) -> None:
    (page,) = tool.pages(measured(tmp_path / "bench.json"))
    page.write()
    before, sizes, mumps = (tmp_path / "sizes.md").read_text().split("<!-- table")
    assert before == "before\n\n"
    assert sizes.splitlines()[2:6] == ["| unknowns | a step, s |", "| --- | --- |", "| 768 | 0.123 |", "| 4 | 1110 |"]
    assert "old" not in sizes
    assert mumps.splitlines()[2] == "old mumps"
    assert mumps.endswith("after\n")


def test_what_was_only_tried_and_what_no_page_has_is_refused(tool: Any, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="run with --quick"):
        list(tool.pages(measured(tmp_path / "bench.json", quick=True)))
    with pytest.raises(ValueError, match="no page of docs/ has a table of threads"):
        list(tool.pages(measured(tmp_path / "bench.json", "threads")))
