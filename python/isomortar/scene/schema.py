"""The tables of a scene file, format 1. Every default of a scene is stated here or in `SolverSettings`."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field, field_validator, model_validator
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import PydanticCustomError, core_schema

from isomortar._arrays import MaterialLaw
from isomortar.geometry.patch import Direction, Family, Patch
from isomortar.geometry.primitives import bowl, box, ring
from isomortar.model.entities import Material, Measure, Motion, SolverSettings
from isomortar.scene.types import (
    Axis,
    Count,
    FaceName,
    GaussPoints,
    Name,
    PerDirection,
    PerSurfaceDirection,
    PlanePoint,
    Point,
    Positive,
    Real,
    Table,
)

#: Residuals and distances that are left stand for an error of the result: above this share none is worth having.
Tolerance = Annotated[Positive, Field(le=1e-3)]
Penalty = Annotated[Real, Field(ge=1e-12, le=1e12)]

_PAPER = Material()
_SOLVER = SolverSettings()


class MaterialTable(Table):
    """A solid; the defaults are the paper's."""

    young: Positive = _PAPER.young
    """Young's modulus, force per area."""
    poisson: Annotated[Real, Field(gt=-1, lt=0.5)] = _PAPER.poisson
    """Poisson's ratio, above -1 and below 0.5."""
    law: MaterialLaw = _PAPER.law
    """Stored energy (docs/method.md): the paper's, that of Abaqus and CalculiX, or small strains' for turns that are small too."""


class BoxTable(Table):
    """Axis-parallel box; u, v, w run along x, y, z."""

    closed: ClassVar[Axis | None] = None
    kind: Literal["box"]
    lower: Point
    """Corner with the smallest coordinates."""
    upper: Point
    """Corner with the largest coordinates."""

    def patch(self) -> Patch:
        """The coarse geometry."""
        return box(self.lower, self.upper)


class BowlTable(Table):
    """Block with a flat top and a paraboloid below; u, v, w run along x, y, z."""

    closed: ClassVar[Axis | None] = None
    kind: Literal["bowl"]
    centre: PlanePoint = (0.0, 0.0)
    """Middle of the square, [x, y]."""
    half_width: Positive
    """Half the side of the square."""
    bottom: Real
    """Height z of the lowest point."""
    rise: Real
    """By how much the mid-edges of the underside are higher; its corners by twice that."""
    top: Real
    """Height z of the flat top."""

    def patch(self) -> Patch:
        """The coarse geometry."""
        return bowl(self.centre, self.half_width, self.bottom, self.rise, self.top)


class RingTable(Table):
    """Ring about the y-axis; u runs round it (closed), v outwards, w along -y."""

    closed: ClassVar[Axis | None] = "u"
    kind: Literal["ring"]
    centre: Point = (0.0, 0.0, 0.0)
    """Centre of the ring."""
    inner: Positive
    """Inner radius: face v0."""
    outer: Positive
    """Outer radius: face v1."""
    width: Positive
    """Extent along y."""

    def patch(self) -> Patch:
        """The coarse geometry."""
        return ring(self.centre, self.inner, self.outer, self.width)


class PatchTable(Table):
    """A patch given point by point, here or in a geometry file of its own (suffix .toml)."""

    family: PerDirection[Family] = ("N", "N", "N")
    """N (NURBS) or L (Lagrange elements), by direction."""
    order: PerDirection[Count]
    """Polynomial order, by direction."""
    knots: Annotated[list[list[Real]], Field(min_length=3, max_length=3)]
    """Three lists. N: the whole open knot vector. L: the element boundaries."""
    control_points: list[Point]
    """First direction fastest: number = i1 + n1 (i2 + n2 i3)."""
    weights: list[Real] | None = None
    """Same numbering, not multiplied into the points; default: all 1."""

    def patch(self) -> Patch:
        """The patch; raises InputError with the name of the wrong key."""
        u, v, w = (Direction(f, p, np.array(k)) for f, p, k in zip(self.family, self.order, self.knots, strict=True))
        weights = np.ones(len(self.control_points)) if self.weights is None else np.array(self.weights)
        return Patch((u, v, w), np.array(self.control_points).reshape(-1, 3), weights)


class MeshTable(Table):
    """Discretisation of a body's geometry."""

    family: PerDirection[Family] = ("N", "N", "N")
    """N: NURBS by k-refinement. L: Lagrange elements with their nodes on the geometry."""
    order: PerDirection[Count] | None = None
    """Polynomial order; default: 2 for box, bowl and ring, else the geometry's own."""
    elements: PerDirection[Count] | None = None
    """Elements; a multiple of the geometry's knot spans; default: these."""
    quadrature: PerDirection[GaussPoints] | None = None
    """Gauss points per volume element; default by family and order (Table 1 of the paper; above order 5: order + 2)."""


