"""Writes a results file while the computation runs; a kill at any moment leaves the last completed step readable."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal

import h5py
import numpy as np

from isomortar.errors import ResultsError
from isomortar.model.entities import Contact, Problem
from isomortar.results import layout
from isomortar.results.definition import differences, is_longer, write_problem, write_stages
from isomortar.results.files import SEAL_SIZE, read, replace, sealed
from isomortar.results.reader import Results
from isomortar.solve.record import AugmentationRecord, ContactRates, Observer, Rates, State, StepResult

#: HDF5 1.10's format: its metadata carry checksums (the data get theirs from the filter), so damage is seen, not read.
LIBVER = ("v110", "v110")


class ResultsWriter(Observer):
    """Observer that keeps a results file complete up to the last recorded step.

    HDF5 has no transactions: a file killed while it is written may be lost as a whole; and where the disk is full, it ends the
    process. So each step is appended to a copy in memory, which is sealed, written beside the file, flushed to the disk, and then
    takes the file's name, which is atomic: the name always stands for a complete file. The price is one copy of the file a step:
    the bytes written grow with the square of the number of steps. For 100 steps of 1000 control points that is 8 MB at the end and
    some 20 ms a step, far below the cost of computing it; where it is not, `states="last"` keeps the file at the size of one state.

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
        if overwrite or not self.path.exists():
            self._begin(scene_text, version)
        elif resume:
            self._check_same_scene(scene_text)
        else:
            raise ResultsError(f"{self.path} exists already: resume it, overwrite it, or name another results file")

    def recorded(self, result: StepResult) -> None:
        """Append the step; on return it is on the disk."""
        with self._changed(read(self.path)) as file:
            self._lengthen(file)
            self._renew(file)
            self._append(file, result)

    def _begin(self, scene_text: str, version: str) -> None:
        with self._changed(b"") as file:
            file.attrs["format"] = layout.FORMAT
            file.attrs["format_version"] = layout.FORMAT_VERSION
            file.attrs["program_version"] = version
            _put_scene(file, scene_text)
            write_problem(file.create_group("problem"), self._problem)
            _make_all(file, "curves", layout.STEP)
            for support in self._problem.supports:
                _make_all(file, f"curves/supports/{support.name}", layout.REACTION)
            for contact in self._problem.contacts:
                _make_all(file, f"curves/contacts/{contact.name}", layout.CONTACT)
            for load in self._problem.loads:
                _make_all(file, f"curves/loads/{load.name}", layout.LOAD)
            _make_all(file, "log", layout.LOG)
            _make_all(file, "states", {"step": layout.STATE_STEP})
            file.create_group("timings")
            file.create_group("counters")
            file.create_group("orderings")

    def _check_same_scene(self, scene_text: str) -> None:
        with Results(self.path) as stored:
            unlike = differences(stored.problem, self._problem)
            if unlike and is_longer(stored.problem, self._problem):
                self._longer, unlike = scene_text, []
            further = ", ".join(stage.name for stage in stored.problem.stages[len(self._problem.stages) :])
            if unlike and further and is_longer(self._problem, stored.problem):
                raise ResultsError(
                    f"{self.path} has stages that the scene does not have: {further}. Give them to resume it, as by the same --steps, or "
                    "name another results file"
                )
        if unlike:
            more = f"; and {len(unlike) - 5} more" if len(unlike) > 5 else ""
            raise ResultsError(
                f"{self.path} belongs to another scene, so it cannot be resumed with this one: {'; '.join(unlike[:5])}{more}. "
                "Undo these changes, or name another results file; the last stage may be longer at the same rate, and stages may be added "
                "at the end"
            )

    @contextmanager
    def _changed(self, content: bytes) -> Iterator[h5py.File]:
        """A copy of a file's content in memory (of none: a fresh one), open for writing, that takes the file's place at the end."""
        copy = io.BytesIO(content)
        with h5py.File(copy, "a" if content else "w", libver=LIBVER, **({} if content else {"userblock_size": SEAL_SIZE})) as file:
            yield file
        replace(self.path, sealed(copy.getvalue()))

    def _lengthen(self, file: h5py.File) -> None:
        """Put a scene that goes on for longer in the place of the file's own."""
        if self._longer is None:
            return
        del file["scene"]
        _put_scene(file, self._longer)
        write_stages(file["problem"], self._problem)
        self._longer = None

    def _renew(self, file: h5py.File) -> None:
        """Put what a file of an earlier format holds into the present one, for what is appended to it."""
        version = layout.version_of(file)
        if version == layout.FORMAT_VERSION:
            return
        for contact in self._problem.contacts:
            for name, quantity in layout.CONTACT.items():
                if quantity.turned:
                    dataset = file[f"curves/contacts/{contact.name}/{name}"]
                    dataset[...] = quantity.signed(dataset[()], version)
                    dataset.attrs["description"] = quantity.description
        file.attrs["format_version"] = layout.FORMAT_VERSION

    def _append(self, file: h5py.File, result: StepResult) -> None:
        row = len(file["curves/step"])
        if row and result.step <= file["curves/step"][-1]:
            raise ResultsError(
                f"{self.path} holds load step {result.step} already: resume from its last step, or name another results file"
            )
        _put(file, "curves", layout.STEP, result, row)
        for support, reaction in zip(self._problem.supports, result.reactions, strict=True):
            _put(file, f"curves/supports/{support.name}", layout.REACTION, reaction, row)
        for contact, measured in zip(self._problem.contacts, result.contacts, strict=True):
            _put(file, f"curves/contacts/{contact.name}", layout.CONTACT, measured, row)
        for load, acting in zip(self._problem.loads, result.loads, strict=True):
            _put(file, f"curves/loads/{load.name}", layout.LOAD, acting, row)
        _put_named(file["timings"], layout.TIMING, result.timings, row)
        _put_named(file["counters"], layout.COUNTER, result.counters, row)
        _put_named(file["orderings"], layout.ORDERING, {str(matrices): name for matrices, name in result.orderings.items()}, row)
        _log(file, result.step, result.augmentations)
        self._put_state(file, result)

    def _put_state(self, file: h5py.File, result: StepResult) -> None:
        kept = len(file["states/step"])
        if self._states == "last":
            kept = max(kept - 1, 0)
        _put_row(file, "states/step", layout.STATE_STEP, result.step, kept)
        _put_row(file, "states/positions", layout.POSITIONS, result.state.positions, kept)
        for contact, state, measured in zip(self._problem.contacts, result.state.contacts, result.contacts, strict=True):
            for quantities, source in ((layout.CONTACT_STATE, state), (layout.CONTACT_VALUES, measured)):
                _put(file, f"states/contacts/{contact.name}", _wanted(contact, quantities), source, kept)
        self._put_rates(file, result.state.rates or _unknown(result.state), kept)

    def _put_rates(self, file: h5py.File, rates: Rates, kept: int) -> None:
        _put(file, "rates", layout.RATES, rates, kept)
        for contact, of_contact in zip(self._problem.contacts, rates.contacts, strict=True):
            _put(file, f"rates/contacts/{contact.name}", _wanted(contact, layout.CONTACT_RATES), of_contact, kept)


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


