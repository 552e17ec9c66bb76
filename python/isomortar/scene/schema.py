"""The tables of a scene file, format 1. Every default of a scene is stated here or with the entities of a problem."""

from __future__ import annotations

import ast
import inspect
from itertools import pairwise
from textwrap import dedent
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, StrictBool, TypeAdapter, field_validator, model_validator
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import PydanticCustomError, core_schema

from isomortar.geometry.patch import Closed, Direction, Family, Patch
from isomortar.model.entities import PLACES, Enforcement, Material, Motion, Projection
from isomortar.model.settings import SolverSettings
from isomortar.model.values import Count, Point, Positive, Real
from isomortar.scene.primitives import Primitive
from isomortar.scene.types import (
    CornerName,
    EdgeName,
    FaceName,
    GaussPoints,
    Grading,
    Name,
    PerDirection,
    PerSurfaceDirection,
    SceneName,
    Side,
    Table,
    Version,
    entity,
)

#: Entities of a problem that are tables of a scene file as they are.
MaterialTable = Annotated[Material, entity(Material)]
MotionTable = Annotated[Motion, entity(Motion)]
SolverTable = Annotated[SolverSettings, entity(SolverSettings)]


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
    """Polynomial order; default: 2 for primitives, else the geometry's own."""
    contact_order: Count | None = None
    """Order along the body's one face in contact in the row of control points there, above `order` and no smoother; default: `order`."""
    elements: PerDirection[Count] | None = None
    """Elements; a multiple of the geometry's knot spans; default: these."""
    grading: PerDirection[Grading] = (1.0, 1.0, 1.0)
    """Length of the last element over that of the first, below 1: finer to the end; knot spans of the geometry keep theirs."""
    quadrature: PerDirection[GaussPoints] | None = None
    """Gauss points per volume element; default by family and order (Table 1 of the paper; above 5: order + 2), above contact_order."""


class BodyTable(Table):
    """A body: one of geometry, file, patch."""

    material: str | None = None
    """Name of a material; default: the only one there is, or the paper's."""
    geometry: Annotated[Primitive, Field(discriminator="kind")] | None = None
    """A primitive: kind = "box", "bowl", "cap", "wedge", "ring", "sphere" or "torus" with its dimensions."""
    file: str | None = None
    """A geometry file: .toml (keys of patch) or a volume spline that splinepy reads; relative to the scene file."""
    patch: PatchTable | None = None
    """Knots, control points and weights."""
    mesh: MeshTable = MeshTable()
    """Discretisation."""
    closed: Closed | None = None
    """Direction whose last row of control points is the first one again, or two of a torus; primitives are closed by themselves."""
    rigid: StrictBool = False
    """Does not deform: goes as a whole with the support on one of its faces, or stands still; has no material and no unknowns."""

    @model_validator(mode="after")
    def _rigid_without_solid(self) -> BodyTable:
        given = [key for key, value in (("material", self.material), ("mesh.quadrature", self.mesh.quadrature)) if value is not None]
        if self.rigid and given:
            raise PydanticCustomError(
                "rigid", "is rigid and does not deform, but has {given}; remove that, or rigid", {"given": " and ".join(given)}
            )
        return self

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

    slave: Side
    """BODY.FACE (u0, u1, v0, v1, w0, w1: first and last parametric value of each direction), or a list of faces, edge to edge."""
    master: Side | None = None
    """BODY.FACE of the master, or a list of faces, edge to edge."""
    plane: PlaneTable | None = None
    """Rigid master plane, instead of master."""
    friction: Annotated[Real, Field(ge=0, le=1e100)] = 0.3
    """Coefficient of friction; 0, without cohesion, switches friction off."""
    cohesion: Annotated[Real, Field(ge=0)] = 0.0
    """Traction, force per area, that friction bears where there is contact besides its coefficient times the pressure; none where open."""
    traction_max: Positive | None = None
    """Largest traction, force per area: friction bears min(cohesion + friction * pressure, traction_max); default: no largest one."""
    elastic_slip: Annotated[Real, Field(ge=0)] = 0.0
    """Length that contact slips elastically before it slides, tractions a smooth function of it; 0: it sticks or slides (Coulomb)."""
    smoothing: Annotated[Real, Field(ge=0)] = 0.0
    """Pressure times distance, force per length, that bodies apart keep, so that pressures are smooth; 0: contact or nothing."""
    projection: Projection | None = None
    """How slave points find theirs on a master face: the "closest" one, or along "averaged" normals, which have no kinks on C0 lines."""
    enforcement: Enforcement = "mortar"
    """What is constrained: averages of gap and slip ("mortar", "dual"), or values at Gauss points ("kts"), "knots", "greville", "demko"."""
    quadrature: PerSurfaceDirection[GaussPoints] | None = None
    """Gauss points per slave element, or cell (w0: along u, v; u0: v, w; v0: w, u); default: Table 1 of the paper, or what cells need."""
    subcells: Annotated[int, Field(strict=True, ge=0, le=5)] | None = None
    """How many times over slave elements are cut along the master's knot lines; default: as lines need, 0 where quadrature is given."""
    reference_area: Positive | None = None
    """Divides the penalties; default: area of the slave face in the reference configuration. The paper's numbers imply 1."""

    @model_validator(mode="after")
    def _one_master(self) -> ContactTable:
        if (self.master is None) == (self.plane is None):
            given = "both master and plane" if self.master else "neither master nor plane"
            raise PydanticCustomError("master", "has {given}; allowed: exactly one of them", {"given": given})
        return self


