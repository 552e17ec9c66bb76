"""The collocated contact surface: stresses of the bulk at points of both faces, in place of virtual work there (theory 10.15)."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, cached_property

import numpy as np
from patch_tests.contact import MATERIAL, functions, knots
from scipy.interpolate import BSpline

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, Shown, case

#: Elements along the contact of a slave and of a master, whose knots do not meet inside, and of a reference of order 3.
SLAVE, MASTER, FINE = 8, 11, 24
#: Depth and curvature of a parabola that is pressed into the middle of a unit length, so that about four fifths of it touch.
_DEPTH, _CURVATURE = 0.08, 1.0
#: Flexibility of penalties over that of both bodies, which are as deep as they are wide.
PENALTIES = {"two fields, soft": 1e-2, "two fields, stiff": 1e-5}
#: `one field`: the slave's pressures act at the master's points as well. `two fields`: either side has its own, by penalties on gaps there.
FORMS = ("mortar", "one field", *PENALTIES)
#: Orders that have stresses at every point of a face.
ORDERS = (2, 3, 4)
_SHEAR = MATERIAL.shear
#: Stresses along a stretch and across it, in plane strain.
_ALONG, _ACROSS = MATERIAL.modulus, MATERIAL.bulk - 2.0 / 3.0 * _SHEAR
#: Of both squares between walls.
_FLEXIBILITY = 2.0 / MATERIAL.modulus
#: Depth at places along the contact.
Profile = Callable[[FloatArray], FloatArray]


def slopes(order: int, elements: int, places: FloatArray) -> FloatArray:
    """Derivatives of `functions`, shape (places, functions)."""
    ends = knots(order, elements)
    return np.asarray(BSpline(ends, np.eye(elements + order), order)(places, nu=1))


def greville(order: int, elements: int) -> FloatArray:
    """Where the functions belong, shape (functions,)."""
    ends = knots(order, elements)
    return np.array([ends[i + 1 : i + order + 1].mean() for i in range(elements + order)])


def rule(ends: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Gauss points between places, and their weights."""
    points, weights = np.polynomial.legendre.leggauss(count)
    lengths = np.diff(ends)[:, None]
    return (ends[:-1, None] + 0.5 * lengths * (1.0 + points)).ravel(), (0.5 * lengths * weights).ravel()


class Square:
    """A unit square in plane strain, in small deformations: contact at z = 0, held at z = 1; unknowns are all along x, then all along z."""

    def __init__(self, order: int, elements: int, walls: bool) -> None:
        """Its sides are free, or along `walls` without friction; then its far side can slide as well."""
        self.order, self.elements, self.count = order, elements, elements + order
        self._size = self.count**2
        grid = np.arange(self._size).reshape(self.count, self.count)
        sides = grid[:, [0, -1]].ravel()
        held = np.r_[sides if walls else grid[-1], self._size + grid[-1]]
        self._free = np.setdiff1d(np.arange(2 * self._size), held)

    @cached_property
    def stiffness(self) -> FloatArray:
        """Between all unknowns."""
        places, weights = rule(np.linspace(0.0, 1.0, self.elements + 1), self.order + 1)
        values, rises = (each(self.order, self.elements, places) for each in (functions, slopes))
        mass, mixed, rise = (one.T @ (weights[:, None] * other) for one, other in ((values, values), (rises, values), (rises, rises)))
        along_x, along_z, both = np.kron(mass, rise), np.kron(rise, mass), np.kron(mixed.T, mixed)
        coupled = _ACROSS * both + _SHEAR * both.T
        return np.block([[_ALONG * along_x + _SHEAR * along_z, coupled], [coupled.T, _ALONG * along_z + _SHEAR * along_x]])

    def _moved(self, matrix: FloatArray, right: FloatArray) -> FloatArray:
        """Displacements of all unknowns for some right-hand sides."""
        found = np.zeros_like(right)
        found[self._free] = np.linalg.solve(matrix[np.ix_(self._free, self._free)], right[self._free])
        return found

    def by_forces(self) -> FloatArray:
        """Displacements along z of the face's control points by forces on them."""
        right = np.zeros((2 * self._size, self.count))
        right[self._size : self._size + self.count] = np.eye(self.count)
        return self._moved(self.stiffness, right)[self._size : self._size + self.count]

    def by_pressures(self) -> tuple[FloatArray, FloatArray]:
        """The same by pressures at the face's Greville abscissae, where stresses are the equations (theory 10.15); and forces of them."""
        places, edge = greville(self.order, self.elements), np.zeros(1)
        values, rises = (each(self.order, self.elements, places) for each in (functions, slopes))
        here, rising = (each(self.order, self.elements, edge)[0] for each in (functions, slopes))
        by_x, by_z = np.kron(here, rises), np.kron(rising, values)
        matrix, right = self.stiffness.copy(), np.zeros((2 * self._size, self.count))
        normal = slice(self._size, self._size + self.count)
        matrix[: self.count], matrix[normal] = _SHEAR * np.hstack([by_z, by_x]), np.hstack([_ACROSS * by_x, _ALONG * by_z])
        right[normal] = -np.eye(self.count)
        moved = self._moved(matrix, right)
        return moved[normal], (self.stiffness @ moved)[normal].sum(axis=0)