class BodyTable(Table):
    """A deformable body: one of geometry, file, patch."""

    material: str | None = None
    """Name of a material; default: the only one there is, or the paper's."""
    geometry: Annotated[BoxTable | BowlTable | RingTable, Field(discriminator="kind")] | None = None
    """A primitive: kind = "box", "bowl" or "ring" with its dimensions."""
    file: str | None = None
    """A geometry file: .toml (keys of patch) or a volume spline that splinepy reads; relative to the scene file."""
    patch: PatchTable | None = None
    """Knots, control points and weights."""
    mesh: MeshTable = MeshTable()
    """Discretisation."""
    closed: Axis | None = None
    """Direction whose last row of control points is the first one again; a ring is closed by itself."""

    @model_validator(mode="after")
    def _one_geometry(self) -> BodyTable:
        given = [name for name in ("geometry", "file", "patch") if getattr(self, name) is not None]
        if len(given) != 1:
            raise PydanticCustomError(
                "geometry", "has {given}; allowed: exactly one of geometry, file, patch", {"given": " and ".join(given) or "no geometry"}
            )
        return self


class PlaneTable(Table):
    """A rigid plane; bodies are on the side that the normal points to."""

    point: Point = (0.0, 0.0, 0.0)
    """A point of the plane; origin of its coordinates."""
    normal: Point = (0.0, 0.0, 1.0)
    """Out of the plane, towards the bodies; any length."""
    tangent: Point | None = None
    """Along the first plane coordinate, any length, need not be perpendicular; default: along x, or y where x is nearly normal."""


class ContactTable(Table):
    """A contact pair: slave face, and a master face or a rigid plane."""

    slave: FaceName
    """BODY.FACE; the faces are u0, u1, v0, v1, w0, w1: first and last parametric value of each direction."""
    master: FaceName | None = None
    """BODY.FACE of the deformable master."""
    plane: PlaneTable | None = None
    """Rigid master plane, instead of master."""
    friction: Annotated[Real, Field(ge=0, le=1e100)] = 0.3
    """Coefficient of friction; 0, without cohesion, switches friction off."""
    cohesion: Annotated[Real, Field(ge=0)] = 0.0
    """Traction, force per area, that friction bears where there is contact besides its coefficient times the pressure; none where open."""
    traction_max: Positive | None = None
    """Largest traction, force per area: friction bears min(cohesion + friction * pressure, traction_max); default: no largest one."""
    quadrature: PerSurfaceDirection[GaussPoints] | None = None
    """Gauss points per slave contact element; default by family and order (Table 1 of the paper; above order 5: order + 2)."""
    reference_area: Positive | None = None
    """Divides the penalties; default: area of the slave face in the reference configuration. The paper's numbers imply 1."""

    @model_validator(mode="after")
    def _one_master(self) -> ContactTable:
        if (self.master is None) == (self.plane is None):
            given = "both master and plane" if self.master else "neither master nor plane"
            raise PydanticCustomError("master", "has {given}; allowed: exactly one of them", {"given": given})
        return self


class SupportTable(Table):
    """Prescribed control points of a face; without motion they are fixed."""

    face: FaceName
    """BODY.FACE"""
    components: Annotated[tuple[Literal["x", "y", "z"], ...], Field(min_length=1)] = ("x", "y", "z")
    """Prescribed components; default: all."""
    centre: Point = (0.0, 0.0, 0.0)
    """Centre of rotation, also that of the recorded moment; moves with the translation."""
    axis: Point = (0.0, 0.0, 1.0)
    """Axis of rotation, any length, right-hand rule."""

    @field_validator("components", mode="before")
    @classmethod
    def _each_once(cls, value: Any) -> Any:
        if isinstance(value, list) and len({*map(str, value)}) != len(value):
            raise PydanticCustomError("components", "names a component twice; allowed: x, y, z, each once")
        return value


class MotionTable(Table):
    """What a support does during a stage; grows linearly over its load steps."""

    translate: Point = (0.0, 0.0, 0.0)
    """Total translation of the stage."""
    rotate: Real = 0.0
    """Total angle of the stage in degrees about the support's axis."""

    def motion(self) -> Motion:
        """As plain data."""
        return Motion(self.translate, self.rotate)


class StageTable(Table):
    """A part of the load history."""

    name: Name
    """Shown in progress and results."""
    steps: Annotated[Count, Field(le=1_000_000)]
    """Equal load steps, each of them recorded."""
    motions: dict[str, MotionTable] = Field({})
    """By name of support; supports without a motion stay where they are."""


