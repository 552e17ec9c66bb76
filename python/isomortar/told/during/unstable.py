"""Equilibria that are not stable: bodies that buckle while all load steps converge."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

import numpy as np

from isomortar.errors import FoldedElementError, KernelError
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.rank import motions_left, moved
from isomortar.solve.equilibrium import Balance, Equilibrium

#: Forces that are looked at on each body, each what the last one moves: the softest motions come first.
FORCES = 8
#: What a force moves along itself, beside the largest of all, below which things move against it: above, it is round-off.
AGAINST = -0.01
#: Share of the largest up to which an imaginary part is round-off of a pair that is real.
REAL = 1e-6
#: What a force moves times stiffness, by modulus and size of the bodies, up to which all is held, and nothing moves but by round-off.
HELD = 1e-8
#: How far bodies are taken along a motion, over their size, to see what they resist it by: strains of it alone count, and above round-off.
NEXT = 1e-6
#: Share of a motion that no rigid one makes up to which a body goes as a whole.
DEFORMS = 0.1
#: Share of a motion that is not among forces before below which there are no others.
NOTHING_LEFT = 1e-10


class Unstable:
    """Warnings of equilibria that are not stable at the end of a stage; given once."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        moduli = [body.modulus for body in equilibrium.problem.deformable]
        self._softness = 1.0 / (max(moduli, default=np.inf) * equilibrium.numbering.size)
        self._told = False

    def after_stage(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to, by the factors of its last tangent."""
        motions = () if self._told else self.against_force(balance.positions)
        motion = next((motion for motion in motions if not balance.slipping or self._gives_way(motion, balance.positions)), None)
        if motion is not None:
            self._told = True
            yield self._sentence(motion, balance.positions, step)

    def against_force(self, positions: FloatArray) -> Iterator[FloatArray]:
        """Motions of all control points that go against the forces which make them, shape (control points, 3) (theory 5.26).

        Forces act on one body at a time: a slender or soft one moves so much more that others would be lost beside it.
        """
        equilibrium = self._equilibrium
        of_body = np.zeros(equilibrium.numbering.count, dtype=np.int32)
        for number, points in enumerate(equilibrium.numbering.own.values()):
            of_body[points] = number
        of_unknown = of_body[equilibrium.supports.free // 3]
        found = (self._against_force_on(np.flatnonzero(of_unknown == number).astype(np.int32)) for number in np.unique(of_unknown))
        return (equilibrium.supports.spread(motion, positions) for motion in found if motion is not None)

    def _gives_way(self, motion: FloatArray, positions: FloatArray) -> bool:
        """Whether the bodies' own forces go along with a motion (theory 5.27); what is about to fold does.

        What slips under high friction goes against its force while the bodies resist: it jams, and nothing buckles.
        """
        equilibrium = self._equilibrium
        small = motion * (NEXT * equilibrium.numbering.size / np.abs(motion).max())
        with equilibrium.ledger.phase("solid"), suppress(FoldedElementError):
            change = equilibrium.solid.forces(positions + small) - equilibrium.solid.forces(positions - small)
            return bool(np.sum(change * motion) < 0.0)
        return True

    def _against_force_on(self, unknowns: IntArray) -> FloatArray | None:
        """A motion of the free unknowns against the force which makes it, that acts on some of them alone; or None.

        Forces are made orthogonal to each other; of all their sums those are taken that move things along themselves, to or fro.
        """
        force, forces, motions = np.random.default_rng(0).standard_normal(len(unknowns)), list[FloatArray](), list[FloatArray]()
        for _ in range(min(FORCES, len(unknowns))):
            forces.append(force / np.linalg.norm(force))
            way = self._moved_by(forces[-1], unknowns)
            if way is None:
                return None
            motions.append(way)
            basis, own = np.array(forces), way[unknowns]
            force = own - basis.T @ (basis @ own)
            if np.linalg.norm(force) <= NOTHING_LEFT * np.linalg.norm(own):
                break
        own = np.array(motions)[:, unknowns]
        values, sums = np.linalg.eig(np.array(forces) @ own.T)
        largest = np.abs(values).max()
        along = np.where(np.abs(values.imag) <= REAL * largest, values.real, 0.0)
        least = int(np.argmin(along))
        if largest <= HELD * self._softness or not along[least] < AGAINST * largest:
            return None
        return np.asarray(np.array(motions).T @ sums[:, least].real)

    def _moved_by(self, force: FloatArray, unknowns: IntArray) -> FloatArray | None:
        """How a force on some of the free unknowns moves all.

        None where factors have no digits for it, of which there is another word, or there are none.
        """
        forces = np.zeros(len(self._equilibrium.supports.free))
        forces[unknowns] = force
        try:
            way = self._equilibrium.moved_by(forces)
        except KernelError:
            return None
        return way if way is not None and np.isfinite(way).all() else None

    def _is_rigid(self, motion: FloatArray, positions: FloatArray, point: int) -> bool:
        """Whether what a control point belongs to, with all that is glued to it, goes as a rigid body that supports leave free."""
        equilibrium, numbering = self._equilibrium, self._equilibrium.numbering
        number = numbering.piece_of(point)
        own, piece = numbering.piece_points(number), numbering.pieces[number]
        free = motions_left(equilibrium.problem, piece, equilibrium.supports.stage)
        if not len(free):
            return False
        rigid = np.column_stack([moved(piece, amounts, positions[own]).ravel() for amounts in free])
        way = motion[own].ravel()
        return bool(np.linalg.norm(way - rigid @ np.linalg.lstsq(rigid, way, rcond=None)[0]) <= DEFORMS * np.linalg.norm(way))

    def _sentence(self, motion: FloatArray, positions: FloatArray, step: int) -> str:
        """On the control point that goes farthest."""
        problem, numbering = self._equilibrium.problem, self._equilibrium.numbering
        point = int(np.argmax(np.linalg.norm(motion, axis=1)))
        how = "goes off, or tips over, as a whole" if self._is_rigid(motion, positions, point) else "buckles, or snaps,"
        along = ", ".join(f"{value:g}" for value in np.round(motion[point] / np.linalg.norm(motion[point]), 2) + 0.0)
        return (
            f"load step {step}, the last of stage {problem.stages[problem.stage_of(step)].name!r}: the equilibrium is not stable: body "
            f"{numbering.body_of(point)!r} {how} where it is let, most at control point {point}, along ({along}) or against "
            "that. What is computed is one equilibrium of several, and not the one that bodies come to. Let a small load push them that "
            "way in short load steps, or hold them there by a support"
        )
