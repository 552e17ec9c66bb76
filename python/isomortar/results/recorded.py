"""A recorded load step, from its rows in a results file of this format or an earlier one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import h5py
import numpy as np

from isomortar.model.entities import Problem, Support
from isomortar.model.numbering import Numbering
from isomortar.model.supports import moved_by, progress
from isomortar.results import layout
from isomortar.solve.record import (
    AugmentationRecord,
    ContactRates,
    ContactResult,
    ContactState,
    IterationRecord,
    LoadResult,
    Rates,
    Reaction,
    State,
    StepResult,
)

#: Of a body's extents the smallest by the largest, below which it has no volume: round-off of its control points.
_FLAT = 1e-14


def step_result(file: h5py.File, problem: Problem, number: int, row: int, kept: int) -> StepResult:
    """Load step `number`: row `row` of the curves, `kept` of the states.

    Raises
    ------
    Exception
        Of any kind: the content is damaged.
    """
    states = [f"states/contacts/{contact.name}" for contact in problem.contacts]
    curves = [f"curves/contacts/{contact.name}" for contact in problem.contacts]
    values = _row(file, "curves", layout.STEP, row)
    values["stage"] = values["stage"].decode()
    state = State(
        positions=file["states/positions"][kept],
        contacts=tuple(ContactState(**_row(file, state, layout.CONTACT_STATE, kept)) for state in states),
        rates=_rates(file, problem, kept),
    )
    _check_state(problem, state)
    return StepResult(
        **values,
        state=state,
        reactions=tuple(_reaction(file, problem, support, row) for support in problem.supports),
        contacts=tuple(
            ContactResult(**_row(file, curve, layout.CONTACT, row), **_row(file, state, layout.CONTACT_VALUES, kept))
            for curve, state in zip(curves, states, strict=True)
        ),
        augmentations=_augmentations(file, number),
        timings={name: float(data[row]) for name, data in file["timings"].items() if not np.isnan(data[row])},
        counters={name: int(data[row]) for name, data in file["counters"].items() if data[row] >= 0},
        orderings={int(matrices): data.asstr()[row] for matrices, data in file["orderings"].items() if data[row]},
        loads=tuple(LoadResult(**_row(file, f"curves/loads/{load.name}", layout.LOAD, row)) for load in problem.loads),
    )


def _check_state(problem: Problem, state: State) -> None:
    """What no computation comes to, and nobody can draw or go on from."""
    numbering = Numbering(problem)
    for body in problem.bodies:
        points = numbering.of_patch(body.name, state.positions)
        extents = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if not extents[2] > _FLAT * extents[0]:
            raise ValueError(f"body {body.name!r} has no volume")
    for contact, values in zip(problem.contacts, state.contacts, strict=True):
        if not (np.isfinite(values.pressure).all() and np.isfinite(values.traction).all()):
            raise ValueError(f"pressures of contact {contact.name!r} are not finite")


def _rates(file: h5py.File, problem: Problem, kept: int) -> Rates | None:
    """Rates of a kept state; None where it has none, as in a file from before there were any."""
    values = _row(file, "rates", layout.RATES, kept)
    if np.isnan(values["time"]):
        return None
    of_contacts = (_row(file, f"rates/contacts/{contact.name}", layout.CONTACT_RATES, kept) for contact in problem.contacts)
    return Rates(**values, contacts=tuple(ContactRates(**of_contact) for of_contact in of_contacts))


def _reaction(file: h5py.File, problem: Problem, support: Support, row: int) -> Reaction:
    """What a support bears; how far it has gone is that of its motions in what format 3 recorded."""
    values = _row(file, f"curves/supports/{support.name}", layout.REACTION, row)
    way, angle = moved_by(support, progress(problem.stages, float(file["curves/time"][row])))
    if np.isnan(values["displacement"]).all():
        values["displacement"] = way
    if np.isnan(values["rotation"]):
        values["rotation"] = angle
    return Reaction(**values)


def _row(file: h5py.File, group: str, quantities: Mapping[str, layout.Quantity], row: int) -> dict[str, Any]:
    """Row `row` of every quantity; single numbers as Python's own."""
    rows = {name: column(file, f"{group}/{name}", quantity)[row] for name, quantity in quantities.items()}
    return {name: value.item() if isinstance(value, np.generic) else value for name, value in rows.items()}


def column(file: h5py.File, path: str, quantity: layout.Quantity) -> Any:
    """A dataset; of a quantity that the file is too old for, what stands for it at every recorded load step; of none, zeros."""
    if quantity.missing is not None and path not in file:
        return np.full((len(file["curves/step"]), *quantity.row), quantity.missing)
    if quantity.frictional and path not in file:
        return np.zeros((*file[f"{path.rpartition('/')[0]}/pressure"].shape, *quantity.row))
    return quantity.signed(file[path][()], layout.version_of(file)) if quantity.turned else file[path]


def _augmentations(file: h5py.File, step: int) -> tuple[AugmentationRecord, ...]:
    rows = file["log/augmentations"][()]
    iterations = iter(_iterations(file, step))
    records = [_numbers(row) for row in rows[rows["step"] == step]]
    return tuple(AugmentationRecord(**r | {"iterations": tuple(next(iterations) for _ in range(r["iterations"]))}) for r in records)


def _iterations(file: h5py.File, step: int) -> list[IterationRecord]:
    rows = file["log/iterations"][()]
    mine = np.flatnonzero(rows["step"] == step)
    if not len(mine):
        return []
    begin, end = rows["notes"][: mine[0]].sum(), rows["notes"][: mine[-1] + 1].sum()
    notes = iter(file["log/notes"].asstr()[begin:end])
    records = [_numbers(row) for row in rows[mine]]
    return [IterationRecord(**r | {"notes": tuple(next(notes) for _ in range(r["notes"]))}) for r in records]


def _numbers(row: np.void) -> dict[str, Any]:
    """A row of the log by name, without the load step."""
    return {name: row[name].item() for name in row.dtype.names or () if name != "step"}
