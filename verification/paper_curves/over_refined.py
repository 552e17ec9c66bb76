"""The curves that the paper's studies look at, on meshes far finer than the studies' own, and how far off they still are."""

from __future__ import annotations

from typing import Any

import numpy as np
from paper.plans import FULL
from paper.sections import Section, Variant

from isomortar.accuracy.discretisations import Elements
from isomortar.accuracy.measures import expected_order, reference_uncertainty
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, Matches, case
from isomortar.march.simulation import Simulation

#: By study: its highest order that is smooth enough, and three meshes, each twice as fine as the one before in the studied directions.
#: Not the dragging force: its ripples follow the elements that the sharp rim of the slave leaves, and change by 5 % of the force from
#: 10 to 20 and from 20 to 40 elements of order 5 alike, with a slave of 10 x 10 elements of order 3 too.
MESHES: dict[str, tuple[int, tuple[Elements, Elements, Elements]]] = {
    "press": (3, ((6, 6, 6), (12, 12, 6), (24, 24, 6))),
    "twist": (4, ((4, 4, 3), (8, 8, 3), (16, 16, 3))),
    "tire": (3, ((32, 4, 4), (64, 4, 4), (128, 4, 4))),
}
STUDIES = {study.scene: study for study in FULL}
#: By study: another order, a mesh and one twice as fine, and the most that the curve changes from the one to the other.
OTHERS: dict[str, tuple[int, Elements, Elements, float]] = {
    "press": (2, (6, 6, 6), (12, 12, 6), 0.015),
    "twist": (3, (4, 4, 3), (8, 8, 3), 0.06),
}


def computed(study: Section, order: int, elements: Elements) -> FloatArray:
    """The study's quantity after every load step, converged, shape (load steps,)."""
    problem = study.load(Variant("over-refined", f"N{order}", elements, ""), "monolithic").problem()
    moving = next(number for number, s in enumerate(problem.supports) if s.moves)
    component = "xyz".index(study.quantity.component)
    reactions = [step.reactions[moving] for step in Simulation(problem).run()]
    return np.array([getattr(reaction, study.quantity.kind)[component] for reaction in reactions])


@case(
    claim="The curve that a study of the paper looks at has settled, and is what it was.",
    tier="weekly",
    grid={"study": tuple(MESHES)},
    bounds={
        "curve": Matches("paper_curves", "reference: the same run of this program, as it was"),
        "uncertainty": Bound(at_most=0.02, reason="definition: a reference is to be nearer than what is compared with it, 2 % and more"),
    },
)
def settled(study: str) -> dict[str, Any]:
    """The curve on the finest of three meshes, and its distance from that of no end of elements by the two refinements."""
    order, meshes = MESHES[study]
    coarse, medium, fine = (computed(STUDIES[study], order, elements) for elements in meshes)
    first, second = (float(np.abs(b - a).max() / np.abs(fine).max()) for a, b in ((coarse, medium), (medium, fine)))
    best = expected_order("force", order, slave_refined=study in ("press", "tire"))
    return {
        "curve": fine,
        "uncertainty": reference_uncertainty(first, second, best),
    }


@case(
    claim="Meshes of another order come to the stored curve as near as twice their elements change it.",
    tier="nightly",
    grid={"study": tuple(OTHERS)},
    bounds=lambda study: {
        "curve": Matches("paper_curves", "discretisation: from order one on the error is less than the change", allowance=OTHERS[study][3]),
        "change": Bound(at_most=OTHERS[study][3], reason="definition: what the curve is allowed to be off by"),
    },
)
def other_order(study: str) -> dict[str, Any]:
    """The curve on the finer of two meshes, and its largest change from the coarser one over its largest value."""
    order, *meshes, _ = OTHERS[study]
    coarse, fine = (computed(STUDIES[study], order, elements) for elements in meshes)
    return {"curve": fine, "change": float(np.abs(fine - coarse).max() / np.abs(fine).max())}
