"""The place of a results file: held by one run at a time, never taken from another file, and a disk that takes no more."""

from __future__ import annotations

import io
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import isomortar
from isomortar.errors import InputError, ResultsError
from isomortar.results import writer
from isomortar.results.files import claimed, sealed, writing
from isomortar.solve.record import StepResult

SMALL = ["bodies.block.mesh.elements=[3,3,2]", "stages.press.steps=3"]


def command(*words: str, small: bool = True) -> list[str]:
    overrides = [word for value in SMALL for word in ("--set", value)] if small else []
    return [sys.executable, "-m", "isomortar", *words, *overrides]


def ended(folder: Path, *words: str, small: bool = True, limit: Callable[[], None] | None = None) -> subprocess.CompletedProcess[str]:
    process = subprocess.run(command(*words, small=small), cwd=folder, capture_output=True, text=True, check=False, preexec_fn=limit)
    assert process.returncode in (0, 1, 2), process.stderr  # no signal, no fault of the program
    return process


def recorded(path: Path) -> list[int]:
    with isomortar.Results(path) as results:
        return [int(step) for step in results.steps]


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """A results file of three load steps."""
    path = tmp_path / "press.h5"
    isomortar.run(isomortar.Scene.load("press", SMALL), path).close()
    return path


@pytest.mark.parametrize("option", [[], ["--resume"], ["--overwrite"]])
def test_a_second_run_is_refused_while_the_first_one_writes(tmp_path: Path, option: list[str]) -> None:
    slow = command("run", "iron", "--output", "run.h5", small=False)
    with subprocess.Popen(slow, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as first:
        assert first.stderr is not None
        assert any(line.startswith("step  1/50") for line in first.stderr)
        second = ended(tmp_path, "run", "iron", "--output", "run.h5", *option, small=False)
        first.send_signal(signal.SIGKILL)
        first.communicate()
    assert second.returncode == 1
    assert "another run is writing run.h5" in second.stderr
    steps = recorded(tmp_path / "run.h5")
    assert steps == list(range(1, len(steps) + 1))
    with claimed(tmp_path / "run.h5"):  # what a killed process held is free
        pass
    assert not list(tmp_path.glob(".*.lock"))


def test_of_runs_that_start_together_one_writes(tmp_path: Path) -> None:
    runs = [subprocess.Popen(command("run", "press", "--output", "run.h5"), cwd=tmp_path, stderr=subprocess.PIPE, text=True) for _ in "123"]
    said = [run.communicate()[1] for run in runs]
    assert sorted(run.returncode for run in runs)[0] == 0
    assert all("another run is writing" in text or "exists already" in text for run, text in zip(runs, said, strict=True) if run.returncode)
    assert recorded(tmp_path / "run.h5") == [1, 2, 3]


def test_a_lock_that_its_holder_removed_holds_nobody(tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    for _ in range(3):
        with claimed(path), pytest.raises(ResultsError, match="another run is writing"), claimed(path):
            pytest.fail("two hold it")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("option", [[], ["--resume"], ["--overwrite"]])
@pytest.mark.parametrize("kind", ["scene", "link", "dangling link", "device", "foreign HDF5"])
def test_nothing_but_results_is_replaced(results: Path, kind: str, option: list[str]) -> None:
    place = results.with_name("place")
    target = results.with_name("target.h5")
    scene = isomortar.Scene.load("press").to_toml()
    match kind:
        case "scene":
            place.write_text(scene)
        case "link":
            results.rename(target)
            place.symlink_to(target)
        case "dangling link":
            place.symlink_to(target)
        case "device":
            place = Path(os.devnull)
        case "foreign HDF5":
            place.write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(600))
    before = [place.lstat().st_mode, place.lstat().st_ino, target.exists() and target.read_bytes(), place.is_file() and place.read_bytes()]
    done = ended(results.parent, "run", "press", "--output", str(place), *option)
    assert done.returncode == 1
    assert str(place) in done.stderr
    after = [place.lstat().st_mode, place.lstat().st_ino, target.exists() and target.read_bytes(), place.is_file() and place.read_bytes()]
    assert after == before


def test_results_are_replaced_on_demand_also_damaged_ones(results: Path) -> None:
    scene = isomortar.Scene.load("press", [*SMALL, "stages.press.steps=1"])
    with pytest.raises(InputError, match="exists already"):
        isomortar.run(scene, results)
    isomortar.run(scene, results, overwrite=True).close()
    assert recorded(results) == [1]
    results.write_bytes(results.read_bytes()[:-100])
    with pytest.raises(ResultsError, match="damaged"):
        isomortar.run(scene, results, resume=True)
    isomortar.run(scene, results, overwrite=True).close()
    assert recorded(results) == [1]


class StopsAtOnce(isomortar.Observer):
    """Ends a run before its first load step."""

    def iteration(self, step: int, time: float, augmentation: int, record: object) -> None:
        raise KeyboardInterrupt


def test_a_file_without_a_step_is_in_nobodys_way(tmp_path: Path) -> None:
    path, scene = tmp_path / "run.h5", isomortar.Scene.load("press", SMALL)
    with pytest.raises(KeyboardInterrupt):
        isomortar.run(scene, path, StopsAtOnce())
    assert recorded(path) == []
    isomortar.run(isomortar.Scene.load("press", [*SMALL, "contacts.floor.friction=0.1"]), path).close()
    assert recorded(path) == [1, 2, 3]


def test_a_scene_that_is_refused_leaves_results_and_no_lock(results: Path) -> None:
    before = results.read_bytes()
    done = ended(results.parent, "run", "press", "--output", "press.h5", "--overwrite", "--set", "bodies.block.geometry.top=-0.5")
    assert done.returncode == 2
    assert results.read_bytes() == before
    assert list(results.parent.iterdir()) == [results]


def test_what_cannot_be_replaced_still_holds_load_steps_up_to_its_last_one(results: Path) -> None:
    assert len(recorded(results)) > 1
    assert writer._still_in(results) == f"; it still holds load steps up to {recorded(results)[-1]}"


@pytest.mark.parametrize("kilobytes", [1, 40, 60, 80, 100])
def test_a_full_disk_has_its_sentence(tmp_path: Path, kilobytes: int) -> None:
    """Stands for a full disk: a limit on the size of a file, which fails the same calls. HDF5 ended the process when its own failed."""
    limit = 1024 * kilobytes
    done = ended(tmp_path, "run", "press", "--output", "run.h5", limit=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
    assert done.returncode == 1
    assert "isomortar: run.h5 cannot be written: File too large" in done.stderr
    assert "None" not in done.stderr
    assert [path.name for path in tmp_path.iterdir()] in ([], ["run.h5"])
    steps = recorded(tmp_path / "run.h5") if (tmp_path / "run.h5").exists() else []
    assert done.stderr.rpartition("File too large")[2].strip() == (f"; it still holds load steps up to {steps[-1]}" if steps else "")
    if (tmp_path / "run.h5").exists():
        assert ended(tmp_path, "run", "press", "--output", "run.h5", "--resume").returncode == 0
        assert recorded(tmp_path / "run.h5") == [1, 2, 3]
        assert steps == [1, 2, 3][: len(steps)]


@pytest.mark.parametrize("what", ["plot", "export"])
def test_a_full_disk_has_its_sentence_where_figures_are_written(results: Path, what: str) -> None:
    done = ended(results.parent, what, "press.h5", small=False, limit=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)))
    assert done.returncode == 1
    assert "cannot be written: File too large" in done.stderr
    assert f"press-{'plots' if what == 'plot' else 'paraview'}/" in done.stderr
    assert not [path for path in results.parent.rglob("*") if path.is_file() and path.stat().st_size == 2000]


