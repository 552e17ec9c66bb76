"""What curves are drawn over: load time, or how far a support has moved or turned."""

from __future__ import annotations

import re

import numpy as np

from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.geometry.patch import FloatArray
from isomortar.results.reader import Results

_WAY = re.compile(r"(?P<quantity>displacement|rotation)( (?P<component>[xyz]))? of (?P<support>[\w-]+)")


@frozen
class Abscissa:
    """Values at rest and at every recorded load step, shape (steps + 1,), and what stands below their axis."""

    values: FloatArray
    label: str

    @property
    def one_way(self) -> bool:
        """Whether they never go back, so that stages lie beside each other."""
        steps = np.diff(self.values)
        return bool(np.all(steps >= 0.0) or np.all(steps <= 0.0))


def abscissa(results: Results, what: str = "time") -> Abscissa:
    """What curves are drawn over, by its words.

    Parameters
    ----------
    results : Results
    what : str
        ``time``; ``displacement z of top``, without a component its size; ``rotation of top``, in degrees.

    Raises
    ------
    InputError
        Other words, or a support that does not move like that.
    ResultsError
        There is no such support.
    """
    if what == "time":
        return Abscissa(from_rest(results.curve("time")), "load time (steps)")
    found = _WAY.fullmatch(what)
    if not found or (found["component"] and found["quantity"] == "rotation"):
        raise InputError(
            f"is {what!r}; allowed: 'time', 'displacement of SUPPORT' (its size), 'displacement z of SUPPORT', 'rotation of SUPPORT'", "x"
        )
    values = results.curve(found["quantity"], support=found["support"])
    if values.ndim == 2:
        values = values[:, "xyz".index(found["component"])] if found["component"] else np.linalg.norm(values, axis=1)
    values = from_rest(values)
    if not values.any():
        raise InputError(f"is {what!r}, and it stays zero: nothing can be drawn over it", "x")
    unit = " (degrees)" if found["quantity"] == "rotation" else ""
    return Abscissa(values, f"{what}{unit}")


def from_rest(values: FloatArray) -> FloatArray:
    """What is recorded by load step, shape (steps, ...), with the rest before them: zero."""
    return np.concatenate([np.zeros((1, *values.shape[1:])), values])
