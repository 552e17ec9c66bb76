"""Films of runs: which load steps, on which scale, and what cannot be filmed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import isomortar
from isomortar.errors import InputError, ResultsError
from isomortar.results import ResultsWriter
from isomortar.results.bodies import common_scale, draw_bodies
from results_samples import problem
from test_results_pictures import quiet


@pytest.fixture
def results_path(tmp_path: Path) -> Path:
    path = tmp_path / "run.h5"
    writer = ResultsWriter(path, problem(), "", "0")
    for number in range(1, 5):
        writer.recorded(quiet(number))
    return path


def test_a_film_shows_one_load_step_in_so_many_and_the_last_one(results_path: Path, tmp_path: Path) -> None:
    told = []
    path = isomortar.film(results_path, tmp_path / "run.gif", every=3, rate=5.0, tell=lambda *done: told.append(done))
    with Image.open(path) as pictures:
        assert (pictures.format, pictures.n_frames, pictures.info["loop"], pictures.info["duration"]) == ("GIF", 2, 0, 200)
        first = np.asarray(pictures.convert("RGB"), float)
        pictures.seek(1)
        assert np.abs(np.asarray(pictures.convert("RGB"), float) - first).max() > 50.0
    assert told == [(1, 2), (2, 2)]


def test_a_film_for_players_of_films_has_the_pictures_too(results_path: Path, tmp_path: Path) -> None:
    """Decoded again: as many, at that rate, and near to those of the film without losses."""
    exact, path = (isomortar.film(results_path, tmp_path / f"run.{kind}", every=3, rate=4.0) for kind in ("webp", "mp4"))
    frames = imageio_ffmpeg.read_frames(str(path))
    facts = next(frames)
    (width, height), shown = facts["size"], [np.frombuffer(frame, np.uint8) for frame in frames]
    assert (len(shown), facts["fps"], facts["codec"]) == (2, 4.0, "h264")
    with Image.open(exact) as pictures:
        for number, frame in enumerate(shown):
            pictures.seek(number)
            right = np.asarray(pictures.convert("RGB"), float)[:height, :width]
            assert np.abs(frame.reshape(height, width, 3) - right).mean() < 3.0


@pytest.mark.filterwarnings("error")
def test_a_scene_of_any_script_is_filmed_and_drawn(tmp_path: Path) -> None:
    """Letters that the font does not have are boxes, and no words of the picture's library."""
    path = tmp_path / "接触.h5"
    writer = ResultsWriter(path, replace(problem(), name="接触"), "", "0")
    for number in (1, 2):
        writer.recorded(quiet(number))
    assert isomortar.film(path, path.with_suffix(".webp")).is_file()
    assert isomortar.plot(path, tmp_path / "drawn", formats=["png"])


def test_a_film_goes_into_a_folder_that_is_made_and_never_over_results(results_path: Path, tmp_path: Path) -> None:
    assert isomortar.film(results_path, tmp_path / "new" / "films" / "run.webp", every=3, rate=0.01).is_file()
    results = results_path.rename(tmp_path / "run.gif")
    before = results.read_bytes()
    with pytest.raises(ResultsError, match=r"run\.gif is a results file, so it is not overwritten"):
        isomortar.film(results, results)
    assert results.read_bytes() == before


def corners(figure: Figure, picture: int) -> np.ndarray:
    """Lower left and upper right one of what is seen."""
    axes = figure.axes[picture]
    return np.transpose([axes.get_xlim(), axes.get_ylim()])


@pytest.mark.parametrize("number", [0, 1])
def test_all_pictures_of_a_film_have_one_scale(number: int) -> None:
    """Nothing leaves them, and the hardest pressure of all has the end of the colours."""
    made, steps = problem(), [quiet(k) for k in range(1, 4)]
    scale = common_scale(made, steps, number)
    single = [draw_bodies(made, step, number) for step in steps]
    together = [draw_bodies(made, step, number, scale) for step in steps]
    hardest = max(figure.axes[2].get_ylim()[1] for figure in single)
    assert [figure.axes[2].get_ylim()[1] for figure in together] == pytest.approx([hardest] * len(steps))
    for one in together:
        assert np.array_equal(corners(one, 0), corners(together[0], 0))
        assert np.ptp(corners(one, 1), axis=0) == pytest.approx(scale.size)
        for picture in (0, 1):
            low, high = corners(one, picture)
            drawn = np.concatenate([path.vertices for path in one.axes[picture].collections[0].get_paths()])
            assert (drawn >= low).all()
            assert (drawn <= high).all()


def test_what_cannot_be_filmed_leaves_no_file(results_path: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is 'sky'; allowed: tread, ground"):
        isomortar.film(results_path, tmp_path / "run.gif", contact="sky")
    assert not (tmp_path / "run.gif").exists()
