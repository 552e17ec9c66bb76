"""The page of a run: what it must not leave out."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from isomortar.cli.commands import app
from isomortar.errors import InputError
from isomortar.harness.report import duration

CASE = """
from isomortar.harness import Bound, case

LIMITS = {1: 3e-2, 2: 0.9, 3: 1e-5}

@case(claim="Limits differ.", bounds=lambda order: {"error": Bound(at_most=LIMITS[order], reason="theory: so")}, grid={"order": [1, 2, 3]})
def widely(order):
    return {"error": 0.0}
"""


@pytest.fixture
def family(tmp_path, monkeypatch):
    """A family of one case, in the folder ``cases`` of the working directory."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "cases" / f"family_{tmp_path.name}"  # a name of its own: modules stay imported
    folder.mkdir(parents=True)
    (folder / "widely.py").write_text(CASE)
    return folder.name


def verify(*options):
    command = ["verify", "--cases", "cases", "--results", "out", "-j", "1", *options]
    return CliRunner().invoke(app, command, catch_exceptions=False)


def test_a_page_of_a_part_says_so(family):
    assert verify("--family", family).exit_code == 0
    assert f"<h1>All 3 cells pass: only family {family}</h1>" in Path("out/report.html").read_text()
    assert json.loads(Path("out/report.json").read_text())["only"] == f"family {family}"
    assert verify().exit_code == 0
    assert "<h1>All 3 cells pass</h1>" in Path("out/report.html").read_text()


def test_all_families_and_cases_that_are_named_are_run(family):
    (Path("cases") / "beside").mkdir()
    (Path("cases/beside/also.py")).write_text(CASE)
    assert verify("--family", family, "--family", "beside").output.strip().startswith("6 passed")
    assert json.loads(Path("out/report.json").read_text())["only"] == f"family {family}, family beside"
    first, second = f"{family}/widely[order=1]", "beside/widely"
    assert verify("--case", first, "--case", second, "--case", first).output.strip().startswith("4 passed")
    assert verify("--family", "beside", "--case", second).output.strip().startswith("3 passed")
    with pytest.raises(InputError, match="there is no family 'nowhere'"):
        verify("--family", family, "--family", "nowhere")


def test_cells_of_a_case_that_a_run_leaves_out_are_counted(family):
    """A claim on all settings is measured at some of them only: a page of green cells must not pass for all of it."""
    path = Path("cases") / family / "widely.py"
    path.write_text(CASE.replace("grid={", "tier=lambda order: 'gate' if order < 2 else 'nightly', grid={"))
    assert verify().exit_code == 0
    page = Path("out/report.html").read_text()
    assert "2 further cells of these cases are not in this run" in page
    assert "1 of 1, 2 not in this run" in page
    assert json.loads(Path("out/report.json").read_text())["left_out"] == [f"{family}/widely[order={k}]" for k in (2, 3)]
    assert verify("--tier", "nightly").exit_code == 0
    assert "not in this run" not in Path("out/report.html").read_text()


@pytest.mark.usefixtures("family")
def test_the_widest_limit_is_on_the_page():
    assert verify().exit_code == 0
    page = Path("out/report.html").read_text()
    assert "≤ 1e-05 … ≤ 0.9" in page
    assert page.count('title="limit ≤ 0.03"') == 1


@pytest.mark.usefixtures("family")
def test_the_page_is_none_of_the_files_beside_it():
    with pytest.raises(InputError, match="the page is an"):
        verify("--report", "out/report.json")


@pytest.mark.parametrize(
    ("seconds", "said"),
    [(4e-4, "< 1 ms"), (0.5, "500 ms"), (89.0, "89.0 s"), (720.0, "12 min"), (212 * 60.0, "4 h"), (457798 * 60.0, "318 days")],
)
def test_times_are_in_units_that_people_count_in(seconds, said):
    assert duration(seconds) == said
