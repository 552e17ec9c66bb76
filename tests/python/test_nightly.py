"""What is run at night: every part is run whatever became of the others, one page tells of all, and one exit code."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest
from sanitizers.memory import FAULT, FILE, SOUND

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def nightly():
    spec = importlib.util.spec_from_file_location("run_nightly", ROOT / "tools" / "run_nightly.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["run_nightly"] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules["run_nightly"]


def test_a_part_that_fails_keeps_no_other_from_being_run(nightly, tmp_path):
    good = nightly.Part("good", ("--version",), Path("README.md"))
    bad = nightly.Part("bad", ("run", "no_such_scene"), Path("no_such_page.html"))
    assert nightly.night([bad, good], tmp_path) == 1
    page = (tmp_path / "index.html").read_text()
    assert "Not well: bad" in page
    assert "no_such_scene" in page.split("<pre>")[1]  # what it printed
    assert "good.log" in page
    assert "no_such_page" not in page
    assert nightly.night([good], tmp_path) == 0
    page = (tmp_path / "index.html").read_text()
    assert "All is well" in page
    assert "Nights before" in page
    assert len(nightly.Journal(tmp_path / "history.jsonl").entries) == 2


def test_the_fault_that_sanitizers_must_see_fits_the_sources():
    assert (ROOT / FILE).read_text().count(SOUND) == 1
    assert SOUND != FAULT


def test_parts_are_commands_that_there_are(nightly):
    from typer.testing import CliRunner

    from isomortar.cli.commands import app

    for part in (part for part in nightly.PARTS if part.program == "isomortar"):
        options = [word for word in part.arguments if not word.startswith("--")]
        shown = CliRunner().invoke(app, [*options[: 2 if options[0] == "report" else 1], "--help"])
        assert shown.exit_code == 0, part.command
        assert all(word in shown.output for word in part.arguments if word.startswith("--")), part.command
        assert str(part.page.parent) in shown.output.replace("NAME", options[-1]), part.command


def test_tests_of_the_night_are_there_and_are_run(nightly):
    marked = [path for path in (ROOT / "tests").rglob("test_*.py") if "@pytest.mark.nightly" in path.read_text() and path != Path(__file__)]
    assert marked
    assert ("pytest", ("-q", "-m", "nightly", "tests")) in [(part.program, part.arguments) for part in nightly.PARTS]
