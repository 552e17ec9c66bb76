"""Bodies that shrink by more than their law is for: beyond that it resists the less, the smaller they are."""

from __future__ import annotations

from collections.abc import Iterator

from isomortar.solve.equilibrium import Balance, Equilibrium

#: By law: share of its volume below which it takes less force to shrink a body further (theory 9.16); the others have none.
LEAST_VOLUMES = {"neo-hookean-j": 0.4}


class Shrunk:
    """Warnings of bodies that are smaller than their law is for; each is given once a body."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._left = {body.name for body in equilibrium.problem.deformable if body.material.law in LEAST_VOLUMES}

    def after_step(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to (theory 9.16)."""
        if not self._left:
            return
        equilibrium = self._equilibrium
        smallest = equilibrium.solid.smallest_jacobians(balance.positions)
        for body, volume in zip(equilibrium.problem.deformable, smallest, strict=True):
            if body.name in self._left and volume < LEAST_VOLUMES[body.material.law]:
                self._left.remove(body.name)
                law, least = body.material.law, LEAST_VOLUMES[body.material.law]
                yield (
                    f"body {body.name!r}, load step {step}: it is pressed to {volume:.2g} of its volume, and below {least:g} its law, "
                    f"{law}, resists the less, the more it is pressed: it may have fallen in on itself. "
                    'Take law = "neo-hookean", which resists the more, or smaller motions'
                )
