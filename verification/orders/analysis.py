"""From the runs of a plan to errors, smoothness, verdicts, and what raising the order buys against more elements."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from orders.plan import Plan

from isomortar.accuracy.discretisations import Discretisation, parse_kind
from isomortar.accuracy.measures import curve_error, expected_order, reference_uncertainty, relative_error, roughness
from isomortar.geometry.patch import FloatArray
from isomortar.harness.measurement import Measurement
from isomortar.harness.orders import Convergence, OrderEstimate, estimate_order

CURVES, FIELDS = ("force", "moment"), ("pressure", "displacement")
#: Moments below this share of force times size of the swept body are round-off; so are changes of all else from mesh to mesh.
NOTHING = 1e-6


@dataclass(frozen=True)
class Point:
    """A run: its numbers (none where it failed, for the reason given), errors and roughness by measure.

    Errors are relative to the reference; `roughness` is the second-difference energy over that of the reference, where that has any.
    `floor` names the measures whose error is not above the reference's uncertainty.
    """

    discretisation: Discretisation
    numbers: Mapping[str, Any]
    failure: str
    errors: dict[str, float] = field(default_factory=dict)
    roughness: dict[str, float] = field(default_factory=dict)
    floor: tuple[str, ...] = ()

    @property
    def unknowns(self) -> int:
        """Three a control point."""
        return 3 * int(self.numbers["control_points"])


@dataclass(frozen=True)
class Step:
    """Refinement from one run to another (`way` h: more elements, k: higher order): what multiplies cost and roughness, divides errors.

    Where the error after it is at the floor, the quotient is a lower bound and the measure is in `at_least`.
    """

    way: str
    start: Discretisation
    end: Discretisation
    unknowns: float
    cpu: float
    tangents: float
    roughness: dict[str, float]
    gains: dict[str, float]
    at_least: tuple[str, ...]


@dataclass(frozen=True)
class Analysis:
    """All that the report shows.

    `points`: all runs by discretisation, in the order of the plan. `uncertainty` of the reference by measure. `verdicts` by kind and
    measure. `steps`: k- against h-refinement.
    """

    plan: Plan
    measures: tuple[str, ...]
    points: dict[Discretisation, Point]
    uncertainty: dict[str, float]
    verdicts: dict[str, dict[str, OrderEstimate]]
    steps: tuple[Step, ...]

    @property
    def reference(self) -> Point:
        """The run that errors are against."""
        return self.points[self.plan.reference[-1]]

    @property
    def failed(self) -> list[Point]:
        """Runs that did not come to their end."""
        return [point for point in self.points.values() if point.failure]

    @property
    def curves(self) -> tuple[str, ...]:
        """The measures that are curves."""
        return tuple(m for m in self.measures if m in CURVES)

    @property
    def rough(self) -> tuple[str, ...]:
        """The curves whose roughness is told: stages of two load steps have none."""
        return tuple(m for m in self.curves if m in self.reference.roughness)

    def sequence(self, kind: str) -> list[Point]:
        """The runs of a kind that came to their end, coarsest first."""
        points = [self.points[mesh] for mesh in self.plan.meshes(kind)]
        return [point for point in points if not point.failure]


def analyse(plan: Plan, measurements: Mapping[Discretisation, Measurement]) -> Analysis:
    """Compare all runs of a plan with its reference.

    Parameters
    ----------
    plan : Plan
    measurements : dict
        Of every discretisation of `plan.runs`.
    """
    runs = {chosen: _point(chosen, measurements[chosen]) for chosen in plan.runs}
    comparison = _Comparison(plan, runs[plan.reference[-1]].numbers)
    uncertainty = {measure: _uncertainty(plan, runs, comparison, measure) for measure in comparison.measures}
    points = {chosen: comparison.compared(run, uncertainty) for chosen, run in runs.items()}
    partial = Analysis(plan, comparison.measures, points, uncertainty, {}, ())
    verdicts = {kind: {m: _verdict(partial, kind, m) for m in partial.measures} for kind in plan.kinds}
    return Analysis(plan, partial.measures, points, uncertainty, verdicts, tuple(_steps(partial)))


def curve(numbers: Mapping[str, Any], measure: str) -> FloatArray:
    """Force or moment of all moving supports, shape (steps, 3 * supports)."""
    by_support = np.asarray(numbers[measure], float)
    return np.moveaxis(by_support, 0, 1).reshape(by_support.shape[1], -1)


class _Comparison:
    """Compares runs with a reference in the measures that mean something for it."""

    def __init__(self, plan: Plan, reference: Mapping[str, Any]) -> None:
        self._reference = reference
        areas, volumes = (grid.weights for grid in plan.grids())
        self._weights = {"pressure": areas, "displacement": volumes}
        size = float(np.cbrt(volumes.sum()))
        self.measures = tuple(m for m in (*CURVES, *FIELDS) if _means_something(reference, m, size))

    def distance(self, measure: str, numbers: Mapping[str, Any], other: Mapping[str, Any]) -> float:
        """Error of a run against another one."""
        if measure in CURVES:
            return curve_error(*_from_rest(numbers, measure), *_from_rest(other, measure))
        return relative_error(numbers[measure], other[measure], self._weights[measure])

    def compared(self, run: Point, uncertainty: Mapping[str, float]) -> Point:
        """The run with its errors."""
        if run.failure or not self._reference:
            return run
        errors = {m: self.distance(m, run.numbers, self._reference) for m in self.measures}
        rough = {m: self._roughness(self._reference, m) for m in self.measures if m in CURVES}
        ratios = {m: self._roughness(run.numbers, m) / of_reference for m, of_reference in rough.items() if math.isfinite(of_reference)}
        floor = tuple(m for m in self.measures if not errors[m] > uncertainty[m])
        return Point(run.discretisation, run.numbers, "", errors, ratios, floor)

    @staticmethod
    def _roughness(numbers: Mapping[str, Any], measure: str) -> float:
        return roughness(numbers["time"], curve(numbers, measure), numbers["stage"]) or math.nan


def _from_rest(numbers: Mapping[str, Any], measure: str) -> tuple[FloatArray, FloatArray]:
    """Load times and values of a curve, from rest on: one load step is a curve, too."""
    values = curve(numbers, measure)
    return np.append(0.0, numbers["time"]), np.vstack([np.zeros_like(values[:1]), values])


def _point(chosen: Discretisation, measurement: Measurement) -> Point:
    if measurement.ending == "measured":
        broken = [name for name, value in measurement.numbers.items() if not np.isfinite(np.asarray(value, float)).all()]
        return Point(chosen, {}, f"not finite: {', '.join(broken)}") if broken else Point(chosen, measurement.numbers, "")
    return Point(chosen, {}, measurement.reason)


def _means_something(reference: Mapping[str, Any], measure: str, size: float) -> bool:
    if not reference:
        return True
    largest = float(np.abs(np.asarray(reference[measure], float)).max())
    return largest > (NOTHING * size * float(np.abs(np.asarray(reference["force"], float)).max()) if measure == "moment" else 0.0)


def _uncertainty(plan: Plan, runs: Mapping[Discretisation, Point], comparison: _Comparison, measure: str) -> float:
    """Of the reference, by two refinements of it: at least what the last one changed, as meshes agree by chance."""
    coarse, medium, fine = (runs[chosen] for chosen in plan.reference)
    if coarse.failure or medium.failure or fine.failure:
        return math.inf
    first, second = (comparison.distance(measure, a.numbers, b.numbers) for a, b in ((coarse, medium), (medium, fine)))
    if first < NOTHING and second < NOTHING:
        return first + second
    series = reference_uncertainty(first, second, expected_order(measure, parse_kind(plan.sweep.reference)[1], plan.slave_refined))
    return float(np.fmax(second, series))


def _verdict(analysis: Analysis, kind: str, measure: str) -> OrderEstimate:
    """The order that a kind shows in a measure."""
    points = [p for p in analysis.sequence(kind) if p.errors]
    worth = analysis.uncertainty[measure]
    if not math.isfinite(worth):
        return OrderEstimate(math.nan, math.nan, math.nan, (), "at the floor", "the reference does not tell its own error")
    sizes = [analysis.plan.size(p.discretisation) for p in points]
    convergence = Convergence(sizes, [p.errors[measure] for p in points], {"reference": worth})
    return estimate_order(convergence, expected_order(measure, parse_kind(kind)[1], analysis.plan.slave_refined))


def _steps(analysis: Analysis) -> list[Step]:
    """From the second coarsest mesh of the lowest NURBS order above 1: finer meshes, and higher orders on the same mesh."""
    nurbs = sorted((order, kind) for kind in analysis.plan.kinds for family, order in (parse_kind(kind),) if family == "N" and order > 1)
    if not nurbs:
        return []
    kind = nurbs[0][1]
    meshes = analysis.plan.meshes(kind)
    ways = [("h", mesh) for mesh in meshes[2:]] + [("k", Discretisation(other, meshes[1].elements)) for _, other in nurbs[1:]]
    start = analysis.points[meshes[1]]
    found = [(way, analysis.points.get(end)) for way, end in ways]
    return [_step(analysis, way, start, end) for way, end in found if end and start.errors and end.errors]


def _step(analysis: Analysis, way: str, start: Point, end: Point) -> Step:
    resolved = [m for m in analysis.measures if m not in start.floor]
    left = {m: max(end.errors[m], analysis.uncertainty[m]) for m in resolved}
    return Step(
        way,
        start.discretisation,
        end.discretisation,
        end.unknowns / start.unknowns,
        end.numbers["cpu_seconds"] / start.numbers["cpu_seconds"],
        end.numbers["tangents"] / start.numbers["tangents"],
        {m: end.roughness[m] / start.roughness[m] for m in analysis.rough},
        {m: start.errors[m] / left[m] if left[m] else math.inf for m in resolved},
        tuple(m for m in resolved if m in end.floor),
    )