class ForceTable(Table):
    """Components of the force that a support is to exert: there its face moves as a plate, by as much as that takes."""

    x: Real | None = None
    """Along x, on its body."""
    y: Real | None = None
    """Along y."""
    z: Real | None = None
    """Along z."""


class SupportTable(Table):
    """Prescribed control points of a face, an edge or a corner; without motion they are fixed."""

    face: FaceName | None = None
    """BODY.FACE"""
    edge: EdgeName | None = None
    """BODY.FACE.FACE: the row of control points where two faces meet, instead of face."""
    corner: CornerName | None = None
    """BODY.FACE.FACE.FACE: the control point where three faces meet, instead of face."""
    components: Annotated[tuple[Literal["x", "y", "z"], ...], Field(min_length=1)] | None = None
    """Prescribed components; default: all without a force."""
    force: ForceTable = ForceTable()
    """Forces in place of motions, by component, { z = -10 } say; they grow as loads do (stages[].loads)."""
    moment: Real | None = None
    """Moment about the axis through the moving centre, in place of turns; grows as the force does. 0: turns as its body wants."""
    stages: Annotated[list[str], Field(min_length=1)] | None = None
    """Names of the stages in which it holds; default: all. Released, its force goes linearly to zero within the stage that follows."""
    centre: Point = (0.0, 0.0, 0.0)
    """Centre of rotation, also that of the recorded moment; moves with the translation."""
    axis: Point = (0.0, 0.0, 1.0)
    """Axis of rotation, any length, right-hand rule."""

    @model_validator(mode="before")
    @classmethod
    def _one_moment(cls, data: Any) -> Any:
        if isinstance(data, dict) and isinstance(data.get("moment"), (dict, list)):
            raise PydanticCustomError(
                "moment", "has a moment by component, but turns about one axis; allowed: moment, a number, with that axis"
            )
        return data

    @property
    def by_force(self) -> bool:
        """Whether a force or a moment moves it."""
        return bool(self.force.model_fields_set) or self.moment is not None

    @model_validator(mode="after")
    def _one_place(self) -> SupportTable:
        given = [key for key in PLACES if getattr(self, key) is not None]
        if len(given) != 1:
            facts = {"given": " and ".join(given) or "no place"}
            raise PydanticCustomError("place", "has {given}; allowed: exactly one of face, edge, corner", facts)
        return self

    @model_validator(mode="after")
    def _either_motion_or_force(self) -> SupportTable:
        both = [axis for axis in self.components or () if getattr(self.force, axis) is not None]
        if both:
            facts = {"both": ", ".join(both)}
            raise PydanticCustomError("force", "prescribes {both} both by components and by force; allowed: each by one of them", facts)
        return self

    @field_validator("components", mode="before")
    @classmethod
    def _each_once(cls, value: Any) -> Any:
        if isinstance(value, list) and len({*map(str, value)}) != len(value):
            raise PydanticCustomError("components", "names a component twice; allowed: x, y, z, each once")
        return value


class LoadTable(Table):
    """A load: a pressure or a traction on a face, or the weight of a body."""

    face: FaceName | None = None
    """BODY.FACE, of a pressure or a traction."""
    body: str | None = None
    """Name of a body, of a weight."""
    pressure: Real | None = None
    """Force per area of the face as it is deformed, into the body: follows the face."""
    traction: Point | None = None
    """Force per area of the face in the reference configuration, along x, y, z: keeps its direction and its size."""
    weight: Point | None = None
    """Force per volume of the body in the reference configuration, along x, y, z."""

    @model_validator(mode="after")
    def _one_kind(self) -> LoadTable:
        given = [key for key in ("pressure", "traction", "weight") if getattr(self, key) is not None]
        if len(given) != 1:
            facts = {"given": " and ".join(given) or "no size"}
            raise PydanticCustomError("load", "has {given}; allowed: exactly one of pressure, traction, weight", facts)
        place, other = ("body", "face") if given == ["weight"] else ("face", "body")
        if getattr(self, place) is None or getattr(self, other) is not None:
            facts = {"kind": given[0], "place": place, "other": other}
            raise PydanticCustomError("load", "is a {kind}; allowed: {place}, and no {other}", facts)
        return self


