"""What docs/results.md says of a results file is what a file holds, and it leaves nothing out that there is a quantity for."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import h5py
import pytest

import isomortar
from isomortar.results import layout

TOOL = Path(__file__).parents[2] / "tools" / "document_results.py"


def test_the_reference_of_results_files_is_what_a_file_holds() -> None:
    spec = importlib.util.spec_from_file_location("document_results", TOOL)
    assert spec
    assert spec.loader
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    text = tool.PAGE.read_text()
    assert tool.page(text) == text, "make it anew: python tools/document_results.py"
    tables = (layout.STEP, layout.REACTION, layout.CONTACT, layout.CONTACT_STATE, layout.CONTACT_VALUES, layout.RATES, layout.LOG)
    single = (layout.POSITIONS, layout.TIMING, layout.ORDERING, layout.CONTROL_POINTS, layout.WEIGHTS, layout.KNOTS, layout.STATE_STEP)
    for quantity in (*(entry for table in (*tables, layout.CONTACT_RATES) for entry in table.values()), *single):
        assert f"| {quantity.unit} | {quantity.description} |" in text


#: Tables by the group of a file that has a dataset of each of their names, with friction and rates.
GROUPS = {
    "curves": layout.STEP, "curves/supports/top": layout.REACTION, "curves/contacts/floor": layout.CONTACT,
    "states/contacts/floor": layout.CONTACT_STATE | layout.CONTACT_VALUES, "rates/contacts/floor": layout.CONTACT_RATES,
}  # fmt: skip


@pytest.fixture(scope="module")
def file_of_a_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("run") / "press.h5"
    overrides = ["bodies.block.mesh.elements=[2,2,1]", "stages.press.steps=2", "contacts.floor.friction=0.3"]
    isomortar.run(isomortar.Scene.load("press", overrides), path).close()
    return path


@pytest.mark.parametrize("group", GROUPS)
def test_rows_that_the_tables_name_are_those_of_the_data(group: str, file_of_a_run: Path) -> None:
    """They are what a file without a load step has, and what stands for tractions without friction."""
    with h5py.File(file_of_a_run) as file:
        for name, quantity in GROUPS[group].items():
            held = file[f"{group}/{name}"].shape
            assert held[len(held) - len(quantity.row) :] == quantity.row
