"""Reads a results file, also one whose computation is still running or was killed."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from shlex import quote
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import h5py
import numpy as np
from numpy.typing import NDArray

from isomortar import _arguments
from isomortar._frozen import frozen
from isomortar.errors import ResultsError
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.entities import Contact, Problem
from isomortar.model.supports import moved_by, progress
from isomortar.results import layout
from isomortar.results.definition import read_problem
from isomortar.results.files import is_marked, is_whole
from isomortar.results.recorded import column, step_result
from isomortar.results.table import data_frame, data_set
from isomortar.solve.record import StepResult

if TYPE_CHECKING:
    import pandas
    import xarray

Value = TypeVar("Value")


@frozen
class ContactHistory:
    """The values of a contact pair's constraints over the kept states.

    `steps`: shape (m,); `pressure`, `traction_norm`, `status`, `gap`: shape (m, n); `traction`: shape (m, n, 2);
    n constraints as in `ContactState` and `ContactResult`.
    """

    contact: Contact
    steps: NDArray[np.int64]
    pressure: FloatArray
    traction: FloatArray
    traction_norm: FloatArray
    status: IntArray
    gap: FloatArray


class Results:
    """A results file.

    It shows the file as it was when it was opened; a computation that goes on replaces the file and does not disturb.

    >>> with Results("iron.h5") as results:
    ...     drag = results.curve("force", support="top", component="x")

    Parameters
    ----------
    path : path-like

    Raises
    ------
    InputError
        The path is none.
    ResultsError
        There is no such file, it is damaged, or it holds something else. Every method raises it as well where the file is damaged.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        _arguments.kind("path", path, str, os.PathLike)
        self.path = Path(path)
        if self.path.is_dir():
            raise ResultsError(f"{self.path} is a folder: name the results file in it")
        if self.path.exists() and not self.path.is_file():
            raise ResultsError(f"{self.path} is a device, and no results file: name one")
        if not self.path.is_file():
            raise ResultsError(f"{self.path} does not exist: run the scene first, or check the path")
        try:
            self._check_seal()
        except OSError as error:
            raise ResultsError(f"{self.path} cannot be read: {error.strerror or error}") from error
        try:
            self._file = h5py.File(self.path, "r")
        except OSError as error:
            raise self._damaged(error) from error
        try:
            self._read(self._check_format)
        except ResultsError:
            self.close()
            raise

    def __enter__(self) -> Results:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        if not self._file:
            return f"<Results {self.path}: closed>"
        return f"<Results {self.path}: {len(self.steps)}/{self.problem.total_steps} steps>"

    def __reduce__(self) -> tuple[type[Results], tuple[Path]]:
        """Another process opens the file itself."""
        return Results, (self.path.absolute(),)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    @cached_property
    def scene_text(self) -> str:
        """Text of the scene file."""
        return self._read(lambda file: bytes(file["scene"][()]).decode())

    @property
    def version(self) -> str:
        """Version of the program that wrote the file."""
        return self._read(lambda file: str(file.attrs["program_version"]))

    @cached_property
    def problem(self) -> Problem:
        """What was computed: bodies with their patches, contacts, supports, stages, settings."""
        return self._read(lambda file: read_problem(file["problem"]))

    @cached_property
    def steps(self) -> NDArray[np.int64]:
        """Numbers of the recorded load steps."""
        return self._rows("curves/step")

    @cached_property
    def kept_states(self) -> NDArray[np.int64]:
        """Numbers of the load steps whose full state is in the file."""
        return self._rows("states/step")

    @cached_property
    def stages(self) -> list[str]:
        """Stage of each recorded load step."""
        return [text.decode() for text in self._rows("curves/stage")]

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """What was told of the scene and its run, each sentence once; none of files from before it was kept."""
        return self._read(lambda file: tuple(text.decode() for text in file["log/warnings"][()]) if "warnings" in file["log"] else ())

    def curve(
        self,
        quantity: str,
        *,
        support: str | None = None,
        contact: str | None = None,
        load: str | None = None,
        component: Literal["x", "y", "z"] | None = None,
    ) -> NDArray[Any]:
        """A quantity over the recorded load steps.

        Parameters
        ----------
        quantity : str
            Of a support: force, moment, centre, displacement, rotation (degrees). Of a contact: force_slave, force_master, moment_slave,
            moment_master, active, slip, pressure_field, excluded, friction_work, spurious_work. Of a load: force, moment. Of none of them:
            step, time, newton_order, substeps, cuts, next_increment.
        support, contact, load : str, optional
            Name of a support, of a contact pair, or of a load.
        component : {"x", "y", "z"}, optional
            Of a vector; absent: all three.

        Returns
        -------
        ndarray, shape (steps,) or (steps, 3)
        """
        named = [kind for kind, name in (("support", support), ("contact", contact), ("load", load)) if name is not None]
        if len(named) > 1:
            raise ResultsError(f"a curve is of one of {', '.join(named)}: name that alone")
        motion: dict[str, FloatArray] = {}
        if support is not None:
            known, place = layout.REACTION, f"supports/{_named(self.problem.supports, support, 'support').name}/"
            motion = self._motion(support)
        elif contact is not None:
            known, place = layout.CONTACT, f"contacts/{_named(self.problem.contacts, contact, 'contact').name}/"
        elif load is not None:
            known, place = layout.LOAD, f"loads/{_named(self.problem.loads, load, 'load').name}/"
        else:
            known, place = {name: kind for name, kind in layout.STEP.items() if name != "stage"}, ""
        if quantity not in known:
            raise ResultsError(f"there is no curve {quantity!r} here; {_where(quantity)}there are: {', '.join(known)}")
        values: NDArray[Any] = self._read(lambda file: column(file, f"curves/{place}{quantity}", known[quantity])[()])
        if quantity in motion:
            values = np.where(np.isnan(values), motion[quantity], values)
        if component is None:
            return values
        if component not in ("x", "y", "z"):
            raise ResultsError(f"component is {component!r}; allowed: 'x', 'y' or 'z', or none of them for all three")
        if values.ndim != 2 or values.shape[1] != 3:
            raise ResultsError(f"curve {quantity!r} has no components")
        return values[:, "xyz".index(component)]

    def _motion(self, support: str) -> dict[str, FloatArray]:
        """What files do not hold of how a support moves, from its motions: those from before there were forces, or moments."""
        chosen, stages = _named(self.problem.supports, support, "support"), self.problem.stages
        moved = [moved_by(chosen, progress(stages, time)) for time in self.curve("time")]
        return {"displacement": np.reshape([shift for shift, _ in moved], (-1, 3)), "rotation": np.array([angle for _, angle in moved])}

    def to_dataframe(self) -> pandas.DataFrame:
        """All curves as a frame of pandas: a row for each recorded load step, columns like ``force.top.x`` and ``active.floor``.

        Raises
        ------
        InputError
            Pandas is not installed.
        """
        return data_frame(self)

    def to_xarray(self) -> xarray.Dataset:
        """All curves as arrays of xarray over load steps, supports, contacts or loads, and components, with units and meanings.

        For example ``results.to_xarray().force.sel(support="top", component="z")``; of loads, ``load_force``.

        Raises
        ------
        InputError
            Xarray is not installed.
        """
        return data_set(self)

    def timings(self) -> dict[str, FloatArray]:
        """CPU seconds, of all threads, by phase over the recorded load steps; NaN where a step did not tell."""
        return self._read(lambda file: {name: data[()] for name, data in file["timings"].items()})

    def counters(self) -> dict[str, NDArray[np.int64]]:
        """What was done, by name, over the recorded load steps; -1 where a step did not tell (docs/method.md, "What a run costs")."""
        return self._read(lambda file: {name: data[()] for name, data in file["counters"].items()})

    def augmentations(self) -> NDArray[np.int64]:
        """How many augmentations each recorded load step took; one an increment where multipliers are unknowns."""
        made = self._read(lambda file: file["log/augmentations"]["step"])
        return np.array([np.count_nonzero(made == step) for step in self.steps], dtype=np.int64)

    def contact(self, name: str) -> ContactHistory:
        """Control values of a contact pair over the kept states."""
        contact = _named(self.problem.contacts, name, "contact")
        if not len(self.kept_states):
            raise ResultsError(f"{self.path} holds no load step yet")
        known = {**layout.CONTACT_STATE, **layout.CONTACT_VALUES}
        names = ("pressure", "traction", "traction_norm", "status", "gap")
        values = self._read(lambda file: {n: column(file, f"states/contacts/{name}/{n}", known[n])[()] for n in names})
        return ContactHistory(contact=contact, steps=self.kept_states, **values)

    def last_step(self) -> StepResult | None:
        """The newest recorded step, from which a computation resumes; None: nothing is recorded yet."""
        return self.step(int(self.steps[-1])) if len(self.steps) else None

    def step(self, number: int) -> StepResult:
        """A recorded load step, bit for bit as it was recorded.

        Raises
        ------
        ResultsError
            The step was not recorded, or its state was not kept.
        """
        if number not in self.steps:
            raise ResultsError(f"load step {number} is not in {self.path}; it holds {_ranges(self.steps)}")
        if number not in self.kept_states:
            raise ResultsError(f"{self.path} kept no state of load step {number} (states = 'last'); it has the curves of all steps")
        row = int(np.flatnonzero(self.steps == number)[0])
        kept = int(np.flatnonzero(self.kept_states == number)[0])
        return self._read(lambda file: step_result(file, self.problem, number, row, kept))

    def _rows(self, path: str) -> NDArray[Any]:
        return self._read(lambda file: file[path][()])

    def _check_seal(self) -> None:
        """HDF5 must not see a damaged file: it may read wrong numbers from it, end the process, or never come back."""
        if not is_marked(self.path) and self.path.suffix == ".toml":
            raise ResultsError(f"{self.path} is a scene file, and no results: isomortar run {quote(str(self.path))} computes them")
        if not is_marked(self.path):
            raise ResultsError(f"{self.path} is no results file of isomortar, or one of an earlier version: run the scene again")
        if not is_whole(self.path):
            raise ResultsError(
                f"{self.path} is damaged (a killed run does not damage it): restore a copy, or remove it and run the scene again"
            )

    def _check_format(self, file: h5py.File) -> None:
        if file.attrs.get("format") != layout.FORMAT:
            raise ResultsError(f"{self.path} is sealed as results of isomortar are, but holds something else")
        version = layout.version_of(file)
        if version > layout.FORMAT_VERSION:
            raise ResultsError(
                f"{self.path} has format {version}, newer than format {layout.FORMAT_VERSION} that this program reads: update isomortar, "
                "or run the scene again into another file"
            )
        if version < layout.EARLIEST_VERSION:
            raise ResultsError(
                f"{self.path} has format {version}, this program reads formats {layout.EARLIEST_VERSION} to {layout.FORMAT_VERSION}: use "
                "the version that wrote it, or run the scene again"
            )

    def _read(self, action: Callable[[h5py.File], Value]) -> Value:
        if not self._file:
            raise ResultsError(f"{self.path} is closed: read it before that, within its with block, or open it again")
        try:
            return action(self._file)
        except ResultsError:
            raise
        except Exception as error:  # damaged content may come up as any of them
            raise self._damaged(error) from error

    def _damaged(self, error: Exception) -> ResultsError:
        return ResultsError(
            f"{self.path} cannot be read ({error}), though no byte of it has changed since it was written: another version may have "
            "written it. Run the scene again"
        )


def _named(entries: tuple[Any, ...], name: str, kind: str) -> Any:
    for entry in entries:
        if entry.name == name:
            return entry
    raise ResultsError(f"there is no {kind} {name!r}; there are: {', '.join(entry.name for entry in entries) or 'none'}")


def _where(quantity: str) -> str:
    """Of what there is a curve of that name, as a part of a sentence; empty where there is none."""
    kinds = {"support": layout.REACTION, "contact": layout.CONTACT, "load": layout.LOAD}
    owners = [f"{kind}=" for kind, known in kinds.items() if quantity in known]
    return f"name what it is of, by {' or '.join(owners)}; " if owners else ""


def _ranges(steps: NDArray[np.int64]) -> str:
    return f"steps {steps[0]} to {steps[-1]}" if len(steps) else "no step yet"
