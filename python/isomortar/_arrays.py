"""The arrays that the kernel reads, checked where they are made.

Arrays have the point index first here (``positions`` is (n, 3)); the kernel sees the same memory with it last.
Control points, elements and unknowns count from 0.
"""

from __future__ import annotations

from dataclasses import field
from functools import cached_property
from typing import ClassVar, Literal, Self, get_args

import numpy as np

from isomortar import _arguments as check
from isomortar._arguments import FloatArray, IntArray
from isomortar._frozen import frozen
from isomortar.errors import InputError

#: Material laws in the order of their numbers in the kernel (isomortar_solid_material_table), from 1.
MaterialLaw = Literal["neo-hookean", "neo-hookean-j", "linear-elastic"]
LAWS = {name: number for number, name in enumerate(get_args(MaterialLaw), start=1)}
#: Numbers of the friction laws in the kernel (isomortar_contact_friction_table); 0: no friction.
FRICTION_LAWS = {"none": 0, "coulomb": 1, "capped": 2}


@frozen(eq=False)
class PatchArrays:
    """A volume patch, flat.

    Parameters
    ----------
    families, orders, counts : ndarray of int32, shape (3,)
        By direction: 1 NURBS, 2 Lagrange; order; number of control points.
    knots : ndarray
        Knots (of Lagrange elements: boundaries) of the directions, one after the other.
    point : ndarray of int32
        Global number of each control point, the first direction fastest.
    weight : ndarray
        Weight of each.
    """

    families: IntArray
    orders: IntArray
    counts: IntArray
    knots: FloatArray
    point: IntArray
    weight: FloatArray

    def __post_init__(self) -> None:
        check.patch(self.families, self.orders, self.counts, self.knots, self.point, self.weight)

    @cached_property
    def highest(self) -> int:
        """Largest number of a control point."""
        return check.highest(self.point)

    @cached_property
    def elements(self) -> tuple[int, int, int]:
        """Elements (non-empty knot spans) by direction."""
        lengths = np.where(self.families == 1, self.counts + self.orders + 1, (self.counts - 1) // self.orders + 1)
        u, v, w = (len(np.unique(part)) - 1 for part in np.split(self.knots, np.cumsum(lengths[:2])))
        return u, v, w

    def face(self, axis: int) -> tuple[int, int, int, int]:
        """Functions of an element and elements by direction of the faces across an axis (1 to 3)."""
        first, second = axis % 3, (axis + 1) % 3
        return int(self.orders[first]) + 1, int(self.orders[second]) + 1, self.elements[first], self.elements[second]


@frozen(eq=False)
class BodyArrays:
    """A body: its patch, Gauss points of an element by direction, and the reference positions of all control points, shape (n, 3).

    `often`: what it has at its Gauss points is kept, 184 bytes each, and not computed with its forces.
    """

    patch: PatchArrays
    gauss: tuple[int, int, int]
    reference: FloatArray
    often: bool = False

    def __post_init__(self) -> None:
        check.kind("patch", self.patch, PatchArrays)
        check.gauss("gauss", self.gauss, 3)
        check.finite("reference", check.array("reference", self.reference, np.float64, None, 3))
        check.flag("often", self.often)
        check.below("patch.point", self.patch.highest, len(self.reference), "control point")


@frozen(eq=False)
class MaterialArrays:
    """A material: number of its law (isomortar_solid_material_table) and what that takes, the moduli A1 and A2."""

    law: int
    parameters: FloatArray

    def __post_init__(self) -> None:
        check.whole("law", self.law, 1, len(LAWS))
        for modulus in check.array("parameters", self.parameters, np.float64, 2):
            check.real("parameters", float(modulus), lambda value: value > 0, "numbers above 0")


@frozen(eq=False)
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


#: The law of none.
NO_FRICTION = FrictionArrays(FRICTION_LAWS["none"], np.zeros(0))


@frozen(eq=False)
class PlaneArrays:
    """A rigid plane as a master: a point of it, its normal and a direction in it, each of shape (3,)."""

    origin: FloatArray
    normal: FloatArray
    tangent: FloatArray
    #: It has no control points, and no elements.
    highest: ClassVar[int] = -1
    elements: ClassVar[None] = None

    def __post_init__(self) -> None:
        for name in ("origin", "normal", "tangent"):
            check.finite(name, check.array(name, getattr(self, name), np.float64, 3))


@frozen(eq=False)
class FaceArrays:
    """A face of a deformable body as a master: its patch, the axis across the face (1 to 3) and its end there (0, 1).

    `brim`: how far it goes on beyond its edges, as a share of the outer elements. `mirror`, shape (directions, 2), start and end:
    component (1 to 3) across the plane of symmetry that an edge is on, 0: none (theory 3.21).
    """

    patch: PatchArrays
    axis: int
    side: int
    brim: float = 0.0
    mirror: IntArray = field(default_factory=lambda: np.zeros((2, 2), np.int32))

    def __post_init__(self) -> None:
        check.kind("patch", self.patch, PatchArrays)
        check.face(self.axis, self.side)
        check.real("brim", self.brim, lambda value: 0 <= value <= 1, "numbers from 0 to 1")
        check.within("mirror", check.array("mirror", self.mirror, np.int32, 2, 2), 0, 3)

    @property
    def highest(self) -> int:
        """Largest number of a control point."""
        return self.patch.highest

    @cached_property
    def elements(self) -> tuple[int, int]:
        """Elements by direction of the surface."""
        return self.patch.face(self.axis)[2:]


@frozen(eq=False)
class AveragedFaceArrays(FaceArrays):
    """A face as a master on which feet are found along the averaged normal."""


MasterArrays = PlaneArrays | FaceArrays


@frozen(eq=False)
class FunctionArrays:
    """Functions on a slave face: those of each element, shape (elements, local), their values, (points, local), and how many they are."""

    nodes: IntArray
    values: FloatArray
    count: int

    def __post_init__(self) -> None:
        _, local = check.array("nodes", self.nodes, np.int32, None, None).shape
        check.finite("values", check.array("values", self.values, np.float64, None, local))
        check.within("nodes", self.nodes, 0, check.whole("count", self.count, 0, check.MAX_POINT) - 1)


@frozen(eq=False)
class SlaveArrays:
    """A slave side.

    Parameters
    ----------
    shape : FunctionArrays
        Functions that interpolate the positions of its control points.
    test : FunctionArrays
        Functions that constraints are weighted with and multipliers interpolated by; those of the mortar method are the shape functions.
    area : ndarray, shape (points,)
        Reference areas of the quadrature points; as many in each element.
    point : ndarray of int32, shape (slave control points,)
        Global number of each control point.
    slopes : ndarray, shape (points, 2, local)
        Derivatives of the shape functions by the coordinates of the face.
    outward : int
        Sign of t_1 x t_2, the product of the tangents along these, that points out of the body.
    """

    shape: FunctionArrays
    test: FunctionArrays
    area: FloatArray
    point: IntArray
    slopes: FloatArray
    outward: int

    @classmethod
    def of_points(cls, point: IntArray) -> Self:
        """Control points, each a quadrature point of area one with an element and a function of its own: what is integrated is its own."""
        count = len(check.array("point", point, np.int32, None))
        alone = FunctionArrays(np.arange(count, dtype=np.int32)[:, None].copy(), np.ones((count, 1)), count)
        return cls(alone, alone, np.ones(count), point, np.zeros((count, 2, 1)), 1)

    def __post_init__(self) -> None:
        check.kind("shape", self.shape, FunctionArrays)
        check.kind("test", self.test, FunctionArrays)
        points = len(check.finite("area", check.array("area", self.area, np.float64, None)))
        elements = len(self.shape.nodes)
        for name, functions in (("shape", self.shape), ("test", self.test)):
            if len(functions.nodes) != elements or len(functions.values) != points:
                found = f"{len(functions.nodes)} elements and {len(functions.values)} points"
                raise InputError(f"has {found}; allowed: {elements} and {points}, as the other functions and `area`", name)
        check.array("point", self.point, np.int32, self.shape.count)
        check.within("point", self.point, 0, check.MAX_POINT)
        check.finite("slopes", check.array("slopes", self.slopes, np.float64, points, 2, self.shape.nodes.shape[1]))
        check.whole("outward", self.outward, -1, 1)
        if not elements or points % elements:
            raise InputError(f"has {points} quadrature points for {elements} elements; allowed: as many in each element", "area")

    @cached_property
    def highest(self) -> int:
        """Largest number of a control point."""
        return check.highest(self.point)

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.shape.nodes)

    @property
    def per_element(self) -> int:
        """Number of quadrature points of an element."""
        return len(self.area) // self.elements