def closed(closing: FloatArray, start: FloatArray) -> FloatArray:
    """Pressures that press gaps shut, and are nothing elsewhere, by active sets.

    Parameters
    ----------
    closing : ndarray, shape (n, n)
        What pressures take of gaps.
    start : ndarray, shape (n,)
        Gaps where nothing presses.
    """
    active, pressures = start > 0.0, np.zeros(len(start))
    for _ in range(50):
        pressures = np.zeros(len(start))
        pressures[active] = np.linalg.solve(closing[np.ix_(active, active)], start[active])
        trial = pressures + (start - closing @ pressures) / np.diag(closing)
        if np.array_equal(trial > 0.0, active):
            return pressures
        active = trial > 0.0
    raise RuntimeError("the active set does not settle")


def mortar(slave: Square, master: Square, depth: Profile) -> tuple[FloatArray, float, float]:
    """Pressures at the slave's Greville abscissae, and forces on both, by averages over cells between the knots of both."""
    lines = [np.linspace(0.0, 1.0, square.elements + 1) for square in (slave, master)]
    places, weights = rule(np.unique(np.round(np.concatenate(lines), 12)), slave.order + 1)
    own, others = (functions(square.order, square.elements, places) for square in (slave, master))
    mass, mixed = own.T @ (weights[:, None] * own), others.T @ (weights[:, None] * own)
    control = closed(mass @ slave.by_forces() @ mass + mixed.T @ master.by_forces() @ mixed, own.T @ (weights * depth(places)))
    at_points = functions(slave.order, slave.elements, greville(slave.order, slave.elements)) @ control
    return at_points, float((mass @ control).sum()), float((mixed @ control).sum())


def one_field(slave: Square, master: Square, depth: Profile) -> tuple[FloatArray, float, float]:
    """Gaps closed at the slave's Greville abscissae; its field of pressures acts at the master's."""
    places, others = (greville(square.order, square.elements) for square in (slave, master))
    own, across = (functions(square.order, square.elements, places) for square in (slave, master))
    carried = functions(slave.order, slave.elements, others) @ np.linalg.inv(own)
    (moved, force), (moved_master, force_master) = slave.by_pressures(), master.by_pressures()
    pressures = closed(own @ moved + across @ moved_master @ carried, depth(places))
    return pressures, float(force @ pressures), float(force_master @ carried @ pressures)


def two_fields(slave: Square, master: Square, depth: Profile, penalty: float) -> tuple[FloatArray, float, float]:
    """Pressures at either's Greville abscissae by penalties on the gaps there; those of both, the slave's first."""
    places = np.concatenate([greville(square.order, square.elements) for square in (slave, master)])
    (moved, force), (moved_master, force_master) = slave.by_pressures(), master.by_pressures()
    own, across = (functions(square.order, square.elements, places) for square in (slave, master))
    closing = np.hstack([own @ moved, across @ moved_master]) + np.eye(len(places)) / penalty
    pressures = closed(closing, depth(places))
    return pressures, float(force @ pressures[: slave.count]), float(force_master @ pressures[slave.count :])


def pressed(form: str, order: int, depth: Profile, *, walls: bool) -> tuple[FloatArray, float, float]:
    """Pressures and forces on both squares by a form."""
    squares = Square(order, SLAVE, walls), Square(order, MASTER, walls)
    if form in PENALTIES:
        return two_fields(*squares, depth, 1.0 / (PENALTIES[form] * _FLEXIBILITY))
    return (mortar if form == "mortar" else one_field)(*squares, depth)


def exactly(form: str, order: int) -> dict[str, Bound]:  # noqa: ARG001
    """Round-off, and what a penalty leaves of the digits of gaps."""
    limit = 1e-14 / PENALTIES.get(form, 1e-2)
    return {
        "pressure": Bound(at_most=limit, reason="round-off: of stresses, a hundred times; of gaps that are a share of the displacements")
    }


@case(
    claim="On meshes that do not match the collocated contact surface passes the patch test, to round-off, as averages do in cells.",
    tier="gate",
    grid={"form": FORMS, "order": ORDERS},
    bounds=exactly,
)
def collocated_patch(form: str, order: int) -> dict[str, float]:
    """Largest relative error of the pressures of two squares between walls."""
    pressures, _, _ = pressed(form, order, lambda places: np.full(len(places), _DEPTH), walls=True)
    expected = _DEPTH / (_FLEXIBILITY * (1.0 + PENALTIES.get(form, 0.0)))
    return {"pressure": float(np.abs(pressures / expected - 1.0).max())}


def parabola(places: FloatArray) -> FloatArray:
    """Its depth."""
    return _DEPTH - 0.5 * _CURVATURE * (places - 0.5) ** 2


@cache
def reference() -> float:
    """Force of the parabola by averages on a fine mesh."""
    squares = Square(3, FINE, False), Square(3, FINE, False)
    return mortar(*squares, parabola)[1]


@case(
    claim="Where pressures are not uniform the forces on both bodies of the collocated contact surface are not opposite; with pressures of "
    "either side by its own gaps they are far off once penalties are stiff.",
    tier="gate",
    grid={"form": FORMS, "order": ORDERS},
    bounds=lambda form, order: {  # noqa: ARG005
        "forces": Bound(at_most=1e-12, reason="round-off: both are sums of the same pressures at the same points")
        if form == "mortar"
        else Bound(at_least=1e-6, reason="theory: no virtual work says that they are opposite; far above round-off"),
        "off": Shown("discretisation: force on the slave, off that by averages on a fine mesh"),
    },
)
def collocated_press(form: str, order: int) -> dict[str, float]:
    """Difference of the forces on both squares over the slave's, and how far that is off; of a parabola pressed into its middle."""
    _, on_slave, on_master = pressed(form, order, parabola, walls=False)
    return {"forces": abs(on_master / on_slave - 1.0), "off": abs(on_slave / reference() - 1.0)}
