"""Which figures are drawn of a results file, of which load step and field, into which files; what a film shows, how fast."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

from matplotlib.figure import Figure
from output.records import SCENE, load_steps, recorded
from PIL import Image

from isomortar import film, plot
from isomortar.harness import Bound, case
from isomortar.results import film as films
from isomortar.results import pictures
from isomortar.scene import Scene

#: Of the scene's supports two move, one by a motion and one by a force.
MOVING = ("ground", "push")
CONTACTS = ("under", "over")
DRAG = SimpleNamespace(name="drag", support="ground", quantity="force", component="x")
#: What is asked for, and the figures that are drawn of which load step: names of files without a type.
_REACTIONS = {f"reactions-{name}": 0 for name in MOVING}
ASKED: tuple[tuple[dict[str, Any], dict[str, int]], ...] = (
    ({}, {**_REACTIONS, **{f"{kind}-{name}": 5 for kind in ("bodies", "pressure") for name in CONTACTS}}),
    ({"curves": [DRAG], "only": ["curves"], "step": 3}, {**_REACTIONS, "curve-drag": 0}),
    ({"fields": ["stress", "gap"], "step": 2}, {**_REACTIONS, "bodies-stress": 2, **{f"gap-{name}": 2 for name in CONTACTS}}),
    ({"fields": ["slip", "J"], "only": ["maps"], "formats": ["svg"]}, {f"slip-{name}": 5 for name in CONTACTS}),
    ({"fields": ["traction", "pressure"], "only": ["bodies"], "step": 1}, {f"bodies-{name}": 1 for name in CONTACTS}),
)
#: One load step in so many, and which of five are shown.
SHOWN = {1: (1, 2, 3, 4, 5), 2: (1, 3, 5), 3: (2, 5), 7: (5,)}


class Drawn:
    """Stands for what draws: notes the load step, the contact and the field, and draws nothing."""

    def __init__(self) -> None:
        self.steps: list[int] = []

    def curves(self, *_: object) -> Figure:
        """Curves, which are of all load steps."""
        return self._figure(0)

    def bodies(self, _problem: object, step: Any, *_: object) -> Figure:
        """Bodies of a load step."""
        return self._figure(step.step)

    def maps(self, _problem: object, step: Any, field: Any) -> Figure:
        """A map of a load step, of a field that knows the one before it."""
        before = field[4].step if field[4] else 0
        return self._figure(step.step if field[1] is step and before == step.step - 1 else -1)

    def _figure(self, step: int) -> Figure:
        self.steps.append(step)
        return Figure(figsize=(1, 1))


def files(names: dict[str, int], formats: Sequence[str]) -> list[str]:
    """Files of figures, in any order: pictures of bodies are PNG, whatever is asked for."""
    return sorted(f"{name}.{kind}" for name in names for kind in (("png",) if name.startswith("bodies") else formats or ("png", "pdf")))


@case(
    claim="Figures are those that are asked for, of the load step that is, in the types of files that are; where nothing is said, curves "
    "of all supports that move, and of the last load step bodies and maps by pressure. Films show one load step in so many, and the last.",
    tier="gate",
    bounds={
        "files": Bound(0.0, 0.0, "definition: calls that write other files than are asked for, or say so"),
        "steps": Bound(0.0, 0.0, "definition: calls that draw other load steps"),
        "films": Bound(0.0, 0.0, "definition: films of other load steps, of another contact, its scale or another rate"),
    },
)
def chosen() -> dict[str, float]:
    """How many are wrong; what draws is stood in for, and draws nothing."""
    problem = Scene.from_toml(SCENE).problem()
    found = {"files": 0.0, "steps": 0.0, "films": 0.0}
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder) / "run.h5"
        recorded(run, problem, load_steps(problem), "every")
        for number, (asked, names) in enumerate(ASKED):
            drawn, out = Drawn(), Path(folder) / str(number)
            stand_ins: dict[str, Any] = {
                "draw_reactions": drawn.curves,
                "draw_curve": drawn.curves,
                "draw_bodies": drawn.bodies,
                "draw_coloured": drawn.bodies,
            }
            with patch.multiple(pictures, **stand_ins, draw_map=drawn.maps, face_field=lambda *given: given):
                paths = plot(run, out, **asked)
            expected = files(names, asked.get("formats", ()))
            found["files"] += sorted(path.name for path in paths) != expected or sorted(path.name for path in out.iterdir()) != expected
            found["steps"] += sorted(drawn.steps) != sorted(names.values())
        found["films"] = float(sum(_wrong_film(run, every, steps) for every, steps in SHOWN.items()))
    return found


def _wrong_film(run: Path, every: int, steps: tuple[int, ...]) -> bool:
    """Whether a film of the second contact, eight pictures a second, is another one."""
    seen: list[tuple[int, int, object]] = []
    scales: list[tuple[int, list[int]]] = []

    def draw(_problem: object, step: Any, number: int, common: object) -> Figure:
        seen.append((step.step, number, common))
        figure = Figure(figsize=(0.2, 0.2))
        figure.add_subplot().plot([0, len(seen)])  # pictures that are the same are one
        figure.set_facecolor((0.1 * len(seen), 0.5, 0.5))
        return figure

    def scale(_problem: object, of: Any, number: int) -> str:
        scales.append((number, [step.step for step in of]))
        return "of all"

    path = run.with_name(f"{every}.gif")
    with patch.multiple(films, draw_bodies=draw, common_scale=scale):
        film(run, path, contact=CONTACTS[1], every=every)
    with Image.open(path) as moving:
        frames, pause = getattr(moving, "n_frames", 1), moving.info.get("duration", 120 if len(steps) == 1 else 0)
    right = seen == [(step, 1, "of all") for step in steps] and scales == [(1, list(steps))]
    return not (right and frames == len(steps) and abs(pause - 125) <= 5)
