"""What is wanted of a scene: a curve, a number of one, or a field, and how far runs are apart in it."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from isomortar._frozen import frozen
from isomortar.accuracy.measures import roughness
from isomortar.errors import InputError
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Problem
from isomortar.scene.types import listed

#: Places of a stage that curves are compared at, evenly apart.
PLACES = 200
#: Load steps of a stage that show a curve, where the scene has as many.
FEWEST = 5
_PATTERN = re.compile(r"(?P<quantity>\w+)\.(?P<where>[\w-]+)(\.(?P<component>\w+))?(@(?P<stage>[\w-]+))?(:(?P<part>\w+))?")
_FORM = "QUANTITY.NAME[.COMPONENT][@STAGE][:PART]"
_SUPPORT, _CURVES = ("force", "moment"), ("force", "moment", "displacement", "area")
_FIELDS = ("pressure", "traction", "edge", "gap")  # at the end
_COMPONENTS, _PARTS = ("x", "y", "z", "norm"), ("curve", "end", "peak", "roughness")
#: What is less than this share of the vector of which it is a component is what tolerances and round-off leave.
ROUND_OFF = 1e-9
#: Load steps of a stage that have a second difference.
_BENDS = 3


@frozen
class Want:
    """Something that is wanted of a scene.

    Parameters
    ----------
    text : str
        As it was asked for: ``force.top.x``, ``moment.top.z@twist:peak``, ``pressure.floor``.
    values : callable
        From the numbers of a run (`isomortar.trade.run.traded`) and of the truth to what is compared, shape (n,). How far a curve
        is from the truth is known where the run has a load step, and linear between them; the truth alone is linear itself.
    weights : callable
        From the numbers of a run to what each value counts, shape (n,).
    shown : callable
        Whether a problem has the load steps, or the whole face, that show it.
    power : int
        Of the norm that errors are measured in.
    whole : float
        What errors are a share of; NaN: the size of the truth.
    beside : callable
        From the numbers of a run to the size of that of which it is one part: of a component the vector, of a moment force times length.
    """

    text: str
    values: Callable[[Mapping[str, Any], Mapping[str, Any]], FloatArray]
    weights: Callable[[Mapping[str, Any]], FloatArray]
    shown: Callable[[Problem], bool] = lambda _: True
    power: int = 2
    whole: float = math.nan
    beside: Callable[[Mapping[str, Any]], float] = lambda _: 0.0

    def size(self, values: FloatArray, weights: FloatArray) -> float:
        """Weighted norm of some values."""
        return float((weights @ np.abs(values) ** self.power) ** (1.0 / self.power))

    def is_nothing(self, run: Mapping[str, Any]) -> bool:
        """Whether a run has nothing of it but round-off, as of forces by symmetry; of a gap that is as it should be."""
        size = self.size(self.values(run, run), self.weights(run))
        return math.isnan(self.whole) and size <= ROUND_OFF * self.beside(run)


def wanted(text: str, problem: Problem) -> Want:
    """What a person wants of a problem.

    Parameters
    ----------
    text : str
        ``force.SUPPORT.x``, ``moment.SUPPORT.norm``, ``displacement.SUPPORT.z``, ``area.CONTACT``: a curve over the load history, of one
        stage with ``@STAGE``, its last value with ``:end``, its largest size with ``:peak``, how rough it is with ``:roughness`` (not of
        an area).
        ``pressure.CONTACT``, ``traction.CONTACT``, ``edge.CONTACT``, ``gap.CONTACT``: fields, where contact ends, and what penetrates at
        the end.
    problem : Problem

    Raises
    ------
    InputError
        The scene has no such thing; says what is allowed.
    """
    found = _PATTERN.fullmatch(text)
    if not found:
        raise InputError(f"is {text!r}; it is of the form {_FORM}, e.g. force.top.x@press or pressure.floor", "want")
    quantity, where, part = found["quantity"], found["where"], found["part"] or "curve"
    _among(quantity, (*_CURVES, *_FIELDS), f"{text!r} has no such quantity")
    if quantity in _FIELDS:
        number = _contact(where, problem)
        if found["component"] or found["stage"] or found["part"]:
            raise InputError(f"is {text!r}; a field is that at the end, without component, stage or part: {quantity}.{where}", "want")
        if quantity == "gap":
            return _of_gap(text, number)
        return _of_edge(text, number, problem) if quantity == "edge" else _of_field(text, quantity, number, problem)
    _among(part, _PARTS, f"{text!r} has no such part")
    stages = _stages(found["stage"], problem)
    if quantity == "area":
        if found["component"]:
            raise InputError(f"is {text!r}; an area has no components: area.{where}", "want")
        if part == "roughness":
            raise InputError(f"is {text!r}; areas are counted in cells, and would be as rough as these: area.{where}", "want")
        number = _contact(where, problem)
        return _of_curve(text, lambda run: np.asarray(run["area"], float)[number], stages, part, problem)
    names = [support.name for support in problem.given_supports]
    _among(where, names, f"{text!r} has no such support")
    component = found["component"] or "norm"
    _among(component, _COMPONENTS, f"{text!r} has no such component")
    if part == "roughness":
        _bent(text, stages, problem)
    number = names.index(where)
    curve = _of_curve(text, lambda run: _component(np.asarray(run[quantity], float)[number], component), stages, part, problem)
    return curve if part == "roughness" else replace(curve, beside=_beside(quantity, number, problem))


def wishes(problem: Problem) -> tuple[str, ...]:
    """What users look at: force and moment of supports that move, how far forces move them; area and fields of contacts."""
    moving = [s.name for s in problem.supports if s.moves]
    parts = ("", ":roughness") if all(stage.steps >= _BENDS for stage in problem.stages) else ("",)
    curves = [f"{quantity}.{name}{part}" for name in moving for quantity in _SUPPORT for part in parts]
    curves += [f"displacement.{support.name}" for support in problem.supports if support.pressed]
    single = [c.name for c in problem.contacts if len(c.slave.faces) == 1]
    fields = [f"{quantity}.{name}" for name in single for quantity in ("area", *_FIELDS)]
    return (*curves, *fields)


def _of_curve(text: str, curve: Callable[[Mapping[str, Any]], FloatArray], stages: range, part: str, problem: Problem) -> Want:
    first, last = float(stages.start), float(stages.stop)
    places = np.linspace(first, last, PLACES * len(stages), endpoint=False) + 0.5 / PLACES
    needed = [min(FEWEST, problem.stages[n].steps) for n in stages]
    count = len(places) if part == "curve" else 1

    def recorded(run: Mapping[str, Any]) -> tuple[FloatArray, FloatArray]:
        return np.append(0.0, run["time"]), np.append(0.0, curve(run))  # at rest before the first load step

    def values(run: Mapping[str, Any], truth: Mapping[str, Any]) -> FloatArray:
        times, heights = recorded(run)
        if part == "end":
            return np.array([np.interp(last, times, heights)])
        if part == "peak":
            return np.array([np.abs(heights[(times >= first) & (times <= last)]).max()])
        if part == "roughness":
            return np.array([sum(_roughness(times[1:], heights[1:], number) for number in stages)])  # as measured: without the rest
        right = recorded(truth)
        return np.interp(places, *right) + np.interp(places, times, heights - np.interp(times, *right))

    def shown(other: Problem) -> bool:
        return part in ("end", "peak") or all(other.stages[n].steps >= least for n, least in zip(stages, needed, strict=True))

    return Want(text, values, lambda _: np.full(count, 1.0 / count), shown)


def _beside(quantity: str, number: int, problem: Problem) -> Callable[[Mapping[str, Any]], float]:
    """The largest vector of a support, beside which components are something or nothing; of moments force times the scene's length."""
    vector, length = quantity, 1.0
    if quantity == "moment":
        points = np.concatenate([body.patch.control_points for body in problem.bodies])
        vector, length = "force", float(np.linalg.norm(np.ptp(points, axis=0)))
    return lambda run: length * float(np.linalg.norm(np.asarray(run[vector], float)[number], axis=1).max())


