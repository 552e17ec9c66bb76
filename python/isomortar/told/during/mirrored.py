"""Halves that are stable where the whole is not: what buckles across a plane of symmetry, each side against its mirror image."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

import numpy as np

from isomortar.errors import InputError, KernelError
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Face, Motion, Problem, Support, SymmetryPlane
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.told.during.unstable import Unstable

#: A body that is less than so many times as long as it is wide across a plane gives way otherwise before it buckles across that.
SLENDER = 1.5
#: Share of the shortening (pi w / L)^2 / 48 at which a body buckles that is held at one end, w wide and L long, below which none would.
SHORTENED = 0.25


class Mirrored:
    """Warnings of bodies that would buckle across a plane of symmetry; each plane is asked until it gives one."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._left = list(equilibrium.problem.symmetry)

    def after_stage(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to."""
        for plane in [plane for plane in self._left if self._may_buckle(plane, balance.positions)]:
            with suppress(InputError, KernelError):
                body = self._buckles(plane, balance, step)
                if body:
                    self._left.remove(plane)
                    yield self._sentence(plane, body, step)

    def _may_buckle(self, plane: SymmetryPlane, positions: FloatArray) -> bool:
        """Whether bodies are slender enough, and shortened, to buckle across a plane: to ask takes as much as an iteration."""
        numbering = self._equilibrium.numbering
        along = [k for k in range(3) if k != plane.axis]
        for piece in numbering.pieces:
            points = np.concatenate([numbering.points[body.name] for body in piece])
            wide = 2.0 * np.abs(numbering.reference[points, plane.axis] - plane.place).max()
            long, now = (np.ptp(of[points][:, along], axis=0) for of in (numbering.reference, positions))
            shortest = SHORTENED * (np.pi * wide / long) ** 2 / 48.0
            if np.any((long > SLENDER * wide) & (1.0 - now / long > shortest)):
                return True
        return False

    def _buckles(self, plane: SymmetryPlane, balance: Balance, step: int) -> str:
        """A body that goes against the force which moves it across the plane; empty: there is none."""
        pairs = zip(self._equilibrium.problem.contacts, balance.responses, strict=True)
        touched = [side for contact, response in pairs if np.any(response.state) for side in (contact.slave, contact.master)]
        faces = [side for side in touched if isinstance(side, Face)]
        other = Equilibrium(_across(self._equilibrium.problem, plane, faces), self._equilibrium.ledger)
        other.standing(step)
        other.time = self._equilibrium.time
        sources, values = other.body_tangents(balance.positions, keep_bodies=False)
        if not len(other.supports.free):
            return ""
        other.solve(sources, values, np.zeros(len(other.supports.free)), balance.positions)
        motion = next(Unstable(other).against_force(balance.positions), None)
        return "" if motion is None else other.numbering.body_of(int(np.argmax(np.linalg.norm(motion, axis=1))))

    def _sentence(self, plane: SymmetryPlane, body: str, step: int) -> str:
        problem = self._equilibrium.problem
        stage = problem.stages[problem.stage_of(step)].name
        return (
            f"load step {step}, the last of stage {stage!r}: the whole is not stable, though its part on one side of {plane.words} may be: "
            f"body {body!r} buckles across that plane, which a part cannot. Compute the whole, without symmetry.{'xyz'[plane.axis]}"
        )


def _across(problem: Problem, plane: SymmetryPlane, touched: list[Face]) -> Problem:
    """The part as it goes where both sides go the same way (theory 5.28): free across the plane, held along it, and where contact acts."""
    still = tuple(Motion() for _ in problem.stages)
    supports = tuple(_held(support, plane) for support in problem.supports)
    rigid = {body.name for body in problem.bodies if body.rigid}
    faces = [face for side in touched for face in side.faces if face.body not in rigid]
    stuck = tuple(Support(f"contact-{k}", face, still) for k, face in enumerate(faces))
    return replace(problem, contacts=(), supports=(*supports, *stuck), symmetry=())


def _held(support: Support, plane: SymmetryPlane) -> Support:
    """A support with what its forces move standing still; that of the plane with the components along it."""
    if support.name == plane.holding(support.place.body):
        return replace(support, components=tuple(k for k in range(3) if k != plane.axis))
    return replace(support, components=tuple(sorted(support.carried)), force=(None, None, None), moment=None)
