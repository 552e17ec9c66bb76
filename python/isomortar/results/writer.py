"""Writes a results file while the computation runs; a kill at any moment leaves the last completed step readable."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from time import monotonic
from typing import Literal

import h5py
import numpy as np

from isomortar.errors import ResultsError
from isomortar.model.entities import Contact, Problem
from isomortar.results import layout
from isomortar.results.comparison import differences, is_longer
from isomortar.results.datasets import Datasets
from isomortar.results.definition import write_problem, write_stages
from isomortar.results.files import SEAL_SIZE, read, replace, seal
from isomortar.results.reader import Results
from isomortar.solve.record import AugmentationRecord, ContactRates, Observer, Rates, State, StepResult

#: Seconds that writing a file may take at every load step, and how many times as long as it took before it is written again, if it takes
#: longer: of thousands of quick steps most of the time would go into writing the same again.
BRIEF, REST = 0.05, 10.0
#: HDF5 1.10's format: its metadata carry checksums (the data get theirs from the filter), so damage is seen, not read.
LIBVER = ("v110", "v110")


def goes_on_longer(stored: Results, problem: Problem) -> bool:
    """Whether a problem goes on where that of results ends; it may be the same.

    Raises
    ------
    ResultsError
        It is another one, which results of this one cannot be resumed with.
    """
    unlike = differences(stored.problem, problem)
    if not unlike or is_longer(stored.problem, problem):
        return bool(unlike)
    further = ", ".join(stage.name for stage in stored.problem.stages[len(problem.stages) :])
    if further and is_longer(problem, stored.problem):
        raise ResultsError(
            f"{stored.path} has stages that the scene does not have: {further}. Give them to resume it, as by the same --steps, or "
            "name another results file"
        )
    more = f"; and {len(unlike) - 5} more" if len(unlike) > 5 else ""
    raise ResultsError(
        f"{stored.path} belongs to another scene, so it cannot be resumed with this one: {'; '.join(unlike[:5])}{more}. "
        "Undo these changes, or name another results file; the last stage may be longer at the same rate, and stages may be added "
        "at the end"
    )


class ResultsWriter(Observer):
    """Observer that keeps a results file complete up to the last recorded step.

    HDF5 has no transactions: a file killed while it is written may be lost as a whole; and where the disk is full, it ends the
    process. So the file is held in memory; with each step it is sealed, written beside the file, flushed to the disk, and then
    takes the file's name, which is atomic: the name always stands for a complete file. The price is the file's size in memory, and one
    copy of it a step. For 100 steps of 1000 control points that is 8 MB at the end and some 20 ms a step, far below the cost of computing
    it; where it is not, several steps are written at once, so that writing takes a tenth of the time at most: of a file that takes a
    second to write a kill loses up to ten, an interrupt or an error nothing, as both `keep` what is there.

    Parameters
    ----------
    path : path-like
        The file. Its directory is made if it does not exist.
    problem : Problem
        What is computed.
    scene_text : str
        Text of the scene file, stored as it is.
    version : str
        Version of the program.
    states : {"every", "last"}
        Keep the full state of every step, or of the newest only. Curves and log keep every step.
    resume : bool
        Append to an existing file (or begin one if there is none). The problem's last stage may be longer than in the file, at the same
        rate, and it may have stages more at its end.
    overwrite : bool
        Begin anew in the place of an existing file. Without `resume` and `overwrite` the file must not exist yet.

    Raises
    ------
    ResultsError
        The file exists already, is damaged, belongs to another scene, or cannot be written.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        problem: Problem,
        scene_text: str,
        version: str,
        states: Literal["every", "last"] = "every",
        resume: bool = False,
        overwrite: bool = False,
    ) -> None:
        self.path = Path(path)
        self._problem = problem
        self._states = states
        self._longer: str | None = None
        self._resumed, self._last = False, 0
        self._unstored, self._stored, self._took = False, monotonic(), 0.0
        if overwrite or not self.path.exists():
            self._hold(h5py.File.in_memory(libver=LIBVER))
            self._begin(scene_text, version)
            self._store()
        elif resume:
            with Results(self.path) as stored:
                self._longer = scene_text if goes_on_longer(stored, problem) else None
                self._resumed, self._last = True, max(stored.steps, default=0)
            self._hold(h5py.File.in_memory(read(self.path)[SEAL_SIZE:], libver=LIBVER))
        else:
            raise ResultsError(f"{self.path} exists already: resume it, overwrite it, or name another results file")

    def warned(self, message: str) -> None:
        """Append the warning, if it is not there yet; it is on the disk with the next load step, or by `keep_up` or `keep`."""
        if "warnings" not in self._file["log"]:
            self._datasets.make("log", {"warnings": layout.LOG["warnings"]})
        if message.encode() not in self._file["log/warnings"][()]:
            self._datasets.extend("log/warnings", [message])
            self._unstored = True

    def recorded(self, result: StepResult) -> None:
        """Append the step; on return it is on the disk, or will be soon where writing takes long."""
        self._unstored = False  # an interrupt on the way leaves a part of a step, which is not to be kept
        if self._resumed:
            self._lengthen()
            self._renew()
            self._resumed = False
        self._append(result)
        self._unstored, self._last = True, result.step
        self.keep_up()

    def keep_up(self) -> None:
        """Put on the disk what was told since it was written last, if writing takes next to nothing, or was long ago."""
        if self._took <= BRIEF or monotonic() - self._stored >= REST * self._took:
            self.keep()

    def keep(self) -> None:
        """Put on the disk what was told since it was written last."""
        if self._unstored:
            self._store()

    def _hold(self, file: h5py.File) -> None:
        self._file, self._datasets = file, Datasets(file)

    def _store(self) -> None:
        """Put the file as it is in memory in the place of that on the disk."""
        begun = monotonic()
        self._file.flush()
        image = self._file.id.get_file_image()
        try:
            replace(self.path, seal(image), image)
        except ResultsError as error:
            raise ResultsError(f"{error}{_still_in(self.path)}") from error
        self._unstored, self._stored = False, monotonic()
        self._took = self._stored - begun

    def _begin(self, scene_text: str, version: str) -> None:
        file, make = self._file, self._datasets.make
        file.attrs["format"] = layout.FORMAT
        file.attrs["format_version"] = layout.FORMAT_VERSION
        file.attrs["program_version"] = version
        _put_scene(file, scene_text)
        write_problem(file.create_group("problem"), self._problem)
        make("curves", layout.STEP)
        for support in self._problem.supports:
            make(f"curves/supports/{support.name}", layout.REACTION)
        for contact in self._problem.contacts:
            make(f"curves/contacts/{contact.name}", layout.CONTACT)
        for load in self._problem.loads:
            make(f"curves/loads/{load.name}", layout.LOAD)
        make("log", layout.LOG)
        make("states", {"step": layout.STATE_STEP})
        for group in ("timings", "counters", "orderings"):
            file.create_group(group)

    def _lengthen(self) -> None:
        """Put a scene that goes on for longer in the place of the file's own."""
        if self._longer is None:
            return
        del self._file["scene"]
        _put_scene(self._file, self._longer)
        write_stages(self._file["problem"], self._problem)
        self._longer = None

    def _renew(self) -> None:
        """Put what a file of an earlier format holds into the present one, for what is appended to it."""
        version = layout.version_of(self._file)
        if version == layout.FORMAT_VERSION:
            return
        for contact in self._problem.contacts:
            for name, quantity in layout.CONTACT.items():
                if quantity.turned:
                    dataset = self._file[f"curves/contacts/{contact.name}/{name}"]
                    dataset[...] = quantity.signed(dataset[()], version)
                    dataset.attrs["description"] = quantity.description
        self._file.attrs["format_version"] = layout.FORMAT_VERSION

    def _append(self, result: StepResult) -> None:
        datasets = self._datasets
        row = datasets.rows("curves/step")
        if result.step <= self._last:
            raise ResultsError(
                f"{self.path} holds load step {result.step} already: resume from its last step, or name another results file"
            )
        datasets.put("curves", layout.STEP, result, row)
        for support, reaction in zip(self._problem.supports, result.reactions, strict=True):
            datasets.put(f"curves/supports/{support.name}", layout.REACTION, reaction, row)
        for contact, measured in zip(self._problem.contacts, result.contacts, strict=True):
            datasets.put(f"curves/contacts/{contact.name}", layout.CONTACT, measured, row)
        for load, acting in zip(self._problem.loads, result.loads, strict=True):
            datasets.put(f"curves/loads/{load.name}", layout.LOAD, acting, row)
        datasets.put_named("timings", layout.TIMING, result.timings, row)
        datasets.put_named("counters", layout.COUNTER, result.counters, row)
        datasets.put_named("orderings", layout.ORDERING, {str(matrices): name for matrices, name in result.orderings.items()}, row)
        self._put_log(result.step, result.augmentations)
        self._put_state(result)

    def _put_log(self, step: int, augmentations: tuple[AugmentationRecord, ...]) -> None:
        extend, iterations = self._datasets.extend, [i for a in augmentations for i in a.iterations]
        extend(
            "log/augmentations",
            [
                (step, a.augmentation, a.penalty_normal, a.penalty_tangential, a.change_pressure, a.change_traction, len(a.iterations))
                for a in augmentations
            ],
        )
        extend("log/iterations", [(step, i.iteration, i.residual, i.active, i.stick, i.slip, len(i.notes)) for i in iterations])
        extend("log/notes", [note for i in iterations for note in i.notes])

    def _put_state(self, result: StepResult) -> None:
        kept = self._datasets.rows("states/step")
        if self._states == "last":
            kept = max(kept - 1, 0)
        self._datasets.put_row("states/step", layout.STATE_STEP, result.step, kept)
        self._datasets.put_row("states/positions", layout.POSITIONS, result.state.positions, kept)
        for contact, state, measured in zip(self._problem.contacts, result.state.contacts, result.contacts, strict=True):
            for quantities, source in ((layout.CONTACT_STATE, state), (layout.CONTACT_VALUES, measured)):
                self._datasets.put(f"states/contacts/{contact.name}", _wanted(contact, quantities), source, kept)
        self._put_rates(result.state.rates or _unknown(result.state), kept)

    def _put_rates(self, rates: Rates, kept: int) -> None:
        self._datasets.put("rates", layout.RATES, rates, kept)
        for contact, of_contact in zip(self._problem.contacts, rates.contacts, strict=True):
            self._datasets.put(f"rates/contacts/{contact.name}", _wanted(contact, layout.CONTACT_RATES), of_contact, kept)


def _still_in(path: Path) -> str:
    """What results hold that could not be replaced, as the end of a sentence; empty, where they hold no load step or are not there."""
    with suppress(ResultsError), Results(path) as stored:
        return "".join(f"; it still holds load steps up to {last}" for last in stored.steps[-1:])
    return ""


def _put_scene(file: h5py.File, text: str) -> None:
    scene = file.create_dataset("scene", data=np.bytes_(text.encode()))
    scene.attrs["unit"], scene.attrs["description"] = "text", "the scene file, UTF-8"


def _wanted(contact: Contact, quantities: Mapping[str, layout.Quantity]) -> dict[str, layout.Quantity]:
    """What is written of a contact."""
    return {name: kind for name, kind in quantities.items() if contact.friction_law.acts or not kind.frictional}


def _unknown(state: State) -> Rates:
    """What stands for the rates of a state that has none."""
    contacts = (ContactRates(np.full_like(c.pressure, np.nan), np.full_like(c.traction, np.nan)) for c in state.contacts)
    return Rates(np.nan, np.full_like(state.positions, np.nan), tuple(contacts))
