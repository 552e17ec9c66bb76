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
from isomortar.told.during.acting import covered
from isomortar.told.during.locking import locking

#: How much too stiff elements of order 2 are in bending, over (h / t)^2 times (h / R)^2 of bodies that are curved, and (h / l)^2 of smooth
#: ones that are l long: fitted to half and quarter rings (0.10 to 0.18), and to beams and plates (0.02 to 0.28, by how they are held).
CURVED, STRAIGHT = 0.15, 0.1
#: As much, at the most, of order p, over (h / t)^2 times (h / R)^(2 p - 2) + (h / l)^(2 p - 2): parts of rings of orders 3 and 4 were off
#: by 0.0001 to 0.3 times that, beams of orders 2 and 3 with both ends held by 0.02 to 0.42. What it suspects is computed.
AT_MOST = 0.5
#: Share by which a body is too stiff from which on it is told: estimates are good for the order of magnitude.
TOLD = 0.25
#: Share by which a body that stretches more than it bends is too stiff from which on it is told: it would bend, and stretches for it. So
#: are such as are by so much along two directions at once, and so many times (`BOTH`) as along one: plates with all sides held were off by
#: 140 and 170 times, and by 1.0 if one direction alone was mended; the width of beams adds a third.
STIFF, BOTH = 1.0, 2.0
#: The same of bodies that contact presses on, whose pressures are of the lower order and go to and fro: one that is right but for a tenth
#: was 2.5 times too stiff by them, arches of one and two elements under cylinders, off by 230 to 500 times, 115 to 135.
PRESSED = 10.0
#: Share of a face that contact presses on from which on it shapes the body: that was 0.75 to 1 of pipes round cores and of beams on beds,
#: and 0.6 and less of what bends by lids and cylinders.
LIES = 0.7
#: Length over thickness from which on bodies bend rather than shear, about as beams do.
SLENDER = 4.0
#: A body bends where its middle has gone so many times as far across as its thickness has changed, both in the mean.
BENDS = 2.0
#: A body bends along lines that have gone so many times as far across, in the mean of those beside each other, as these differ: once in
#: a plate that bends both ways alike, by symmetry, and nowhere in the mean in a strip that is twisted.
ASIDE = 0.5
#: Angle, in radians, by which lines turn from which on elements that are no splines have kinks where they meet: six degrees, of the 90 to
#: 360 of arcs and rings, and round-off of straight bodies.
TURNED = 0.1
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
        By how much it is too stiff there, at the most (theory 9.20).
    about : float
        By how much about; zero of orders above 2, of which that is not known.
    thick : float
        How thick it is there, with all that is glued to it.
    """

    along: int
    across: int
    share: float
    about: float
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
            bent = self._bent(body, balance, found)
            if bent is not None:
                self._told.add(body.name)
                yield self._sentence(body, bent, step)

    def _bent(self, body: Body, balance: Balance, found: list[Way]) -> Way | None:
        """How a body bends, or would, that is too stiff for it: as computed, or estimated of one that bends and is too large for that."""
        equilibrium, along = self._equilibrium, sorted({way.along for way in found})
        way, bends_more = bends(body, equilibrium.numbering.of_patch(body.name, balance.positions), found)
        if way is None or (not bends_more and any(_kinked(body, axis) for axis in along)):
            return None
        pressed = covered(equilibrium, balance, body)
        if pressed > LIES and not bends_more:
            return None
        least = TOLD if bends_more else PRESSED if pressed > 0.0 else STIFF
        together = locking(equilibrium, balance, body, along)
        if together is not None and together <= least:
            return None
        shares = {axis: together if len(along) == 1 else locking(equilibrium, balance, body, [axis]) for axis in along}
        known = {axis: share for axis, share in shares.items() if share is not None}
        if not known:
            return replace(way, share=way.about) if bends_more and way.about > TOLD else None
        worst = max((one for one in found if one.along in known), key=lambda one: known[one.along])
        share = known[worst.along]
        if together is not None and together > max(STIFF, BOTH * share):
            share = together
        return replace(worst, share=share) if share > least else None

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


def _kinked(body: Body, along: int) -> bool:
    """Whether a body is curved along elements that are no splines: where they meet it has kinks, at which a pressure bends it."""
    direction = body.patch.directions[along]
    return direction.family == "L" and direction.elements > 1 and _turn(body, along) > TURNED


def ways(problem: Problem, body: Body) -> list[Way]:
    """Ways in which a body may be too stiff in bending, the worst first (theory 9.20); what is glued to it across bends with it."""
    lengths = element_lengths(body.patch)
    whole = [float(of.sum()) for of in lengths]
    thick = [length + _glued(problem, body, across) for across, length in enumerate(whole)]
    pairs = [(along, across) for along in range(3) for across in range(3) if whole[along] > SLENDER * thick[across] and along != across]
    found = [Way(along, across, *_shares(body, along, lengths[along], thick[across]), thick[across]) for along, across in pairs]
    return sorted((way for way in found if way.share > TOLD), key=lambda way: -way.share)


def _glued(problem: Problem, body: Body, across: int) -> float:
    """How thick all is that is glued to a body's two faces across a direction, and to these in turn; what is softer counts for less."""
    joints = dict([joint for one, other in problem.glue for joint in ((one, other), (other, one))])
    thick, seen = 0.0, {body.name}
    for end in (0, 1):
        face = joints.get(Face(body.name, f"{'uvw'[across]}{end}"))
        while face is not None and face.body not in seen:
            seen.add(face.body)
            other = problem.body(face.body)
            thick += float(element_lengths(other.patch)["uvw".index(face.face[0])].sum()) * min(
                1.0, other.material.young / body.material.young
            )
            face = joints.get(Face(face.body, opposite(face.face)))
    return thick


def _shares(body: Body, along: int, lengths: FloatArray, thick: float) -> tuple[float, float]:
    """How much too stiff elements of these lengths are along a direction where a body so thick bends: at most, and about (theory 9.20)."""
    direction, whole = body.patch.directions[along], float(lengths.sum())
    if direction.order == 1:
        share = float(np.sum(lengths**3)) / whole / thick**2 / (2.0 * (1.0 + body.material.poisson))
        return share, share
    power, curvature = 2 * direction.order, _turn(body, along) / whole
    size = float(np.sum(lengths ** (power + 1))) / whole / thick**2
    most = size * AT_MOST * (curvature ** (power - 2) + whole ** (2 - power))
    if direction.order > 2:
        return most, 0.0
    return most, size * (CURVED * curvature**2 + (STRAIGHT / whole**2 if direction.family == "N" else 0.0))


def _turn(body: Body, along: int) -> float:
    """By how much the longest line of a body's control points along a direction turns, in radians."""
    lines = np.moveaxis(body.patch.control_points.reshape(*body.patch.shape, 3, order="F"), along, 0)
    steps = np.diff(lines.reshape(len(lines), -1, 3), axis=0)
    lengths = np.linalg.norm(steps, axis=2)
    longest = int(np.argmax(lengths.sum(axis=0)))
    there = lengths[:, longest] > 0.0
    units = steps[there, longest] / lengths[there, longest, None]
    return float(np.arccos(np.clip(np.sum(units[1:] * units[:-1], axis=1), -1.0, 1.0)).sum())


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
        if along > max(BENDS * squeezed, ASIDE * beside):
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
