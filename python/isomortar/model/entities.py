"""What a computation consists of: bodies, contacts, supports with their motions, loads, stages."""

from __future__ import annotations

import math
from dataclasses import field
from functools import cached_property
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from isomortar._arrays import FRICTION_LAWS, LAWS, NO_FRICTION, FrictionArrays, MaterialArrays, MaterialLaw
from isomortar._frozen import frozen
from isomortar.geometry.outside import Outside
from isomortar.geometry.patch import FACES, Closed, FloatArray, Patch
from isomortar.model.settings import SolverSettings
from isomortar.model.values import TABLE, Point, Positive, Real

#: How a slave point finds its point on a face of its master: the closest one, or along the averaged normal.
Projection = Literal["closest", "averaged"]
#: Which functionals of gap and slip are constrained: averages with the slave's functions or with functions dual to these, or values at
#: quadrature points, at unique knots, at Greville's or at Demko's abscissae.
Enforcement = Literal["mortar", "dual", "kts", "knots", "greville", "demko"]


@frozen
class Material:
    """A solid; the defaults are the paper's."""

    __pydantic_config__ = TABLE

    young: Positive = 10.0
    """Young's modulus, force per area."""
    poisson: Annotated[Real, Field(gt=-1, lt=0.5)] = 0.3
    """Poisson's ratio, above -1 and below 0.5."""
    law: MaterialLaw = "neo-hookean"
    """Stored energy (docs/method.md): the paper's, that of Abaqus and CalculiX, or small strains' for turns that are small too."""

    @cached_property
    def arrays(self) -> MaterialArrays:
        """What the kernel takes for it."""
        return MaterialArrays(LAWS[self.law], np.array([self.bulk, self.shear]))

    @property
    def bulk(self) -> float:
        """Bulk modulus A1 = E / (3 (1 - 2 nu)), theory 1.2."""
        return self.young / (3.0 * (1.0 - 2.0 * self.poisson))

    @property
    def shear(self) -> float:
        """Shear modulus A2 = E / (2 (1 + nu)), theory 1.2."""
        return self.young / (2.0 * (1.0 + self.poisson))

    @property
    def modulus(self) -> float:
        """Stiffness without lateral strain, A1 + 4/3 A2: the largest entries of a tangent go with it (theory 5.7)."""
        return self.bulk + 4.0 / 3.0 * self.shear


@frozen
class Raised:
    """A face along which functions are of the patch's orders in its own row of control points alone, and of other `orders` below."""

    face: str
    orders: tuple[int, int, int]


@frozen
class Body:
    """A body: one volume patch with its material.

    `quadrature` are Gauss points per element and direction. `closed` names the direction ("u", "v", "w")
    whose last row of control points is the same unknown as the first (a ring), or two of them (a torus), or is None.
    A `rigid` one does not deform: all of its control points go where its support does, or stand still; it needs no material.
    `raised`: its functions are of the patch's order at a face alone (theory 2.12).
    """

    name: str
    patch: Patch
    material: Material
    quadrature: tuple[int, int, int]
    closed: Closed | None = None
    rigid: bool = False
    raised: Raised | None = None

    @property
    def orders(self) -> tuple[int, int, int]:
        """Orders by direction; below a raised face."""
        u, v, w = self.patch.directions
        return self.raised.orders if self.raised else (u.order, v.order, w.order)

    @property
    def outer(self) -> tuple[str, ...]:
        """Its faces, without those at which it meets itself."""
        return tuple(face for face in FACES if face[0] not in (self.closed or ""))

    @property
    def modulus(self) -> float:
        """Stiffness without lateral strain, theory 5.7; that of a rigid body is infinite."""
        return np.inf if self.rigid else self.material.modulus

    @cached_property
    def points(self) -> int:
        """Gauss points of all its elements."""
        return math.prod(direction.elements for direction in self.patch.directions) * math.prod(self.quadrature)

    @cached_property
    def size(self) -> float:
        """Largest extent of its control points along a coordinate."""
        return float(np.ptp(self.patch.control_points, axis=0).max())

    @cached_property
    def outside(self) -> Outside:
        """What encloses it: all outer faces that have an area."""
        return Outside.of(self.patch, self.outer)


#: What one face of a body is, two that meet, and three.
PLACES = ("face", "edge", "corner")


@frozen
class Face:
    """A face of a body: a contact patch, or the place of a support."""

    body: str
    face: str

    @property
    def faces(self) -> tuple[Face, ...]:
        """The single faces that it is of."""
        return (self,)

    @property
    def meeting(self) -> tuple[str, ...]:
        """Names of the faces of its body on all of which its points are."""
        return (self.face,)

    @property
    def words(self) -> str:
        """As scene files name it."""
        return ", ".join(".".join((face.body, *face.meeting)) for face in self.faces)