def test_a_film_whose_encoder_fails_is_none(results: Path) -> None:
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))  # noqa: E731
    done = ended(results.parent, "film", "press.h5", "--output", "press.mp4", small=False, limit=limit)
    assert done.returncode == 1
    assert done.stderr == "isomortar: press.mp4 cannot be written: its encoder failed\n"
    assert not results.with_name("press.mp4").exists()


def test_reading_goes_on_while_a_run_writes(tmp_path: Path) -> None:
    slow = command("run", "iron", "--output", "run.h5", small=False)
    with subprocess.Popen(slow, cwd=tmp_path, stderr=subprocess.DEVNULL) as run:
        until = time.monotonic() + 60
        seen = 0
        while seen < 2 and time.monotonic() < until:
            if (tmp_path / "run.h5").exists():
                seen = len(recorded(tmp_path / "run.h5"))
        run.kill()
    assert seen >= 2


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: isomortar.Results(3), r"path: is 3; allowed: str or PathLike"),  # type: ignore[arg-type]
        (lambda: isomortar.run(None), r"scene: is None; allowed: Scene or str or PathLike"),  # type: ignore[arg-type]
        (lambda: isomortar.run("press", observer=5), r"observer: is 5; allowed: Observer or NoneType"),  # type: ignore[arg-type]
    ],
)
def test_what_is_no_path_scene_or_observer_is_refused(call: Callable[[], Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        call()


class _Stopping(isomortar.Observer):
    """Notes how many load steps are on the disk when one is recorded, and stops at one of them."""

    def __init__(self, path: Path, last: int) -> None:
        self.path, self.last, self.seen = path, last, list[int]()

    def recorded(self, result: StepResult) -> None:
        self.seen.append(len(recorded(self.path)))
        if result.step == self.last:
            raise KeyboardInterrupt


@pytest.mark.parametrize("slow", [False, True])
def test_steps_are_written_together_where_writing_takes_long_and_kept_if_the_run_is_stopped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, slow: bool
) -> None:
    path, clock = tmp_path / "run.h5", iter(range(10**6))
    if slow:  # each look at the clock takes a second, and writing so a second, which no ten of go by
        monkeypatch.setattr(writer, "BRIEF", 0.05)
        monkeypatch.setattr(writer, "monotonic", lambda: float(next(clock)))
    observer = _Stopping(path, 5)
    with pytest.raises(KeyboardInterrupt):
        isomortar.run(isomortar.Scene.load("press", ["bodies.block.mesh.elements=[1,1,1]", "stages.press.steps=6"]), path, observer)
    assert (observer.seen == [1, 2, 3, 4, 5]) is not slow
    assert observer.seen[-1] >= slow
    assert recorded(path) == [1, 2, 3, 4, 5]


def test_a_file_that_was_edited_and_sealed_again_is_refused_where_bodies_are_missing(results: Path) -> None:
    content = io.BytesIO(results.read_bytes())
    with h5py.File(content, "a") as file:
        del file["problem/bodies/0"]
    results.write_bytes(sealed(content.getvalue()))
    with isomortar.Results(results) as edited, pytest.raises(ResultsError, match="bodies of the scene are missing"):
        _ = edited.problem


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("states/positions", np.ones(3), "body 'block' has no volume"),
        ("states/positions", np.array([1.0, 1.0, 0.0]), "body 'block' has no volume"),
        ("states/positions", np.array([np.nan, 1.0, 1.0]), "cannot be read"),
        ("states/contacts/floor/pressure", np.inf, "pressures of contact 'floor' are not finite"),
        ("states/contacts/floor/traction", np.nan, "pressures of contact 'floor' are not finite"),
    ],
)
def test_states_that_nothing_computes_are_refused_by_whoever_reads_them(results: Path, name: str, value: Any, words: str) -> None:
    content = io.BytesIO(results.read_bytes())
    with h5py.File(content, "a") as file:
        kept = file[name][()]
        if np.ndim(value):
            kept = kept * value if 0.0 in value else np.broadcast_to(value, kept.shape)
        else:  # one number of the last state
            kept[-1].ravel()[-1] = value
        file[name][...] = kept
    results.write_bytes(sealed(content.getvalue()))
    with isomortar.Results(results) as edited, pytest.raises(ResultsError, match=words):
        edited.last_step()


def test_what_cannot_be_written_leaves_no_part_of_a_new_file_and_the_old_one_as_it_was(tmp_path: Path) -> None:
    for name, before in (("new", None), ("old", "as it was")):
        path = tmp_path / name
        if before:
            path.write_text(before)
        with pytest.raises(ResultsError, match=f"{name} cannot be written: full"):
            _write_a_part(path, OSError(28, "full"))
        with pytest.raises(KeyboardInterrupt):
            _write_a_part(path, KeyboardInterrupt())
        assert (path.read_text() if path.exists() else None) == before
    assert [path.name for path in tmp_path.iterdir()] == ["old"]


def test_what_a_link_leads_to_is_written_and_the_link_stays(tmp_path: Path) -> None:
    link, file = tmp_path / "link.svg", tmp_path / "file.svg"
    link.symlink_to(file)
    with writing(link) as fresh:
        fresh.write_text("whole")
    assert link.is_symlink()
    assert file.read_text() == "whole"


def _write_a_part(path: Path, end: BaseException) -> None:
    with writing(path) as fresh:
        fresh.write_text("a part")
        raise end
