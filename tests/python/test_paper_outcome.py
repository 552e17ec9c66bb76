"""What is left of runs that fail, and of results files that are gone."""

from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import get_args

import pytest
from paper.outcome import Outcome, Outcomes, outcome, planned, run_of
from paper.page import Report, as_data, page
from paper.quick import PRESS
from paper.run import results_file
from paper.sections import Section

from isomortar.errors import InputError
from isomortar.harness.cases import Cell
from isomortar.harness.measurement import Measurement, measure
from isomortar.harness.runner import Result
from isomortar.harness.store import Store
from isomortar.harness.study import Study
from isomortar.program.process import Ending

#: The block is 0.8 high.
IMPOSSIBLE = ("stages.press.motions.top.translate=[0,0,-0.9]", "stages.press.steps=8", "solver.max_cuts=0", "contacts.floor.friction=0.0")


def section(*changes: str) -> Section:
    """One small run."""
    return replace(PRESS, variants=PRESS.variants[:1], changes=("stages.press.steps=2", *changes))


def cell_of(folder: Path, *changes: str) -> Cell:
    """The cell of its monolithic run."""
    return Study((run_of(*plan(*changes)),), page).cells(folder)[0]


def plan(*changes: str):
    """What is planned first, its monolithic run."""
    return planned([section(*changes)])[0]


def ended(cell: Cell, measurement: Measurement, *changes: str) -> Outcome:
    return outcome(*plan(*changes), Result(cell, measurement, (), True))


def test_a_failed_run_keeps_what_had_converged_and_is_shown(tmp_path):
    cell = cell_of(tmp_path, *IMPOSSIBLE)
    measurement = measure(cell)
    assert measurement.ending == "not converged"
    found = ended(cell, measurement, *IMPOSSIBLE)
    assert not found.lost
    assert found.failure.startswith(f"load step {found.steps + 1} (stage 'press') does not converge")
    assert 1 <= found.steps < found.total_steps == 8
    assert len(found.curve) == found.steps
    assert found.numbers["tangents"] > 0
    report = Report(Outcomes((found.section,), (found,)), (), 0, True, datetime.now().astimezone(), {})
    assert as_data(report)["runs"][0]["load_steps"] == [found.steps, 8]
    text = page(report, {"press": []})
    assert "does not converge" in text
    assert f"{found.steps} of 8" in text


def test_a_run_of_which_nothing_converged_has_no_numbers(tmp_path):
    found = ended(cell_of(tmp_path), Measurement("timed out", message="no result after 1 s"))
    assert (found.failure, found.steps, found.numbers, found.lost) == ("no result after 1 s", 0, {}, True)


@pytest.mark.parametrize("ending", get_args(Ending)[1:])
def test_of_lagrange_elements_only_that_they_do_not_converge_is_a_finding(tmp_path, ending):
    """A crash is a failure, as whatever else says nothing of the elements: the command ends with exit code 1."""
    lagrange = replace(PRESS, variants=tuple(v for v in PRESS.variants if v.name == "L1"))
    plans = planned([lagrange])
    cells = Study(tuple(run_of(*each) for each in plans), page).cells(tmp_path)
    measurement = Measurement(ending, message="as it is")
    found = tuple(outcome(*each, Result(cell, measurement, (), True)) for each, cell in zip(plans, cells, strict=True))
    report = Report(Outcomes((lagrange,), found), (), 0, True, datetime.now().astimezone(), {})
    assert len(report.failed) == 2
    assert report.complete is (ending == "not converged")


def test_what_is_computed_is_read_not_computed_again(tmp_path):
    cell = cell_of(tmp_path)
    first = measure(cell)
    assert first.ending == "measured", first.message
    path = results_file(Path(cell.settings["scene"]))
    written = path.stat().st_mtime_ns
    assert measure(cell).numbers == first.numbers
    assert path.stat().st_mtime_ns == written


def test_another_scene_text_has_another_results_file(tmp_path):
    one = results_file(Path(cell_of(tmp_path).settings["scene"]))
    assert one != results_file(Path(cell_of(tmp_path, "solver.max_cuts=3").settings["scene"]))


def test_a_results_file_that_is_gone_is_asked_for_before_anything_runs(tmp_path):
    cell = cell_of(tmp_path)
    Store(tmp_path / "cells").put(cell, Measurement("measured", {"tangents": 1.0}))
    with pytest.raises(InputError, match="is gone; remove"):
        cell_of(tmp_path)
