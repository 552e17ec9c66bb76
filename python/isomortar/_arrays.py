"""The arrays that the kernel reads, checked where they are made.

Arrays have the point index first here (``positions`` is (n, 3)); the kernel sees the same memory with it last.
Control points, elements and unknowns count from 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal, get_args

import numpy as np

from isomortar import _arguments as check
from isomortar._arguments import FloatArray, IntArray
from isomortar.errors import InputError

#: Material laws in the order of their numbers in the kernel (isomortar_solid_material_table), from 1.
MaterialLaw = Literal["neo-hookean", "neo-hookean-j", "linear-elastic"]
LAWS = {name: number for number, name in enumerate(get_args(MaterialLaw), start=1)}
#: Numbers of the friction laws in the kernel (isomortar_contact_friction_table); 0: no friction.
FRICTION_LAWS = {"none": 0, "coulomb": 1, "capped": 2}


@dataclass(frozen=True)
class PatchArrays:
    """A volume patch, flat: families, orders and counts; knots one after the other; global control points; weights."""

    layout: IntArray
    knots: FloatArray
    point: IntArray
    weight: FloatArray

    def __post_init__(self) -> None:
        check.patch(self.layout, self.knots, self.point, self.weight)

    @cached_property
    def highest(self) -> int:
        """Largest number of a control point."""
        return check.highest(self.point)

    @cached_property
    def elements(self) -> tuple[int, int, int]:
        """Elements (non-empty knot spans) by direction."""
        family, order, count = self.layout.reshape(3, 3)
        lengths = np.where(family == 1, count + order + 1, (count - 1) // order + 1)
        u, v, w = (len(np.unique(part)) - 1 for part in np.split(self.knots, np.cumsum(lengths[:2])))
        return u, v, w

    def face(self, axis: int) -> tuple[int, int, int, int]:
        """Functions of an element and elements by direction of the faces across an axis (1 to 3)."""
        first, second = axis % 3, (axis + 1) % 3
        return int(self.layout[3 + first]) + 1, int(self.layout[3 + second]) + 1, self.elements[first], self.elements[second]


@dataclass(frozen=True)
class MaterialArrays:
    """A material: number of its law (isomortar_solid_material_table) and what that takes, the moduli A1 and A2."""

    law: int
    parameters: FloatArray

    def __post_init__(self) -> None:
        check.whole("law", self.law, 1, len(LAWS))
        for modulus in check.array("parameters", self.parameters, np.float64, 2):
            check.real("parameters", float(modulus), lambda value: value > 0, "numbers above 0")


@dataclass(frozen=True)
class FrictionArrays:
    """A law of friction: its number (isomortar_contact_friction_table) and what that takes: nothing, mu, or mu, c and tau_max."""

    law: int
    parameters: FloatArray

    def __post_init__(self) -> None:
        check.whole("friction.law", self.law, 0, len(FRICTION_LAWS) - 1)
        for parameter in check.array("friction.parameters", self.parameters, np.float64, None):
            check.real("friction.parameters", float(parameter), lambda value: value >= 0, "numbers not below 0")

    @property
    def acts(self) -> bool:
        """Whether there is friction."""
        return self.law != FRICTION_LAWS["none"]


@dataclass(frozen=True)
class MasterArrays:
    """A master, flat: axis and end of a face and the layout of its patch, or axis 0 and a plane's vectors in `knots`."""

    kind: IntArray
    knots: FloatArray
    point: IntArray
    weight: FloatArray

    def __post_init__(self) -> None:
        check.array("kind", self.kind, np.int32, 11)
        check.whole("kind", self.kind[0], 0, 3)
        if self.kind[0]:
            check.whole("kind", self.kind[1], 0, 1)
            check.patch(self.kind[2:], self.knots, self.point, self.weight)
        else:
            check.finite("knots", check.array("knots", self.knots, np.float64, 9))
            check.array("point", self.point, np.int32, None)
            check.array("weight", self.weight, np.float64, len(self.point))

    @cached_property
    def highest(self) -> int:
        """Largest number of a control point; -1: a plane has none."""
        return check.highest(self.point) if self.kind[0] else -1

    @cached_property
    def elements(self) -> tuple[int, int] | None:
        """Elements by direction of the surface; None: a plane."""
        if not self.kind[0]:
            return None
        return PatchArrays(self.kind[2:], self.knots, self.point, self.weight).face(int(self.kind[0]))[2:]


