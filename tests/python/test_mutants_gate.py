"""The gate that faulty programs meet: which cells it asks, in which order, how long, and what it takes for a catch."""

import math
from pathlib import Path

import pytest

from isomortar.errors import IsomortarError
from isomortar.harness.collection import collect
from isomortar.harness.measurement import Measurement
from isomortar.harness.mutants.bench import Bench
from isomortar.harness.mutants.gate import Gate
from isomortar.harness.mutants.tests.as_cells import cells_of_tests

CASES = """
from isomortar.harness import Bound, case

@case(claim="Cheap.", bounds={"zero": Bound(at_most=1.0, reason="definition: so")}, grid={"k": [1, 2]})
def cheap(k: int):
    return {"zero": 0.0}

@case(claim="Dear.", bounds={"zero": Bound(at_most=1.0, reason="definition: so")})
def dear():
    return {"zero": 0.0}
"""


#: Kernels of an oracle.
SOUND, FAULTY = Path("sound"), Path("faulty")


class Oracle:
    """Measures in no time, red where it is told to, on faulty kernels or on all; notes what it was asked."""

    def __init__(self, red: str = "", ending: str = "measured", on: tuple[Path, ...] = (FAULTY,)) -> None:
        self.red, self.ending, self.on, self.asked = red, ending, on, []

    def measure(self, kernel, cell, seconds):
        self.asked.append((cell.name, seconds))
        if cell.name != self.red or kernel not in self.on:
            return Measurement("measured", dict.fromkeys(cell.case.bounds, 0.0))
        return Measurement(self.ending, {"zero": math.nan} if self.ending == "measured" else {}, "gone")


@pytest.fixture(scope="module")
def cells(tmp_path_factory):
    family = tmp_path_factory.mktemp("cases") / "mutants_family"
    family.mkdir()
    (family / "mutants_cases.py").write_text(CASES)
    return [cell for case in collect(family.parent) for cell in case.cells]


def names(cells) -> set[str]:
    return {cell.name for cell in cells}


def gate(cells) -> Gate:
    return Gate({cell.name: 5.0 if "dear" in cell.name else 0.1 for cell in cells}, cells, lambda *_: None, SOUND)


def test_the_gate_stops_at_the_first_red_cell_and_asks_it_first_next_time(cells):
    red, tried = "mutants_family/cheap[k=2]", gate(cells)
    first = tried.attack(Oracle(red), FAULTY, "solid/a.f90", names(cells), (), math.inf)
    assert first.killer == red
    assert "not finite" in first.found
    tried.learn("solid", first)
    tried.learn("solid", first)
    bench = Oracle(red)
    assert tried.attack(bench, FAULTY, "solid/a.f90", names(cells), (), math.inf).passed == ()
    assert [name for name, _ in bench.asked] == [red]


@pytest.mark.parametrize("ending", ["crashed", "timed out", "trouble", "refused", "skipped"])
def test_whatever_does_not_pass_kills(cells, ending):
    assert (
        gate(cells).attack(Oracle("mutants_family/dear", ending), FAULTY, "solid/a.f90", names(cells), (), math.inf).killer
        == "mutants_family/dear"
    )


def test_a_cell_that_crashes_without_a_fault_too_is_no_catch(cells):
    with pytest.raises(IsomortarError, match=r"dear is red on the sound program too.*\(zero: crashed"):
        gate(cells).attack(Oracle("mutants_family/dear", "crashed", (FAULTY, SOUND)), FAULTY, "solid/a.f90", names(cells), (), math.inf)


def test_a_survivor_met_the_whole_gate_or_as_much_as_asked_for(cells):
    bench, tried = Oracle(), gate(cells)
    finding = tried.attack(bench, FAULTY, "solid/a.f90", names(cells), (), math.inf)
    assert finding.killer is None
    assert tried.is_whole(finding, names(cells))
    assert [name for name, _ in bench.asked] == ["mutants_family/cheap[k=2]", "mutants_family/cheap[k=1]", "mutants_family/dear"]
    assert [seconds for _, seconds in bench.asked] == [20.0, 20.0, 100.0]
    assert not tried.is_whole(tried.attack(Oracle(), FAULTY, "solid/a.f90", names(cells), (), 0.15), names(cells))


