"""The paper's Section 5: what holds in all sections."""

from __future__ import annotations

import numpy as np
from paper.findings.press import NON_NEGATIVE
from paper.measures import negative_share
from paper.statements import Evidence, Statement

from isomortar.harness.statement import Values

_SECTIONS = ("press", "twist", "iron", "tire")


def _negative(runs: Evidence) -> Values:
    return {scene: float(np.max([negative_share(o) for o in runs.series(f"{scene}-N")])) for scene in _SECTIONS}


STATEMENTS = (
    Statement(
        "5",
        "The pressure of NURBS is guaranteed to be non-negative, in all studies and at all load steps.",
        tuple(f"{scene}-N" for scene in _SECTIONS),
        _negative,
        "most negative field pressure over the peak, worst order",
        at_most=NON_NEGATIVE,
        reason="“guaranteed”: up to the complementarity tolerance 1e-8",
        percent=True,
    ),
)
