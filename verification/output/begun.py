"""How a run treats its results file: begun, gone on with, begun anew, refused; and what happens to files where the system refuses."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from isomortar import Observer, Results, run
from isomortar.errors import InputError, IsomortarError, ResultsError
from isomortar.harness import Bound, case
from isomortar.results.comparison import differences
from isomortar.results.files import claimed, replace, write_whole, writing
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

SCENE = """
format = 1
name = "bar"
bodies.bar = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1, elements = 1 } }
supports = { left.face = "bar.u0", right.face = "bar.u1" }
stages = [{ name = "pull", steps = 3, motions.right.translate = [0.03, 0, 0] }]
record.states = "STATES"
"""


class Stopping(Observer):
    """Ends a run after a load step; what the file held then, and what was told."""

    def __init__(self, path: Path, after: int) -> None:
        self._path, self._after = path, after
        self.first, self.held = 0, []  # type: ignore[var-annotated]

    def started(self, total_steps: int, first_step: int) -> None:
        """Where the run begins."""
        self.first = first_step if total_steps == 3 else -1

    def recorded(self, result: StepResult) -> None:
        """A load step that has to be in the file."""
        with Results(self._path) as results:
            self.held.append(int(results.steps[-1]) == result.step)
        if result.step == self._after:
            raise KeyboardInterrupt


def refused(action: Callable[[], object], kind: type[IsomortarError], words: str) -> bool:
    """Whether something is refused in these words, as that kind of error."""
    try:
        action()
    except IsomortarError as error:
        return isinstance(error, kind) and words in str(error)
    return False


@case(
    claim="A load step is in the file when it is told of. A file with load steps is an error, gone on with after the last one, or begun "
    "anew, as is asked for, or for longer; the end is the same. What is no results file, or held by another run, stays as it is.",
    tier="gate",
    grid={"states": ("every", "last")},
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: runs that begin elsewhere, files that are touched or are not, and should be, or should not"),
        "apart": Bound(at_most=0.0, reason="theory: the same numbers, to the last bit"),
    },
)
def begun(states: str) -> dict[str, float]:
    """How many are wrong; differences of positions and forces of a run that was stopped from one that was not."""
    scene = Scene.from_toml(SCENE.replace("STATES", states))
    with tempfile.TemporaryDirectory() as folder:
        whole, path, other = (Path(folder) / name for name in ("whole.h5", "below/run.h5", "notes.txt"))
        run(scene, whole).close()
        first = Stopping(path, 2)
        with contextlib.suppress(KeyboardInterrupt):
            run(scene, path, first)
        stopped = path.read_bytes()
        wrong = int(first.first != 1 or first.held != [True] * 2)
        wrong += not refused(lambda: run(scene, path), InputError, "exists already") or path.read_bytes() != stopped
        for content in ("notes", ""):
            other.write_text(content, encoding="utf-8")
            for option, words in {"resume": "cannot be resumed", "overwrite": "is not overwritten"}.items():
                said = f"notes.txt is no results file of isomortar, so it {words}"
                wrong += not refused(lambda option=option: run(scene, other, **{option: True}), ResultsError, said)  # type: ignore[arg-type, misc]
            wrong += not refused(lambda: run(scene, other), ResultsError, "notes.txt is no results file")
            wrong += other.read_text(encoding="utf-8") != content
        with claimed(path):
            wrong += not refused(lambda: run(scene, path, resume=True), ResultsError, "another run is writing")
        wrong += path.read_bytes() != stopped
        second = Stopping(path, 9)
        run(scene, path, second, resume=True).close()
        wrong += second.first != 3 or second.held != [True]
        with Results(whole) as one, Results(path) as two:
            apart = [np.abs(one.curve("force", support="right") - two.curve("force", support="right")).max()]
            apart.append(np.abs(one.step(3).state.positions - two.step(3).state.positions).max())
            kept = [1, 2, 3] if states == "every" else [3]
            wrong += list(two.kept_states) != kept or list(two.steps) != [1, 2, 3]
        longer = Scene.from_toml(SCENE.replace("STATES", states).replace("steps = 3", "steps = 5").replace("0.03", "0.05"))
        run(longer, path, resume=True).close()
        with Results(path) as results:
            wrong += bool(differences(results.problem, longer.problem()))
            wrong += results.problem.total_steps != 5 or results.scene_text != longer.to_toml() or list(results.steps) != [1, 2, 3, 4, 5]
        again = Stopping(path, 1)
        with contextlib.suppress(KeyboardInterrupt):
            run(scene, path, again, overwrite=True)
        with Results(path) as results:
            wrong += again.first != 1 or list(results.steps) != [1]
        wrong += sorted(entry.name for entry in path.parent.iterdir()) != ["run.h5"]
    return {"wrong": float(wrong), "apart": float(np.max(apart))}


@case(
    claim="Where the system refuses to write, what was there before stays, what was begun anew is taken away, and it is said where.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: files that are lost or left over, and errors without the name of the file")},
)
def system_refuses() -> dict[str, float]:
    """How many."""

    def fail(path: Path) -> None:
        with writing(path) as fresh:
            fresh.write_text("half", encoding="utf-8")
            raise OSError(28, "No space left on device")

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        old, new, place = folder / "old.svg", folder / "new.svg", folder / "place.h5"
        old.write_text("whole", encoding="utf-8")
        place.mkdir()
        wrong = int(not refused(lambda: fail(old), ResultsError, "old.svg cannot be written: No space"))
        wrong += old.read_text(encoding="utf-8") != "whole"
        wrong += not refused(lambda: fail(new), ResultsError, "new.svg cannot be written: No space") or new.exists()
        wrong += not refused(lambda: replace(place, b"content"), ResultsError, "place.h5 cannot be written")
        wrong += not refused(lambda: replace(old / "below.h5", b"content"), ResultsError, "old.svg is a file, and no folder")
        wrong += not refused(lambda: write_whole(place, "content"), ResultsError, "place.h5 cannot be written")
        wrong += not refused(lambda: write_whole(old / "below" / "page.html", ""), ResultsError, "old.svg is a file, and no folder")
        replace(new, b"one")
        replace(new, b"two")
        wrong += new.read_bytes() != b"two" or sorted(entry.name for entry in folder.iterdir()) != ["new.svg", "old.svg", "place.h5"]
    return {"wrong": float(wrong)}