@frozen(eq=False)
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


@frozen
class Projections:
    """Slave quadrature points on the master: coordinates, element, whether found, slip increment and whether it counts.

    `doubt`: 0, or for a point that is found, but whose foot does not follow it, a status (isomortar_base_status) that says why: then its
    distance alone means something.
    `fixed`: 1 for coordinates that stay while the point moves, on lines across which the master is only continuous, shape (points, 2).
    `origin`: coordinates from where slips count.
    """

    xi: FloatArray
    element: IntArray
    fixed: IntArray
    found: IntArray
    doubt: IntArray
    origin: FloatArray
    slip: FloatArray
    slips: IntArray

    def __post_init__(self) -> None:
        points = len(check.array("found", self.found, np.int32, None))
        check.array("xi", self.xi, np.float64, points, 2)
        check.array("element", self.element, np.int32, points, 2)
        check.array("fixed", self.fixed, np.int32, points, 2)
        check.array("doubt", self.doubt, np.int32, points)
        check.finite("origin", check.array("origin", self.origin, np.float64, points, 2))
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


@frozen
class Control:
    """Control quantities of every test function: <R>, <R R>, <R g>, <R slip>, <R R a_ab>; a_ab at the points."""

    weight: FloatArray
    square: FloatArray
    gap: FloatArray
    slip: FloatArray
    metric: FloatArray
    point_metric: FloatArray


