"""All curves of a results file side by side: a column each, by the names that `isomortar trade` wants them by."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from isomortar.errors import InputError
from isomortar.results import layout

if TYPE_CHECKING:
    import pandas

    from isomortar.results.reader import Results


def columns(results: Results) -> dict[str, NDArray[Any]]:
    """Every curve by its name, shape (recorded steps,): ``force.top.x``, ``active.floor``, ``pressure_field.floor.largest``."""
    table: dict[str, NDArray[Any]] = {"time": results.curve("time"), "stage": np.array(results.stages)}
    table |= {name: results.curve(name) for name in layout.STEP if name not in ("step", "stage", "time")}
    for support in results.problem.supports:
        for quantity in (*layout.REACTION, *layout.MOTION):
            table |= _components(f"{quantity}.{support.name}", results.curve(quantity, support=support.name))
    for contact in results.problem.contacts:
        for quantity in layout.CONTACT:
            table |= _components(f"{quantity}.{contact.name}", results.curve(quantity, contact=contact.name))
    return table


def _components(name: str, values: NDArray[Any]) -> dict[str, NDArray[Any]]:
    """A curve, or those of its components."""
    if values.ndim == 1:
        return {name: values}
    names = ("x", "y", "z") if values.shape[1] == 3 else ("smallest", "largest")
    return {f"{name}.{component}": column for component, column in zip(names, values.T, strict=True)}


def data_frame(results: Results) -> pandas.DataFrame:
    """The table as a frame of pandas, with the number of the load step as its index.

    Raises
    ------
    InputError
        Pandas is not installed.
    """
    try:
        import pandas
    except ImportError as error:
        raise InputError("needs pandas, which is not installed: pip install 'isomortar[pandas]'", "to_dataframe") from error
    return pandas.DataFrame(columns(results), index=pandas.Index(results.steps, name="step"))
