"""The paper's Section 4.3: the twisting moment."""

from __future__ import annotations

import numpy as np
from paper.measures import deviation, mean, rms_second_difference
from paper.outcome import Outcome
from paper.statements import Evidence, Statement, each, ratio, successive

from isomortar.harness.statement import Values


def _turning(outcome: Outcome) -> np.ndarray:
    """Whether a load step is of the twisting stage."""
    return outcome.array("stage") == outcome.array("stage")[-1]


def _pressing(outcome: Outcome) -> float:
    """Largest distance of the pressing force from its mean over the twisting stage."""
    force = outcome.array("force")[_turning(outcome), 2]
    return float(np.abs(force / force.mean() - 1.0).max())


def _before(outcome: Outcome) -> float:
    """Tractions at the end of compression over those at the end of twisting."""
    traction, turning = outcome.array("traction_norm"), _turning(outcome)
    return float(traction[~turning][-1] / traction[turning][-1])


def _range(outcome: Outcome) -> float:
    moment = outcome.curve[outcome.window]
    return float(np.ptp(moment)) / abs(mean(outcome))


def _ended(runs: Evidence, *keys: str) -> Values:
    """The share of the load steps to which a run came."""
    return {o.key: o.steps / o.total_steps for key in keys for o in runs.all(key)}


def _variant(name: str) -> Statement:
    words = {
        "ten-points": "Ten contact points a direction in place of six",
        "more-steps": "More load steps, 15 normal and 60 tangential,",
        "tolerance": "A tolerance of 0.001",
    }
    return Statement(
        "4.3",
        f"{words[name]} {'matches' if name == 'tolerance' else 'match'} the default response.",
        ("twist-N2", f"twist-{name}"),
        lambda runs: {f"N2 against {name}": deviation(runs.run("twist-N2"), runs.run(f"twist-{name}"))},
        "L2 deviation of the twisting moment",
        at_most=0.01,
        reason="“match”, “only negligible changes”: within 1 %",
        methods=("paper",),
        percent=True,
    )


STATEMENTS = (
    Statement(
        "4.3",
        "The contact pressure remains approximately constant throughout the twisting stage.",
        ("twist-N",),
        lambda runs: each(runs.series("twist-N"), _pressing),
        "largest distance of the pressing force from its mean",
        at_most=0.1,
        reason="“approximately constant”: within 10 %",
        percent=True,
    ),
    Statement(
        "4.3",
        "Tractions are low at the end of compression, the materials being similar, and evolve considerably in twisting.",
        ("twist-N",),
        lambda runs: each(runs.series("twist-N"), _before),
        "rms traction at the end of compression, over that at the end of twisting",
        at_most=1 / 3,
        reason="“low-valued”: at most a third",
        percent=True,
    ),
    Statement(
        "4.3",
        "Closest points on Lagrange masters need a special treatment to converge.",
        ("twist-L1", "twist-L2"),
        lambda runs: _ended(runs, "twist-L1", "twist-L2"),
        "share of the load steps that converge",
        at_most=0.999,
        reason="“required to achieve convergence”: without one of its own no such run comes to its end",
        percent=True,
    ),
    Statement(
        "4.3",
        "Such a treatment is not necessary with NURBS.",
        ("twist-N",),
        lambda runs: _ended(runs, "twist-N"),
        "share of the load steps that converge",
        at_least=1.0,
        reason="“not necessary”: all come to their end",
        percent=True,
    ),
    Statement(
        "4.3",
        "The twisting moment is not constant, master and slave being of comparable size.",
        ("twist-N",),
        lambda runs: each(runs.series("twist-N"), _range),
        "range of the moment over its mean",
        at_least=0.01,
        reason="“will not be a constant”: a range that a plot shows, above 1 %",
        percent=True,
    ),
    Statement(
        "4.3",
        "The twisting moment gets smoother as the order increases.",
        ("twist-N",),
        lambda runs: successive(runs.series("twist-N"), rms_second_difference),
        "rms second difference, over that of the order before",
        at_most=1.0,
        reason="“smoother”: below 1",
    ),
    Statement(
        "4.3",
        "The twisting moment approaches the reference as the order increases.",
        ("twist-N", "twist-reference"),
        lambda runs: successive(runs.series("twist-N"), lambda o: deviation(o, runs.run("twist-reference"))),
        "L2 deviation from the reference, over that of the order before",
        at_most=1.0,
        reason="“approach”: below 1",
    ),
    Statement(
        "4.3",
        "With the same number of control points N4 with three elements evolves similarly to N2 with five.",
        ("twist-coarse", "twist-N2"),
        lambda runs: {"N4 against N2": deviation(runs.run("twist-coarse"), runs.run("twist-N2"))},
        "L2 deviation of the twisting moment",
        at_most=0.05,
        reason="“similar”: within 5 %",
        percent=True,
    ),
    Statement(
        "4.3",
        "With the same number of control points N4 delivers a slightly smoother response than N2.",
        ("twist-coarse", "twist-N2"),
        lambda runs: ratio(runs.run("twist-coarse"), runs.run("twist-N2"), rms_second_difference),
        "rms second difference, over that of N2",
        at_most=1.0,
        reason="“slightly smoother”: below 1",
    ),
    Statement(
        "4.3",
        "The fine N2 and the standard N5 are both close to the reference.",
        ("twist-fine", "twist-N5", "twist-reference"),
        lambda runs: each([runs.run("twist-fine"), runs.run("twist-N5")], lambda o: deviation(o, runs.run("twist-reference"))),
        "L2 deviation from the reference",
        at_most=0.02,
        reason="“close”: within 2 %",
        percent=True,
    ),
    Statement(
        "4.3",
        "The fine N2 is slightly more oscillatory than the standard N5.",
        ("twist-fine", "twist-N5"),
        lambda runs: ratio(runs.run("twist-fine"), runs.run("twist-N5"), rms_second_difference),
        "rms second difference, over that of N5",
        at_least=1.0,
        reason="“slightly more oscillatory”: above 1",
    ),
    *map(_variant, ("ten-points", "more-steps", "tolerance")),
)
