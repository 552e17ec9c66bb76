"""A small folder of cases, as the command and the pytest plugin run them."""

import json
import resource
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from typer.testing import CliRunner

from harness_cases import GOOD, MATCH, measured
from isomortar.cli.commands import app
from isomortar.errors import InputError
from isomortar.harness import history
from isomortar.harness.collection import collect, find
from isomortar.harness.measurement import measure, used
from isomortar.harness.runner import select

BAD = """
import os, time
from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case, skip

B = {"error": Bound(at_most=1.0, reason="theory: so")}

@case(claim="Crashes.", bounds=B)
def crash():
    os.abort()

@case(claim="Leaves as if all were well.", bounds=B)
def leaving():
    raise SystemExit(0)

@case(claim="Raises.", bounds=B)
def raising():
    raise ValueError("no such thing")

@case(claim="Has no memory.", bounds=B)
def full():
    raise MemoryError

@case(claim="Lacks a file.", bounds=B)
def lacking():
    raise FileNotFoundError("no such file")

@case(claim="Does not converge.", bounds=B)
def unsolved():
    raise ConvergenceError("load step 1 does not converge")

@case(claim="Skips.", bounds=B)
def skipping():
    skip("no library")

@case(claim="Lies.", bounds=B)
def nan():
    return {"error": float("nan")}

@case(claim="Is late.", bounds=B)
def late():
    time.sleep(60)

@case(claim="Prints and is fine.", bounds=B)
def printing():
    print("hello")
    return {"error": 0.5}
"""


def test_bad_cells_fail_and_the_run_goes_on(root, monkeypatch):
    monkeypatch.setitem(__import__("isomortar.harness.cases").harness.cases.TIMEOUTS, "gate", 8.0)
    next(root.glob("family_*")).joinpath("bad.py").write_text(BAD)
    results = measured(root)
    states = {name: result.state for name, result in results.items() if "[" not in name}
    assert states == {
        "crash": "crashed", "leaving": "crashed",
        "raising": "crashed", "full": "failed", "lacking": "failed", "unsolved": "failed", "skipping": "skipped", "nan": "failed",
        "late": "timed out", "printing": "passed",
    }  # fmt: skip
    assert "SIGABRT" in results["crash"].measurement.message
    assert "no such thing" in results["raising"].measurement.message
    again = measured(root)
    kept = {name for name, result in again.items() if not result.fresh and "[" not in name}
    assert kept == {"nan", "printing", "unsolved"}  # the others may be the machine's fault, or be there the next time


def test_what_children_cost_counts():
    def of_children() -> float:
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    before, children = used(), of_children()
    subprocess.run([sys.executable, "-c", "sum(range(10**6))"], check=True)
    assert of_children() > children
    assert used() - before >= of_children() - children


def test_selection(root):
    cases = collect(root)
    family = cases[0].family
    assert len(select(cases, "gate")) == 5
    assert len(select(cases, "weekly", family, f"{family}/sine")) == 3
    assert len(select(cases, "gate", None, f"{family}/sine[order=2]")) == 1
    for tier, other, name in (("gate", "none", None), ("gate", None, "none")):
        with pytest.raises(InputError):
            select(cases, tier, other, name)
    with pytest.raises(InputError, match=rf"of 3 cells of {family}/sine the nearest are {family}/sine\[order="):
        select(cases, "gate", None, f"{family}/sine[order=9]")
    with pytest.raises(InputError) as refused:
        select(20 * cases, "gate", None, f"{family}/sin")
    assert str(refused.value).count(", ") < 6, "not all of some hundreds"
    with pytest.raises(InputError):
        find(root, "none")
    with pytest.raises(InputError):
        collect(root / "nowhere")


def test_no_case_is_lost_unseen(root):
    family = next(root.glob("family_*"))
    one = "from isomortar import harness\n\n@harness.case(claim='It holds.', bounds={'e': harness.Bound(1.0, reason='theory: so')})\n"
    (family / "other.py").write_text(one + "def other():\n    return {'e': 2.0}\n")
    assert f"{family.name}/other" in [case.name for case in collect(root)]
    (root / "helper.py").write_text("SCALE = 1\n" + one + "def made_elsewhere():\n    return {'e': 2.0}\n")
    (family / "more.py").write_text("from isomortar.harness import case\nfrom helper import made_elsewhere as made\n")
    sys.modules.pop("helper")
    with pytest.raises(InputError, match="made stand in no family"):
        collect(root)
    (family / "more.py").write_text(one + "def twin():\n    return {'e': 2.0}\n" + one + "def twin():\n    return {'e': 0.0}\n")
    with pytest.raises(InputError, match="defines twin twice"):
        collect(root)


