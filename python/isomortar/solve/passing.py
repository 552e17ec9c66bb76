"""Bodies that have come into each other while they deformed, with no contact between them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.left_out import unrelated, without_contact
from isomortar.solve.meeting import depth

#: Depth over the size of the smaller body from which bodies are in each other: cells are flat, and faces between them are not.
PASSED = 0.01


class Passing:
    """Warnings of bodies that nothing keeps apart; each pair is told of once, and not if a first look has told of it."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._pairs = list(unrelated(equilibrium.problem))
        self._told = set[tuple[str, str]]()

    @cached_property
    def _known(self) -> list[tuple[str, str]]:
        return without_contact(self._equilibrium.problem)

    def after_stage(self, balance: Balance, stage: str) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to."""
        for one, other in self._pairs:
            names = one.name, other.name
            if names in self._told:
                continue
            inside = depth(self._deformed(one, balance.positions), self._deformed(other, balance.positions))
            if inside > PASSED * min(one.size, other.size) and names not in self._known:
                self._told.add(names)
                yield (
                    f"bodies {one.name!r} and {other.name!r} are in each other at the end of stage {stage!r}, by {inside:.3g}, and no "
                    "contact is between them: nothing keeps them apart. Give them a table contacts.NAME with slave and master"
                )

    def _deformed(self, body: Body, positions: FloatArray) -> Body:
        return replace(body, patch=replace(body.patch, control_points=self._equilibrium.numbering.of_patch(body.name, positions)))
