"""The paper's Section 4.5: the torque of the rolling tire."""

from __future__ import annotations

import numpy as np
from paper.fields import Fields, fields
from paper.measures import deviation, mean, ripple
from paper.outcome import Outcome
from paper.statements import Evidence, Statement, each, ratio, successive

from isomortar.harness.statement import Values

#: Degrees that a C0 line is from the lowest point while it counts as being there.
_AT_JOINT = 9.0
#: Rolling is steady from here on, in degrees.
_STEADY = 45.0


def _midway(outcome: Outcome) -> Fields:
    """Contact fields half way through the last stage."""
    last = outcome.array("stage") == outcome.array("stage")[-1]
    nearest = np.argmin(np.where(last, np.abs(outcome.array("share") - 0.5), np.inf))
    return fields(outcome, int(outcome.array("step")[nearest]))


def _similar(runs: Evidence) -> Values:
    found = list(each(runs.series("tire-N"), ripple).values())
    return {"largest / smallest": float(np.max(found) / np.min(found))}


def _strongly(runs: Evidence, series: str) -> Values:
    first, *_, last = runs.all(series)
    return ratio(runs.run(last.key), runs.run(first.key), ripple)


def _closer(runs: Evidence) -> Values:
    """In the mean, with as many control points as the next order of NURBS against as many nodes."""
    truth = mean(runs.run("tire-reference"))
    matched = {run.variant.name: run for run in runs.series("tire-matched")}
    pairs = [(run, matched.get(f"{run.variant.name}-matched")) for run in runs.series("tire-L")]
    return {f"{m.variant.name} / {o.variant.name}": abs(mean(m) - truth) / abs(mean(o) - truth) for o, m in pairs if m}


def _at_joints(outcome: Outcome) -> float:
    """Rms second difference of the torque while a C0 line is at the lowest point, over that at all other load steps of steady rolling."""
    rolling = outcome.array("stage") == outcome.array("stage")[-1]
    angle = 270.0 * outcome.array("share")[rolling]
    second = np.diff(outcome.curve[rolling], 2)
    place = np.abs((angle[1:-1] + 45.0) % 90.0 - 45.0)
    steady = angle[1:-1] >= _STEADY
    there, elsewhere = (second[steady & chosen] for chosen in (place <= _AT_JOINT, place > _AT_JOINT))
    return float(np.sqrt((there**2).mean() / (elsewhere**2).mean()))


def _variants(runs: Evidence) -> Values:
    truth = runs.run("tire-L2")
    return {name: deviation(runs.run(f"tire-{name}"), truth) for name in ("L2-tolerance", "L2-points")}


STATEMENTS = (
    Statement(
        "4.5",
        "Ripples in the contact interface are almost non-visible with NURBS.",
        ("tire-N",),
        lambda runs: each(runs.series("tire-N"), lambda o: _midway(o).zone_roughness / 0.5),
        "rms distance of tire and road in the contact zone midway, over the outer radius",
        at_most=0.01,
        reason="“almost non-visible”: below 1 % of the tire's radius",
        percent=True,
    ),
    Statement(
        "4.5",
        "The ripples become amplified for high orders of Lagrange elements.",
        ("tire-L",),
        lambda runs: successive(runs.series("tire-L"), lambda o: _midway(o).zone_roughness),
        "rms distance of tire and road in the contact zone midway, over that of the order before",
        at_least=1.0,
        reason="“amplified”: above 1",
    ),
    Statement(
        "4.5",
        "The oscillations of the torque are similar for all NURBS.",
        ("tire-N",),
        _similar,
        "largest over smallest standard deviation of the torque without its cubic trend",
        at_most=1.5,
        reason="“similar”, so that the paper shows one of them only: within a factor of 1.5",
    ),
    Statement(
        "4.5",
        "The oscillations of the torque increase with every order of Lagrange elements, the number of nodes being the same.",
        ("tire-L",),
        lambda runs: successive(runs.series("tire-L"), ripple),
        "standard deviation of the torque without its cubic trend, over that of the order before",
        at_least=1.0,
        reason="“increase”: above 1",
    ),
    Statement(
        "4.5",
        "That increase is strong.",
        ("tire-L",),
        lambda runs: _strongly(runs, "tire-L"),
        "standard deviation of the torque without its cubic trend, highest order over lowest",
        at_least=2.0,
        reason="“strongly”: at least twice",
    ),
    Statement(
        "4.5",
        "With as many control points as the next order of NURBS, Lagrange elements are closer to the reference in the mean.",
        ("tire-L", "tire-matched", "tire-reference"),
        _closer,
        "distance of the mean torque from the reference's, over that with as many nodes as L1",
        at_most=1.0,
        reason="“closer”: below 1",
    ),
    Statement(
        "4.5",
        "With matched control points the oscillations still increase with the order of Lagrange elements.",
        ("tire-matched",),
        lambda runs: successive(runs.series("tire-matched"), ripple),
        "standard deviation of the torque without its cubic trend, over that of the order before",
        at_least=1.0,
        reason="“still increase”: above 1",
    ),
    Statement(
        "4.5",
        "With matched control points the deviation from the reference still increases with the order of Lagrange elements.",
        ("tire-matched", "tire-reference"),
        lambda runs: successive(runs.series("tire-matched"), lambda o: deviation(o, runs.run("tire-reference"))),
        "L2 deviation from the reference, over that of the order before",
        at_least=1.0,
        reason="“still increase”: above 1",
    ),
    Statement(
        "4.5",
        "The lines of the geometry where NURBS are C0 only are not discernible in the torque.",
        ("tire-N", "tire-N4"),
        lambda runs: each(runs.series("tire-N"), _at_joints),
        "rms second difference of the torque with such a line at the lowest point, over that at other load steps",
        at_most=1.5,
        reason="“not discernible”: not above 1.5 times what is there anyway",
    ),
    Statement(
        "4.5",
        "Decreasing the tolerance or increasing the integration order does not influence the results of Lagrange elements.",
        ("tire-L2", "tire-L2-tolerance", "tire-L2-points"),
        _variants,
        "L2 deviation of the torque",
        at_most=0.01,
        reason="“not to influence”: within 1 %",
        methods=("paper",),
        percent=True,
    ),
)