@frozen
class Faces(Face):
    """A side of a contact of several faces that join to one, the first and those `beside`; no place of a support."""

    beside: tuple[Face, ...]

    @property
    def faces(self) -> tuple[Face, ...]:
        """The single faces that it is of."""
        return (Face(self.body, self.face), *self.beside)


@frozen
class Edge(Face):
    """Where a face meets one or two `others` of its body, in an edge or a corner: the place of a support."""

    others: tuple[str, ...]

    @property
    def meeting(self) -> tuple[str, ...]:
        """Names of the faces of its body on all of which its points are."""
        return (self.face, *self.others)


@frozen
class RigidPlane:
    """A rigid master plane through `point`; coordinates are lengths along `tangent` and `normal` x `tangent`."""

    point: tuple[float, float, float]
    normal: tuple[float, float, float]
    tangent: tuple[float, float, float]


@frozen
class Contact:
    """A contact pair. `quadrature` are Gauss points per slave contact element and surface direction.

    `reference_area` divides the penalties (theory 7.1); None: the area of the slave face in the reference configuration.
    Where there is pressure p, tractions are up to min(`cohesion` + `friction` p, `traction_max`), force per area (theory 4.6);
    None: no largest one.
    `projection`: how a slave point finds its point on a master that is a face: the closest one, or along the averaged normal;
    `by_default`: nobody asked for it, the master's C0 lines do.
    `enforcement`: which functionals of gap and slip are constrained (theory 10).
    `elastic_slip`: the most that contact slips elastically before it slides (theory 4.15), a length; 0: Coulomb's law.
    `smoothing`: what pressure times distance is of bodies that are apart (theory 4.18), force per length; 0: nothing.
    `subcells`: how many times over slave elements are cut in each direction where the master's knot lines cross them (theory 10.9).
    """

    name: str
    slave: Faces | Face
    master: Faces | Face | RigidPlane
    friction: float
    quadrature: tuple[int, int]
    reference_area: float | None = None
    cohesion: float = 0.0
    traction_max: float | None = None
    projection: Projection = "closest"
    by_default: bool = False
    enforcement: Enforcement = "mortar"
    subcells: int = 0
    elastic_slip: float = 0.0
    smoothing: float = 0.0

    @property
    def bodies(self) -> set[str]:
        """Names of the bodies of both sides."""
        return {face.body for side in (self.slave, self.master) if isinstance(side, Face) for face in side.faces}

    @property
    def averaged(self) -> bool:
        """Whether slave points find theirs along the averaged normal of a face."""
        return self.projection == "averaged" and isinstance(self.master, Face)

    @property
    def of_averages(self) -> bool:
        """Whether its constraints are averages of gap and slip, one a control point, and not values at points."""
        return self.enforcement in ("mortar", "dual")

    @property
    def friction_law(self) -> FrictionArrays:
        """Its law of friction, as the kernel takes it: the simplest one that is the same."""
        if self.friction == self.cohesion == 0.0:
            return NO_FRICTION
        if self.cohesion == 0.0 and self.traction_max is None:
            return FrictionArrays(FRICTION_LAWS["coulomb"], np.array([self.friction]))
        largest = np.finfo(np.float64).max if self.traction_max is None else self.traction_max
        return FrictionArrays(FRICTION_LAWS["capped"], np.array([self.friction, self.cohesion, largest]))


@frozen
class Motion:
    """What a support does during a stage; grows linearly over its load steps."""

    __pydantic_config__ = TABLE

    translate: Point = (0.0, 0.0, 0.0)
    """Total translation of the stage."""
    rotate: Real = 0.0
    """Total angle of the stage in degrees about the support's axis."""

    @property
    def moves(self) -> bool:
        """Whether it is any motion at all."""
        return any(self.translate) or self.rotate != 0.0


