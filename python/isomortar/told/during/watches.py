"""All that watches a run: asked of each load increment, of each load step before it is recorded, and of the whole at its end."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from isomortar.geometry.patch import FloatArray
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.record import ContactState, StepResult
from isomortar.told.during.advice import StepAdvice
from isomortar.told.during.astray import Astray
from isomortar.told.during.behind import Behind
from isomortar.told.during.bending import Bending
from isomortar.told.during.coarse import Coarse
from isomortar.told.during.held_inside import HeldInside
from isomortar.told.during.in_itself import InItself
from isomortar.told.during.inside_out import InsideOut
from isomortar.told.during.leaving import Leaving
from isomortar.told.during.lost import LostDigits
from isomortar.told.during.mirrored import Mirrored
from isomortar.told.during.on_areas import OnAreas
from isomortar.told.during.other_faces import OtherFaces
from isomortar.told.during.passing import Passing
from isomortar.told.during.pivoting import Pivoting
from isomortar.told.during.pulling import Pulling
from isomortar.told.during.rolling import Rolling
from isomortar.told.during.sharing import Sharing
from isomortar.told.during.shrunk import Shrunk
from isomortar.told.during.small_strains import SmallStrains
from isomortar.told.during.snapping import Snapping
from isomortar.told.during.unseen import Unseen
from isomortar.told.during.unstable import Unstable


class Watches:
    """What a run says of itself.

    Parameters
    ----------
    equilibrium : Equilibrium
    step : int
        Load step that the run goes on from; 0: a run from the beginning.
    states : sequence of ContactState
        Those of the contacts at its end.
    """

    def __init__(self, equilibrium: Equilibrium, step: int, states: Sequence[ContactState]) -> None:
        problem = self._problem = equilibrium.problem
        self._equilibrium = equilibrium
        self._lost, self._pulling, self._sharing = LostDigits(equilibrium), Pulling(equilibrium), Sharing(equilibrium)
        self._small_strains, self._astray, self._unseen = SmallStrains(equilibrium), Astray(equilibrium), Unseen(equilibrium)
        self._snapping, self._inside_out, self._unstable = Snapping(equilibrium), InsideOut(equilibrium), Unstable(equilibrium)
        self._mirrored, self._shrunk, self._bending = Mirrored(equilibrium), Shrunk(equilibrium), Bending(equilibrium)
        self._coarse, self._advice = Coarse(equilibrium, states), StepAdvice(problem, step, states)
        self._pivoting, self._rolling, self._held_inside = Pivoting(equilibrium), Rolling(equilibrium), HeldInside(equilibrium)
        self._on_areas = OnAreas(equilibrium)
        self._leaving = Leaving([mechanics.pair for mechanics in equilibrium.pairs], states)
        self._of_stages = [watch for watch in (Passing(problem), OtherFaces(problem), Behind(problem), InItself(problem)) if watch.needed]

    def look(self, before: FloatArray, after: FloatArray, share: float) -> None:
        """Look at a load increment, a share of the longest one, from positions to others.

        Raises
        ------
        ConvergenceError
            It may have gone past an equilibrium, and a shorter one may show.
        """
        self._snapping.look(before, after, share)
        with self._equilibrium.ledger.phase("solid"):
            self._inside_out.look(before, after, share)

    def by_factors(self, balance: Balance, step: int) -> list[str]:
        """Warnings at the end of a stage that solves by the factors of its last tangent give rise to: they count in that load step."""
        return [*self._unstable.after_stage(balance, step), *self._mirrored.after_stage(balance, step)]

    def after_step(self, balance: Balance, result: StepResult, ends: bool) -> Iterator[str]:
        """Warnings that a load step gives rise to, which may be the last of its stage."""
        step = result.step
        yield from self._lost.after_step(balance, result)
        yield from self._pulling.after_step(balance, step)
        yield from self._sharing.after_step(result)
        yield from self._small_strains.after_step(balance, step)
        yield from self._shrunk.after_step(balance, step)
        yield from self._snapping.after_step(step)
        yield from self._inside_out.after_step(step)
        yield from self._astray.after_step(balance, step)
        yield from self._pivoting.after_step(balance, step)
        yield from self._rolling.after_step(balance, step)
        yield from self._coarse.after_step(balance, step, ends)
        yield from self._leaving.after_step(step, result.contacts, result.state.contacts)
        yield from self._advice.after_step(step, result.contacts, result.state.contacts)
        self._unseen.after_step(balance)
        if ends:
            yield from self._bending.after_stage(balance, step)
            yield from self._held_inside.after_stage(balance, step)
            yield from self._on_areas.after_stage(balance, step)
        if ends and self._of_stages:
            deformed = self._equilibrium.numbering.deformed(balance.positions)
            for watch in self._of_stages:
                yield from watch.after_stage(deformed, result.stage)

    def at_the_end(self) -> Iterator[str]:
        """Warnings that the whole run gives rise to."""
        yield from self._advice.at_the_end(self._unseen.depths)