def _of_field(text: str, quantity: str, number: int, problem: Problem) -> Want:
    def values(run: Mapping[str, Any], truth: Mapping[str, Any]) -> FloatArray:
        there = _share(truth, quantity, number)
        return _share(run, quantity, number) if run["images"] == truth["images"] else np.full_like(there, np.nan)  # on another part

    return Want(text, values, lambda run: _share(run, "cells", number), lambda other: other.images == problem.images)


def _of_edge(text: str, number: int, problem: Problem) -> Want:
    """Where there is pressure: the area that has some in one run alone, over that which has some in the truth."""
    field = _of_field(text, "pressure", number, problem)

    def values(run: Mapping[str, Any], truth: Mapping[str, Any]) -> FloatArray:
        pressures = field.values(run, truth)
        return np.where(np.isnan(pressures), np.nan, pressures > 0.0)

    return replace(field, values=values, power=1)


def _of_gap(text: str, number: int) -> Want:
    """The largest penetration at the end, over the size of the slave's body: of the truth it is next to nothing."""
    return Want(text, lambda run, _: np.array([float(run["gap"][number])]), lambda _: np.ones(1), whole=1.0)


def _roughness(times: FloatArray, heights: FloatArray, stage: int) -> float:
    """Second-difference energy of a curve in a stage, by second difference: the same of a smooth curve however many load steps show it.

    Not a number where too few show it: a run may have fewer of them than the scene.
    """
    inside = (times > stage + 1e-9) & (times < stage + 1 + 1e-9)
    count = int(np.count_nonzero(inside))
    if count < _BENDS:
        return math.nan
    return roughness(times[inside], heights[inside], np.zeros(count)) / (count + 1 - _BENDS)


