"""``isomortar paper`` from end to end on its quick sections."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from isomortar.cli.commands import app
from isomortar.errors import InputError
from isomortar.harness.report import stated

CASES = Path(__file__).parents[2] / "verification"


def drawn(folder: Path, *studies: str) -> tuple[dict, str]:
    """What the quick studies of some scenes leave: all of it as data, and the page."""
    command = [sys.executable, "-m", "isomortar", "paper", "--quick", "-j", "1", "--out", str(folder), "--cases", str(CASES), *studies]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    first = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    assert first.returncode == 0, first.stdout + first.stderr
    data, page = json.loads((folder / "paper.json").read_text()), (folder / "paper.html").read_text()
    assert data["verdicts"]["not measured"] == 0
    assert page.count("<svg") + page.count("<img") == len(list((folder / "figures").iterdir()))
    assert not re.search(r'(src|href)="(?!#|data:)', page)  # it needs nothing else
    return data, page


def test_a_quick_study_from_end_to_end(tmp_path):
    data, page = drawn(tmp_path, "--study", "press")
    runs = {(run["key"], run["method"]): run for run in data["runs"]}
    assert {key.split("-")[0] for key, _ in runs} == {"press"}
    assert runs["press-N2", "paper"]["augmentations"] > runs["press-N2", "monolithic"]["augmentations"]
    assert 0 < runs["press-N2", "monolithic"]["from_the_papers_method"] < 0.1
    assert "isomortar run press --set" in page


@pytest.mark.nightly
def test_the_quick_studies_from_end_to_end(tmp_path):
    data, page = drawn(tmp_path)
    runs = {(run["key"], run["method"]): run for run in data["runs"]}
    assert {key.split("-")[0] for key, _ in runs} == {"press", "twist", "iron", "tire"}
    assert all(run["failure"] is None or "-L" in key for (key, _), run in runs.items())
    assert runs["iron-N3", "monolithic"]["load_steps"] == [8, 8]
    by_text = {statement["text"]: statement for statement in data["statements"]}
    non_negative = by_text["NURBS deliver a pressure distribution that is nowhere negative."]
    assert non_negative["verdict"] == "holds"  # theory: non-negative functions
    assert set(non_negative["by_method"]) == {"monolithic", "paper"}
    assert len(list((tmp_path / "figures").iterdir())) > 15
    assert "isomortar run iron --set" in page


def test_outside_of_a_checkout_it_says_where_to_stand(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for command in (["paper", "--quick"], ["report", "orders", "press"]):
        result = CliRunner().invoke(app, command)
        assert isinstance(result.exception, InputError)
        assert "studies are run in a checkout, from its folder; or give the folder with --cases" in str(result.exception)
    assert not list(tmp_path.iterdir())


def test_bad_input_runs_nothing(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(app, ["paper", "--quick", "--study", "press,iorn", "--cases", str(CASES)])
    assert isinstance(result.exception, InputError)
    assert "'iorn'; allowed: press, twist, iron, tire" in str(result.exception)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("value", "in_percent", "text"),
    [(0.0, True, "0"), (0.01, True, "1 %"), (-0.0213, True, "-2.13 %"), (1e-8, True, "1e-08"), (1.0523, False, "1.05")],
)
def test_numbers_as_people_read_them(value, in_percent, text):
    assert stated(value, in_percent) == text
