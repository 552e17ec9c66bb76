"""The paper's Section 4.2: pressure and tangential traction over the contact zone of the pressed block."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from paper.fields import Fields, fields
from paper.measures import excess_variation, field_deviation, negative_share
from paper.outcome import Outcome
from paper.statements import Evidence, Statement, each, successive

from isomortar.harness.statement import Values

NON_NEGATIVE = 1e-8
_SOLVED = "“non-negative” up to what the solution is solved to: the complementarity tolerance 1e-8"
_VISIBLE = "what is seen in a surface plot: 1 % of the peak"


def _last(outcome: Outcome) -> Fields:
    return fields(outcome, int(outcome.numbers["step"][-1]))


def _oscillation(runs: Evidence, series: str, reference: str) -> Values:
    truth = _last(runs.run(reference)).pressure
    return each(runs.series(series), lambda o: excess_variation(_last(o).pressure, truth))


def _growth(runs: Evidence) -> Values:
    """Differences from order to order: excess variations may be below zero, so that quotients say nothing."""
    found = list(_oscillation(runs, "press-L", "press-L1-fine").items())
    return {f"{b} - {a}": y - x for (a, x), (b, y) in pairwise(found)}


def _pressure_error(runs: Evidence) -> Values:
    truth = _last(runs.run("press-reference"))
    return successive(runs.series("press-N"), lambda o: field_deviation(_last(o).pressure, truth.pressure, truth.areas))


def _traction_error(runs: Evidence, series: str, reference: str) -> Values:
    truth = _last(runs.run(reference))
    return each(runs.series(series), lambda o: field_deviation(_last(o).traction, truth.traction, truth.areas))


def _deterioration(runs: Evidence) -> Values:
    worst = float(np.max(list(_traction_error(runs, "press-N", "press-reference").values())))
    return {name: error / worst for name, error in _traction_error(runs, "press-L>1", "press-L1-fine").items()}


def _tolerance(runs: Evidence) -> Values:
    loose, tight = _last(runs.run("press-N2")), _last(runs.run("press-tolerance"))
    return {
        "pressure": field_deviation(loose.pressure, tight.pressure, tight.areas),
        "traction": field_deviation(loose.traction, tight.traction, tight.areas),
    }


STATEMENTS = (
    Statement(
        "4.2",
        "The gap within the contact zone is of order 10⁻³ of the body's width, 1.",
        ("press-reference",),
        lambda runs: each([runs.run("press-reference")], lambda o: _last(o).zone_height),
        "largest distance of slave surface and plane in the contact zone",
        at_most=10**-2.5,
        reason="“of order 10⁻³”: nearer to 10⁻³ than to 10⁻², below 10^-2.5",
    ),
    Statement(
        "4.2",
        "The changes are negligible when the tolerance is decreased to 0.001.",
        ("press-N2", "press-tolerance"),
        _tolerance,
        "L2 deviation of the fields",
        at_most=0.01,
        reason="“negligible”: at most 1 %",
        methods=("paper",),
        percent=True,
    ),
    Statement(
        "4.2",
        "NURBS deliver a pressure distribution that is nowhere negative.",
        ("press-N",),
        lambda runs: each(runs.series("press-N"), negative_share),
        "most negative field pressure over the peak",
        at_most=NON_NEGATIVE,
        reason=_SOLVED,
        percent=True,
    ),
    Statement(
        "4.2",
        "Increasing the order of NURBS does not deteriorate the pressure.",
        ("press-N", "press-reference"),
        _pressure_error,
        "L2 deviation from the reference, over that of the order before",
        at_most=1.05,
        reason="“does not deteriorate”: not above 1, and 5 % for what surface plots do not show",
    ),
    Statement(
        "4.2",
        "Pressures of NURBS remain minimally oscillatory even at this coarse discretization.",
        ("press-N", "press-reference"),
        lambda runs: _oscillation(runs, "press-N", "press-reference"),
        "total variation of the pressure beyond that of the reference",
        at_most=0.05,
        reason="“minimally”: at most 5 % more up and down than the reference, less than a plot shows",
        percent=True,
    ),
    Statement(
        "4.2",
        "With Lagrange elements of order above 1 the pressure is negative in places.",
        ("press-L>1",),
        lambda runs: each(runs.series("press-L>1"), negative_share),
        "most negative field pressure over the peak",
        at_least=0.01,
        reason=f"grey zones of Fig. 2; {_VISIBLE}",
        percent=True,
    ),
    Statement(
        "4.2",
        "With Lagrange elements increasing the order deteriorates the pressure: it oscillates more.",
        ("press-L", "press-L1-fine"),
        _growth,
        "total variation beyond that of the reference, less that of the order before",
        at_least=0.0,
        reason="“deteriorates”: more than at the order before",
        percent=True,
    ),
    Statement(
        "4.2",
        "Tangential tractions of NURBS match the reference accurately.",
        ("press-N", "press-reference"),
        lambda runs: _traction_error(runs, "press-N", "press-reference"),
        "L2 deviation of the first traction component from the reference",
        at_most=0.05,
        reason="“accurately” in surface plots: within 5 % in L2, which is what an eye sees there",
        percent=True,
    ),
    Statement(
        "4.2",
        "Tangential tractions deteriorate significantly with Lagrange elements of order above 1.",
        ("press-N", "press-L>1", "press-reference", "press-L1-fine"),
        _deterioration,
        "L2 deviation of the first traction component from the reference, over the largest of NURBS",
        at_least=2.0,
        reason="“significantly”: at least twice",
    ),
    Statement(
        "4.2",
        "L1 is the most robust of the Lagrange elements.",
        ("press-L", "press-L1-fine"),
        lambda runs: _least(_oscillation(runs, "press-L", "press-L1-fine")),
        "total variation beyond that of the reference, less that of L1",
        at_least=0.0,
        reason="“the most robust”: no other oscillates less",
        percent=True,
    ),
)


def _least(oscillation: Values) -> Values:
    if "L1" not in oscillation:
        return {}
    return {name: value - oscillation["L1"] for name, value in oscillation.items() if name != "L1"}
