"""Values of another kind than a key takes: what is said of each is the field's and TOML's, and names the key as the scene has it."""

from __future__ import annotations

import re
from typing import Any

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.scene.keys import settable_keys

#: One of each kind that TOML has but for times, and lists of them.
VALUES: tuple[Any, ...] = ("3", "true", "x", 3, 2.5, True, [], [1], ["3", "3", "3"], [True] * 3, {}, {"a": 1}, [[1]])
#: Words of the library that reads scenes, and of Python.
FOREIGN = re.compile(r"valid|[Ii]nput|integer|string|boolean|None|dict|tuple|instance|^\S*[{}]")
#: What is allowed where a text is wrong by its quotes alone.
UNQUOTED = {"3": re.compile("allowed: a (whole )?number"), "true": re.compile("allowed: true or false")}


def refused(scene: str, path: str, value: Any) -> list[str]:
    """What is said of a value, if it is refused."""
    try:
        Scene.load(scene, {path: value})
    except InputError as error:
        return str(error).splitlines()
    return []


@case(
    claim="Values of another kind than a key of a scene takes are refused by that key in the words of TOML: numbers, whole ones, texts in "
    "quotes, true or false; where quotes alone are wrong, by these.",
    tier="gate",
    grid={"scene": ("iron", "tire", "press")},
    bounds={
        "foreign": Bound(0.0, 0.0, "definition: sentences with words of the library that reads scenes, or without a key"),
        "quotes": Bound(0.0, 0.0, "definition: quotes that nothing is said of"),
        "refused": Bound(at_least=100.0, reason="definition: or nothing is tried"),
    },
)
def kinds(scene: str) -> dict[str, float]:
    """How many sentences there are of each, over all keys."""
    said = [(value, sentence) for path, _ in settable_keys(scene) for value in VALUES for sentence in refused(scene, path, value)]
    quoted = [sentence for value, sentence in said if isinstance(value, str) and value in UNQUOTED and UNQUOTED[value].search(sentence)]
    return {
        "foreign": float(sum(bool(FOREIGN.search(sentence)) or ": " not in sentence for _, sentence in said)),
        "quotes": float(sum(not sentence.endswith("without quotes") for sentence in quoted)),
        "refused": float(len(said)),
    }
