"""What a computation consists of: bodies, contacts, supports with their motions, stages."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from isomortar._arrays import FRICTION_LAWS, LAWS, FrictionArrays, MaterialArrays, MaterialLaw
from isomortar.geometry.patch import FloatArray, Patch


@dataclass(frozen=True)
class Material:
    """A material: its law, and the moduli that all laws have in common where strains are small (theory 1).

    Parameters
    ----------
    young : float
        Young's modulus E, force per area.
    poisson : float
        Poisson's ratio, -1 < nu < 0.5.
    law : str
        "neo-hookean": the paper's, W = A1/2 (ln J)^2 + A2/2 (J^(-2/3) tr C - 3); "neo-hookean-j": that of Abaqus and CalculiX,
        with A1/2 (J - 1)^2; "linear-elastic": Hooke's law of small strain, for small turns alone.
    """

    young: float = 10.0
    poisson: float = 0.3
    law: MaterialLaw = "neo-hookean"

    @property
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


@dataclass(frozen=True)
class Body:
    """A deformable body: one volume patch with its material.

    `quadrature` are Gauss points per element and direction. `closed` names the direction ("u", "v", "w")
    whose last row of control points is the same unknown as the first (a ring), or is None.
    """

    name: str
    patch: Patch
    material: Material
    quadrature: tuple[int, int, int]
    closed: Literal["u", "v", "w"] | None = None

    @property
    def size(self) -> float:
        """Largest extent of its control points along a coordinate."""
        return float(np.ptp(self.patch.control_points, axis=0).max())


@dataclass(frozen=True)
class Face:
    """A face of a body: a contact patch, or the place of a support."""

    body: str
    face: str


@dataclass(frozen=True)
class RigidPlane:
    """A rigid master plane through `point`; coordinates are lengths along `tangent` and `normal` x `tangent`."""

    point: tuple[float, float, float]
    normal: tuple[float, float, float]
    tangent: tuple[float, float, float]


@dataclass(frozen=True)
class Contact:
    """A contact pair. `quadrature` are Gauss points per slave contact element and surface direction.

    `reference_area` divides the penalties (theory 7.1); None: the area of the slave face in the reference configuration.
    Where there is pressure p, tractions are up to min(`cohesion` + `friction` p, `traction_max`), force per area (theory 4.6);
    None: no largest one.
    """

    name: str
    slave: Face
    master: Face | RigidPlane
    friction: float
    quadrature: tuple[int, int]
    reference_area: float | None = None
    cohesion: float = 0.0
    traction_max: float | None = None

    @property
    def friction_law(self) -> FrictionArrays:
        """Its law of friction, as the kernel takes it: the simplest one that is the same."""
        if self.friction == self.cohesion == 0.0:
            return FrictionArrays(FRICTION_LAWS["none"], np.zeros(0))
        if self.cohesion == 0.0 and self.traction_max is None:
            return FrictionArrays(FRICTION_LAWS["coulomb"], np.array([self.friction]))
        largest = np.finfo(np.float64).max if self.traction_max is None else self.traction_max
        return FrictionArrays(FRICTION_LAWS["capped"], np.array([self.friction, self.cohesion, largest]))


@dataclass(frozen=True)
class Motion:
    """What a support does during one stage: grows linearly over the stage's load steps.

    `translate`: total vector (length). `rotate`: total angle in degrees, right-hand rule about the support's axis.
    """

    translate: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotate: float = 0.0


@dataclass(frozen=True)
class Support:
    """Prescribed control points of a face: x = c + u(t) + R(axis, angle(t)) (X - c) in the given components.

    `motions` has one entry a stage. u and angle accumulate over the stages.
    """

    name: str
    place: Face
    motions: tuple[Motion, ...]
    components: tuple[int, ...] = (0, 1, 2)
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)

    @property
    def moves(self) -> bool:
        """Whether it moves in some stage."""
        return any(any(motion.translate) or motion.rotate for motion in self.motions)


@dataclass(frozen=True)
class Stage:
    """A part of the load history: `steps` equal load steps, each of them recorded."""

    name: str
    steps: int


#: What helps Newton's method on the way to the solution (theory 6.5, 7.5); none changes the solution.
#: keeping: factors of an earlier tangent serve for as long as solves with them leave a small share of the residual. The others
#: help the monolithic loop. forgiving: slip rows with the current traction in place of the cone's. margin: what slips at the
#: start of an increment goes on slipping. reversal: predicted slip against its traction sticks instead. halving: updates that
#: fold an element, lose a projection, return to an earlier set of states, or double the merit are halved; in Uzawa's loop those that
#: leave a larger residual.
Measure = Literal["forgiving", "margin", "reversal", "halving", "keeping"]
MEASURES: tuple[Measure, ...] = ("forgiving", "margin", "reversal", "halving", "keeping")


@dataclass(frozen=True)
class SolverSettings:
    """How contact is enforced and when a load step has converged (theory 5).

    Parameters
    ----------
    method : {"monolithic", "uzawa"}
        Multipliers as unknowns of one Newton loop (theory 6), or augmentations around Newton's method (theory 7, the paper's way).
    slip_sum : {"local", "paper"}
        The trial traction from the control point's own slip, or summed over active neighbours (theory 4.4, 4.5).
    penalty_normal, penalty_tangential : float
        Base penalties, times the largest diagonal entry of the solid tangent over the reference area.
    penalty_growth, penalty_growth_max : float
        Factor per augmentation within a load step and its limit over the base.
    augmentation_tolerance : float
    augmentation_norm : {"separate", "paper"}
        Pressures and tractions tested each in their norm, or the paper's single mixed norm.
    newton_tolerance : float
    complementarity_tolerance : float
        Monolithic: relative distance of pressures and of tractions from the contact conditions.
    max_augmentations, max_iterations, max_cuts : int
        `max_cuts`: how often a load step may be halved.
    measures : tuple of str
        What helps Newton's method on the way (MEASURES; theory 6.5).
    path_tolerance : float or None
        Relative error of the control multipliers that a load increment may make by itself, estimated by halving it; None: the
        increments are the stages' load steps.
    """

    method: Literal["monolithic", "uzawa"] = "monolithic"
    slip_sum: Literal["local", "paper"] = "local"
    penalty_normal: float = 100.0
    penalty_tangential: float = 10.0
    penalty_growth: float = 2.0
    penalty_growth_max: float = 200.0
    augmentation_tolerance: float = 0.01
    augmentation_norm: Literal["separate", "paper"] = "separate"
    newton_tolerance: float = 1e-9
    complementarity_tolerance: float = 1e-8
    max_augmentations: int = 100
    max_iterations: int = 30
    max_cuts: int = 8
    measures: tuple[Measure, ...] = MEASURES
    path_tolerance: float | None = None


@dataclass(frozen=True)
class Problem:
    """A whole computation, ready for `isomortar.solve`: plain data, no unknowns, no state.

    Scenes build it (`isomortar.scene`); it can be built by hand as well.
    """

    name: str
    bodies: tuple[Body, ...]
    contacts: tuple[Contact, ...]
    supports: tuple[Support, ...]
    stages: tuple[Stage, ...]
    settings: SolverSettings = field(default_factory=SolverSettings)

    def body(self, name: str) -> Body:
        """The body of that name."""
        return next(b for b in self.bodies if b.name == name)

    @property
    def total_steps(self) -> int:
        """Number of recorded load steps over all stages."""
        return sum(stage.steps for stage in self.stages)


def unit(vector: tuple[float, float, float]) -> FloatArray:
    """The vector divided by its length, shape (3,)."""
    v = np.asarray(vector, dtype=np.float64)
    return v / np.linalg.norm(v)
