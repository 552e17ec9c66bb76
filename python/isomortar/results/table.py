"""All curves of a results file side by side: a column each, or arrays over load steps, supports or contacts, and components."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from isomortar.results import layout
from isomortar.results.optional import optional

if TYPE_CHECKING:
    import pandas
    import xarray

    from isomortar.results.reader import Results

#: Names of what a vector has, and of what a range has.
_COMPONENTS, _ENDS = ("x", "y", "z"), ("smallest", "largest")
_OF_STEPS = tuple(name for name in layout.STEP if name not in ("step", "stage", "time"))


def columns(results: Results) -> dict[str, NDArray[Any]]:
    """Every curve by its name, shape (recorded steps,): ``force.top.x``, ``active.floor``, ``pressure_field.floor.largest``."""
    table: dict[str, NDArray[Any]] = {"time": results.curve("time"), "stage": np.array(results.stages)}
    table |= {name: results.curve(name) for name in _OF_STEPS}
    for support in results.problem.supports:
        for quantity in layout.REACTION:
            table |= _components(f"{quantity}.{support.name}", results.curve(quantity, support=support.name))
    for contact in results.problem.contacts:
        for quantity in layout.CONTACT:
            table |= _components(f"{quantity}.{contact.name}", results.curve(quantity, contact=contact.name))
    for load in results.problem.loads:
        for quantity in layout.LOAD:
            table |= _components(f"{quantity}.load.{load.name}", results.curve(quantity, load=load.name))
    return table


def _components(name: str, values: NDArray[Any]) -> dict[str, NDArray[Any]]:
    """A curve, or those of its components."""
    if values.ndim == 1:
        return {name: values}
    names = _COMPONENTS if values.shape[1] == 3 else _ENDS
    return {f"{name}.{component}": column for component, column in zip(names, values.T, strict=True)}


def data_frame(results: Results) -> pandas.DataFrame:
    """The table as a frame of pandas, with the number of the load step as its index.

    Raises
    ------
    InputError
        Pandas is not installed.
    """
    pandas = optional("pandas", "to_dataframe")
    return pandas.DataFrame(columns(results), index=pandas.Index(results.steps, name="step"))


def data_set(results: Results) -> xarray.Dataset:
    """All curves as arrays of xarray that know their dimensions, units and meanings.

    Raises
    ------
    InputError
        Xarray is not installed.
    """
    xarray = optional("xarray", "to_xarray")
    supports, contacts = ([entry.name for entry in entries] for entries in (results.problem.supports, results.problem.contacts))
    arrays = {name: _array(layout.STEP[name], ("step",), results.curve(name)) for name in _OF_STEPS}
    for name in layout.REACTION if supports else ():
        values = np.stack([results.curve(name, support=support) for support in supports], axis=1)
        arrays[name] = _array(layout.REACTION[name], ("step", "support"), values)
    for name in layout.CONTACT if contacts else ():
        values = np.stack([results.curve(name, contact=contact) for contact in contacts], axis=1)
        arrays[name] = _array(layout.CONTACT[name], ("step", "contact"), values)
    loads = [load.name for load in results.problem.loads]
    for name in layout.LOAD if loads else ():
        values = np.stack([results.curve(name, load=load) for load in loads], axis=1)
        arrays[f"load_{name}"] = _array(layout.LOAD[name], ("step", "load"), values)
    places = {"step": results.steps, "time": ("step", results.curve("time")), "stage": ("step", np.array(results.stages, dtype=str))}
    named = {"support": supports, "contact": contacts, "load": loads, "component": list(_COMPONENTS), "end": list(_ENDS)}
    used = {dimension for dimensions, *_ in arrays.values() for dimension in dimensions}
    places |= {name: names for name, names in named.items() if name in used}
    return xarray.Dataset(arrays, coords=places, attrs={"name": results.problem.name, "program_version": results.version})


def _array(quantity: layout.Quantity, dimensions: tuple[str, ...], values: NDArray[Any]) -> tuple[Any, ...]:
    """An array with its dimensions, those of a vector or a range among them, and what it is."""
    if values.ndim > len(dimensions):
        dimensions += ("component" if values.shape[-1] == 3 else "end",)
    return dimensions, values, {"units": quantity.unit, "long_name": quantity.description}