def _bent(text: str, stages: range, problem: Problem) -> None:
    """Refuse the roughness of what has no second difference."""
    for stage in (problem.stages[n] for n in stages):
        if stage.steps < _BENDS:
            raise InputError(
                f"is {text!r}; the {stage.steps} load steps of stage {stage.name!r} are not rough or smooth: three are, of another @STAGE",
                "want",
            )


def _component(vectors: FloatArray, component: str) -> FloatArray:
    return np.linalg.norm(vectors, axis=1) if component == "norm" else vectors[:, _COMPONENTS.index(component)]


def _share(run: Mapping[str, Any], name: str, contact: int) -> FloatArray:
    """The part of a field over all contacts that one of them has."""
    ends = np.cumsum(np.asarray(run["counts"], int))
    return np.asarray(run[name], float)[ends[contact] - int(run["counts"][contact]) : ends[contact]]


def _stages(name: str | None, problem: Problem) -> range:
    """The numbers of the stages that are meant: all, without a name. In a trade each takes a time of one."""
    names = [stage.name for stage in problem.stages]
    if name is None:
        return range(len(names))
    _among(name, names, f"there is no stage {name!r}")
    return range(names.index(name), names.index(name) + 1)


def _contact(name: str, problem: Problem) -> int:
    names = [contact.name for contact in problem.contacts]
    _among(name, names, f"there is no contact {name!r}")
    if len(problem.contacts[names.index(name)].slave.faces) > 1:
        raise InputError(f"is a field of {name!r}, whose slave is of several faces; fields are compared on single faces", "want")
    return names.index(name)


def _among(name: str, names: tuple[str, ...] | list[str], words: str) -> None:
    if name not in names:
        raise InputError(f"{words}; allowed: {listed(name, names)}", "want")
