"""What docs/scene.md and docs/results.md say of scene files and results files is so, and they leave nothing out."""

from __future__ import annotations

import importlib
import re
from pathlib import Path
from typing import Any

import h5py
import pytest

import isomortar
from isomortar.results import layout
from isomortar.scene import json_schema

TOOLS = Path(__file__).parents[2] / "tools"


def page_of(tool: str, monkeypatch: pytest.MonkeyPatch) -> Any:
    """The page that a tool makes; it is up to date."""
    monkeypatch.syspath_prepend(TOOLS)
    page = importlib.import_module(tool).page
    assert page.renewed(page.path.read_text()) == page.path.read_text(), f"make it anew: python tools/{tool}.py"
    return page


def test_the_reference_of_scene_files_is_the_schema_and_its_example_is_sound(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """The example says of itself what is so: what is left out is default, and signs are those of the page."""
    text = page_of("document_scene", monkeypatch).path.read_text()
    (example,) = re.findall(r"```toml\n(.*?)```", text, re.DOTALL)
    scene = isomortar.Scene.from_toml(example, overrides={"bodies.pad.mesh.elements": [4, 4, 2]})
    with isomortar.run(scene, tmp_path / "pad.h5") as results:
        assert (results.curve("force", support="top", component="z") < 0).all()
        assert (results.curve("force_slave", contact="floor", component="z") > 0).all()
        assert results.curve("force", support="top", component="x")[-1] > 0  # it drags the pad along
        assert results.curve("friction_work", contact="floor")[-1] > 0
        step = results.last_step()
        assert step is not None
        assert step.contacts[0].gap.min() < 0 < step.contacts[0].pressure_field[1]  # where the pad has not come down
    for table in json_schema()["$defs"].values():
        assert all(entry.get("description", "") in text for entry in table["properties"].values())


def test_the_reference_of_results_files_is_what_a_file_holds(monkeypatch: pytest.MonkeyPatch) -> None:
    text = page_of("document_results", monkeypatch).path.read_text()
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
