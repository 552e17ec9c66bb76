"""The page of the extremes: intervals, counts and words of sweeps, beside those of an earlier program."""

import json
from pathlib import Path

import pytest
from extremes.endings import Ending
from extremes.points import Earlier, Point, read, right_in, write
from typer.testing import CliRunner

from isomortar.cli.commands import app
from isomortar.errors import InputError

CASES = """
from isomortar.harness import Bound, Words, case
from extremes.endings import Ending, endings

def ended(ending, words=""):
    return {"ending": float(ending), "digits": 8.0 if ending == Ending.RIGHT else 0.0, "words": Words(words)}

@case(claim="Forces do not care.", grid={"size": (1e-3, 1.0, 1e3, 1e6)}, bounds=lambda size: endings(size == 1.0))
def sizes(size):
    "Scaling law."
    if size == 1e6:
        raise ValueError("no word of it")
    return ended(Ending.RIGHT) if size < 1e3 else ended(Ending.REFUSED, "too large <b>")

@case(claim="Pairs do not care.", grid={"a": (1.0, 2.0), "b": ("x", "y")}, bounds=endings(False))
def pairs(a, b):
    "Symmetry."
    return ended(Ending.WRONG, "off") if (a, b) == (2.0, "y") else ended(Ending.WARNED, "doubtful")

@case(claim="Nothing of an ending.", bounds={"error": Bound(at_most=1.0, reason="theory: so")})
def other():
    return {"error": 0.5}
"""


def point(ending: Ending) -> Point:
    return Point(ending, 8.0, "said")


@pytest.fixture
def page(tmp_path, monkeypatch):
    """The page of a small family, its exit code, and the folder of its cases."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2] / "verification"))  # for the measuring processes
    folder = tmp_path / "cases" / f"family_{tmp_path.name}"
    folder.mkdir(parents=True)
    (folder / "sweeps.py").write_text(CASES)
    (folder / "page.py").write_text("from extremes.page import write\n")
    name = f"{folder.name}/sizes"
    before = {
        f"{name}[size=0.001]": point(Ending.WRONG),
        f"{name}[size=1.0]": point(Ending.RIGHT),
        f"{name}[size=1000.0]": point(Ending.RIGHT),
    }
    write(folder / "before.json", Earlier("0123456789abcdef", before))
    done = CliRunner().invoke(app, ["verify", "--cases", "cases", "--results", "out", "-j", "1"])
    assert f"{folder.name}.html" in done.output
    return (tmp_path / "out" / f"{folder.name}.html").read_text(), done.exit_code


def test_the_page_says_what_is_right_where_and_what_is_wrong(page):
    text, exit_code = page
    assert exit_code == 1
    assert "<title>2 of 8 wrong" in text
    assert "0.001 to 1</td>" in text  # right now
    assert "1 to 1000</td>" in text  # right before
    assert "0 of 4 pairs" in text
    assert "1 points that were wrong at commit <code>0123456789ab</code>" in text
    assert "size 1000</li>" in text  # right before, not now
    assert "too large &lt;b&gt;" in text
    assert "no word of it" in text
    assert "Nothing of an ending." in text
    assert text.count("<svg") == 2


def test_a_run_without_sweeps_writes_no_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2] / "verification"))  # for the measuring processes
    folder = tmp_path / "cases" / f"family_{tmp_path.name}"
    folder.mkdir(parents=True)
    (folder / "page.py").write_text("from extremes.page import write\n")
    (folder / "plain.py").write_text(CASES[: CASES.index("def ended")] + CASES[CASES.index('@case(claim="Nothing') :])
    assert CliRunner().invoke(app, ["verify", "--cases", "cases", "--results", "out", "-j", "1"]).exit_code == 0
    assert not (tmp_path / "out" / f"{folder.name}.html").exists()


@pytest.mark.parametrize(
    ("right", "values", "said"),
    [
        ([0, 0, 0], [1.0, 2.0, 3.0], "none"),
        ([1, 1, 0], [1.0, 2.0, 3.0], "1 to 2"),
        ([1, 0, 1], [1.0, 2.0, 3e9], "1; 3000000000"),
        ([1, 0, 1], ["a", "b", "c"], "a, c"),
        ([0, 0, 0], ["a", "b", "c"], "none"),
    ],
)
def test_intervals_are_of_neighbours(right, values, said):
    assert right_in(values, [point(Ending.RIGHT if is_right else Ending.STOPPED) for is_right in right]) == said
    assert right_in(values, [None] * len(values)) == "none"


def test_points_come_back_as_they_were_written(tmp_path):
    earlier = Earlier("abc", {f"f/c[x={ending}]": Point(ending, 1.5, 'ß "quoted"') for ending in Ending})
    write(tmp_path / "before.json", earlier)
    assert read(tmp_path / "before.json") == earlier
    assert read(tmp_path / "none.json") == Earlier("", {})


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"commit": "a", "points": {"x": {"ending": "odd", "digits": 1, "words": ""}}}'])
def test_another_file_is_refused(tmp_path, text):
    (tmp_path / "before.json").write_text(text)
    with pytest.raises(InputError, match="earlier program"):
        read(tmp_path / "before.json")


def test_what_is_kept_is_one_line_a_point(tmp_path):
    write(tmp_path / "before.json", Earlier("abc", {"a": point(Ending.RIGHT), "b": point(Ending.WRONG)}))
    text = (tmp_path / "before.json").read_text()
    assert json.loads(text)["commit"] == "abc"
    assert len(text.splitlines()) == 4
