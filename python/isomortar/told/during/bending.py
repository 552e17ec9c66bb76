"""Thin bodies that bend, of elements so long along them that they are far too stiff: they shear and stretch where they should bend."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.faces import cells
from isomortar.geometry.patch import FloatArray, opposite
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.ratios import times
from isomortar.model.rigid import deformation
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.told.before.meshes import SAID_ABOVE, stiff_sheet
from isomortar.told.during.locking import locking

#: How much too stiff elements of order 2 are in bending, over (h / t)^2 times (h / R)^2 of bodies that are curved, and (h / l)^2 of smooth
#: ones that are l long: fitted to half and quarter rings (0.10 to 0.18), and to beams and plates (0.02 to 0.28, by how they are held).
CURVED, STRAIGHT = 0.15, 0.1
#: As much, at the most, of order p above 2, over (h / t)^2 (h / R)^(2 p - 2): parts of rings of orders 3 and 4 were off by 0.0001 to 0.3
#: times that, by how they are held. What it suspects is computed.
HIGHER = 0.3
#: Order up to which these are estimates, good enough to be told of bodies that are too large to be computed.
ESTIMATED = 2
#: Share by which a body is too stiff from which on it is told: estimates are good for the order of magnitude.
TOLD = 0.25
#: Share by which a body that stretches more than it bends is too stiff from which on it is told: it would bend, and stretches for it.
STIFF = 1.0
#: Length over thickness from which on bodies bend rather than shear, about as beams do.
SLENDER = 4.0
#: A body bends where its middle has gone so many times as far across as its thickness has changed, both in the mean.
BENDS = 2.0
#: Share of a body's size below which its ways are round-off.
STILL = 1e-9


@frozen
class Way:
    """How a body may bend: along one direction, across another one.

    Attributes
    ----------
    along, across : int
        Numbers of the directions.
    share : float
        By how much it is too stiff there (theory 9.20), of an order above 2 at the most.
    thick : float
        How thick it is there, with all that is glued to it.
    """

    along: int
    across: int
    share: float
    thick: float


class Bending:
    """Warnings of bodies that bend and are far too stiff for it, at the end of a stage; each is given once a body."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._told = set[str]()

    @cached_property
    def _stiff(self) -> list[tuple[Body, list[Way]]]:
        """Bodies with the ways in which they are too stiff; of sheets of order 1 that is said before."""
        problem = self._equilibrium.problem
        return [(body, found) for body in problem.deformable if stiff_sheet(problem, body) <= SAID_ABOVE and (found := ways(problem, body))]

    def after_stage(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to."""
        for body, found in self._stiff:
            if body.name in self._told:
                continue
            bent = self._bent(body, balance.positions, found)
            if bent is not None:
                self._told.add(body.name)
                yield self._sentence(body, bent, step)

    def _bent(self, body: Body, positions: FloatArray, found: list[Way]) -> Way | None:
        """How a body bends that is too stiff for it, if it does; what stretches instead may be so stiff that it cannot bend."""
        way, bends_more = bends(body, self._equilibrium.numbering.of_patch(body.name, positions), found)
        if way is None:
            return None
        computed = locking(self._equilibrium, positions, body, way.along)
        if computed is None:
            return way if bends_more and body.patch.directions[way.along].order <= ESTIMATED else None
        share = computed.share if bends_more or (computed.at_ends and computed.share > STIFF) else 0.0
        return replace(way, share=share) if share > TOLD else None

    def _sentence(self, body: Body, bent: Way, step: int) -> str:
        problem = self._equilibrium.problem
        stage, letter, order = problem.stages[problem.stage_of(step)].name, "uvw"[bent.along], body.patch.directions[bent.along].order
        far = bent.share >= 1.0
        size = f"{times(1.0 + bent.share, 2)} times" if far else f"{10 * round(10.0 * bent.share)} %"
        return (
            f"body {body.name!r}, load step {step}, the last of stage {stage!r}: it bends along {letter}, and its elements of order "
            f"{order} are so long there that it is up to about {size} too stiff for that: they shear and stretch instead (locking). Take "
            f"bodies.{body.name}.mesh.order = {order + 1} or more along {letter}, {'and' if far else 'or'} twice as many elements there"
        )


def ways(problem: Problem, body: Body) -> list[Way]:
    """Ways in which a body is too stiff in bending, the worst first (theory 9.20); what is glued to it across bends with it."""
    lengths = element_lengths(body.patch)
    whole = [float(of.sum()) for of in lengths]
    thick = [length + _glued(problem, body, across) for across, length in enumerate(whole)]
    pairs = [(along, across) for along in range(3) for across in range(3) if whole[along] > SLENDER * thick[across] and along != across]
    found = [Way(along, across, _share(body, along, lengths[along], thick[across]), thick[across]) for along, across in pairs]
    return sorted((way for way in found if way.share > TOLD), key=lambda way: -way.share)


def _glued(problem: Problem, body: Body, across: int) -> float:
    """How thick all is that is glued to a body's two faces across a direction, and to these bodies in turn."""
    joints = dict([joint for one, other in problem.glue for joint in ((one, other), (other, one))])
    thick, seen = 0.0, {body.name}
    for end in (0, 1):
        face = joints.get(Face(body.name, f"{'uvw'[across]}{end}"))
        while face is not None and face.body not in seen:
            seen.add(face.body)
            thick += float(element_lengths(problem.body(face.body).patch)["uvw".index(face.face[0])].sum())
            face = joints.get(Face(face.body, opposite(face.face)))
    return thick


def _share(body: Body, along: int, lengths: FloatArray, thick: float) -> float:
    """By how much elements of these lengths along a direction are too stiff where a body so thick bends (theory 9.20)."""
    direction, whole = body.patch.directions[along], float(lengths.sum())
    if direction.order == 1:
        return float(np.sum(lengths**3)) / whole / thick**2 / (2.0 * (1.0 + body.material.poisson))
    lines = np.moveaxis(body.patch.control_points.reshape(*body.patch.shape, 3, order="F"), along, 0)
    curvature, power = _curvature(lines.reshape(len(lines), -1, 3)), 2 * direction.order
    bent = (CURVED if direction.order == 2 else HIGHER) * curvature ** (power - 2)
    straight = STRAIGHT / whole**2 if direction.family == "N" and direction.order == 2 else 0.0
    return float(np.sum(lengths ** (power + 1))) / whole / thick**2 * (bent + straight)


def _curvature(lines: FloatArray) -> float:
    """Mean curvature of the longest of some lines of control points, shape (points, lines, 3): how far it turns, over its length."""
    steps = np.diff(lines, axis=0)
    lengths = np.linalg.norm(steps, axis=2)
    longest = int(np.argmax(lengths.sum(axis=0)))
    there = lengths[:, longest] > 0.0
    units = steps[there, longest] / lengths[there, longest, None]
    return float(np.arccos(np.clip(np.sum(units[1:] * units[:-1], axis=1), -1.0, 1.0)).sum() / lengths[:, longest].sum())


def bends(body: Body, positions: FloatArray, ways: Sequence[Way]) -> tuple[Way | None, bool]:
    """The first of some ways in which a body goes across by more than it is squeezed, and whether it bends more than it stretches.

    What is bent another way goes nowhere in the mean, and its rigid motion is none.

    Parameters
    ----------
    body : Body
    positions : ndarray, shape (control points of the patch, 3)
    ways : sequence of Way
    """
    now = replace(body.patch, control_points=positions)
    stretched: Way | None = None
    for way in ways:
        faces = [f"{'uvw'[way.across]}{end}" for end in (0, 1)]
        reference, (low, high) = ([cells(patch, face).centres for face in faces] for patch in (body.patch, now))
        gone = _but_for_size(np.concatenate(reference), np.concatenate([low, high]))
        if not np.abs(gone).max() > STILL * np.ptp(positions, axis=0).max():
            return None, False
        shape, axis = cells(now, faces[0]).shape, 0 if way.along == (way.across + 1) % 3 else 1
        (below, above), thick = np.split(gone, 2), np.linalg.norm(high - low, axis=1)
        normal = np.divide(high - low, thick[:, None], out=np.zeros_like(high), where=thick[:, None] > 0.0)  # nothing is across a seam
        across = np.sum(0.5 * (below + above) * normal, axis=1).reshape(shape)
        along, beside = (np.std(across.mean(axis=k)) for k in (1 - axis, axis))  # what is twisted has gone nowhere in the mean
        middles = [np.reshape(0.5 * (one + other), (*shape, 3)) for one, other in (reference, (low, high))]
        squeezed = np.sqrt(np.mean(np.sum((above - below) * normal, axis=1) ** 2))
        if along > max(BENDS * squeezed, beside):
            if _bent(across, axis, middles[0], max(way.thick, float(thick.mean()))) > _stretched(*middles):
                return way, True
            stretched = stretched or way
    return stretched, False


def _bent(across: FloatArray, axis: int, middle: FloatArray, thick: float) -> float:
    """Strain of bending along an axis of a middle, whose cells have gone so far across, in the mean."""
    step = np.linalg.norm(np.diff(middle, axis=axis), axis=2).mean()
    return 0.5 * thick * float(np.sqrt(np.mean(np.square(np.diff(across.mean(axis=1 - axis), 2))))) / step**2


def _stretched(before: FloatArray, after: FloatArray) -> float:
    """Strain of the lines of a middle as wholes, the larger one of both ways: where elements lock they stretch to and fro."""
    strains = []
    for axis in (0, 1):
        long, now = (np.linalg.norm(np.diff(middle, axis=axis), axis=2).sum(axis=axis) for middle in (before, after))
        strains.append(np.sqrt(np.mean(np.square((now - long)[long > 0.0] / long[long > 0.0]))))
    return float(max(strains))


def _but_for_size(before: FloatArray, after: FloatArray) -> FloatArray:
    """Ways of points but for the nearest motion that keeps the shape: a ring that widens does not bend."""
    gone, centred = deformation(before, after), after - after.mean(axis=0)
    turned = centred - gone
    return np.asarray(gone - turned * (np.sum(turned * gone) / np.sum(turned * turned)))
