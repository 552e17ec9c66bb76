"""The paper's Section 4.4: the dragging force."""

from __future__ import annotations

import numpy as np
from paper.fields import fields
from paper.measures import cycles, mean, ripple, rms_second_difference
from paper.outcome import Outcome
from paper.statements import Evidence, Statement, each, ratio, successive

from isomortar.harness.statement import Values


def _relative(outcome: Outcome) -> float:
    return ripple(outcome) / abs(mean(outcome))


def _leading(outcome: Outcome) -> float:
    """Smallest place of the pressure's peak along the drag within the window, 0: trailing edge, 1: leading edge."""
    return float(np.min([fields(outcome, int(step)).peak[0] for step in outcome.array("step")[outcome.window]]))


def _sideways(outcome: Outcome) -> float:
    """Tractions across the drag when a quarter of it is done, over those at the end of compression."""
    across, pressed = outcome.array("traction")[:, 1], outcome.array("stage") == 0
    return float(across[outcome.window.start] / across[pressed][-1])


def _control_points(runs: Evidence) -> Values:
    fewest = runs.run("iron-reference").numbers["control_points"]
    return {name: float(runs.run(f"iron-{name}").numbers["control_points"] - fewest) for name in ("A", "B")}


STATEMENTS = (
    Statement(
        "4.4",
        "High pressures are near the leading edge during dragging.",
        ("iron-N",),
        lambda runs: each(runs.series("iron-N"), _leading),
        "smallest place of the peak over the window, 0: trailing edge, 1: leading edge",
        at_least=0.5,
        reason="“near the leading edge”: in the leading half at every load step",
    ),
    Statement(
        "4.4",
        "Tractions across the drag relax rapidly to zero during dragging.",
        ("iron-N",),
        lambda runs: each(runs.series("iron-N"), _sideways),
        "their rms when a quarter of the drag is done, over that at the end of compression",
        at_most=0.1,
        reason="“rapidly”: within a quarter of the drag; “to zero”: a tenth, which looks flat in Fig. 8",
        percent=True,
    ),
    Statement(
        "4.4",
        "C1 continuity is not sufficient for a smooth response: the dragging force of N2 oscillates visibly.",
        ("iron-N2",),
        lambda runs: each([runs.run("iron-N2")], _relative),
        "standard deviation of the force without its cubic trend, over its mean",
        at_least=0.01,
        reason="“easily observed”: above 1 % of the force",
        percent=True,
    ),
    Statement(
        "4.4",
        "The dragging force gets smoother as the order increases.",
        ("iron-N",),
        lambda runs: successive(runs.series("iron-N"), rms_second_difference),
        "rms second difference, over that of the order before",
        at_most=1.0,
        reason="“smoother”: below 1",
    ),
    Statement(
        "4.4",
        "Both refined N2 (A: 840, B: 1015 control points) have more degrees of freedom than N5 (770).",
        ("iron-A", "iron-B", "iron-reference"),
        _control_points,
        "control points more than N5",
        at_least=1.0,
        reason="“more”",
    ),
    Statement(
        "4.4",
        "N5 is clearly significantly smoother than the refined N2, with fewer control points.",
        ("iron-A", "iron-B", "iron-reference"),
        lambda runs: {
            name: value
            for run in ("A", "B")
            for name, value in ratio(runs.run(f"iron-{run}"), runs.run("iron-reference"), rms_second_difference).items()
        },
        "rms second difference, over that of N5",
        at_least=2.0,
        reason="“clearly significantly”: at least twice",
    ),
    Statement(
        "4.4",
        "With a finer resolution the oscillations have a larger frequency.",
        ("iron-refined",),
        lambda runs: successive(runs.series("iron-refined"), lambda o: float(cycles(o))),
        "periods of the strongest harmonic, over those of the coarser mesh",
        at_least=1.05,
        reason="“larger”: above 1",
    ),
    Statement(
        "4.4",
        "With a finer resolution the oscillations have a smaller amplitude.",
        ("iron-refined",),
        lambda runs: successive(runs.series("iron-refined"), ripple),
        "standard deviation of the force without its cubic trend, over that of the coarser mesh",
        at_most=1.0,
        reason="“smaller”: below 1",
    ),
    Statement(
        "4.4",
        "The oscillations decrease with decreasing normal force (C: 0.4, D: 0.3 in place of 0.5).",
        ("iron-N2", "iron-C", "iron-D"),
        lambda runs: successive([runs.run(f"iron-{name}") for name in ("N2", "C", "D")], ripple),
        "standard deviation of the force without its cubic trend, over that at the larger force",
        at_most=1.0,
        reason="“decreases”: below 1",
    ),
    Statement(
        "4.4",
        "The oscillations remain at lower pressures, and their relative amplitude may be significant.",
        ("iron-C", "iron-D"),
        lambda runs: each([runs.run("iron-C"), runs.run("iron-D")], _relative),
        "standard deviation of the force without its cubic trend, over its mean",
        at_least=0.01,
        reason="“may be significant”: above 1 % of the force, as for the standard one",
        percent=True,
    ),
)
