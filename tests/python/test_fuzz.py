"""What the fuzz makes of how the program ends."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import pytest
from forked import program
from fuzz import scenes, twins
from fuzz.base_scenes import TEXTS
from fuzz.child import Wrong, ending_of, tried

from isomortar import Scene
from isomortar.scene.schema import SceneTable


@pytest.mark.parametrize(("code", "kind"), [(0, "right"), (1, "stopped"), (2, "refused")])
def test_a_sentence_is_an_ending(code: int, kind: str) -> None:
    assert ending_of(code, "isomortar: that is so\n" if code else "").kind == kind


@pytest.mark.parametrize("code", [1, 2, 3, 130, -11])
def test_other_words_are_wrong(code: int) -> None:
    with pytest.raises(Wrong):
        ending_of(code, "isomortar: one\nisomortar: two\n")


def test_a_fault_of_the_program_is_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    """It never shows as a traceback: the command line makes a sentence of it."""
    monkeypatch.setattr(Scene, "load", lambda *_: {}["no such key"])
    ending = tried(lambda folder: ending_of(*program("run", "press", "--output", str(Path(folder) / "o.h5"), folder=folder)))
    assert ending.kind == "wrong"
    assert "a fault of the program" in ending.said
    assert "no such key" in ending.said


@pytest.mark.parametrize("text", TEXTS, ids=[tomllib.loads(text)["name"] for text in TEXTS])
@pytest.mark.parametrize("number", [0, 1, 2, 3], ids=["units", "order", "never-kept", "other-method"])
def test_scenes_that_are_changed_are_right_unchanged(text: str, number: int, tmp_path: Path) -> None:
    assert scenes.judged(text.encode(), number, tmp_path).kind == "right"


def test_the_unit_of_every_number_of_a_scene_is_known() -> None:
    """A key that is new stays as it is in other units, so its scene is another one there: that took fuzzed plates for faults."""
    scaled = {*twins.LENGTHS, *twins.STRESSES, *twins.LOADS, "young", "moment", "symmetry"}
    schema = SceneTable.model_json_schema()
    tables = [*schema["$defs"].values(), schema]
    keys = {key for table in tables for key, field in table.get("properties", {}).items() if _is_real(field)}
    assert keys <= scaled | twins.PURE
    assert keys >= twins.PURE
    assert not scaled & twins.PURE


def _is_real(field: Any) -> bool:
    parts = [part for key in ("anyOf", "prefixItems") for part in field.get(key, ())]
    parts += [field[key] for key in ("items", "additionalProperties") if isinstance(field.get(key), dict)]
    return field.get("type") == "number" or any(map(_is_real, parts))
