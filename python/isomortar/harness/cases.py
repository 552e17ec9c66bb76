"""Verification cases: a small function that measures, and beside it what is claimed of its numbers and why.

::

    @case(
        claim="Rational functions add up to one.",
        tier="gate",
        grid={"order": [1, 2, 3]},
        bounds={"error": Bound(at_most=1e-14, reason="round-off: a sum of (order + 1)^3 terms of size one")},
    )
    def partition_of_unity(order: int) -> dict[str, float]:
        ...
        return {"error": error}

The function stands in ``FOLDER/<family>/*.py``. It returns one entry for every bound, no more and no fewer: numbers, arrays,
`Convergence` sequences or `Curve`. What it can not measure it says with `skip`, which fails the gate.
"""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Literal, NoReturn, get_args

import numpy as np
from numpy.typing import ArrayLike

from isomortar._frozen import frozen
from isomortar.errors import InputError, IsomortarError

Tier = Literal["gate", "nightly", "weekly"]
Settings = dict[str, Any]

TIERS: tuple[Tier, ...] = get_args(Tier)
#: Seconds after which a cell has failed, by tier.
TIMEOUTS: dict[Tier, float] = {"gate": 120.0, "nightly": 1800.0, "weekly": 4 * 3600.0}
#: The discretisations that families of cases run over.
NURBS, LAGRANGE = ("N1", "N2", "N3", "N4", "N5"), ("L1", "L2", "L3", "L4")
#: What a bound may rest on; the reason of every bound begins with one of them and a colon.
GROUNDS = ("theory", "definition", "quadrature", "discretisation", "round-off", "reference")


class SkippedError(IsomortarError):
    """A case that could not be measured here. It does not pass."""


def skip(reason: str) -> NoReturn:
    """Say that the case can not be measured here, and why."""
    raise SkippedError(reason)


@frozen
class Curve:
    """A sequence to be shown, of which no order is claimed: error against quadrature points, pressure against radius.

    `x`, `y`: shape (n,). A bound on the curve holds for every `y`. Axes are logarithmic where `log_x`, `log_y` say so.
    """

    x: ArrayLike
    y: ArrayLike
    x_label: str
    y_label: str
    log_x: bool = False
    log_y: bool = True


@frozen
class Words:
    """What was said, beside the numbers: to be shown (`Shown`), or to be as it was, line by line (`Matches`)."""

    text: str


def _check_reason(reason: str) -> None:
    ground, colon, text = reason.partition(":")
    if ground not in GROUNDS or not colon or not text.strip():
        raise InputError(f"is {reason!r}; it must begin with what the bound rests on, one of {', '.join(GROUNDS)}, and a colon", "reason")


@frozen
class Bound:
    """Limits of a number, or of every entry of an array.

    An upper limit alone speaks of an error, which is not negative: -1 breaks it. A signed number needs both limits.
    """

    at_most: float | None = None
    at_least: float | None = None
    reason: str = ""

    def __post_init__(self) -> None:
        _check_reason(self.reason)
        limits = [limit for limit in (self.at_most, self.at_least) if limit is not None]
        if not limits or not np.isfinite(limits).all():
            raise InputError("needs at_most, at_least or both, finite", "bound")
        if not self.low <= self.high:
            raise InputError(f"holds for no number: at least {self.low:g} and at most {self.high:g}", "bound")

    @property
    def low(self) -> float:
        """Smallest value allowed."""
        return 0.0 if self.at_least is None else self.at_least

    @property
    def high(self) -> float:
        """Largest value allowed; infinity where there is only a lower limit (the value must still be finite)."""
        return np.inf if self.at_most is None else self.at_most


@frozen
class Order:
    """The order of accuracy of a `Convergence`, from theory (never from a run): its verdict must be ``confirmed``."""

    expected: float
    reason: str

    def __post_init__(self) -> None:
        _check_reason(self.reason)
        if not (np.isfinite(self.expected) and self.expected > 0):
            raise InputError(f"is {self.expected}; an order must be positive", "expected")


@frozen
class Matches:
    """Agreement with the dataset of the same name in a reference.

    The tolerance is twice the reference's uncertainty plus `allowance` times the largest absolute value of the reference:
    the error that this computation itself is allowed, with its reason. Of `Words` that holds for the numbers of each line, and what is
    no number is to be the same.
    """

    reference: str
    reason: str
    allowance: float = 0.0

    def __post_init__(self) -> None:
        _check_reason(self.reason)
        if not (np.isfinite(self.allowance) and self.allowance >= 0):
            raise InputError(f"is {self.allowance}; allowed: zero or more", "allowance")


@frozen
class Shown:
    """No claim: the value is shown for what it tells, and need only be there and finite."""

    reason: str


Claim = Bound | Order | Matches | Shown


