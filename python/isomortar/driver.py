"""From a scene to a results file: the whole run, its steps on the disk as they come."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from types import NoneType

from isomortar._arguments import kind
from isomortar.errors import InputError, IsomortarWarning, ResultsError
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.results.files import claimed, is_marked
from isomortar.results.reader import Results
from isomortar.results.writer import ResultsWriter, goes_on_longer
from isomortar.scene.scene import Scene
from isomortar.solve.record import AugmentationRecord, IterationRecord, Observer, StepResult


def run(
    scene: Scene | str | os.PathLike[str],
    output: str | os.PathLike[str] | None = None,
    observer: Observer | None = None,
    *,
    resume: bool = False,
    overwrite: bool = False,
) -> Results:
    """Compute a scene and keep every load step in a results file.

    Parameters
    ----------
    scene : Scene, str or path-like
        A scene, the name of a bundled one, or the path of a scene file.
    output : path-like, optional
        The results file, complete up to the last load step at any moment; default ``results/NAME.h5``. Its folder is made if it does not
        exist.
    observer : Observer, optional
        Watches; of a recorded step it hears when that is on the disk, but where writing takes long. Without one what is doubtful becomes
        Python's own warnings, of the category `IsomortarWarning`.
    resume : bool
        Go on after the last load step of the file; begin where there is no file; nothing is computed where all is there.
    overwrite : bool
        Begin anew in the place of a results file that is there, once the scene is known to be sound. Without `resume` or `overwrite`
        it is an error, unless it holds no load step yet.

    Returns
    -------
    Results
        The results file, open.

    Raises
    ------
    InputError
        The scene is wrong, or none; the observer is none; or the results file exists. No file has been touched.
    ConvergenceError
        A load step could not be cut further. The steps before it are in the file.
    ResultsError
        Another run is writing the results file; or what is there is damaged, no results file, belongs to another scene, or cannot be
        written.
    """
    kind("scene", scene, Scene, str, os.PathLike)
    kind("output", output, str, os.PathLike, NoneType)
    kind("observer", observer, Observer, NoneType)
    chosen = scene if isinstance(scene, Scene) else Scene.load(os.fspath(scene))
    return compute(chosen, chosen.problem(), Path(output or results_path(chosen)), observer or _Aloud(), resume, overwrite)


def results_path(scene: Scene) -> Path:
    """The results file of a scene where nobody names another."""
    return Path("results") / f"{scene.name}.h5"


def compute(scene: Scene, problem: Problem, path: Path, observer: Observer, resume: bool, overwrite: bool) -> Results:
    """The same as `run`, where the scene's problem is known already."""
    with claimed(path):
        last = _last_step(path, problem, resume, overwrite)

        def open_writer() -> ResultsWriter:
            return ResultsWriter(path, problem, scene.to_toml(), version("isomortar"), scene.record.states, resume, not resume)

        recorder, steps = _Recorder(open_writer, observer), 0
        try:
            for _ in Simulation(problem, recorder, last).run():
                steps += 1
        except BaseException:
            recorder.keep()
            raise
        if steps:  # where all was there the file stays as it is
            recorder.keep()
            recorder.complain()
    return Results(path)


def _last_step(path: Path, problem: Problem, resume: bool, overwrite: bool) -> StepResult | None:
    """Where to go on, of the same problem; nothing is there, or may go, where the answer is None."""
    if path.is_symlink():
        raise ResultsError(f"{path} is a symbolic link: name the file that it leads to")
    if not path.exists():
        return None
    if not path.is_file():
        raise ResultsError(f"{path} is no ordinary file, but a folder or a device: name another results file")
    if not is_marked(path):
        kept = (
            "cannot be resumed: name the one to go on with, or leave --resume out" if resume else "is not overwritten: remove it yourself"
        )
        raise ResultsError(f"{path} is no results file of isomortar, so it {kept}, or name another file with --output")
    if overwrite:
        return None
    with Results(path) as results:
        last = results.last_step()
        if last and resume:
            goes_on_longer(results, problem)
    if last and not resume:
        raise InputError(f"{path} exists already: go on with --resume, begin anew with --overwrite, or name another file with --output")
    return last


class _Recorder(Observer):
    """Writes each recorded step, then tells the observer. The file is opened when the simulation has accepted the problem.

    A warning that Python is to make an error of is raised when its load step is on the disk, so that a run can go on behind it.
    """

    def __init__(self, open_writer: Callable[[], ResultsWriter], observer: Observer) -> None:
        self._open_writer, self._observer = open_writer, observer
        self._complaint: IsomortarWarning | None = None
        self._begun = False

    def started(self, total_steps: int, first_step: int) -> None:
        self._writer, self._begun = self._open_writer(), True
        self._observer.started(total_steps, first_step)

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:
        self._writer.keep_up()  # load steps may take long, and be stopped
        self._observer.iteration(step, time, augmentation, record)

    def augmented(self, step: int, time: float, record: AugmentationRecord) -> None:
        self._observer.augmented(step, time, record)

    def cut(self, step: int, time: float, increment: float, reason: str) -> None:
        self._observer.cut(step, time, increment, reason)

    def recorded(self, result: StepResult) -> None:
        self._writer.recorded(result)
        self._observer.recorded(result)
        self.complain()

    def warned(self, message: str) -> None:
        self._writer.warned(message)
        try:
            self._observer.warned(message)
        except IsomortarWarning as complaint:
            self._complaint = self._complaint or complaint

    def keep(self) -> None:
        """Have all on the disk that was told, of a run that has begun."""
        if self._begun:
            self._writer.keep()

    def complain(self) -> None:
        """Raise what a warning was made an error of."""
        if self._complaint is not None:
            raise self._complaint


class _Aloud(Observer):
    """Says what is doubtful by Python's own warnings, with the line that runs the scene."""

    def warned(self, message: str) -> None:
        frame, depth = sys._getframe(), 1
        while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == __package__:
            frame, depth = frame.f_back, depth + 1
        warnings.warn(message, IsomortarWarning, stacklevel=depth)
