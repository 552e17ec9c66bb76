"""Files of earlier formats: contact forces have the sign of today when they are read, and in files that are resumed."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import h5py
import numpy as np
import pytest

import isomortar
from isomortar.errors import ResultsError
from isomortar.results import layout
from isomortar.results.files import sealed
from isomortar.results.reader import Results
from isomortar.results.writer import ResultsWriter
from results_samples import problem, step_result
from stopped_runs import Stopped
from test_results_store import same

#: What format 3 held with the other sign.
TURNED = "force_slave", "force_master", "moment_slave", "moment_master"
PRESS = ["bodies.block.mesh.elements=[2,2,1]", "stages.press.steps=3"]


def as_before(path: Path, number: int | None) -> None:
    """Put a file into the format that contact forces had the other sign in; it may not tell its number."""
    with h5py.File(path, "a") as file:
        for contact in file["curves/contacts"].values():
            for name in TURNED:
                contact[name][...] = -contact[name][()]
        del file.attrs["format_version"]
        if number is not None:
            file.attrs["format_version"] = number
    path.write_bytes(sealed(path.read_bytes()))


def without_ways(path: Path) -> None:
    """Take what no file of format 3 held: how far supports had gone, by their motions alone."""
    with h5py.File(path, "a") as file:
        for support in file["curves/supports"].values():
            del support["displacement"], support["rotation"]
    path.write_bytes(sealed(path.read_bytes()))


@pytest.fixture(params=[3, None], ids=["format 3", "no number"])
def earlier(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """Load steps 1 to 3 of the samples in an earlier format."""
    writer = ResultsWriter(tmp_path / "run.h5", problem(), "", "0.1")
    for number in (1, 2, 3):
        writer.recorded(step_result(number))
    as_before(writer.path, request.param)
    return writer.path


def test_an_earlier_file_is_read_with_the_signs_of_today(earlier: Path) -> None:
    with Results(earlier) as results:
        assert [same(results.step(k), step_result(k)) for k in (1, 2, 3)] == [True] * 3
        frame = results.to_dataframe()
        for number, contact in enumerate(problem().contacts):
            for name in layout.CONTACT:
                expected = [getattr(step_result(k).contacts[number], name) for k in (1, 2, 3)]
                assert np.array_equal(results.curve(name, contact=contact.name), expected), name
            forces = [step_result(k).contacts[number].force_slave[2] for k in (1, 2, 3)]
            assert np.array_equal(frame[f"force_slave.{contact.name}.z"], forces)


def test_an_earlier_file_is_resumed_in_the_format_of_today(earlier: Path) -> None:
    writer = ResultsWriter(earlier, problem(), "", "0.1", resume=True)
    for number in (4, 5):
        writer.recorded(step_result(number))
    with Results(earlier) as results:
        assert [same(results.step(k), step_result(k)) for k in range(1, 6)] == [True] * 5
    with h5py.File(earlier) as file:
        assert layout.version_of(file) == layout.FORMAT_VERSION
        for name in TURNED:
            dataset = file[f"curves/contacts/tread/{name}"]
            assert np.array_equal(dataset[()], [getattr(step_result(k).contacts[0], name) for k in range(1, 6)])
            assert dataset.attrs["description"] == layout.CONTACT[name].description


def test_a_file_is_not_rewritten_where_nothing_is_left_to_compute(earlier: Path) -> None:
    before = earlier.read_bytes()
    ResultsWriter(earlier, problem(), "", "0.1", resume=True)
    assert earlier.read_bytes() == before


@pytest.mark.parametrize(("number", "words"), [(2, "use the version that wrote it"), (layout.FORMAT_VERSION + 1, "update isomortar")])
def test_other_formats_are_refused_with_what_to_do(tmp_path: Path, number: int, words: str) -> None:
    path = tmp_path / "run.h5"
    ResultsWriter(path, problem(), "", "0.1")
    as_before(path, number)
    before = path.read_bytes()
    with pytest.raises(ResultsError, match=f"has format {number}.*{words}"):
        Results(path)
    with pytest.raises(ResultsError, match=f"has format {number}.*{words}"):
        ResultsWriter(path, problem(), "", "0.1", resume=True)
    assert path.read_bytes() == before


def test_a_run_that_was_stopped_before_goes_on_to_the_same_numbers(tmp_path: Path) -> None:
    scene = isomortar.Scene.load("press", PRESS)
    with isomortar.run(scene, tmp_path / "whole.h5") as whole:
        path = tmp_path / "stopped.h5"
        with pytest.raises(KeyboardInterrupt):
            isomortar.run(scene, path, Stopped(2))
        as_before(path, 3)
        without_ways(path)
        with isomortar.run(scene, path, resume=True) as resumed:
            for number in whole.steps:
                one, other = (dataclasses.replace(r.step(int(number)), timings={}, counters={}) for r in (whole, resumed))
                assert same(one, other)


BESIDE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [-3, 1, 0], upper = [-2, 2, 1] }
contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0], normal = [0, 0, 1] }, friction = 0.5 }
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 2, motions.top.translate = [0.05, 0, -0.1] }]
"""


def test_what_acts_on_a_body_is_in_balance(tmp_path: Path) -> None:
    """A block beside the origin is pressed down on a plane and dragged along: the plane pushes it up and back."""
    with isomortar.run(isomortar.Scene.from_toml(BESIDE), tmp_path / "run.h5") as results:
        top, floor = results.curve("force", support="top"), results.curve("force_slave", contact="floor")
        assert (floor[:, 2] > 0).all()
        assert (floor[:, 0] < 0).all()
        assert np.abs(top + floor).max() < 1e-8 * np.abs(top).max()
        moment = results.curve("moment", support="top") + np.cross(results.curve("centre", support="top"), top)
        left = moment + results.curve("moment_slave", contact="floor")
        assert np.abs(left).max() < 1e-8 * np.abs(moment).max()
        assert not results.curve("force_master", contact="floor").any()
