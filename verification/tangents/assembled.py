"""The tangent of contact as the twin assembles it: the same routines, which there check that they stay within their arrays."""

from __future__ import annotations

from typing import Final

import numpy as np
from tangents.every_block import uneven

from isomortar import _twin
from isomortar.harness import Bound, case
from isomortar.harness.tangents import PairTangent

_FRICTIONLESS, _AVERAGED = "contacts.interface.friction=0", "contacts.interface.projection=averaged"
_KINKED: Final = ('bodies.master.mesh={ family = "L", order = 1, elements = [6, 5, 1] }', "contacts.interface.projection=closest")
_PLANE = 'contacts.interface={ slave = "slave.w0", plane = { tangent = [0.8, 0.6, 0] }, friction = 0.3, quadrature = [3, 3] }'
_OVER_THE_RIM = "bodies.slave.geometry.centre=[0.6, 0.02]"
#: Ways of contact that take other procedures, by what they change of the scene.
WAYS: Final[dict[str, tuple[str, ...]]] = {
    "local": (),
    "paper": ("solver.slip_sum=paper",),
    "frictionless": (_FRICTIONLESS,),
    "elastic": ("contacts.interface.elastic_slip=0.02",),
    "smooth": ("contacts.interface.smoothing=1e-4",),
    "dual": ("contacts.interface.enforcement=dual",),
    "greville": ("contacts.interface.enforcement=greville",),
    "cells": ("contacts.interface.subcells=1",),
    "plane": (_PLANE,),
    "raised": ("bodies.slave.mesh={ order = [2, 2, 1], elements = [2, 1, 1], contact_order = 3 }",),
    "on lines": _KINKED,
    "over the rim": (_OVER_THE_RIM,),
    "averaged": (_AVERAGED,),
    "averaged, frictionless": (_AVERAGED, _FRICTIONLESS),
    "averaged, kinked": (*_KINKED, _AVERAGED),
    "averaged, over the rim": (_AVERAGED, _OVER_THE_RIM),
}
#: How rough all is, and how far above its master the slave: by the way where feet are to be on ridges.
ROUGH: Final = {"on lines": (0.03, 0.1)}


@case(
    claim="The tangent of contact is what the twin assembles, within all bounds and contracts.",
    grid={"way": tuple(WAYS)},
    bounds={
        "tangent": Bound(at_most=1e-13, reason="round-off: the same sums in double and extended precision"),
        "there": Bound(at_least=1.0, reason="definition: a procedure is tested only where it acts"),
    },
)
def assembled(way: str) -> dict[str, float]:
    """Largest difference of blocks over the largest entry; the fewest of points, and of constraints, of a kind that a way is to have."""
    equilibrium, visit = uneven(*WAYS[way], **dict(zip(("rough", "lift"), ROUGH.get(way, ()), strict=False)))
    pair = equilibrium.pairs[0]
    tangent = PairTangent(pair, visit.positions, visit.pairs[0])
    patterns, start, law = tangent.blocks.patterns, visit.pairs[0].start, visit.pairs[0].law
    projections, state = tangent.kinematics.projections, tangent.response.state
    twin = _twin.contact_tangent(
        pair.pair.slave, pair.pair.master, visit.positions, projections, start.projection, start.projected, law,
        tangent.blocks.rows.shape[1], patterns.rows, pair.pair.neighbours, patterns.wide, patterns.tangent,
    )  # fmt: skip
    kinds: list[np.ndarray] = [projections.found * start.projected, projections.found * (1 - start.projected), state]
    if pair.friction.acts:
        kinds += [state == 1, state == 2]
    if way == "on lines":
        kinds.append(projections.fixed[:, 0] + projections.fixed[:, 1])
    if "rim" in way:
        kinds.append(np.equal(projections.found, 0))
    return {
        "tangent": float(np.abs(tangent.condensed - twin).max() / np.abs(twin).max()),
        "there": float(np.min([np.count_nonzero(kind) for kind in kinds])),
    }
