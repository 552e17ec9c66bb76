"""What a run tells while it goes on: live progress, every iteration, and the log that keeps it."""

from __future__ import annotations

import contextlib
import io
import re
import shlex
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from rich.console import Console

import isomortar
from command_lines import SMALL, Invoke, settings
from isomortar.cli.progress import LiveProgress, NotebookProgress, progress
from isomortar.model import constants
from isomortar.solve.record import IterationRecord


def test_live_progress_shows_where_the_run_is() -> None:
    text = io.StringIO()
    console = Console(file=text, width=80)
    problem = isomortar.Scene.load("iron").problem()
    live = LiveProgress(problem, console.print)
    live.started(50, 12)
    live.iteration(12, 11.5, 2, IterationRecord(3, 1.5e-7, 9, 4, 5))
    console.print(live)
    shown = text.getvalue()
    for part in ("11/50", "elapsed 0:00", "drag: step 12/50", "load time 11.5", "augmentation 2", "iteration 3", "1.5e-07"):
        assert part in shown
    assert "active 9  stick 4  slip 5" in shown


STAMP = re.compile(r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3} ")


def test_every_iteration_is_told_and_kept_on_demand(invoke: Invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    """What --verbose tells is what --log keeps, and what the results file holds."""
    monkeypatch.setattr(constants, "DENSE_SHARE", 0.0)  # general systems, which have an ordering to tell
    _, _, told = invoke("run", "press", *settings(SMALL), "--verbose", "--log", "logs/press.log")
    kept = Path("logs/press.log").read_text().splitlines()
    assert all(STAMP.match(line) for line in kept)
    first, *lines = (STAMP.sub("", line, count=1) for line in kept)
    assert first.startswith(f"isomortar {isomortar.__version__}: ")
    assert "--log logs/press.log" in first
    assert lines == told.splitlines()
    with isomortar.Results("results/press.h5") as results:
        for step in map(results.step, results.steps):
            log = step.augmentations[0].iterations
            expected = [f"iteration {i.iteration}, residual {i.residual:.1e}; active {i.active} (stick {i.stick}, slip" for i in log]
            found = [line for line in lines if f"  step {step.step}, load time {step.step}: iteration" in line]
            assert len(found) == len(expected)
            assert all(words in line for words, line in zip(expected, found, strict=True))
    effort = [line for line in lines if "increments 1, cuts 0, next increment 1 step" in line]
    assert len(effort) == 3
    assert all(word in effort[-1] for word in ("ordered by", "solid ", "total "))


def test_a_log_goes_on_and_has_what_ended_a_run(invoke: Invoke) -> None:
    uzawa = settings([*SMALL, "solver.method=uzawa", "solver.max_augmentations=1", "solver.max_cuts=1"])
    code, _, told = invoke("run", "press", *uzawa, "--quiet", "--log", "press.log")
    assert code == 1
    assert "iteration" not in told
    assert "isomortar: load step 1" in told
    assert "stopped with 0 of 3 load steps done\n" in told
    kept = Path("press.log").read_text()
    assert "augmentation 1 changed pressures by" in kept
    assert "load increment to 1 failed, cut to 1/2 step" in kept
    assert "ConvergenceError: load step 1" in kept
    assert invoke("run", "press", *settings(SMALL), "--quiet", "--log", "press.log")[:2] == (0, "results/press.h5\n")
    assert Path("press.log").read_text().startswith(kept)
    assert "3 load steps done, 1 warning" in Path("press.log").read_text().splitlines()[-1]


def test_a_log_does_not_go_into_results(invoke: Invoke) -> None:
    assert invoke("run", "press", *settings(SMALL), "--quiet")[0] == 0
    before = Path("results/press.h5").read_bytes()
    code, _, err = invoke("run", "press", *settings(SMALL), "--log", "results/press.h5", "--output", "other.h5")
    assert (code, "log: results/press.h5 is a results file: name another one" in err) == (2, True)
    assert Path("results/press.h5").read_bytes() == before


def test_a_log_does_not_go_into_the_scene_or_where_results_will_be(invoke: Invoke) -> None:
    scene = isomortar.Scene.load("press", SMALL).to_toml()
    Path("mine.toml").write_text(scene)
    for log, what in (("mine.toml", "scene file"), ("./mine.toml", "scene file"), ("mine.h5", "results file")):
        code, _, err = invoke("run", "mine.toml", "--log", log, "--output", "mine.h5")
        assert (code, f"log: {Path(log)} is the {what} of this run: name another one" in err) == (2, True)
    assert Path("mine.toml").read_text() == scene
    assert not Path("mine.h5").exists()


def test_a_log_that_cannot_be_written_is_named(invoke: Invoke) -> None:
    code, _, err = invoke("run", "press", *settings(SMALL), "--quiet", "--log", "/dev/full")
    assert (code, "isomortar: /dev/full cannot be written: No space left on device" in err) == (1, True)


def test_loud_and_quiet_at_once_is_refused(invoke: Invoke) -> None:
    code, _, err = invoke("run", "press", "--quiet", "--verbose")
    assert (code, "--log" in err) == (2, True)


def test_a_run_whose_standard_error_is_closed_says_nothing_there(tmp_path: Path) -> None:
    """Nor where its numbers go."""
    words = "run press --set stages.press.steps=1 --set bodies.block.mesh.elements=[1,1,1] --output run.h5"
    command = f"exec {shlex.quote(sys.executable)} -m isomortar {words} 2>&-"
    ended = subprocess.run(["sh", "-c", command], cwd=tmp_path, stdout=subprocess.PIPE, text=True, check=False)
    assert (ended.returncode, ended.stdout) == (0, "run.h5\n")


def test_lines_are_out_at_once(tmp_path: Path) -> None:
    """Where the standard error is a file, too."""
    with (
        (tmp_path / "said").open("w") as file,
        contextlib.redirect_stderr(file),
        progress(isomortar.Scene.load("press").problem()) as watching,
    ):
        watching.started(3, 1)
        assert (tmp_path / "said").read_text() == "press: 3 load steps\n"


def test_a_library_of_notebooks_makes_no_notebook(monkeypatch: pytest.MonkeyPatch) -> None:
    """Programs import it that run notebooks: a kernel is what makes one."""
    problem = isomortar.Scene.load("press").problem()
    for shell, drawn in (
        (None, False),
        (SimpleNamespace(), False),
        (SimpleNamespace(kernel=None), False),
        (SimpleNamespace(kernel=1), True),
    ):
        monkeypatch.setitem(sys.modules, "ipykernel", SimpleNamespace())
        monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda shell=shell: shell))
        with contextlib.redirect_stderr(io.StringIO()), progress(problem) as watching:
            assert isinstance(watching, NotebookProgress) == drawn
