"""Mistakes that make wrong models, `wrong_models.toml`: each is refused, or told with what to change; none passes in silence."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from typing import TypedDict

import pytest
from told.mistakes import MISTAKES

from isomortar.errors import IsomortarError
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from test_advice import Warned


class Mistake(TypedDict):
    """What is changed in a scene, where it is noticed, and words of what is said."""

    scene: str
    set: list[str]
    said: str
    words: str


WRONG: dict[str, Mistake] = tomllib.loads(MISTAKES.read_text(encoding="utf-8"))


def refused(mistake: Mistake) -> Sequence[str]:
    """By the first look at it."""
    with pytest.raises(IsomortarError) as error:
        checked(mistake)
    return [str(error.value)]


def checked(mistake: Mistake) -> Sequence[str]:
    """Warnings of `isomortar check`, which `isomortar run` gives before the first load step."""
    return outlook(Scene.load(mistake["scene"], mistake["set"]).problem()).warnings


def computed(mistake: Mistake) -> Sequence[str]:
    """Warnings of a run, and what it stops with."""
    observer = Warned()
    try:
        list(Simulation(Scene.load(mistake["scene"], mistake["set"]).problem(), observer).run())
    except IsomortarError as error:
        observer.said.append(str(error))
    return observer.said


NOTICED = {"refused": refused, "check": checked, "run": computed}


@pytest.mark.parametrize("name", WRONG)
def test_no_wrong_model_passes_in_silence(name: str) -> None:
    mistake = WRONG[name]
    said = NOTICED[mistake["said"]](mistake)
    assert any(mistake["words"] in sentence for sentence in said), said


def test_there_are_thirty_of_kinds_that_no_other_is_of() -> None:
    """No two are noticed by the same words in the same scene."""
    kinds = {(mistake["scene"], mistake["words"]) for mistake in WRONG.values()}
    assert len(WRONG) >= 30
    assert len(kinds) >= len(WRONG) - 2, "places and units are both why a contact cannot close, and which way a plane looks"
