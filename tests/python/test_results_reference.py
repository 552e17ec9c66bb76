"""What docs/results.md says of a results file is what a file itself says."""

from __future__ import annotations

import importlib.util
from pathlib import Path

TOOL = Path(__file__).parents[2] / "tools" / "document_results.py"


def test_the_reference_of_results_files_is_what_a_file_says() -> None:
    spec = importlib.util.spec_from_file_location("document_results", TOOL)
    assert spec
    assert spec.loader
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    text = tool.PAGE.read_text()
    assert tool.page(text) == text, "make it anew: python tools/document_results.py"
    assert text.count("\n| `") > 60
