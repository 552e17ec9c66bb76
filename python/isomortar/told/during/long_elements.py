"""Elements that are too long for a contact, its slave's or its master's: they cannot follow what is pressed in, and are too stiff."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.sheet import Sheet
from isomortar.model.supports import BoolArray
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.told.before.dents import AT_POINTS
from isomortar.told.during.extent import extent, mirrored_ends
from isomortar.told.during.giving_way import Yields
from isomortar.told.during.indenting import coordinates_of_slave, further
from isomortar.told.during.narrow import bearing
from isomortar.told.during.pulling import pulls
from isomortar.told.during.softness import softness

#: Share of what a body gives way by that its elements keep back, by one over the width of contact in these, and what is taken from that:
#: fitted to balls and cylinders on blocks of orders 1 to 3; and the most that it is taken for.
KEEPS, FREE, MOST = 0.2, 0.4, 0.8
#: Order from which on elements follow shorter pressures in proportion.
SMOOTH = 2.0
#: The same across, by one over the width of contact in heights of elements of order 2: caps on one that was twice as high as the contact
#: was wide kept back 0.02 to 0.06. Of order 1 four times as much, and nothing is taken from it, nor is contact that is as wide as the face
#: left out: blocks on one element, as high as half their width, are a third too stiff.
ACROSS, LINEAR = 0.06, 0.24
#: Share of a face's elements from which on contact is as wide as it: nothing beside it is to be bent down.
ALL = 0.8
#: Elements of the master are too long for a finer slave: longer than its own by this factor. Where they are not both are too long.
FINER = 1.2
#: Share that elements of both may keep back, by the estimate, from which on it is computed what they do: rough, that takes half a second.
#: It is asked as well where contact lies between two rows of its slave, and both together may be too much: elements added up to 7 % there.
SUSPECT = 0.03
#: Share of an element by which contact may have moved along a face, and share of its width by which that may be another one, up to which
#: what was computed of it holds: where knots lie decides, and from one to the other it changes by all that it is.
SAME = 0.1
#: Share of the force that this adds from which on it is told, and the largest that is: under rigid slaves it is a bound of little use.
COSTS, LARGEST = 0.1, 1.0
#: A direction is too coarse where it keeps back this share of what the worst one does: along the face, and across.
PARTS = (0.5, 0.5, 1.0)


@frozen
class SideElements:
    """How a contact lies on the elements of one of its sides.

    Attributes
    ----------
    place : Face
    letters : tuple of str
        Of its directions along the face, and across.
    middles, widths : ndarray, shape (2,)
        Where contact is along each coordinate of the face, and how wide, in elements of that.
    kept : ndarray, shape (3,)
        Share of what the body gives way by that elements may keep back along each direction.
    softness : float
        Share of the side in what both bodies give way.
    """

    place: Face
    letters: tuple[str, str, str]
    middles: FloatArray
    widths: FloatArray
    kept: FloatArray
    softness: float

    @property
    def suspect(self) -> float:
        """Share of what both bodies give way by that its elements may keep back."""
        return self.softness * min(MOST, float(np.linalg.norm(self.kept)))

    @property
    def along(self) -> float:
        """The same of those along the face alone."""
        return self.softness * min(MOST, float(np.linalg.norm(self.kept[:2])))


@frozen
class LongElements:
    """What elements of both sides of a contact keep back.

    Attributes
    ----------
    sides : tuple of SideElements
        Slave and master, but for a rigid plane.
    longer : bool
        Whether the master's elements are longer than the slave's.
    known : ndarray, shape (sides,)
        How much further sides would be pressed in by short elements, over how far all are; not a number of what is not known.
    rows : float
        Share of the force that it adds that contact lies between two rows of its slave.
    yields : Yields
        How far both give way.
    """

    sides: tuple[SideElements, ...]
    longer: bool
    known: FloatArray
    rows: float
    yields: Yields

    @property
    def of_sides(self) -> FloatArray:
        """Shares of the force that elements of sides add to it, about, shape (sides,) (theory 9.15, 9.26, 9.27)."""
        estimates = np.array([side.along if self.longer and side is self.sides[-1] else 0.0 for side in self.sides])
        alone = np.where(np.isnan(self.known), estimates / (1.0 - estimates), self.known)
        alone[0] += self.rows
        whole = float(alone.sum())
        return np.asarray(alone * (self.yields.of_force(whole) / whole if whole > 0.0 else 0.0))

    @property
    def costs(self) -> float:
        """Share of the force that both add to it, about."""
        return float(self.of_sides.sum())

    @property
    def is_told(self) -> bool:
        """Whether it costs enough to be told."""
        return self.costs > COSTS

    def sentence(self, problem: Problem, contact: Contact, step: int) -> str:
        """What is said of it at the end of a load step: of the side that adds more."""
        worst = int(np.argmax(self.of_sides))
        side, what = self.sides[worst], ("slave", "master")[worst]
        stage = problem.stages[problem.stage_of(step)].name
        most = float(side.kept.max())
        few = [letter for letter, kept, part in zip(side.letters, side.kept, PARTS, strict=True) if 0.0 < kept >= part * most]
        few = few or list(side.letters[:2])
        keys = ", ".join(f"bodies.{name}.mesh.elements" for name in dict.fromkeys(face.body for face in side.place.faces))
        return (
            f"contact {contact.name!r}, load step {step}, the last of stage {stage!r}: elements of its {what} {side.place.words} are "
            f"too long for it, and too stiff: it is {side.widths[0]:.2g} of them wide along {side.letters[0]} and {side.widths[1]:.2g} "
            f"along {side.letters[1]}. Forces under given motions may be too large by about {10 * round(10.0 * min(LARGEST, self.costs))} "
            f"%, or by little, as knots lie there, and pressures by more. Take twice as many elements or more along {' and '.join(few)} "
            f"({keys}), or shorter ones there (mesh.grading)"
        )


class LongElementsLook:
    """Looks for elements that are too long for a contact; what is computed of one serves as long as it lies about where it did."""

    def __init__(self) -> None:
        self._looked = dict[int, tuple[FloatArray, FloatArray]]()

    def __call__(self, equilibrium: Equilibrium, balance: Balance, number: int, yields: Yields) -> LongElements | None:
        """How a contact that presses lies on elements of its bodies (theory 9.15, 9.26); None of what pulls."""
        pair, projections, problem = equilibrium.pairs[number].pair, balance.kinematics[number].projections, equilibrium.problem
        forces = pair.slave.area * np.maximum(pair.field(balance.responses[number].pressure), 0.0) * (projections.found > 0)
        if not forces.any() or pulls(equilibrium, balance, number):
            return None
        share = forces / forces.sum()
        soft = np.array([share @ part for part in softness(problem, equilibrium.numbering, pair, projections)])
        if not soft.any():
            return None
        on_faces = (pair.contact.slave, coordinates_of_slave(pair, equilibrium)), (pair.contact.master, projections.xi)
        places = [(place, at) for place, at in on_faces if isinstance(place, Face)]
        first, *others = (_side(problem, *place, share, part) for place, part in zip(places, soft / soft.sum(), strict=False))
        rows = bearing(equilibrium, balance, number, yields).adds
        sides = replace(first, kept=np.maximum(first.kept, np.append(rows, 0.0))), *others
        lengths = [Sheet.of(problem, place).element_size for place, _ in places]
        longer = problem.images == 1 and lengths[-1] > FINER * lengths[0]
        known = np.zeros(len(sides))
        if rows.any() or sum(side.suspect for side in sides) > SUSPECT:
            at_points = pair.contact.enforcement in AT_POINTS  # forces there press in the further, the shorter elements are
            known = known + np.nan if at_points else self._known(equilibrium, balance, number, yields, sides, places)
        return LongElements(sides, longer, known, float(rows.sum()), yields)

    def _known(
        self,
        equilibrium: Equilibrium,
        balance: Balance,
        number: int,
        yields: Yields,
        sides: Sequence[SideElements],
        places: Sequence[tuple[Face, FloatArray]],
    ) -> FloatArray:
        """How much further sides would be pressed in, over how far all are; as it was, where contact lay and was as wide as now."""
        lies = np.array([(side.middles, side.widths) for side in sides])
        within = SAME * np.array([(np.ones(2), np.maximum(1.0, side.widths)) for side in sides])
        if number in self._looked and np.all(np.abs(lies - self._looked[number][0]) < within):
            return self._looked[number][1]
        pressed = float(yields.pressed.sum())
        found = further(equilibrium, balance, number, places) / pressed if pressed > 0.0 else np.zeros(len(sides))
        self._looked[number] = lies, found
        return found


def _side(problem: Problem, place: Face, at: FloatArray, share: FloatArray, softness: float) -> SideElements:
    """A side of a contact whose force is at some coordinates, by shares of it."""
    sheet = Sheet.of(problem, place)
    along = zip(at.T, sheet.directions, sheet.closed, mirrored_ends(problem, place, sheet.letters), strict=True)
    found = [extent(one, share, d.boundaries, np.arange(d.elements + 1.0), closed, mirror) for one, d, closed, mirror in along]
    middles, widths = np.array(found).T
    narrow = np.divide(1.0, widths, out=np.full(2, np.inf), where=widths > 0.0)
    narrow[widths > ALL * np.array([direction.elements for direction in sheet.directions])] = 0.0
    orders = np.array([direction.order for direction in sheet.directions])
    kept = np.append(
        KEEPS * np.minimum(1.0, SMOOTH / orders) * np.maximum(0.0, narrow - FREE), _across(problem, place, widths, narrow > 0.0)
    )
    return SideElements(place, (*sheet.letters, place.face[0]), middles, widths, np.minimum(MOST, kept), softness)


def _across(problem: Problem, place: Face, widths: FloatArray, narrow: BoolArray) -> float:
    """What elements at a face may keep back across it, by how high they are and how wide contact is; none of joined faces."""
    patch, axis, sheet = problem.body(place.body).patch, "uvw".index(place.face[0]), Sheet.of(problem, place)
    order = patch.directions[axis].order
    counts = widths > 0.0 if order == 1 else narrow & (widths > 0.0)
    if len(place.faces) > 1 or not counts.any():
        return 0.0
    lengths = element_lengths(patch)
    wide = widths * [np.median(lengths["uvw".index(letter)]) for letter in sheet.letters]
    high = float(lengths[axis][-int(place.face[1])] / wide[counts].min())
    return LINEAR * high if order == 1 else ACROSS * (SMOOTH / order) ** 2 * max(0.0, high - FREE)
