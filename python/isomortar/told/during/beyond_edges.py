"""Elements of a slave that go on beyond an edge of its master: they cannot follow what it presses in, and are too stiff."""

from __future__ import annotations

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model.enforcement.face import SlaveFace, grid
from isomortar.model.entities import Contact, Problem
from isomortar.model.sheet import Sheet
from isomortar.model.supports import BoolArray
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import slave_points
from isomortar.told.during.giving_way import Yields
from isomortar.told.during.softness import softness

#: Share of the force by which an edge of the master makes contact too stiff, times the width in elements that is over the master: fitted to
#: punches, of widths from a fifth of an element to ten, on blocks of order 1 to 3.
STIFFENS = 0.1
#: Parts of an element along a line that are looked at.
PARTS = 8
#: Share of the force from which on it is told.
COSTS = 0.15
#: Pressure at an end, beside the mean of what is over the master, above which it is held up there.
LOADED = 0.3
#: A direction is too coarse where it costs this share of what the other one does.
PART = 0.5


@frozen
class BeyondEdges:
    """What of a contact is over its master.

    Attributes
    ----------
    widths : ndarray, shape (2,)
        How wide that is along each coordinate of the slave face, in elements of that.
    edges : ndarray of int, shape (2,)
        At how many ends of that the slave goes on.
    softness : float
        Share of the slave in what both bodies give way.
    yields : Yields
        How far both do.
    """

    widths: FloatArray
    edges: FloatArray
    softness: float
    yields: Yields

    @property
    def costs(self) -> FloatArray:
        """Shares of the force that elements along each coordinate add to it, by an estimate, shape (2,) (theory 9.13)."""
        alone = self.softness * STIFFENS * self.edges / self.widths
        whole = float(alone.sum())
        return np.asarray(alone * (self.yields.of_force(whole) / whole if whole > 0.0 else 0.0))

    @property
    def is_told(self) -> bool:
        """Whether it costs enough to be told."""
        return bool(self.costs.sum() > COSTS)

    def sentence(self, problem: Problem, contact: Contact, step: int) -> str:
        """What is said of it at the end of a load step."""
        letters, body, stage = Sheet.of(problem, contact.slave).letters, contact.slave.body, problem.stages[problem.stage_of(step)].name
        over = " and ".join(
            f"{width:.2g} along {letter}" for letter, width, edges in zip(letters, self.widths, self.edges, strict=True) if edges
        )
        few = [letter for letter, costs in zip(letters, self.costs, strict=True) if costs > PART * self.costs.max()]
        return (
            f"contact {contact.name!r}, load step {step}, the last of stage {stage!r}: elements of its slave {contact.slave.words} are too "
            f"long for its master, beyond whose edges they go on: {over} are over it, and too stiff. Forces under given motions may be too "
            f"large by about {10 * round(10.0 * float(self.costs.sum()))} %, pressures by more. Take twice as many elements or more along "
            f"{' and '.join(few)} (bodies.{body}.mesh.elements), or shorter ones there (mesh.grading)"
        )


def beyond_edges(equilibrium: Equilibrium, balance: Balance, number: int, yields: Yields) -> BeyondEdges | None:
    """What is over the master, along the lines of the face that bear most (theory 9.13); None where all is, or nothing.

    Lines are lines of places, each as its nearest quadrature point is. What does not bear at its end is not held up there.
    """
    pair = equilibrium.pairs[number].pair
    projections, pressure = balance.kinematics[number].projections, pair.field(balance.responses[number].pressure)
    contact, problem, found = pair.contact, equilibrium.problem, projections.found > 0
    if found.all() or not found.any():
        return None
    from scipy.spatial import cKDTree

    face = SlaveFace(contact, problem, equilibrium.numbering)
    (u, du), (v, dv) = (_places(direction) for direction in face.directions)
    nodes, values, slopes = face.at(grid(u, v))
    places = np.einsum("qa,qai->qi", values, balance.positions[face.point[nodes]])
    nearest = cKDTree(slave_points(pair, balance.positions)).query(places)[1]
    over, bears = (part[nearest].reshape(len(v), -1) for part in (found, np.where(found, np.maximum(pressure, 0.0), 0.0)))
    closed_u, closed_v = face.closed
    widths, edges = np.array([_run(over, bears, closed_u), _run(over.T, bears.T, closed_v)]).T
    if edges.any():  # areas are known better than lines, where quadrature points are few
        area = np.sum(np.prod(grid(du, dv), axis=1) * face.areas(nodes, slopes), where=over.ravel())
        widths[edges > 0] *= (np.sum(pair.slave.area, where=found) / area) ** (1.0 / np.count_nonzero(edges))
    slave, master = (part[found].sum() for part in softness(problem, equilibrium.numbering, pair, projections))
    return BeyondEdges(widths, edges, slave / (slave + master), yields)


def _places(direction: Direction) -> tuple[FloatArray, FloatArray]:
    """Middles of equal parts of each element along a direction, and lengths of these."""
    lengths = np.diff(direction.boundaries)[:, None]
    middles = direction.boundaries[:-1, None] + lengths * (np.arange(PARTS) + 0.5) / PARTS
    return middles.ravel(), np.repeat(lengths / PARTS, PARTS)


def _run(over: BoolArray, bears: FloatArray, closed: bool) -> tuple[float, int]:
    """Of the line that bears most, how many elements of those that are over the master beside each other, and at how many ends they bear.

    `over`, `bears`: by lines and places, which begin anew after the last where the face meets itself.
    """
    line = int(np.argmax(bears.sum(axis=1)))
    # Along an edge of the master some points beyond it are nearer to places within than those within: lines beside tell of these.
    beside_it = np.asarray(over[max(line - 1, 0) : line + 2].any(axis=0))
    over, bears, first = beside_it, bears[line], int(np.argmax(bears[line]))
    if over.all():
        return len(over) / PARTS, 0
    if closed:
        shift = len(over) // 2 - first
        over, bears, first = np.roll(over, shift), np.roll(bears, shift), len(over) // 2
    beside = np.flatnonzero(~over)
    low, high = beside[beside < first].max(initial=-1) + 1, beside[beside > first].min(initial=len(over))
    run, last = bears[low:high], max(1, min(PARTS // 2, (high - low) // 2))
    ends = (low > 0, run[:last]), (high < len(over), run[-last:])
    return len(run) / PARTS, sum(bool(is_edge and end.mean() > LOADED * run.mean()) for is_edge, end in ends)
