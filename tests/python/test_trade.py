"""A trade of a tiny scene from its first run to what is kept of it."""

import json
from datetime import datetime

import keep_front
import numpy as np
import pytest
from fronts import recommended

from isomortar.harness.runner import local_processes
from isomortar.scene import Scene
from isomortar.trade import page
from isomortar.trade.knobs import KNOBS, dials_of
from isomortar.trade.laboratory import Laboratory
from isomortar.trade.search import Search
from isomortar.trade.want import wanted
from trade_samples import TINY


@pytest.fixture
def scene():
    return Scene.from_toml(TINY)


def test_a_search_that_was_killed_goes_on_to_the_same_answer(scene, tmp_path, monkeypatch):
    knobs = [knob for knob in KNOBS if knob.name in ("elements", "load steps")]
    dials = dials_of(scene, knobs=knobs)
    wants = [wanted("force.top.z", scene.problem())]

    def conducted(stop):
        told = []

        def tell(outcome):
            told.append(outcome)
            if len(told) == stop:
                raise KeyboardInterrupt

        with local_processes(1) as submit:
            search = Search(Laboratory(scene, dials, tmp_path, submit, tell), dials, wants, 1e4)
            search.screen()
            search.find_truth([0.5])
            return search, search.answer(0.5)

    with pytest.raises(KeyboardInterrupt):
        conducted(5)
    first = conducted(-1)
    begun = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.json")}
    second = conducted(-1)
    assert first[1].best.choice == second[1].best.choice
    changed_cells = [path for path, at in begun.items() if path.stat().st_mtime_ns != at]
    assert {path.relative_to(tmp_path).parts[0] for path in changed_cells} == {"afresh"}  # what is recommended is run again
    data = json.loads(page.write(tmp_path, scene, *(second[0], [second[1]]), datetime.now().astimezone()).with_suffix(".json").read_text())
    assert data["answers"][0]["error"] <= 0.5
    assert np.isfinite(data["uncertainty"])
    _kept_and_run_again(tmp_path, data, monkeypatch)


def _kept_and_run_again(trade, data, monkeypatch):
    """What a trade found is kept as a reference; its recommendation is as near to the truth as it was."""
    kept = trade / "kept"
    (kept / "scenes").mkdir(parents=True)
    (kept / "scenes" / "tiny-within-7-percent.toml").write_text("of an earlier trade")
    keep_front.keep(trade, kept, kept / "scenes")
    monkeypatch.setattr(recommended, "REFERENCES", kept)
    monkeypatch.setattr(recommended, "FOLDER", kept / "scenes")
    (name,) = (path.stem for path in (kept / "scenes").iterdir())
    found = recommended.recommended.function(name)
    assert recommended.target(name) == 0.5
    assert found["error"] == pytest.approx(data["answers"][0]["error"], rel=1e-9)
    front = recommended.truth_of(name).dataset("front/error").values
    assert front == pytest.approx([run["error"] for run in data["front"]])
    assert (np.diff(front) < 0).all()