@frozen
class Support:
    """Prescribed control points of a face, an edge or a corner: x = c + u(t) + R(axis, angle(t)) (X - c) in the given components.

    `motions` has one entry a stage. u and angle accumulate over the stages. A component with a `force` is none of the `components`: there
    u(t) is what makes the support exert that force, times its factor at the end of each stage (`factors`; none: 1). With a `moment` about
    the axis the angle is what makes it exert that.
    `stages`: numbers of those in which it holds; None: all.
    """

    name: str
    place: Edge | Face
    motions: tuple[Motion, ...]
    components: tuple[int, ...] = (0, 1, 2)
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    force: tuple[float | None, float | None, float | None] = (None, None, None)
    factors: tuple[float, ...] = ()
    moment: float | None = None
    stages: tuple[int, ...] | None = None

    def holds(self, stage: int) -> bool:
        """Whether it holds in a stage."""
        return self.stages is None or stage in self.stages

    @property
    def carried(self) -> tuple[int, ...]:
        """Components that go with it, by a motion or by a force."""
        return (*self.components, *self.pressed)

    @property
    def is_plate(self) -> bool:
        """Whether a force or a moment moves it."""
        return bool(self.pressed) or self.moment is not None

    @property
    def pressed(self) -> tuple[int, ...]:
        """Components with a force."""
        return tuple(k for k, force in enumerate(self.force) if force is not None)

    @property
    def moves(self) -> bool:
        """Whether it moves in some stage."""
        return any(motion.moves for motion in self.motions)

    @property
    def turns(self) -> bool:
        """Whether it turns in some stage."""
        return any(motion.rotate for motion in self.motions)


@frozen
class SymmetryPlane:
    """A plane of symmetry across a coordinate `axis` (0, 1, 2), where that coordinate is `place`."""

    axis: int
    place: float

    def holding(self, body: str) -> str:
        """Name of the support that holds a body's points on it."""
        return f"symmetry-{'xyz'[self.axis]}-{body}"

    @property
    def words(self) -> str:
        """As messages name it."""
        return f"the plane {'xyz'[self.axis]} = {self.place:g}"


@frozen
class Stage:
    """A part of the load history: `steps` equal load steps, each of them recorded."""

    name: str
    steps: int


#: What a load is: a pressure that follows its face, a traction that does not, or the weight of a body.
LoadKind = Literal["pressure", "traction", "weight"]


@frozen
class Load:
    """A load on a body: `pressure` on its current face (one value), `traction` on its reference face, or `weight` on its reference volume.

    `value` is force per area, or per volume, along x, y, z; `face` is None for a weight.
    `factors` has one entry a stage: by what the value is multiplied at the end of the stage; none: 1 at all of them.
    """

    name: str
    kind: LoadKind
    body: str
    face: str | None
    value: tuple[float, ...]
    factors: tuple[float, ...] = ()

    @property
    def place(self) -> Face:
        """The face it is on."""
        assert self.face is not None
        return Face(self.body, self.face)


@frozen(eq=False)
class Problem:
    """A whole computation, ready for `isomortar.solve`: plain data, no unknowns, no state.

    Scenes build it (`isomortar.scene`); it can be built by hand as well. `glue`: faces of two bodies each that share their control points.
    `symmetry`: planes on whose upper side it is; forces of supports, contacts and loads are those of the whole.
    """

    name: str
    bodies: tuple[Body, ...]
    contacts: tuple[Contact, ...]
    supports: tuple[Support, ...]
    stages: tuple[Stage, ...]
    settings: SolverSettings = field(default_factory=SolverSettings)
    glue: tuple[tuple[Face, Face], ...] = ()
    symmetry: tuple[SymmetryPlane, ...] = ()
    loads: tuple[Load, ...] = ()

    def body(self, name: str) -> Body:
        """The body of that name."""
        return next(b for b in self.bodies if b.name == name)

    @property
    def deformable(self) -> tuple[Body, ...]:
        """Its bodies but for the rigid ones."""
        return tuple(body for body in self.bodies if not body.rigid)

    @property
    def total_steps(self) -> int:
        """Number of recorded load steps over all stages."""
        return sum(stage.steps for stage in self.stages)

    def stage_of(self, step: int) -> int:
        """Number of the stage that a load step, counted from 1 over all stages, belongs to."""
        ends = np.cumsum([stage.steps for stage in self.stages])
        return int(np.searchsorted(ends, step))

    def ends_stage(self, step: int) -> bool:
        """Whether a load step is the last one of its stage: the next one does not go on as it did."""
        return step in np.cumsum([stage.steps for stage in self.stages])

    def holds(self, face: Face, stage: int) -> bool:
        """Whether supports together hold, or carry, all components of a face in a stage."""
        there = [support for support in self.supports if support.place == face and support.holds(stage)]
        return {0, 1, 2} == {component for support in there for component in support.carried}

    @property
    def given_supports(self) -> tuple[Support, ...]:
        """Its supports but for those that hold planes of symmetry, which come last."""
        of_planes = {plane.holding(body.name) for plane in self.symmetry for body in self.bodies}
        return tuple(support for support in self.supports if support.name not in of_planes)

    @property
    def images(self) -> int:
        """How many times the whole holds it: itself and its mirror images."""
        return int(2 ** len(self.symmetry))


def unit(vector: tuple[float, float, float]) -> FloatArray:
    """The vector divided by its length, shape (3,)."""
    v = np.asarray(vector, dtype=np.float64)
    return v / np.linalg.norm(v)