def _put(file: h5py.File, group: str, quantities: Mapping[str, layout.Quantity], source: object, row: int) -> None:
    for name, quantity in quantities.items():
        _put_row(file, f"{group}/{name}", quantity, getattr(source, name), row)


def _put_row(file: h5py.Group, path: str, quantity: layout.Quantity, value: Any, row: int) -> None:
    """Write row `row` of a dataset, its last one; make the dataset at its first row.

    By HDF5's own calls: h5py's datasets take six times as long for a row, of which a load step has sixty.
    """
    value = np.asarray(value, dtype=quantity.dtype)
    try:
        dataset = h5py.h5d.open(file.id, path.encode())
    except KeyError:
        _make(file, path, quantity, value.shape)
        dataset = h5py.h5d.open(file.id, path.encode())
    dataset.set_extent((row + 1, *value.shape))
    if quantity.dtype == layout.TEXT:
        h5py.Dataset(dataset)[row] = value[()]
    elif value.size:
        place = dataset.get_space()
        place.select_hyperslab((row, *(0 for _ in value.shape)), (1, *value.shape))
        dataset.write(h5py.h5s.create_simple((1, *value.shape)), place, np.ascontiguousarray(value[None]))


def _put_named(group: h5py.Group, quantity: layout.Quantity, values: Mapping[str, float] | Mapping[str, str], row: int) -> None:
    """Write one row of each dataset of a group; a name that only some steps have is filled up."""
    for name in {*group, *values}:
        _put_row(group, name, quantity, values.get(name, quantity.missing), row)


def _log(file: h5py.File, step: int, augmentations: tuple[AugmentationRecord, ...]) -> None:
    rows = [
        (step, a.augmentation, a.penalty_normal, a.penalty_tangential, a.change_pressure, a.change_traction, len(a.iterations))
        for a in augmentations
    ]
    iterations = [i for a in augmentations for i in a.iterations]
    _extend(file, "augmentations", rows)
    _extend(file, "iterations", [(step, i.iteration, i.residual, i.active, i.stick, i.slip, len(i.notes)) for i in iterations])
    _extend(file, "notes", [note for i in iterations for note in i.notes])


def _extend(file: h5py.File, name: str, rows: list[Any]) -> None:
    dataset = file[f"log/{name}"]
    before = len(dataset)
    dataset.resize(before + len(rows), axis=0)
    dataset[before:] = np.array(rows, dtype=layout.LOG[name].dtype)


def _make_all(file: h5py.File, group: str, quantities: Mapping[str, layout.Quantity]) -> None:
    for name, quantity in quantities.items():
        _make(file, f"{group}/{name}", quantity, quantity.row)


def _make(file: h5py.Group, path: str, quantity: layout.Quantity, row: tuple[int, ...]) -> None:
    """An empty dataset that grows along its first axis, in chunks of about 1 kB, at least one row."""
    rows = max(1, 128 // max(1, int(np.prod(row))))
    dataset = file.create_dataset(
        path,
        shape=(0, *row),
        maxshape=(None, *row),
        chunks=(rows, *(max(n, 1) for n in row)),
        dtype=quantity.dtype,
        fillvalue=quantity.missing,
        fletcher32=quantity.dtype != layout.TEXT,
    )
    dataset.attrs["unit"], dataset.attrs["description"] = quantity.unit, quantity.description