def test_a_cell_that_does_not_run_a_faults_statement_is_not_asked(cells):
    bench, tried, able = Oracle("mutants_family/dear"), gate(cells), {"mutants_family/cheap[k=1]"}
    finding = tried.attack(bench, FAULTY, "solid/a.f90", able, (), math.inf)
    assert [name for name, _ in bench.asked] == sorted(able)
    assert finding.killer is None
    assert tried.is_whole(finding, able)
    assert not tried.is_whole(finding, names(cells))


def test_a_file_of_tests_that_passed_says_nothing_of_the_others(cells, tmp_path):
    """Cells of one case do: after two of three the third would come behind a case that takes three times as long."""
    for name in ("test_one", "test_two", "test_three"):
        (tmp_path / f"{name}.py").write_text("")
    files = cells_of_tests(tmp_path)
    dear = next(cell for cell in cells if "dear" in cell.name)
    bench = Oracle()
    Gate({dear.name: 3.0} | {cell.name: 1.0 for cell in files}, [dear, *files], lambda *_: None, SOUND).attack(
        bench, FAULTY, "solid/a.f90", names([dear, *files]), (), math.inf
    )
    assert [name for name, _ in bench.asked][-1] == dear.name


def test_a_file_of_tests_is_another_when_what_it_reads_is(tmp_path):
    """Files that it imports, others below its folder, and those of folders that it names."""
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "page.html").write_text("")
    tests = tmp_path / "tests/python"
    (tests / "pictures").mkdir(parents=True)
    for name, text in {"test_one.py": 'import test_two\nDOCS = "docs"', "test_two.py": "", "pictures/a.png": "", "samples.py": ""}.items():
        (tests / name).write_text(text)
    one, two = (set(cell.case.files) for cell in cells_of_tests(tests))
    assert two == {tests / "test_two.py", tests / "pictures/a.png", tests / "samples.py"}
    assert one == two | {tests / "test_one.py", tmp_path / "docs" / "page.html"}


def test_cells_that_are_named_like_the_faulty_file_come_first(tmp_path):
    for name in ("test_one", "test_scene_errors", "test_zero"):
        (tmp_path / f"{name}.py").write_text("")
    files, bench = cells_of_tests(tmp_path), Oracle()
    Gate({cell.name: 1.0 for cell in files}, files, lambda *_: None, SOUND).attack(
        bench, FAULTY, "scene/schema.py", names(files), (), math.inf
    )
    assert "test_scene_errors" in bench.asked[0][0]


def test_cells_passed_before_are_not_asked_again(cells):
    bench = Oracle()
    gate(cells).attack(bench, FAULTY, "solid/a.f90", names(cells), ("mutants_family/dear",), math.inf)
    assert "mutants_family/dear" not in dict(bench.asked)


def test_newer_cells_come_first_and_are_met_though_patience_is_spent(cells):
    """A survivor that met the cheap cells before, and has no time left: the dear one is newer."""
    bench, tried = Oracle(), gate(cells)
    passed, newer = [name for name in sorted(names(cells)) if "cheap" in name], {"mutants_family/dear"}
    assert not tried.left(names(cells), passed, 0.1, set())
    finding = tried.attack(bench, FAULTY, "solid/a.f90", names(cells), passed, 0.1, newer)
    assert [name for name, _ in bench.asked] == ["mutants_family/dear"]
    assert tried.is_whole(finding, names(cells))
    tried.attack(bench, FAULTY, "solid/a.f90", names(cells), (), math.inf, newer)
    assert bench.asked[1][0] == "mutants_family/dear"
    assert not tried.left({"mutants_family/cheap[k=1]"}, passed, math.inf, newer), "a cell that cannot be red was to be asked"


def test_a_process_that_died_because_the_run_ended_is_no_catch(cells, tmp_path):
    (tmp_path / "package").mkdir()
    (tmp_path / "program").mkdir()
    bench = Bench(tmp_path / "package", tmp_path, tmp_path / "bench")
    bench.__exit__(None, None, None)
    with pytest.raises(IsomortarError, match="given up"):
        gate(cells).attack(bench, tmp_path / "program", "solid/a.f90", names(cells), (), math.inf)