@frozen
class Case:
    """A measuring function with its claim; `case` makes one.

    Parameters
    ----------
    function : callable
    claim : str
        In words, a full sentence.
    bounds : dict of name to Bound, Order, Matches or Shown, or a function of the settings that returns it
    tier : {"gate", "nightly", "weekly"}, or a function of the settings
        gate: seconds, nightly: minutes.
    grid : dict of argument name to its values
        Every combination is a cell: measured, stored and judged on its own.
    scene : str, optional
        Name of the bundled scene that it runs.
    files : tuple of Path
        Further files that the numbers depend on, such as the binary of another kernel.
    """

    function: Callable[..., Mapping[str, Any]]
    claim: str
    bounds: Mapping[str, Claim] | Callable[..., Mapping[str, Claim]]
    tier: Tier | Callable[..., Tier]
    grid: Mapping[str, Sequence[Any]]
    scene: str | None
    files: tuple[Path, ...]

    @cached_property
    def path(self) -> Path:
        """The file that it stands in."""
        return Path(inspect.getfile(self.function)).resolve()

    @property
    def family(self) -> str:
        """The folder that it stands in."""
        return self.path.parent.name

    @cached_property
    def name(self) -> str:
        """Family and function: ``basis/partition_of_unity``."""
        return f"{self.family}/{self.function.__name__}"

    def bounds_of(self, settings: Settings) -> dict[str, Claim]:
        """Claims on the numbers of one cell."""
        bounds = self.bounds(**settings) if callable(self.bounds) else self.bounds
        if not isinstance(bounds, Mapping):
            raise InputError(f"must be a dict of claims by name, or a function that returns one; got {bounds!r:.60}", f"{self.name}.bounds")
        if not bounds:
            raise InputError("a case without bounds can not fail", f"{self.name}.bounds")
        return dict(bounds)

    def tier_of(self, settings: Settings) -> Tier:
        """Tier of one cell."""
        return self.tier(**settings) if callable(self.tier) else self.tier

    @property
    def cells(self) -> list[Cell]:
        """All combinations of the grid."""
        names = list(self.grid)
        return [Cell(self, dict(zip(names, values, strict=True))) for values in itertools.product(*self.grid.values())]


@frozen
class Cell:
    """One case at one combination of settings."""

    case: Case
    settings: Settings

    @property
    def label(self) -> str:
        """The settings in one line: ``order=2, family=N``; empty without any."""
        return ", ".join(f"{name}={value}" for name, value in self.settings.items())

    @cached_property
    def name(self) -> str:
        """Case and settings: ``basis/partition_of_unity[order=2]``."""
        return f"{self.case.name}[{self.label}]" if self.settings else self.case.name

    @property
    def tier(self) -> Tier:
        """Tier of the cell."""
        return self.case.tier_of(self.settings)


def case(
    *,
    claim: str,
    bounds: Mapping[str, Claim] | Callable[..., Mapping[str, Claim]],
    tier: Tier | Callable[..., Tier] = "gate",
    grid: Mapping[str, Sequence[Any]] | None = None,
    scene: str | None = None,
    files: Sequence[Path] = (),
) -> Callable[[Callable[..., Mapping[str, Any]]], Case]:
    """Make a verification case of a measuring function; see `Case` for the arguments.

    Raises
    ------
    InputError
        The grid does not name the function's arguments, a value of it that JSON can not hold, a tier or bound that is none.
    """

    def decorate(function: Callable[..., Mapping[str, Any]]) -> Case:
        made = Case(function, claim, bounds, tier, grid or {}, scene, tuple(Path(f) for f in files))
        _check(made)
        return made

    return decorate


def measured(*, claim: str, bounds: Mapping[str, Claim], files: Sequence[Path] = ()) -> Callable[[Callable[..., Mapping[str, Any]]], Case]:
    """Make a case of a function that measures a run of a study: it has no cells of its own, its settings are the study's to give."""

    def decorate(function: Callable[..., Mapping[str, Any]]) -> Case:
        return Case(function, claim, bounds, "weekly", dict.fromkeys(inspect.signature(function).parameters, ()), None, tuple(files))

    return decorate


def _check(made: Case) -> None:
    arguments = set(inspect.signature(made.function).parameters)
    if set(made.grid) != arguments:
        raise InputError(f"names {sorted(made.grid)}; the function takes {sorted(arguments)}", f"{made.name}.grid")
    if not made.claim.strip():
        raise InputError("is empty", f"{made.name}.claim")
    for name, values in made.grid.items():
        if not values or not all(isinstance(value, str | int | float | bool) for value in values):
            raise InputError("must be a list of numbers or strings, not empty", f"{made.name}.grid.{name}")
        if len({str(value) for value in values}) < len(values):
            raise InputError(f"holds a value twice: {list(values)}", f"{made.name}.grid.{name}")
    for cell in made.cells:
        if cell.tier not in TIERS:
            raise InputError(f"is {cell.tier!r}; allowed: {', '.join(TIERS)}", f"{cell.name}.tier")
        claims = made.bounds_of(cell.settings)
        if all(isinstance(claimed, Shown) for claimed in claims.values()):
            raise InputError("a case of which everything is only Shown can not fail", f"{cell.name}.bounds")
        for name, claimed in claims.items():
            if not isinstance(claimed, Claim):
                raise InputError(f"is {claimed!r}; allowed: Bound, Order, Matches, Shown", f"{cell.name}.bounds.{name}")
