"""From a scene to a results file: the whole run, each step on the disk before the next one begins."""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

from isomortar.results.reader import Results
from isomortar.results.writer import ResultsWriter
from isomortar.scene.scene import Scene
from isomortar.solve.record import AugmentationRecord, IterationRecord, Observer, StepResult
from isomortar.solve.simulation import Simulation


def run(
    scene: Scene, output: str | os.PathLike[str], observer: Observer | None = None, *, resume: bool = False, overwrite: bool = False
) -> Results:
    """Compute a scene and keep every load step in a results file.

    Parameters
    ----------
    scene : Scene
    output : path-like
        The results file, complete up to the last load step at any moment. Its folder is made if it does not exist.
    observer : Observer, optional
        Watches; of a recorded step it hears when that is on the disk.
    resume : bool
        Go on after the last load step of the file; begin where there is no file; nothing is computed where all is there.
    overwrite : bool
        Remove a file that is there, once the scene is known to be sound. Without `resume` or `overwrite` it is an error.

    Returns
    -------
    Results
        The results file, open.

    Raises
    ------
    InputError
        The scene is wrong; no file has been touched.
    ConvergenceError
        A load step could not be cut further. The steps before it are in the file.
    ResultsError
        The results file exists, is damaged, belongs to another scene, or cannot be written.
    """
    path, problem = Path(output), scene.problem()

    def open_writer() -> ResultsWriter:
        if overwrite:
            path.unlink(missing_ok=True)
        return ResultsWriter(path, problem, scene.to_toml(), version("isomortar"), scene.record.states, resume)

    last = _last_step(path) if resume and path.exists() else None
    for _ in Simulation(problem, _Recorder(open_writer, observer or Observer()), last).run():
        pass
    return Results(path)


def _last_step(path: Path) -> StepResult | None:
    with Results(path) as results:
        return results.last_step()


class _Recorder(Observer):
    """Writes each recorded step, then tells the observer. The file is opened when the simulation has accepted the problem."""

    def __init__(self, open_writer: Callable[[], ResultsWriter], observer: Observer) -> None:
        self._open_writer, self._observer = open_writer, observer

    def started(self, total_steps: int, first_step: int) -> None:
        self._writer = self._open_writer()
        self._observer.started(total_steps, first_step)

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:
        self._observer.iteration(step, time, augmentation, record)

    def augmented(self, step: int, time: float, record: AugmentationRecord) -> None:
        self._observer.augmented(step, time, record)

    def cut(self, step: int, time: float, increment: float, reason: str) -> None:
        self._observer.cut(step, time, increment, reason)

    def recorded(self, result: StepResult) -> None:
        self._writer.recorded(result)
        self._observer.recorded(result)

    def warned(self, message: str) -> None:
        self._observer.warned(message)
