"""The page of the extremes: intervals, counts and words of sweeps, beside those of an earlier program."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
import typer
from extremes.endings import Ending
from extremes.points import Earlier, Point, read, right_in, sweeps, write
from extremes.statements import AsEnded, statement
from extremes.study import study
from typer.testing import CliRunner

from isomortar.cli.commands import app
from isomortar.cli.verification import conduct
from isomortar.errors import InputError
from isomortar.harness.collection import collect
from isomortar.harness.runner import not_measured, select

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
def family(tmp_path, monkeypatch):
    """The folder of a small family, with points of an earlier program."""
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2] / "verification"))  # for the measuring processes
    folder = tmp_path / "cases" / f"family_{tmp_path.name}"
    folder.mkdir(parents=True)
    (folder / "sweeps.py").write_text(CASES)
    name = f"{folder.name}/sizes"
    before = {
        f"{name}[size=0.001]": point(Ending.WRONG),
        f"{name}[size=1.0]": point(Ending.RIGHT),
        f"{name}[size=1000.0]": point(Ending.RIGHT),
        f"{name}[size=1000000.0]": point(Ending.WARNED),
    }
    write(folder / "before.json", Earlier("0123456789abcdef", before))
    return folder


def test_the_page_says_what_is_right_where_and_what_is_wrong(family, tmp_path, capsys):
    with pytest.raises(typer.Exit) as ended:
        conduct(study(family, "gate"), tmp_path / "out", 1)
    assert ended.value.exit_code == 1
    said = capsys.readouterr().out
    assert "2 right, 3 warned, 1 refused, 0 stopped, 2 wrong" in said
    assert str(tmp_path / "out" / "extremes.html") in said
    text = (tmp_path / "out" / "extremes.html").read_text()
    assert "<title>2 of 8 wrong" in text
    assert "0.001 to 1</td>" in text  # right now
    assert "1 to 1000</td>" in text  # right before
    assert "0 of 4 pairs" in text
    assert "1 points that were wrong at commit <code>0123456789ab</code>" in text
    assert "size 1000; now refused: too large &lt;b&gt;</li>" in text  # right before, not now
    assert "too large &lt;b&gt;" in text
    assert "no word of it" in text
    assert "Nothing of an ending." in text
    assert text.count("<svg") == 2
    assert text.count(">does not hold</td>") == 3  # both now, and the one that was measured before
    assert text.count(">not measured</td>") == 2  # of pairs, before: in place of an interval, and of a verdict


def test_a_sweep_states_where_the_program_is_right(family):
    (sizes,) = [sweep for sweep in sweeps(results(family), Earlier("", {})) if sweep.case.name.endswith("sizes")]
    ends = {
        "right": (Ending.STOPPED, Ending.RIGHT, Ending.WARNED, Ending.REFUSED),
        "off": (Ending.RIGHT, Ending.WARNED, *[Ending.RIGHT] * 2),
    }
    judged = {}
    for name, endings in ends.items():
        swept = replace(sizes, now=[point(ending) for ending in endings], before=[None] * 4)
        judged[name] = statement(swept).judged([AsEnded("now", [swept]), AsEnded("before", [swept])])
    assert {name: judgement.verdicts[0].state for name, judgement in judged.items()} == {"right": "holds", "off": "does not hold"}
    assert judged["off"].verdicts[0].values["size 1"] == float(Ending.WARNED - Ending.RIGHT)
    assert judged["right"].verdicts[1].why == "4 of 4 points were not measured"


def test_a_family_without_sweeps_has_a_page_of_its_cases(family, tmp_path):
    (family / "sweeps.py").unlink()
    (family / "plain.py").write_text(CASES[: CASES.index("def ended")] + CASES[CASES.index('@case(claim="Nothing') :])
    conduct(study(family, "gate"), tmp_path / "out", 1)
    assert "Nothing of an ending." in (tmp_path / "out" / "extremes.html").read_text()


def test_the_command_needs_a_checkout(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert "studies are run in a checkout" in str(CliRunner().invoke(app, ["report", "extremes"]).exception)


def results(family):
    return not_measured(select(collect(family.parent), "gate"), lambda *_: None)


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
