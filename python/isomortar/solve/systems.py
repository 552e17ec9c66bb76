"""Which linear system is in use: the last one for as long as all patterns stand, by parts where that is worth its operations."""

from __future__ import annotations

from collections.abc import Sequence

from scipy import sparse

from isomortar._sparse import Ordering
from isomortar.solve.condensed import Bodies, CondensedSystem, Engine, touched
from isomortar.solve.system import CheckedSystem, LinearSystem, Source, entries
from isomortar.solve.timing import Ledger


class Systems:
    """The linear systems of some bodies as supports leave them, one at a time.

    Parameters
    ----------
    free : int
        How many unknowns bodies have: they come first.
    orderings : dict
        Orderings that are known, by the number of sources; those that are found go in.
    ledger : Ledger
    engine : callable, optional
        Makes the factors of bodies, in the place of this process' own.

    Attributes
    ----------
    in_use : CheckedSystem or None
        The last one; None before something was solved.
    bodies : Bodies or None
        What systems by parts have in common.
    """

    def __init__(self, free: int, orderings: dict[int, Ordering], ledger: Ledger, engine: Engine | None) -> None:
        self._free, self._orderings, self._ledger, self._engine = free, orderings, ledger, engine
        self.in_use: CheckedSystem | None = None
        self.bodies: Bodies | None = None
        self._patterns: list[object] = []
        self._known: sparse.csr_array | None = None

    def of(self, sources: Sequence[Source], size: int) -> CheckedSystem:
        """That of some sources, the first of them the bodies': the one in use, where all patterns stand."""
        patterns: list[object] = [source.pattern for source in sources]
        if (
            self.in_use is None
            or len(patterns) != len(self._patterns)
            or any(a is not b for a, b in zip(patterns, self._patterns, strict=True))
        ):
            self.in_use = None  # its factors go before others come
            self.in_use = self.new(sources, size)
            self._patterns = patterns
        return self.in_use

    def new(self, sources: Sequence[Source], size: int) -> CheckedSystem:
        """One of some sources, the first of them the bodies': by parts, where that is worth its operations (theory 5.13)."""
        if self._known is None:
            self._known = entries(sources[:1], self._free)
        known, ledger, orderings = self._known, self._ledger, self._orderings

        def general() -> LinearSystem:  # without `self`: in a cycle factors would stay until Python looks for cycles
            return LinearSystem(size, sources, ledger, known, orderings.get(len(sources)))

        if self._free == 0:  # multipliers alone
            return general()
        if self.bodies is None:
            self.bodies = Bodies(sources[0], known, ledger, self._engine)
        self.bodies.act_on(touched(sources[1:], self._free))
        if self.bodies.condense(size - self._free):
            return CondensedSystem(self.bodies, size, sources, general, ledger)
        return general()

    def note_ordering(self) -> None:
        """Keep the ordering of the system in use for others of as many sources."""
        if self.in_use is not None and self.in_use.ordering:
            self._orderings[len(self._patterns)] = self.in_use.ordering
