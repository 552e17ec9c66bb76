"""What is told of a run stays with it: its results file has every warning, and who watches nothing hears them by Python's own."""

from __future__ import annotations

import re
import tempfile
import warnings
from contextlib import suppress
from html import unescape
from pathlib import Path

import h5py
from output.heard import Hearing
from typer.testing import CliRunner

from isomortar import view
from isomortar.cli.commands import app
from isomortar.cli.info import information, lines
from isomortar.driver import run
from isomortar.errors import ConvergenceError, IsomortarWarning
from isomortar.harness import Bound, case
from isomortar.results.files import sealed
from isomortar.results.reader import Results
from isomortar.scene import Scene
from isomortar.solve.record import IterationRecord, Observer, StepResult

#: A bar of a law for small strains, far from a rough wall with kinks: warned of before a run, in its first load step, and at its end.
SCENE = """
format = 1
name = "bar"
bodies.bar.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
bodies.bar.mesh = { order = 1, elements = 2 }
bodies.bar.material = "rubber"
materials.rubber = { law = "linear-elastic", young = 1, poisson = 0.3 }
bodies.wall.geometry = { kind = "box", lower = [-2, 0, 0], upper = [-1, 1, 1] }
bodies.wall.mesh = { order = 1, elements = 2 }
contacts.wall = { slave = "bar.u0", master = "wall.u1", friction = 5 }
supports.wall.face = "wall.u0"
supports.base.face = "bar.w0"
supports.top.face = "bar.w1"
stages = [{ name = "pull", steps = 3, motions.top.translate = [0, 0, 0.3] }]
"""
#: The same, pressed through itself in the last load step, which is given up.
FOLDED = ("materials.rubber.law=neo-hookean", "stages=[{name='pull', steps=2, motions.top.translate=[0, 0, -2.1]}]")


class Stopping(Observer):
    """Ends a run, as Ctrl-C does, when a load step is on the disk."""

    def __init__(self, step: int) -> None:
        self._step = step

    def recorded(self, result: StepResult) -> None:
        """A load step."""
        if result.step == self._step:
            raise KeyboardInterrupt


def stopped_and_resumed(path: Path, step: int, from_before: bool = False) -> tuple[str, ...]:
    """The warnings of a run that was stopped after a load step; `from_before`: by a program that kept none."""
    with suppress(KeyboardInterrupt):
        run(Scene.from_toml(SCENE), path, Stopping(step))
    if from_before:
        with h5py.File(path, "a") as file:
            del file["log/warnings"]
        path.write_bytes(sealed(path.read_bytes()))
        with Results(path) as results:
            assert results.warnings == ()
    with run(Scene.from_toml(SCENE), path, Observer(), resume=True) as results:
        return results.warnings


