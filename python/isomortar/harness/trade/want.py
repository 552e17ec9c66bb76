"""What is wanted of a scene: a curve, a number of one, or a field, and how far runs are apart in it."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Problem
from isomortar.scene.types import listed

#: Places of a stage that curves are compared at, evenly apart.
PLACES = 200
_PATTERN = re.compile(r"(?P<quantity>\w+)\.(?P<where>[\w-]+)(\.(?P<component>\w+))?(@(?P<stage>[\w-]+))?(:(?P<part>\w+))?")
_FORM = "QUANTITY.NAME[.COMPONENT][@STAGE][:PART]"
_SUPPORT, _CURVES, _FIELDS = ("force", "moment"), ("force", "moment", "area"), ("pressure", "traction")
_COMPONENTS, _PARTS = ("x", "y", "z", "norm"), ("curve", "end", "peak")


@dataclass(frozen=True)
class Want:
    """Something that is wanted of a scene.

    Parameters
    ----------
    text : str
        As it was asked for: ``force.top.x``, ``moment.top.z@twist:peak``, ``pressure.floor``.
    values : callable
        From the numbers of a run (`isomortar.harness.trade.run.traded`) to what is compared, shape (n,).
    weights : callable
        From them to what each value counts, shape (n,).
    """

    text: str
    values: Callable[[Mapping[str, Any]], FloatArray]
    weights: Callable[[Mapping[str, Any]], FloatArray]

    def size(self, values: FloatArray, weights: FloatArray) -> float:
        """Weighted norm of some values."""
        return float(np.sqrt(weights @ values**2))


def wanted(text: str, problem: Problem) -> Want:
    """What a person wants of a problem.

    Parameters
    ----------
    text : str
        ``force.SUPPORT.x``, ``moment.SUPPORT.norm``, ``area.CONTACT``: a curve over the load history, of one stage with ``@STAGE``, its
        last value with ``:end``, its largest size with ``:peak``. ``pressure.CONTACT``, ``traction.CONTACT``: a field at the end.
    problem : Problem

    Raises
    ------
    InputError
        The scene has no such thing; says what is allowed.
    """
    found = _PATTERN.fullmatch(text)
    if not found:
        raise InputError(f"is {text!r}; it is of the form {_FORM}, e.g. force.top.x or pressure.floor@press", "want")
    quantity, where, part = found["quantity"], found["where"], found["part"] or "curve"
    _among(quantity, (*_CURVES, *_FIELDS), f"{text!r} has no such quantity")
    if quantity in _FIELDS:
        number = _contact(where, problem)
        if found["component"] or found["stage"] or found["part"]:
            raise InputError(f"is {text!r}; a field is that at the end, without component, stage or part: {quantity}.{where}", "want")
        return Want(text, lambda run: _share(run, quantity, number), lambda run: _share(run, "cells", number))
    _among(part, _PARTS, f"{text!r} has no such part")
    within = _stages(found["stage"], problem)
    if quantity == "area":
        if found["component"]:
            raise InputError(f"is {text!r}; an area has no components: area.{where}", "want")
        number = _contact(where, problem)
        return _of_curve(text, lambda run: np.asarray(run["area"], float)[number], within, part)
    names = [support.name for support in problem.supports]
    _among(where, names, f"{text!r} has no such support")
    component = found["component"] or "norm"
    _among(component, _COMPONENTS, f"{text!r} has no such component")
    return _of_curve(text, lambda run: _component(np.asarray(run[quantity], float)[names.index(where)], component), within, part)


def wishes(problem: Problem) -> tuple[str, ...]:
    """What users look at: force and moment of supports that move, area, pressure and traction of contacts."""
    moving = [s.name for s in problem.supports if s.moves]
    curves = [f"{quantity}.{name}" for name in moving for quantity in _SUPPORT]
    single = [c.name for c in problem.contacts if len(c.slave.faces) == 1]
    fields = [f"{quantity}.{name}" for name in single for quantity in ("area", *_FIELDS)]
    return (*curves, *fields)


def _of_curve(text: str, curve: Callable[[Mapping[str, Any]], FloatArray], within: tuple[float, float], part: str) -> Want:
    places = np.linspace(*within, round(PLACES * (within[1] - within[0])), endpoint=False) + 0.5 / PLACES

    def values(run: Mapping[str, Any]) -> FloatArray:
        times, heights = np.append(0.0, run["time"]), np.append(0.0, curve(run))  # at rest before the first load step
        if part == "end":
            return np.array([np.interp(within[1], times, heights)])
        inside = heights[(times >= within[0]) & (times <= within[1])]
        return np.array([np.abs(inside).max()]) if part == "peak" else np.interp(places, times, heights)

    return Want(text, values, lambda run: np.full(len(values(run)), 1.0 / len(values(run))))


def _component(vectors: FloatArray, component: str) -> FloatArray:
    return np.linalg.norm(vectors, axis=1) if component == "norm" else vectors[:, _COMPONENTS.index(component)]


def _share(run: Mapping[str, Any], name: str, contact: int) -> FloatArray:
    """The part of a field over all contacts that one of them has."""
    ends = np.cumsum(np.asarray(run["counts"], int))
    return np.asarray(run[name], float)[ends[contact] - int(run["counts"][contact]) : ends[contact]]


def _stages(name: str | None, problem: Problem) -> tuple[float, float]:
    """Where a stage begins and ends, where each has length one; of all without a name."""
    names = [stage.name for stage in problem.stages]
    if name is None:
        return 0.0, float(len(names))
    _among(name, names, f"there is no stage {name!r}")
    return float(names.index(name)), names.index(name) + 1.0


def _contact(name: str, problem: Problem) -> int:
    names = [contact.name for contact in problem.contacts]
    _among(name, names, f"there is no contact {name!r}")
    if len(problem.contacts[names.index(name)].slave.faces) > 1:
        raise InputError(f"is a field of {name!r}, whose slave is of several faces; fields are compared on single faces", "want")
    return names.index(name)


def _among(name: str, names: tuple[str, ...] | list[str], words: str) -> None:
    if name not in names:
        raise InputError(f"{words}; allowed: {listed(name, names)}", "want")
