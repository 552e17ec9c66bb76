"""Mistakes that make wrong models: each is refused, or told of before a run, with what to change; none passes in silence."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from pathlib import Path

from isomortar.errors import IsomortarError
from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.scene import Scene

#: A scene that comes with the program, what is changed in it, where it is noticed, and words of what is said.
MISTAKES = Path(__file__).parent / "wrong_models.toml"


def told(scene: str, changes: Sequence[str]) -> tuple[str, list[str]]:
    """Where something is said first, and what: what refuses the scene, or warnings of `isomortar check`."""
    try:
        return "check", list(outlook(Scene.load(scene, changes).problem()).warnings)
    except IsomortarError as error:
        return "refused", [str(error)]


@case(
    claim="Mistakes of each kind that make a wrong model of a scene are refused, or warned of at a first look, in words that say what "
    "to change.",
    tier="gate",
    grid={"said": ("refused", "check")},
    bounds={
        "silent": Bound(0.0, 0.0, "definition: mistakes that nothing is said of, or something else, or elsewhere"),
        "mistakes": Bound(at_least=10.0, reason="definition: or nothing is tried"),
    },
    files=[MISTAKES],
)
def mistakes(said: str) -> dict[str, float]:
    """How many there are, and of how many the right thing is not said."""
    found = [mistake for mistake in tomllib.loads(MISTAKES.read_text(encoding="utf-8")).values() if mistake["said"] == said]
    heard = [(told(mistake["scene"], mistake["set"]), mistake["words"]) for mistake in found]
    silent = [words for (where, sentences), words in heard if where != said or not any(words in sentence for sentence in sentences)]
    return {"silent": float(len(silent)), "mistakes": float(len(found))}
