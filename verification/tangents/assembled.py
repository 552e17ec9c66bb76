"""The tangent of contact as the twin assembles it: the same routines, which there check that they stay within their arrays."""

from __future__ import annotations

from typing import Final

import numpy as np
from tangents.every_block import uneven

from isomortar import _twin
from isomortar.harness import Bound, case
from isomortar.harness.tangents import PairTangent

#: Ways of contact, by what they change of the scene.
WAYS: Final = {
    "local": [],
    "paper": ["solver.slip_sum=paper"],
    "frictionless": ["contacts.interface.friction=0"],
    "elastic": ["contacts.interface.elastic_slip=0.02"],
    "dual": ["contacts.interface.enforcement=dual"],
    "averaged": ["contacts.interface.projection=averaged"],
    "averaged, frictionless": ["contacts.interface.projection=averaged", "contacts.interface.friction=0"],
    "averaged, kinked": ["contacts.interface.projection=averaged", 'bodies.master.mesh={ family = "L", order = 1, elements = [2, 3, 1] }'],
    "closest, kinked": ["contacts.interface.projection=closest", 'bodies.master.mesh={ family = "L", order = 1, elements = [2, 3, 1] }'],
}


@case(
    claim="The tangent of contact is what the twin assembles, within all bounds and contracts.",
    grid={"way": tuple(WAYS)},
    bounds={
        "tangent": Bound(at_most=1e-13, reason="round-off: the same sums in double and extended precision"),
        "places": Bound(at_least=1.0, reason="definition: there are points with a foot and a history, others without, and closed ones"),
    },
)
def assembled(way: str) -> dict[str, float]:
    """Largest difference of blocks over the largest entry; the fewest of points of a kind."""
    equilibrium, visit = uneven(*WAYS[way])
    pair = equilibrium.pairs[0]
    tangent = PairTangent(pair, visit.positions, visit.pairs[0])
    patterns, start, law = tangent.blocks.patterns, visit.pairs[0].start, visit.pairs[0].law
    projections = tangent.kinematics.projections
    twin = _twin.contact_tangent(
        pair.pair.slave, pair.pair.master, visit.positions, projections, start.projection, start.projected, law,
        tangent.blocks.rows.shape[1], patterns.rows, pair.pair.neighbours, patterns.wide, patterns.tangent,
    )  # fmt: skip
    kinds = [projections.found * start.projected, projections.found * (1 - start.projected), tangent.response.state]
    return {
        "tangent": float(np.abs(tangent.condensed - twin).max() / np.abs(twin).max()),
        "places": float(np.min([np.count_nonzero(kind) for kind in kinds])),
    }
