"""All curves of a results file as a table: every column is that of its curve."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from isomortar.results import layout
from isomortar.results.reader import Results
from isomortar.results.writer import ResultsWriter
from results_samples import problem, step_result


@pytest.fixture
def results(tmp_path: Path) -> Iterator[Results]:
    writer = ResultsWriter(tmp_path / "run.h5", problem(), "format = 1\n", "0.1")
    for number in range(1, 5):
        writer.recorded(step_result(number))
    with Results(tmp_path / "run.h5") as opened:
        yield opened


def test_every_column_is_that_of_its_curve(results: Results) -> None:
    frame = results.to_dataframe()
    assert frame.index.name == "step"
    assert list(frame.index) == [1, 2, 3, 4]
    assert list(frame["stage"]) == results.stages
    expected = {name: results.curve(name) for name in layout.STEP if name not in ("step", "stage")}
    for support in (support.name for support in problem().supports):
        for name in ("force", "moment", "centre", "displacement"):
            expected |= {f"{name}.{support}.{c}": results.curve(name, support=support, component=c) for c in "xyz"}
        expected[f"rotation.{support}"] = results.curve("rotation", support=support)
    for contact in (contact.name for contact in problem().contacts):
        for name in layout.CONTACT:
            curve = results.curve(name, contact=contact)
            if curve.ndim == 1:
                expected[f"{name}.{contact}"] = curve
            elif name == "pressure_field":
                expected |= {f"{name}.{contact}.smallest": curve[:, 0], f"{name}.{contact}.largest": curve[:, 1]}
            else:
                expected |= {f"{name}.{contact}.{c}": curve[:, i] for i, c in enumerate("xyz")}
    assert set(frame.columns) == {"stage", *expected}
    for name, curve in expected.items():
        np.testing.assert_array_equal(frame[name].to_numpy(), curve, err_msg=name)


def test_arrays_have_the_same_numbers_by_name(results: Results) -> None:
    """Every column of the table is in an array, and nothing else is."""
    data, frame = results.to_xarray(), results.to_dataframe()
    seen = []
    for name, array in data.data_vars.items():
        for place in np.ndindex(*array.shape[1:]):
            labels = {dimension: str(array[dimension].values[k]) for dimension, k in zip(array.dims[1:], place, strict=True)}
            seen.append(".".join([str(name), *labels.values()]))
            np.testing.assert_array_equal(array.sel(labels).to_numpy(), frame[seen[-1]].to_numpy(), err_msg=seen[-1])
    assert {*seen, "time", "stage"} == set(frame.columns)
    assert len(seen) == len(set(seen))
    assert list(data.step.values) == [1, 2, 3, 4]
    assert list(data.time.values) == [1.0, 2.0, 3.0, 4.0]
    assert list(data.stage.values) == results.stages
    assert data.force.dims == ("step", "support", "component")
    assert data.active.sel(contact="tread").dims == ("step",)


def test_arrays_say_what_they_are(results: Results) -> None:
    data = results.to_xarray()
    for name, quantity in (layout.REACTION | layout.CONTACT).items():
        assert data[name].attrs == {"units": quantity.unit, "long_name": quantity.description}
    assert data.attrs == {"name": "rolling", "program_version": "0.1"}


def test_what_has_no_contacts_has_no_arrays_of_them(tmp_path: Path) -> None:
    ResultsWriter(tmp_path / "alone.h5", replace(problem(), contacts=()), "", "0.1")
    with Results(tmp_path / "alone.h5") as results:
        data = results.to_xarray()
    assert set(data.dims) == {"step", "support", "component"}
    assert data.sizes["step"] == 0
    assert not set(data.data_vars) & set(layout.CONTACT)
