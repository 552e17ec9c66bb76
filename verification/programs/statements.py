"""What is stated of the programs: every limit follows from what it speaks of, none from what came out."""

from __future__ import annotations

import numpy as np
from programs.found import STAGES, Evidence
from programs.run import PROGRAMS

from isomortar.geometry.patch import FloatArray
from isomortar.harness.statement import Statement, Values

OWN, *OTHERS = PROGRAMS


def _missing(evidence: Evidence) -> Values:
    return {run.name: float(run.missing) for run in evidence.by(evidence.method)}


def _out_of_balance(evidence: Evidence) -> Values:
    found = {run.name: run.forces for run in evidence.by(evidence.method) if len(run.forces)}
    return {name: _over(forces.sum(axis=1), forces) for name, forces in found.items()}


def _beside_the_mesh(evidence: Evidence, stage: str) -> Values:
    return {name: _over(other["fine"] - own["fine"], own["fine"] - own["coarse"]) for name, own, other in evidence.compared(stage)}


def _share_left(evidence: Evidence) -> Values:
    return {
        f"{name} {stage}": _over(other["fine"] - own["fine"], other["coarse"] - own["coarse"])
        for stage in STAGES
        for name, own, other in evidence.compared(stage)
    }


def _over(values: FloatArray, others: FloatArray) -> float:
    """The largest of some values over that of others; nothing is zero times anything."""
    largest, other = (float(np.abs(array).max()) for array in (values, others))
    return largest / other if other else np.inf if largest else 0.0


_MESH = (
    "discretisation: halving the elements changes isomortar's own curve by as much, so that neither can be said to be nearer to the truth"
)

STATEMENTS: tuple[Statement[Evidence], ...] = (
    Statement(
        "ending",
        "Every load step of every run converges.",
        (),
        _missing,
        "load steps that are missing",
        at_most=0.0,
        reason="definition: a program that stops has not computed the problem",
        methods=tuple(PROGRAMS),
    ),
    Statement(
        "balance",
        "The forces on the supports are in balance at every load step.",
        (),
        _out_of_balance,
        "sum of the forces of all supports, over the largest of them",
        at_most=1e-6,
        reason="theory: action and reaction, whatever the elements; Newton's method to 1e-9, seven digits in CalculiX' files",
        methods=tuple(PROGRAMS),
    ),
    Statement(
        "pressed",
        "Pressed, a program finds the force that isomortar finds on the same elements, to within what the elements leave open.",
        (),
        lambda evidence: _beside_the_mesh(evidence, "pressed"),
        "largest difference of the pressing forces on the fine elements, over what these change from the coarse ones by isomortar",
        at_most=1.0,
        reason=_MESH,
        methods=tuple(OTHERS),
    ),
    Statement(
        "dragged",
        "Dragged, it finds the same force along the drag, to within the same.",
        (),
        lambda evidence: _beside_the_mesh(evidence, "dragged"),
        "largest difference of the dragging forces on the fine elements, over what these change from the coarse ones by isomortar",
        at_most=1.0,
        reason=_MESH,
        methods=tuple(OTHERS),
    ),
    Statement(
        "refined",
        "Finer elements bring the programs nearer to each other.",
        (),
        _share_left,
        "largest difference of the forces on the fine elements, over that on the coarse ones",
        at_most=1.0,
        reason="theory: all of them converge to the solution of the same problem, apart from CalculiX' penalty",
        methods=tuple(OTHERS),
    ),
)
