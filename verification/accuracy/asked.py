"""What a comparison of discretisations varies where nobody says it, and what it makes of kinds, curves and changes that are none."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from told.either_way import SCENE

from isomortar.accuracy.discretisations import Sweep, parse_kind, sweep_of
from isomortar.accuracy.measures import curve_error, reference_uncertainty, relative_error
from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.scene import Scene


def refused(function: Callable[..., Any], *arguments: Any) -> str:
    """What is said of arguments that are none; nothing, where they are taken."""
    try:
        function(*arguments)
    except InputError as error:
        return str(error)
    return ""


def named(name: str, old: str, new: str) -> Scene:
    """The blocks under the name of a bundled scene, with a name of theirs replaced."""
    return Scene.from_toml(SCENE.replace("format = 1", f'format = 1\nname = "{name}"').replace(old, new))


BLOCKS = Scene.from_toml(SCENE)
#: A scene, the body that is asked for, and what is varied.
SWEEPS: tuple[tuple[Scene, str | None, Sweep], ...] = (
    (Scene.load("press"), None, Sweep("block", "uv", "floor")),
    (Scene.load("iron"), None, Sweep("master", "u", "interface", "N5")),
    (Scene.load("iron"), "master", Sweep("master", "u", "interface", "N5")),
    (Scene.load("iron"), "slave", Sweep("slave", "uv", "interface")),
    (BLOCKS, None, Sweep("above", "uv", "c")),
    (BLOCKS, "below", Sweep("below", "uv", "c")),
    (named("press", "above", "block"), None, Sweep("block", "uv", "c")),
    (named("press", "contacts.c", "contacts.floor"), None, Sweep("above", "uv", "floor")),
)
#: Changes by two refinements, the order of theory, and the error of the finest mesh.
CHANGES = (
    (1.0, 0.5, 3.0, 0.5),
    (1.0, 0.01, 2.0, 0.01 / 3.0),
    (1.0, 0.0, 2.0, 0.0),
    (0.5, 0.5, 2.0, math.inf),
    (0.5, 1.0, 2.0, math.inf),
    (math.inf, 0.5, 2.0, math.inf),
    (math.nan, 0.5, 2.0, math.inf),
    (1.0, math.nan, 2.0, math.inf),
)
KINDS = {"N1": ("N", 1), "N10": ("N", 10), "L1": ("L", 1), "L4": ("L", 4)}


@case(
    claim="Bundled scenes are varied as the paper varies them, others with their names, and other bodies, along their first contact; one "
    "in none is refused.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes of which something else is varied")},
)
def varied() -> dict[str, float]:
    """How many."""
    wrong = sum(sweep_of(scene, body) != sweep for scene, body, sweep in SWEEPS)
    return {"wrong": float(wrong + ("bodies in contact here: above, below" not in refused(sweep_of, BLOCKS, "nobody")))}


@case(
    claim="Kinds are taken up to the orders that there are, curves that have two load times in common, and values of the shape of their "
    "reference; nothing is a share of zero, and changes that do not fall leave an error that nobody knows.",
    tier="gate",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: kinds, curves and shapes that are taken and are none, or the other way round"),
        "error": Bound(at_most=1e-14, reason="round-off: of errors of the finest mesh, as a share of them"),
    },
)
def taken() -> dict[str, float]:
    """How many, and the largest difference."""
    one, two, ones = np.ones(2), np.array([0.0, 2.0]), np.ones(3)
    wrong = sum(parse_kind(kind) != found for kind, found in KINDS.items())
    wrong += sum(not refused(parse_kind, kind) for kind in ("N0", "N11", "L0", "L5", "M2", "N2x", "N", ""))
    wrong += sum(not refused(curve_error, two, one, two + apart, one) for apart in (2.0, 3.0)) + bool(
        refused(curve_error, two, one, two + 1.0, one)
    )
    wrong += sum(not refused(relative_error, *shapes) for shapes in ((one, ones, one), (one, one, ones)))
    wrong += not math.isnan(relative_error(one, 0.0 * one, one))
    errors = [(reference_uncertainty(*changes), expected) for *changes, expected in CHANGES]
    wrong += sum(math.isinf(found) != math.isinf(expected) for found, expected in errors)
    known = [abs(found - expected) for found, expected in errors if math.isfinite(found) and math.isfinite(expected)]
    return {"wrong": float(wrong), "error": float(np.array(known).max(initial=0.0))}
