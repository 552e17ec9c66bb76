"""What is left of runs that fail, and of results files that are gone."""

from dataclasses import replace
from datetime import datetime
from pathlib import Path

import pytest
from paper import run as cells
from paper.outcome import Outcomes, cells_of, outcome
from paper.page import Report, as_data, page
from paper.quick import PRESS
from paper.sections import Section

from isomortar.errors import InputError
from isomortar.harness.measurement import Measurement, measure
from isomortar.harness.store import Store

#: The block is 0.8 high.
IMPOSSIBLE = ("stages.press.motions.top.translate=[0,0,-0.9]", "stages.press.steps=8", "solver.max_cuts=0", "contacts.floor.friction=0.0")


def section(*changes: str) -> Section:
    """One small run."""
    return replace(PRESS, runs=PRESS.runs[:1], changes=("stages.press.steps=2", *changes))


def planned(folder: Path, *changes: str):
    """The plan of its monolithic run, with its cell."""
    return cells_of([section(*changes)], folder)[0]


def test_a_failed_run_keeps_what_had_converged_and_is_shown(tmp_path):
    plan = planned(tmp_path, *IMPOSSIBLE)
    measurement = measure(plan[-1])
    assert measurement.ending == "not converged"
    found = outcome(*plan, measurement)
    assert not found.lost
    assert found.failure.startswith(f"load step {found.steps + 1} (stage 'press') does not converge")
    assert 1 <= found.steps < found.total_steps == 8
    assert len(found.curve) == found.steps
    assert found.numbers["tangents"] > 0
    report = Report(Outcomes((plan[0],), (found,)), (), 0, True, datetime.now().astimezone(), {})
    assert as_data(report)["runs"][0]["load_steps"] == [found.steps, 8]
    text = page(report, {"press": []})
    assert "does not converge" in text
    assert f"{found.steps} of 8" in text


def test_a_run_of_which_nothing_converged_has_no_numbers(tmp_path):
    plan = planned(tmp_path)
    found = outcome(*plan, Measurement("timed out", message="no result after 1 s"))
    assert (found.failure, found.steps, found.numbers, found.lost) == ("no result after 1 s", 0, {}, True)


def test_what_is_computed_is_read_not_computed_again(tmp_path):
    plan = planned(tmp_path)
    first = measure(plan[-1])
    assert first.ending == "measured", first.message
    path = cells.results_file(Path(plan[-1].settings["scene"]))
    written = path.stat().st_mtime_ns
    assert measure(plan[-1]).numbers == first.numbers
    assert path.stat().st_mtime_ns == written


def test_another_scene_text_has_another_results_file(tmp_path):
    one = cells.results_file(Path(planned(tmp_path)[-1].settings["scene"]))
    assert one != cells.results_file(Path(planned(tmp_path, "solver.max_cuts=3")[-1].settings["scene"]))


def test_a_results_file_that_is_gone_is_asked_for_before_anything_runs(tmp_path):
    *_, cell = planned(tmp_path)
    Store(tmp_path / "cells").put(cell, Measurement("measured", {"tangents": 1.0}))
    with pytest.raises(InputError, match="is gone; remove"):
        planned(tmp_path)
