"""What holds at every interface with friction after every load step: the cone, and the balance of momentum."""

from __future__ import annotations

import numpy as np
from small_scenes import bowl

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation

FRICTION = 0.3


@case(
    claim="No control traction is outside the cone, whatever the master and the slip sum; no control pressure pulls.",
    tier="gate",
    grid={"master": ("block", "plane"), "slip_sum": ("local", "paper")},
    bounds={
        "outside": Bound(at_most=1e-10, reason="round-off: contact conditions are solved to 1e-11 of the largest pressure"),
        "pull": Bound(at_most=1e-10, reason="round-off: contact conditions are solved to 1e-11 of the largest pressure"),
        "slipping": Bound(at_least=1.0, reason="definition: the cone is tested only where points slip"),
    },
)
def cone(master: str, slip_sum: str) -> dict[str, float]:
    """Largest traction norm above mu p, largest negative pressure, over the largest pressure; slipping points at the end."""
    results = list(Simulation(bowl(master, FRICTION, slip_sum=slip_sum)).run())
    shares = []
    for result in results:
        pressure = result.state.contacts[0].pressure
        shares.append(
            [(result.contacts[0].traction_norm - FRICTION * pressure).max() / pressure.max(), (0.0 - pressure.min()) / pressure.max()]
        )
    outside, pull = np.maximum(0.0, np.max(shares, axis=0))
    return {"outside": float(outside), "pull": float(pull), "slipping": float(results[-1].contacts[0].slip)}


@case(
    claim="Forces and moments of the two sides of an interface balance after every load step, however coarse the meshes.",
    tier="gate",
    grid={"friction": (0.0, 0.3)},
    bounds={
        "force": Bound(at_most=1e-12, reason="theory: exact in the discrete equations; sums in double precision"),
        "moment": Bound(at_most=1e-12, reason="theory: exact with the full variation of the projection; sums in double precision"),
    },
)
def momentum_balance(friction: float) -> dict[str, float]:
    """Imbalance over the contact force, and over the contact force times one unit of length, about the width of the block."""
    shares = []
    for result in Simulation(bowl("block", friction)).run():
        found = result.contacts[0]
        left = found.force_slave + found.force_master, found.moment_slave + found.moment_master
        shares.append(np.linalg.norm(left, axis=1) / np.linalg.norm(found.force_slave))
    force, moment = np.max(shares, axis=0)
    return {"force": float(force), "moment": float(moment)}
