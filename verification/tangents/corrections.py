"""Newton's corrections: what they leave out of balance to first order, with motions prescribed in bodies and on faces in contact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from tangents.every_block import uneven

from isomortar.harness import Bound, case

#: Differences of the forces over this share of a correction.
STEP = 1e-6


@case(
    claim="A correction takes what is out of balance away to first order, and makes the prescribed motion, wherever that is: away "
    "from contact, on the master's face and on the slave's.",
    tier="gate",
    grid={"held": ("master.w0", "master.w1", "slave.w0"), "friction": (0.0, 0.3)},
    bounds={
        "left": Bound(at_most=1e-6, reason="round-off: central differences over a millionth of the correction"),
        "motion": Bound(at_most=1e-15, reason="round-off: the prescribed motion is a part of the correction"),
        "contact": Bound(at_least=1e-3, reason="definition: or contact adds nothing to what is out of balance"),
    },
)
def corrections(held: str, friction: float) -> dict[str, float]:
    """Largest force that is left over the largest change; largest difference from the motion; the largest change by contact over all."""
    overrides = (f"supports.floor.face={held}", f"contacts.interface.friction={friction}")
    equilibrium, visit = uneven(*overrides, rough=0.002)
    start = replace(equilibrium.initial_state(), contacts=(visit.pairs[0].start,))
    laws, free = [visit.pairs[0].law], equilibrium.supports.free
    balance = equilibrium.balance(visit.positions, start, laws)
    prescribed = np.zeros_like(visit.positions)
    prescribed.ravel()[equilibrium.supports.prescribed] = 0.01 * np.random.default_rng(3).standard_normal(
        len(equilibrium.supports.prescribed)
    )
    made = equilibrium.correction(balance, laws, prescribed)
    low, high = (equilibrium.balance(visit.positions + share * made, start, laws) for share in (-STEP, STEP))
    change = (high.unbalanced - low.unbalanced).ravel()[free] / (2.0 * STEP)
    solid = (high.internal - low.internal).ravel()[free] / (2.0 * STEP)
    return {
        "left": float(np.abs(balance.unbalanced.ravel()[free] + change).max() / np.abs(change).max()),
        "motion": float(np.abs(made - prescribed).ravel()[equilibrium.supports.prescribed].max()),
        "contact": float(np.abs(change - solid).max() / np.abs(change).max()),
    }