class StageTable(Table):
    """A part of the load history."""

    name: Name
    """Shown in progress and results."""
    steps: Annotated[Count, Field(le=1_000_000)]
    """Equal load steps, each of them recorded."""
    motions: dict[str, MotionTable] = Field({})
    """By name of support; supports without a motion stay where they are."""
    loads: dict[str, Real] = Field({})
    """Factors at its end, by name of load, or support with force or moment; default: as in the stage before, in the first one 1."""


class CurveTable(Table):
    """A curve over the load steps: a component of a support's force, moment or displacement."""

    name: str
    """Label of the curve."""
    support: str
    """Name of a support."""
    quantity: Literal["force", "moment", "displacement"] = "force"
    """Force that the support exerts, moment about its moving centre, or how far that has gone."""
    component: Literal["x", "y", "z", "norm"] = "norm"
    """Component, or the Euclidean norm."""


class RecordTable(Table):
    """What results keep."""

    states: Literal["every", "last"] = "every"
    """Positions and multipliers of every load step, or of the last one only."""
    curves: list[CurveTable] | None = None
    """Curves that `isomortar plot` draws one by one, besides force and moment of every support that moves."""


class SceneTable(Table):
    """A scene file of isomortar."""

    format: Version
    """Version of the file format."""
    name: SceneName | None = None
    """Short name, which results files have; default: the file's."""
    title: str = ""
    """One line for people."""
    materials: dict[Name, MaterialTable] = Field({})
    """Materials by name."""
    bodies: Annotated[dict[Name, BodyTable], Field(min_length=1)]
    """Bodies by name."""
    glue: list[tuple[FaceName, FaceName]] = Field([])
    """Pairs of faces, ["BODY.FACE", "BODY.FACE"], that share their control points: those of two bodies with the same mesh there."""
    contacts: dict[Name, ContactTable] = Field({})
    """Contact pairs by name."""
    symmetry: dict[Literal["x", "y", "z"], Real] = Field({})
    """Planes of symmetry, { y = 0.0 } say: of a scene given whole the part above each is computed; forces are the whole's."""
    supports: dict[Name, SupportTable] = Field({})
    """Supports by name."""
    loads: dict[Name, LoadTable] = Field({})
    """Loads by name."""
    stages: Annotated[list[StageTable], Field(min_length=1)]
    """The load history, in order."""
    solver: SolverTable = SolverSettings()
    """Enforcement of contact and convergence."""
    record: RecordTable = RecordTable()
    """What to keep."""


class _Published(GenerateJsonSchema):
    """TOML has no null: what is optional is left out. Docstrings explain the keys: they are read here alone, for that takes its time."""

    def model_schema(self, schema: core_schema.ModelSchema) -> JsonSchemaValue:
        return _explained(super().model_schema(schema), schema["cls"])

    def dataclass_schema(self, schema: core_schema.DataclassSchema) -> JsonSchemaValue:
        return _explained(super().dataclass_schema(schema), schema["cls"])

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        if schema.get("default", ...) is None:
            return self.generate_inner(schema["schema"])
        return super().default_schema(schema)

    def encode_default(self, dft: Any) -> Any:
        return TypeAdapter(type(dft)).dump_python(dft, mode="json", exclude_none=True)


def _explained(schema: JsonSchemaValue, kind: type) -> JsonSchemaValue:
    """A table's schema with the docstrings below its attributes."""
    declaration = ast.parse(dedent(inspect.getsource(kind))).body[0]
    assert isinstance(declaration, ast.ClassDef)
    for attribute, said in pairwise(declaration.body):
        match attribute, said:
            case ast.AnnAssign(target=ast.Name(id=key)), ast.Expr(value=ast.Constant(value=str(text))):
                schema["properties"][key]["description"] = text
    return schema


def json_schema() -> dict[str, Any]:
    """The JSON schema of scene files (draft 2020-12), for editors and other programs."""
    schema = SceneTable.model_json_schema(schema_generator=_Published)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
