"""What docs/results.md says of a results file is what a file holds, and it leaves nothing out that there is a quantity for."""

from __future__ import annotations

import importlib.util
from pathlib import Path

from isomortar.results import layout

TOOL = Path(__file__).parents[2] / "tools" / "document_results.py"


def test_the_reference_of_results_files_is_what_a_file_holds() -> None:
    spec = importlib.util.spec_from_file_location("document_results", TOOL)
    assert spec
    assert spec.loader
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    text = tool.PAGE.read_text()
    assert tool.page(text) == text, "make it anew: python tools/document_results.py"
    tables = (layout.STEP, layout.REACTION, layout.CONTACT, layout.CONTACT_STATE, layout.CONTACT_VALUES, layout.RATES, layout.LOG)
    single = (layout.POSITIONS, layout.TIMING, layout.ORDERING, layout.CONTROL_POINTS, layout.WEIGHTS, layout.KNOTS, layout.STATE_STEP)
    for quantity in (*(entry for table in (*tables, layout.CONTACT_RATES) for entry in table.values()), *single):
        assert f"| {quantity.unit} | {quantity.description} |" in text
