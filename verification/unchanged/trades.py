"""Trades and advice come out as they did, of runs whose errors and costs are formulas: one run is computed."""

from __future__ import annotations

import json
import math
import tempfile
from collections.abc import Sequence
from contextlib import chdir
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
from unchanged.drawn import watched
from unchanged.runs import FOLDER
from unchanged.written import json_lines, page_lines

from isomortar.harness import Matches, Words, case, report
from isomortar.harness.measurement import stored
from isomortar.scene import Scene
from isomortar.trade import page, run
from isomortar.trade.advice import CheaperSearch, cheaper_dials
from isomortar.trade.knobs import dials_of
from isomortar.trade.laboratory import Choice, Laboratory, Tried
from isomortar.trade.search import Search
from isomortar.trade.want import wanted

#: A scene with friction, whose elements, orders, quadrature, load steps and ways of enforcing contact can all be changed, in a third of a
#: second; what is wanted of it is a curve, and a field.
SCENE, WANTS = "patch", ("force.top.z@drag", "pressure.floor")
#: What measures, as pages tell it: hashes, and a compiler, as on no machine.
MADE = {"program": "0" * 40, "kernel": "1" * 40, "compiler": "a compiler", "libraries": {"Python": "3"}}
#: Errors that are wanted: one that is met, and one that no run of these formulas tells.
TARGETS = (0.15, 1e-4)
_SAME = "round-off: the same numbers of the same program; words, and counts, are to be the same"
#: One cell of the face in so many is looked at, 41 of them: more tell a page nothing, and each is looked at for each forecast.
APART = 100
#: Numbers of a run that an error changes, and by which share of it, so that none is as far off as another; the rest are counts and places.
_WITH_ERRORS = {"force": 1.0, "moment": 0.9, "displacement": 0.3, "area": 0.6, "pressure": 0.8, "traction": 0.7, "gap": 0.5}


class Formulas(Laboratory):
    """Runs that are those of the scene with an error and a cost that each setting has of its own; one that fails."""

    def __init__(self, scene: Scene, dials: Sequence[Any], run: dict[str, Any]) -> None:
        super().__init__(scene, dials, Path(), None, lambda _: None)  # type: ignore[arg-type]
        self._run = run

    def _measured(self, choices: Sequence[Choice], *_: Any, **__: Any) -> dict[Choice, Tried]:
        return {choice: self._formula(choice) for choice in choices}

    def _formula(self, choice: Choice) -> Tried:
        error, cost = 0.0, 1.0
        for number, (dial, setting) in enumerate(zip(self._dials, choice, strict=True)):
            error += (0.02 + 0.01 * math.sin(number)) * 0.25**setting if dial.refines else 0.004 * math.sin(number + setting)
            cost *= (1.2 + 0.1 * math.cos(number)) ** setting if dial.refines else 1.0 + 0.3 * math.sin(number + 2 * setting)
        if not self._dials[-1].refines and choice[-1] != self.own[-1] and sum(choice) % 5 == 0:
            return Tried(choice, self.name(choice), {}, "it does not converge", cost, 2e8)
        numbers = {name: ((1.0 + share * error) * np.asarray(self._run[name], float)).tolist() for name, share in _WITH_ERRORS.items()}
        phases = [0.1 * cost * (k + 1) for k in range(5)]
        more = {"cpu_seconds": cost, "phases": phases, "warnings": {"type": "words", "text": "it pulls"}}
        return Tried(choice, self.name(choice), self._run | numbers | more, "", cost, 1e8 * cost)


@cache
def _of_the_scene() -> dict[str, Any]:
    """One run of it, as trades take them, with a few cells of its face."""
    whole = {name: stored(value) for name, value in run.traded.function(str(FOLDER / f"{SCENE}.toml")).items()}
    cells = {name: np.asarray(whole[name])[::APART].tolist() for name in ("pressure", "traction", "cells")}
    return whole | cells | {"counts": [len(cells["cells"])]}


@case(
    claim="Of runs with the same errors and costs trade and advice say, draw and write what they did.",
    grid={"kind": ("trade", "advice")},
    bounds={"page": Matches("trades", _SAME, allowance=1e-6)},
    files=(FOLDER / f"{SCENE}.toml",),
)
def trades(kind: str) -> dict[str, Words]:
    """The page, its figures, its data, and scene files that are recommended."""
    scene = Scene.load(str(FOLDER / f"{SCENE}.toml"))
    wants = [wanted(text, scene.problem()) for text in WANTS]
    dials = dials_of(scene, wants) if kind == "trade" else cheaper_dials(scene, wants)
    search = (Search if kind == "trade" else CheaperSearch)(Formulas(scene, dials, _of_the_scene()), dials, wants, 1e5)
    search.screen()
    answers = search.answers(TARGETS)
    said = [page.spoken(search, answer) for answer in answers]
    said += [f"{dial.name}: {[setting.label for setting in dial.settings]} {dial.own} {dial.spoils} {dial.part}" for dial in dials]
    with tempfile.TemporaryDirectory() as folder, chdir(folder), watched() as drawn:
        with mock.patch.object(page, "identity", dict), mock.patch.object(report, "identity", return_value=MADE):
            path = page.write(Path(), scene, search, answers, datetime(2026, 1, 2, 3, 4, tzinfo=UTC))
        said += page_lines(path.read_text(encoding="utf-8"))
        said += json_lines(json.loads(path.with_suffix(".json").read_text(encoding="utf-8")))
        said += [f"{file} {line}" for file in sorted(Path().glob("*.toml")) for line in file.read_text().splitlines()]
    return {"page": Words("\n".join([*said, *drawn]))}