class SolverTable(Table):
    """How contact is enforced and when a load step has converged."""

    method: Literal["monolithic", "uzawa"] = _SOLVER.method
    """Multipliers as unknowns of one Newton loop per load step (monolithic), or penalties corrected by augmentations (uzawa)."""
    slip_sum: Literal["local", "paper"] = _SOLVER.slip_sum
    """Trial traction from the control point's own slip (local), or summed over active neighbours (paper)."""
    penalty_normal: Penalty = _SOLVER.penalty_normal
    """Base penalty for the gap, times the largest diagonal entry of the tangents of the pair's bodies over the reference area."""
    penalty_tangential: Penalty = _SOLVER.penalty_tangential
    """Base penalty for slip, in the same unit; keep it near a tenth of the normal one."""
    penalty_growth: Annotated[Real, Field(ge=1, le=1e6)] = _SOLVER.penalty_growth
    """Factor on the penalties per augmentation within a load step; 1: they stay."""
    penalty_growth_max: Annotated[Real, Field(ge=1, le=1e12)] = _SOLVER.penalty_growth_max
    """Limit of that growth over the base."""
    augmentation_tolerance: Annotated[Positive, Field(le=0.1)] = _SOLVER.augmentation_tolerance
    """Relative change of the multipliers, and distance from the contact conditions, below which augmentations have converged."""
    augmentation_norm: Literal["separate", "paper"] = _SOLVER.augmentation_norm
    """Pressures and tractions tested each in their norm (separate), or in the paper's single norm, which mixes units."""
    newton_tolerance: Tolerance = _SOLVER.newton_tolerance
    """Residual over the internal force of each body below which Newton's method has converged."""
    complementarity_tolerance: Tolerance = _SOLVER.complementarity_tolerance
    """Monolithic: relative distance of pressures and tractions from the contact conditions."""
    max_augmentations: Count = _SOLVER.max_augmentations
    """Augmentations after which a load step is cut."""
    max_iterations: Count = _SOLVER.max_iterations
    """Tangents of a Newton loop after which a load step is cut."""
    max_cuts: Annotated[int, Field(strict=True, ge=0, le=30)] = _SOLVER.max_cuts
    """How often a load step may be halved before the run ends; 30 times is to a billionth."""
    measures: tuple[Measure, ...] = _SOLVER.measures
    """What helps Newton's method on the way; leave one out to see what it does."""
    path_tolerance: Annotated[Positive, Field(le=1)] | None = _SOLVER.path_tolerance
    """Error of the multipliers that a load increment may make, estimated by halving it; absent: the load steps as given."""

    def settings(self) -> SolverSettings:
        """As plain data."""
        return SolverSettings(**self.model_dump())


class CurveTable(Table):
    """A curve over the load steps: a component of a support's force or moment."""

    name: str
    """Label of the curve."""
    support: str
    """Name of a support."""
    quantity: Literal["force", "moment"] = "force"
    """Force that the support exerts, or moment about its moving centre."""
    component: Literal["x", "y", "z", "norm"] = "norm"
    """Component, or the Euclidean norm."""


class RecordTable(Table):
    """What results keep."""

    states: Literal["every", "last"] = "every"
    """Positions and multipliers of every load step, or of the last one only."""
    curves: list[CurveTable] | None = None
    """Curves to draw; default: force and moment of every support that moves, by component."""


class SceneTable(Table):
    """A scene file of isomortar."""

    format: Literal[1]
    """Version of the file format."""
    name: Name | None = None
    """Short name; default: the file's."""
    title: str = ""
    """One line for people."""
    materials: dict[Name, MaterialTable] = Field({})
    """Materials by name."""
    bodies: Annotated[dict[Name, BodyTable], Field(min_length=1)]
    """Bodies by name."""
    contacts: dict[Name, ContactTable] = Field({})
    """Contact pairs by name."""
    supports: dict[Name, SupportTable] = Field({})
    """Supports by name."""
    stages: Annotated[list[StageTable], Field(min_length=1)]
    """The load history, in order."""
    solver: SolverTable = SolverTable()
    """Enforcement of contact and convergence."""
    record: RecordTable = RecordTable()
    """What to keep."""


class _WithoutNull(GenerateJsonSchema):
    """TOML has no null: what is optional is left out."""

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        if schema.get("default", ...) is None:
            return self.generate_inner(schema["schema"])
        return super().default_schema(schema)

    def encode_default(self, dft: Any) -> Any:
        return dft.model_dump(mode="json", exclude_none=True) if isinstance(dft, Table) else super().encode_default(dft)


def json_schema() -> dict[str, Any]:
    """The JSON schema of scene files (draft 2020-12), for editors and other programs."""
    schema = SceneTable.model_json_schema(schema_generator=_WithoutNull)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
