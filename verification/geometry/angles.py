"""Angles of a few decimal digits: what is a quarter, a half or the whole of a circle by these is one by their binary values as well."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Material
from isomortar.model.numbering import check_closed
from isomortar.scene.primitives import RingTable


@case(
    claim="Rings from any angle are closed after 360 degrees, and arcs have as many parts as quarters, whatever the last bits of angles.",
    tier="gate",
    grid={"degrees": (90, 180, 270, 360)},
    bounds={
        "parts": Bound(at_least=0.0, at_most=0.0, reason="definition: a part is up to a quarter"),
        "slit": Bound(at_least=0.0, at_most=0.0, reason="definition: what goes all round is closed, and nothing else is"),
        "off": Bound(at_least=50.0, reason="definition: for so many of them the difference of binary values is not that of the angles"),
    },
)
def quarters(degrees: int) -> dict[str, float]:
    """Rings of other parts than quarters, and those not closed that go round or the other way; starts are tenths of a degree."""
    parts = slit = off = 0
    for tenths in range(-3600, 3601, 7):
        angles = tenths / 10, (tenths + 10 * degrees) / 10
        ring = RingTable(kind="ring", inner=1.0, outer=2.0, width=1.0, angles=angles)
        patch = ring.patch()
        off += angles[1] - angles[0] != degrees
        parts += patch.directions[0].elements != degrees // 90
        slit += ring.closed != ("u" if degrees == 360 else None)
        if ring.closed:
            check_closed(Body("ring", patch, Material(), (3, 2, 2), ring.closed))
    return {"parts": float(parts), "slit": float(slit), "off": float(off)}


@case(
    claim="Arcs up to half of a circle are smooth, however long; longer ones are only continuous where their parts meet.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: arcs with another number of lines on which they are only continuous")},
)
def smooth() -> dict[str, float]:
    """How many, of arcs of all whole degrees."""
    wrong = 0
    for degrees in range(1, 361):
        (round_it, *_) = RingTable(kind="ring", inner=1.0, outer=2.0, width=1.0, angles=(10.0, 10.0 + degrees)).patch().directions
        inner, repeated = np.unique(round_it.knots, return_counts=True)
        joints = np.count_nonzero(repeated[1:-1] >= round_it.order)
        wrong += joints != (0 if degrees <= 180 else len(inner) - 2)
    return {"wrong": float(wrong)}
