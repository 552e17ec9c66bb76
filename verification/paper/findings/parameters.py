"""The paper's Section 4.1: penalties, augmentation tolerance, load steps."""

from __future__ import annotations

from paper.measures import deviation
from paper.outcome import Outcome
from paper.statements import Evidence, Statement, ratio

from isomortar.harness.statement import Values

_SECTIONS = ("press", "twist", "iron", "tire")


def _tolerance(runs: Evidence) -> Values:
    return {scene: deviation(runs.run(f"{scene}-N2"), runs.run(f"{scene}-tolerance")) for scene in ("press", "twist")}


def _below(runs: Evidence) -> Values:
    return {"0.001 against 0.0001": deviation(runs.run("twist-tolerance"), runs.run("twist-tight"))}


def _soft(runs: Evidence) -> Values:
    return ratio(runs.run("twist-soft"), runs.run("twist-N2"), lambda o: deviation(o, runs.run("twist-tight")))


def _augmentations(outcome: Outcome) -> float:
    return float(outcome.numbers["augmentations"])


def _effort(runs: Evidence) -> Values:
    return ratio(runs.run("twist-soft-tolerance"), runs.run("twist-tolerance"), _augmentations)


def _cuts(runs: Evidence) -> Values:
    """Of NURBS, and of the Lagrange elements that the paper ran; those of a run that failed are not known and count as one more."""
    found = [o for scene in _SECTIONS for o in [*runs.all(f"{scene}-N"), *(runs.all(f"{scene}-L") if scene in ("press", "tire") else [])]]
    cuts = sum((o.numbers["cuts"] if o.numbers else 0) + bool(o.failure) for o in found)
    return {f"{cuts:g} cuts in {sum(o.steps for o in found)} load steps": cuts / max(1, sum(o.steps for o in found))}


def _larger_steps(runs: Evidence) -> Values:
    """Cuts of the runs in half as many load steps; of one that failed they are not known and count as one more."""
    found = [outcome for scene in ("twist", "iron") for outcome in runs.all(f"{scene}-fewer-steps")]
    return {o.section.scene: float((o.numbers["cuts"] if o.numbers else 0) + bool(o.failure)) for o in found}


def _step_error(runs: Evidence) -> Values:
    return ratio(runs.run("twist-fewer-steps"), runs.run("twist-N2"), lambda o: deviation(o, runs.run("twist-more-steps")))


STATEMENTS = (
    Statement(
        "4.1",
        "With the base penalties tolerance 0.01 is quantitatively in very good agreement with 0.001.",
        ("press-N2", "press-tolerance", "twist-N2", "twist-tolerance"),
        _tolerance,
        "L2 deviation of the curve",
        at_most=0.01,
        reason="“very good agreement”: within 1 %",
        methods=("paper",),
        percent=True,
    ),
    Statement(
        "4.1",
        "Below tolerance 0.001 only negligible changes are observed, if any.",
        ("twist-tolerance", "twist-tight"),
        _below,
        "L2 deviation of the twisting moment",
        at_most=0.01,
        reason="“negligible”: at most 1 %",
        methods=("paper",),
        percent=True,
    ),
    Statement(
        "4.1",
        "Base penalties 10 and 1 deliver inferior results at tolerance 0.01.",
        ("twist-soft", "twist-N2", "twist-tight"),
        _soft,
        "deviation of the twisting moment from tolerance 0.0001, over that of penalties 100 and 10",
        at_least=1.0,
        reason="“inferior”: a larger error",
        methods=("paper",),
    ),
    Statement(
        "4.1",
        "With base penalties 10 and 1 the number of iterations is larger for the high quality that needs tolerance 0.001.",
        ("twist-soft-tolerance", "twist-tolerance"),
        _effort,
        "augmentations, over those of penalties 100 and 10",
        at_least=1.0,
        reason="“larger”: above 1",
        methods=("paper",),
    ),
    Statement(
        "4.1",
        "A reduction of the load step size was needed only a few times overall.",
        (*(f"{scene}-N" for scene in _SECTIONS), "press-L", "tire-L"),
        _cuts,
        "cuts over load steps",
        at_most=0.01,
        reason="“a few times overall” in the paper's hundreds of load steps: at most one in a hundred",
        percent=True,
    ),
    Statement(
        "4.1",
        "In many instances larger load steps could be taken.",
        ("twist-fewer-steps", "iron-fewer-steps"),
        _larger_steps,
        "cuts in half as many load steps",
        at_most=0.0,
        reason="“could be taken”: with no cut",
        methods=("paper",),
    ),
    Statement(
        "4.1",
        "Larger load steps would introduce an error, by the update of the tangential traction.",
        ("twist-fewer-steps", "twist-N2", "twist-more-steps"),
        _step_error,
        "deviation of the twisting moment from that of more load steps, over that of the standard ones",
        at_least=1.0,
        reason="“introduce an error”: a larger one",
        methods=("paper",),
    ),
)
