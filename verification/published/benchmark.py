"""What a published benchmark is: cases that compute it, the numbers that are known of it, and what its sources leave open."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from isomortar.geometry.patch import FloatArray
from isomortar.harness.cases import Claim
from isomortar.model.entities import Problem
from isomortar.program.declaration import LoadStep


@dataclass(frozen=True)
class Known:
    """A published value of a quantity."""

    source: str
    value: float


@dataclass(frozen=True)
class Quantity:
    """A number of a case, and what is known of it.

    Parameters
    ----------
    name : str
        Its key among the numbers of the case.
    label, unit : str
    known : tuple of Known
    remark : str
        Why values differ, or what is open.
    """

    name: str
    label: str
    unit: str
    known: tuple[Known, ...]
    remark: str = ""


@dataclass(frozen=True)
class Drawing:
    """Numbers of a case that are drawn: `y` over `x`, and published points of the same, by source, shape (n, 2); `log`: both decades."""

    x: str
    y: str
    x_label: str
    y_label: str
    points: dict[str, FloatArray]
    log: bool = False


@dataclass(frozen=True)
class Beside:
    """A benchmark as other programs can be told of it, beside our solver, on coarse Lagrange elements.

    Parameters
    ----------
    about : str
        What is other than above.
    problem : callable
        By a kind of elements, ``L1``.
    numbers : callable
        Some of the benchmark's quantities, of the problem and its load steps, which have positions and reactions alone.
    within : dict of str to Bound
        What is claimed of them, whatever program they are of.
    kinds : tuple of str
    stops : dict of str to str
        Runs that do not come to their end, ``L2 CalculiX``, with what becomes of them.
    """

    about: str
    problem: Callable[[str], Problem]
    numbers: Callable[[Problem, Sequence[LoadStep]], dict[str, float]]
    within: Mapping[str, Claim]
    kinds: tuple[str, ...] = ("L1", "L2")
    stops: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Benchmark:
    """A published benchmark.

    Parameters
    ----------
    case : str
        Its case, whose setting ``mesh`` is a discretisation.
    title, about : str
        What is computed.
    open : str
        What the sources leave open, and how it is taken here; empty: nothing.
    finest : two str
        Discretisations of other order and other elements: the value is that of the first, what they differ by its uncertainty.
    beside : Beside or str
        How other programs compute it, or why they do not.
    settings : dict
        Other settings of the case.
    """

    case: str
    title: str
    about: str
    open: str
    finest: tuple[str, str]
    quantities: tuple[Quantity, ...]
    drawings: tuple[Drawing, ...]
    beside: Beside | str
    settings: Mapping[str, Any] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The case and its other settings: nothing else on the page is called so."""
        return "-".join([self.case, *(f"{name}-{value:g}" for name, value in self.settings.items())])


def points(benchmark: str, name: str) -> dict[str, FloatArray]:
    """Published points of a curve by source, shape (n, 2)."""
    table = tomllib.loads((Path(__file__).parent / "known.toml").read_text(encoding="utf-8"))[benchmark][name]
    over = table["over"]
    return {source: np.column_stack([over[: len(values)], values]) for source, values in table.items() if source != "over"}


def among(curve: dict[str, FloatArray], x: float) -> tuple[Known, ...]:
    """Values at one of their points of the published curves that come so far."""
    return tuple(Known(source, float(np.interp(x, *rows.T))) for source, rows in curve.items() if x <= rows[-1, 0])


def ratios(above: Sequence[Known], below: Sequence[Known]) -> tuple[Known, ...]:
    """Quotients of values by the same sources."""
    values = {known.source: known.value for known in below}
    return tuple(Known(known.source, known.value / values[known.source]) for known in above)


def reaction(problem: Problem, step: LoadStep, support: str) -> FloatArray:
    """Force of a support on its body."""
    return next(r.force for s, r in zip(problem.supports, step.reactions, strict=True) if s.name == support)


def at_force(force: float, forces: Sequence[float], values: Sequence[float]) -> float:
    """A value at a force among those of load steps, which both begin at zero: other programs press by displacements."""
    return float(PchipInterpolator([0.0, *forces], [0.0, *values], extrapolate=False)(force))
