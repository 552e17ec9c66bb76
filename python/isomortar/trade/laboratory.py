"""Where a trade's runs are made: each choice of settings once, in processes of their own, kept on disk."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.harness.cases import Cell, Words
from isomortar.harness.measurement import Measurement, restored
from isomortar.harness.runner import Result, Submit, run, start
from isomortar.harness.store import Store
from isomortar.harness.study import Run
from isomortar.scene.scene import Scene
from isomortar.trade.knobs import Dial, changed
from isomortar.trade.run import traded

#: What need not be finite: numbers that are not told of every contact (a face of several has no grid, points may have no foot), and words.
UNTOLD = ("area", "gap", "warnings")
#: The number of a setting, by dial.
Choice = tuple[int, ...]


@frozen
class Tried:
    """What became of a choice: its numbers, or why there are none; CPU seconds that it took, and memory in bytes."""

    choice: Choice
    name: str
    numbers: dict[str, Any]
    failure: str
    seconds: float
    memory: float

    @property
    def cost(self) -> float:
        """CPU seconds of the computation, or until it failed."""
        return self.seconds if self.failure else float(self.numbers["cpu_seconds"])

    @property
    def warnings(self) -> list[str]:
        """What the run warned of."""
        said = restored(self.numbers.get("warnings"), Words)
        return said.text.splitlines() if said else []


class Laboratory:
    """Runs choices of settings of a scene.

    Parameters
    ----------
    scene : Scene
    dials : sequence of Dial
    folder : Path
        Of scene files and measurements; what is there is not run again.
    submit : callable
        Starts a measurement (`isomortar.harness.runner.local_processes`).
    tell : callable
        Told of every outcome as it comes.

    Attributes
    ----------
    outcomes : dict of Choice to Tried
        All that was run, in the order in which it was asked for.
    """

    def __init__(self, scene: Scene, dials: Sequence[Dial], folder: Path, submit: Submit, tell: Callable[[Tried], None]) -> None:
        self._scene, self._dials, self._folder, self._submit, self._tell = scene, tuple(dials), folder, submit, tell
        self.outcomes: dict[Choice, Tried] = {}

    @property
    def own(self) -> Choice:
        """The scene's own settings."""
        return tuple(dial.own for dial in self._dials)

    @property
    def spent(self) -> float:
        """CPU seconds of all that was run, whenever that was."""
        return sum(outcome.cost for outcome in self.outcomes.values())

    def name(self, choice: Choice) -> str:
        """What is not the scene's own, in words."""
        return ", ".join(self.changes(choice)) or "as it is"

    def changes(self, choice: Choice) -> list[str]:
        """What is not the scene's own, an entry a dial."""
        return [f"{dial.name}: {dial.settings[n].label}" for dial, n in zip(self._dials, choice, strict=True) if n != dial.own]

    def scene(self, choice: Choice) -> Scene:
        """The scene with the settings of a choice."""
        return changed(self._scene, [dial.settings[n] for dial, n in zip(self._dials, choice, strict=True)])

    def overrides(self, choice: Choice) -> list[str]:
        """The overrides that give the scene the settings of a choice; later ones go on from earlier ones."""
        scene = self._scene
        found: dict[str, str] = {}
        for dial, number in zip(self._dials, choice, strict=True):
            setting = dial.settings[number]
            if setting.overrides:
                found |= dict(override.split("=", 1) for override in setting.overrides(scene))
                scene = changed(scene, [setting])
        return [f"{key}={value}" for key, value in found.items()]

    def run(self, choices: Sequence[Choice]) -> list[Tried]:
        """Run what was not run yet, at the same time where there are processes for it."""
        missing = [choice for choice in dict.fromkeys(choices) if choice not in self.outcomes]
        found = self._measured(missing, Store(self._folder / "cells"))
        self.outcomes |= {choice: found[choice] for choice in missing}
        return [self.outcomes[choice] for choice in choices]

    def run_afresh(self, choice: Choice) -> Tried:
        """Run a choice again. What was measured before stays, and what the search made of it: it comes to the same answer again."""
        return self._measured([choice], Store(self._folder / "afresh"), fresh=True)[choice]

    def _measured(self, choices: Sequence[Choice], store: Store, fresh: bool = False) -> dict[Choice, Tried]:
        """What became of some choices, in any order."""
        cells: dict[str, Cell] = {}
        by_name: dict[str, Choice] = {}
        found: dict[Choice, Tried] = {}
        for choice in choices:
            try:
                scene = self.scene(choice)
                scene.problem()
            except InputError as error:
                found[choice] = Tried(choice, self.name(choice), {}, f"refused: {error}", 0.0, 0.0)
                continue
            name = f"{self._scene.name}-{'-'.join(map(str, choice))}"
            cells[name] = Run(name, scene, traded).cell(self._folder / "scenes")
            by_name[cells[name].name] = choice

        def made(result: Result) -> None:
            choice = by_name[result.cell.name]
            found[choice] = self._tried(choice, result.measurement)
            self._tell(found[choice])

        run(start(list(cells.values()), store, self._submit, fresh), lambda *_: None, store, made)
        return found

    def _tried(self, choice: Choice, measurement: Measurement) -> Tried:
        broken = [n for n, v in measurement.numbers.items() if n not in UNTOLD and not np.isfinite(np.asarray(v, float)).all()]
        failure = "" if measurement.ending == "measured" else measurement.reason
        failure = failure or (f"not finite: {', '.join(broken)}" if broken else "")
        return Tried(choice, self.name(choice), measurement.numbers, failure, measurement.cpu_seconds, measurement.peak_memory)