@dataclass(frozen=True)
class SlaveArrays:
    """A slave side: control points of each element, functions at the quadrature points, areas, global control points.

    Shapes (elements, local), (points, local), (points,), (slave control points,).
    """

    nodes: IntArray
    basis: FloatArray
    area: FloatArray
    point: IntArray

    def __post_init__(self) -> None:
        elements, local = check.array("nodes", self.nodes, np.int32, None, None).shape
        points = len(check.finite("area", check.array("area", self.area, np.float64, None)))
        check.finite("basis", check.array("basis", self.basis, np.float64, points, local))
        check.array("point", self.point, np.int32, None)
        check.within("nodes", self.nodes, 0, len(self.point) - 1)
        check.within("point", self.point, 0, check.MAX_POINT)
        if not elements or points % elements:
            raise InputError(f"has {points} quadrature points for {elements} elements; allowed: as many in each element", "area")

    @cached_property
    def highest(self) -> int:
        """Largest number of a control point."""
        return check.highest(self.point)


@dataclass(frozen=True)
class Pattern:
    """Compressed rows of 3x3 blocks."""

    start: IntArray
    column: IntArray

    def __post_init__(self) -> None:
        check.rows(self.start, self.column)

    @cached_property
    def highest(self) -> int:
        """Largest number of a column."""
        return check.highest(self.column)


@dataclass(frozen=True)
class Projections:
    """Slave quadrature points on the master: coordinates, element, whether found, slip increment and whether it counts.

    `doubt`: 0, or for a point that is found, but whose foot does not follow it, a status (isomortar_base_status) that says why: then its
    distance alone means something.
    `fixed`: 1 for coordinates that stay while the point moves, on lines across which the master is only continuous, shape (points, 2).
    """

    xi: FloatArray
    element: IntArray
    fixed: IntArray
    found: IntArray
    doubt: IntArray
    slip: FloatArray
    slips: IntArray

    def __post_init__(self) -> None:
        points = len(check.array("found", self.found, np.int32, None))
        check.array("xi", self.xi, np.float64, points, 2)
        check.array("element", self.element, np.int32, points, 2)
        check.array("fixed", self.fixed, np.int32, points, 2)
        check.array("doubt", self.doubt, np.int32, points)
        check.array("slip", self.slip, np.float64, points, 2)
        check.array("slips", self.slips, np.int32, points)

    @property
    def followed(self) -> IntArray:
        """1 for points that have a foot which follows them: slips count from there."""
        return np.where(self.doubt == 0, self.found, np.int32(0))

    @cached_property
    def range(self) -> tuple[int, int, int]:
        """Lowest element of the points that were found, and the highest by direction."""
        found = self.element[self.found != 0]
        first, second = found.max(axis=0, initial=-1).tolist()
        return int(found.min(initial=0)), first, second


@dataclass(frozen=True)
class Control:
    """Control quantities of every slave control point: <R>, <R R>, <R g>, <R slip>, <R R a_ab>; a_ab at the points."""

    weight: FloatArray
    square: FloatArray
    gap: FloatArray
    slip: FloatArray
    metric: FloatArray
    point_metric: FloatArray


@dataclass(frozen=True)
class Law:
    """Augmented penalty law: penalties (normal, tangential), law of friction, current multipliers, the paper's slip sum or the local one.

    What supports hold: control points with `bears` 0 bear nothing, and `free`, shape (n, 2, 2), projects the covariant tractions of the
    others (component, traction) so that nothing is left along it.
    Trials above (1 - `slip_margin`) of what friction bears slip; `held` control points (1) stick whatever their trial; `forgiving` takes
    the current traction for the radial part of the slip derivative (theory 4.14).
    """

    penalties: FloatArray
    friction: FrictionArrays
    pressure: FloatArray
    traction: FloatArray
    summed: bool
    bears: IntArray
    free: FloatArray
    held: IntArray
    slip_margin: float = 0.0
    forgiving: bool = False


@dataclass(frozen=True)
class Response:
    """Control pressures and tractions, states (0 open, 1 stick, 2 slip), and their slopes."""

    pressure: FloatArray
    traction: FloatArray
    state: IntArray
    pressure_slope: FloatArray
    traction_slope: FloatArray
    field_slip: FloatArray
