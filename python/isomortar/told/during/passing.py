"""Bodies that have come into each other while they deformed, with no contact between them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

from isomortar.model.entities import Body, Problem
from isomortar.told.before.left_out import unrelated, without_contact
from isomortar.told.meeting import depth, least_depth


class Passing:
    """Warnings of bodies that nothing keeps apart; each pair is told of once, and not if a first look has told of it.

    Attributes
    ----------
    needed : bool
        Whether there are such.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._pairs = [(one.name, other.name) for one, other in unrelated(problem)]
        self.needed = bool(self._pairs)
        self._told = set[tuple[str, str]]()

    @cached_property
    def _known(self) -> list[tuple[str, str]]:
        return without_contact(self._problem)

    def after_stage(self, deformed: Sequence[Body], stage: str) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to."""
        bodies = {body.name: body for body in deformed}
        for names in self._pairs:
            if names in self._told:
                continue
            one, other = (bodies[name] for name in names)
            inside = depth(one, other, least_depth(one, other))
            if inside > 0.0 and names not in self._known:
                self._told.add(names)
                yield (
                    f"bodies {one.name!r} and {other.name!r} are in each other at the end of stage {stage!r}, by {inside:.3g}, and no "
                    "contact is between them: nothing keeps them apart. Give them a table contacts.NAME with slave and master"
                )