def test_a_folder_without_cases_is_no_green_run(root):
    family = next(root.glob("family_*"))
    (family / "good.py").write_text("from isomortar.harness import case\n")
    with pytest.raises(InputError, match="no cases"):
        collect(root)
    (root / "empty").mkdir()
    with pytest.raises(InputError):
        CliRunner().invoke(app, ["verify", "--family", "empty", "--cases", str(root)], catch_exceptions=False)


def test_command_and_its_report(root):
    options = ["verify", "--cases", str(root), "--results", "out", "-j", "1"]
    assert CliRunner().invoke(app, options).exit_code == 0
    next(root.glob("family_*")).joinpath("match.py").write_text(MATCH)
    assert CliRunner().invoke(app, options).exit_code == 1  # no reference
    report = json.loads(Path("out/report.json").read_text())
    assert report["states"] == {"passed": 5, "missing reference": 2}
    suite = ElementTree.parse("out/report.xml").getroot()[0]
    assert (suite.get("tests"), suite.get("failures"), len(suite.findall("testcase/failure"))) == ("7", "2", 2)
    page = Path("out/report.html").read_text()
    assert "2 of 7 cells do not pass" in page
    assert "missing reference" in page
    assert "<svg" in page
    Path("out/open").touch()
    assert Path("out/report.html").stat().st_mode == Path("out/open").stat().st_mode  # whoever may read the folder may read the page
    for outside in ("http://", "https://", "src=", "<script", "@import", "url("):
        assert outside not in page
    assert len(history.read(Path("out/history.jsonl"))) == 2


IN_A_CHILD = """
import subprocess
import sys

from isomortar.harness import Bound, case

@case(claim="Works in a process of its own.", bounds={"status": Bound(at_most=0.0, reason="definition: it ends well")})
def elsewhere():
    work = "import time\\nwhile time.process_time() < 0.5: pass"
    return {"status": float(subprocess.run([sys.executable, "-c", work]).returncode)}
"""


def test_what_child_processes_take_is_counted(root):
    """A limit by the seconds of a cell is none for what it leaves to others."""
    next(root.glob("family_*/good.py")).write_text(IN_A_CHILD)
    (cell,) = [cell for case in collect(root) for cell in case.cells]
    assert measure(cell).cpu_seconds >= 0.5


pytest_plugins = ["pytester"]


def test_pytest_collects_cells(pytester):
    family = pytester.mkdir("cases_of_ours").joinpath("family_of_ours")
    family.mkdir()
    family.joinpath("helper.py").write_text("")
    family.joinpath("good.py").write_text(GOOD.replace("from helper import SCALE", "SCALE = 1"))
    family.joinpath("more.py").write_text(
        "from isomortar.harness import Bound, case\n"
        "B = {'error': Bound(at_most=1.0, reason='theory: so')}\n"
        "@case(claim='Too large.', bounds=B)\ndef large():\n    return {'error': 2.0}\n"
        "@case(claim='Slow.', bounds=B, tier='nightly')\ndef slow():\n    return {'error': 0.0}\n"
    )
    result = pytester.runpytest_subprocess("cases_of_ours", "-m", "gate", "--strict-markers")
    result.assert_outcomes(passed=5, failed=1, deselected=1)
    result.stdout.fnmatch_lines(["*error: failed: 2, limit*"])


COUNTED = """
from pathlib import Path
from isomortar.harness import Bound, case

@case(claim="Counts.", bounds={{"error": Bound(at_most=1.0, reason="theory: so")}}, grid={{"order": [1, 2, 3]}})
def {name}(order: int):
    with open(Path(__file__).parents[2] / "measured", "a") as log:
        log.write("{name}\\n")
    return {{"error": 0.5}}
"""


def test_workers_of_xdist_measure_each_cell_once(pytester):
    family = pytester.mkdir("cases_of_ours").joinpath("family_of_ours")
    family.mkdir()
    for name in ("first", "second", "third"):
        family.joinpath(f"{name}.py").write_text(COUNTED.format(name=name))
    result = pytester.runpytest_subprocess("cases_of_ours", "-n", "2", "--dist", "loadfile")
    result.assert_outcomes(passed=9)
    assert sorted(pytester.path.joinpath("measured").read_text().split()) == [*["first"] * 3, *["second"] * 3, *["third"] * 3]