@frozen
class Law:
    """Augmented penalty law: penalties (normal, tangential), law of friction, current multipliers, the paper's slip sum or the local one.

    What supports hold: constraints with `bears` 0 bear nothing, and `free`, shape (n, 2, 2), projects the covariant tractions of the
    others (component, traction) so that nothing is left along it.
    Trials above (1 - `slip_margin`) of what friction bears slip; `held` constraints (1) stick whatever their trial; `forgiving` takes
    the current traction for the radial part of the slip derivative (theory 4.14).
    With a largest `elastic_slip`, L, tractions are functions of the slips from `stretch`, shape (n, 2), L/P, on (theory 4.15), whatever
    they were; None: Coulomb's law. With `smoothing` pressures times distances are that, force per length, wherever there is a foot
    (theory 4.18).
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
    elastic_slip: float = 0.0
    stretch: FloatArray | None = None
    smoothing: float = 0.0

    @property
    def elastic(self) -> bool:
        """Whether slip is elastic."""
        return self.stretch is not None

    @property
    def base(self) -> FloatArray:
        """What slips add to in the trial, shape (n, 2): tractions, or stretches."""
        return self.traction if self.stretch is None else self.stretch

    @property
    def factors(self) -> FloatArray:
        """Factors of gap and slip in the trials: the penalties; with elastic slip one over the largest one in place of the second."""
        return self.penalties if self.stretch is None else np.array([self.penalties[0], 1.0 / self.elastic_slip])


@frozen
class Response:
    """Control pressures and tractions, states (0 open, 1 stick, 2 slip), and their slopes."""

    pressure: FloatArray
    traction: FloatArray
    state: IntArray
    pressure_slope: FloatArray
    traction_slope: FloatArray
    field_slip: FloatArray