def heard_by_python(path: Path) -> tuple[tuple[str, ...], set[str]]:
    """What a run says that nobody watches, and the files that it is said of."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", IsomortarWarning)
        run(Scene.from_toml(SCENE), path).close()
    said = [warning for warning in caught if warning.category is IsomortarWarning]
    return tuple(str(warning.message) for warning in said), {warning.filename for warning in said}


@case(
    claim="A results file holds what is told of its run, each sentence once and in order: of a whole run, of one that was stopped and "
    "resumed, of one that is given up; `isomortar info` and the page to look at tell it; a file from before holds nothing, and what is "
    "told from then on. Who runs a scene from Python and watches nothing is told by Python's warnings, with the line that runs it.",
    tier="gate",
    bounds={
        "kinds": Bound(5.0, 5.0, "definition: three before the run, one in it, one at its end, or it was not looked at"),
        "unlike": Bound(0.0, 0.0, "definition: the same sentences, where they are due"),
    },
)
def warned() -> dict[str, float]:
    """How many kinds there are, and how many accounts of them differ."""
    unlike, hearing = 0, Hearing()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with run(Scene.from_toml(SCENE), folder / "whole.h5", hearing) as results:
            kept, told = results.warnings, tuple(lines(information(results), folder / "whole.h5"))
        heard = tuple(str(event[1]) for event in hearing.told if event[0] == "warned")
        unlike += kept != heard
        page = view(folder / "whole.h5", folder / "whole.html").read_text(encoding="utf-8")
        unlike += tuple(unescape(entry) for entry in re.findall("<li>(.*?)</li>", page)) != heard
        unlike += tuple(line for line in told if line.startswith("warning: ")) != tuple(f"warning: {sentence}" for sentence in heard)
        for step in (1, 2, 3):
            again = stopped_and_resumed(folder / f"from_{step}.h5", step)
            unlike += again[: len(heard) - 1] != heard[:-1] or len(set(again)) != len(again)
        later = stopped_and_resumed(folder / "from_before.h5", 1, from_before=True)
        unlike += [sentence.partition(":")[0] for sentence in later] != ["contact 'wall'", "body 'bar', load step 2"]
        said, files = heard_by_python(folder / "alone.h5")
        unlike += said != heard or files != {__file__}
        try:
            run(Scene.from_toml(SCENE, overrides=FOLDED), folder / "given_up.h5", Observer())
        except ConvergenceError:
            with Results(folder / "given_up.h5") as results:
                unlike += not any("friction" in sentence for sentence in results.warnings)
        else:
            unlike += 1
    return {"kinds": float(len(kept)), "unlike": float(unlike)}


class StoppingIn(Observer):
    """Ends a run in a load step, as Ctrl-C does."""

    def __init__(self, step: int) -> None:
        self._step = step

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:  # noqa: ARG002
        """Of a load step."""
        if step == self._step:
            raise KeyboardInterrupt


def held(path: Path) -> tuple[str, ...]:
    """The warnings of a results file."""
    with Results(path) as results:
        return results.warnings


def by_errors(path: Path) -> tuple[int, int]:
    """Load steps of a run whose warnings Python makes errors of, and how often it had to be resumed for that."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", IsomortarWarning)
        for times in range(10):
            try:
                with run(Scene.from_toml(SCENE), path, resume=True) as results:
                    return len(results.steps), times
            except IsomortarWarning:
                continue
    return 0, 10


@case(
    claim="What is told before a load step is in the results file when that is stopped; a run that is resumed, be it whole, ends with all "
    "warnings of its file; and where Python makes errors of them, a run ends behind the load step that they are of, and can be resumed.",
    tier="gate",
    bounds={
        "lost": Bound(0.0, 0.0, "definition: sentences that were told, and are not in the file, or not told again at the end"),
        "steps": Bound(3.0, 3.0, "definition: load steps, where warnings are errors"),
        "times": Bound(3.0, 1.0, "definition: how often that is resumed: every load step can warn"),
    },
)
def stopped() -> dict[str, float]:
    """How many sentences are lost, and how far a run comes."""
    with tempfile.TemporaryDirectory() as name:
        folder, scene = Path(name), Path(name) / "bar.toml"
        scene.write_text(SCENE, encoding="utf-8")
        with run(Scene.from_toml(SCENE), folder / "whole.h5", Observer()) as results:
            kept = results.warnings
        lost = 0
        for step, due in ((1, kept[:-2]), (2, kept[:-1])):
            with suppress(KeyboardInterrupt):
                run(Scene.from_toml(SCENE), folder / f"in_{step}.h5", StoppingIn(step))
            lost += len(set(due) - set(held(folder / f"in_{step}.h5")))
        for file in ("whole.h5", "in_2.h5"):
            told = CliRunner().invoke(app, ["run", str(scene), "--resume", "--output", str(folder / file)])
            now = held(folder / file)
            lost += sum(f"warning: {sentence}" not in told.output for sentence in now) + (f"{len(now)} warnings" not in told.output)
        steps, times = by_errors(folder / "errors.h5")
        lost += len(set(kept[:-1]) - set(held(folder / "errors.h5")))  # one that is resumed does not know of all load steps
    return {"lost": float(lost), "steps": float(steps), "times": float(times)}
