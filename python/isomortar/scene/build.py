"""From the tables of a scene file to the plain data of a `Problem`."""

from __future__ import annotations

from dataclasses import replace
from math import hypot
from pathlib import Path

from isomortar.errors import InputError
from isomortar.geometry.patch import FACES, Direction, Patch
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.geometry.refinement import mesh, raised_along
from isomortar.model import constants
from isomortar.model.checks import check_units
from isomortar.model.contact_checks import has_pole
from isomortar.model.enforcement.integration import integrated
from isomortar.model.entities import (
    PLACES,
    Body,
    Contact,
    Edge,
    Face,
    Faces,
    Load,
    Material,
    Motion,
    Problem,
    Raised,
    RigidPlane,
    Stage,
    Support,
    SymmetryPlane,
)
from isomortar.model.kinks import has_kinks
from isomortar.model.messages import located
from isomortar.model.sheet import Sheet
from isomortar.model.symmetry import held_on_planes, upper_part
from isomortar.scene.geometry_file import read_geometry
from isomortar.scene.schema import BodyTable, ContactTable, LoadTable, MeshTable, PlaneTable, SceneTable, SupportTable
from isomortar.scene.types import listed

#: Scenes above this number of unknowns are taken for mistakes: their factorisation would not fit a large machine.
MAX_UNKNOWNS = 5_000_000
#: Examples of faces that meet.
_MEETING = {"edge": "u0.w1", "corner": "u0.v0.w1"}


def build(scene: SceneTable, name: str, folder: Path) -> Problem:
    """The problem that a validated scene describes.

    Parameters
    ----------
    scene : SceneTable
    name : str
        Name where the scene has none.
    folder : Path
        Where geometry files lie.

    Raises
    ------
    InputError
        References to what does not exist, impossible geometry or discretisation.
    """
    coarse = {body: coarse_patch(body, table, folder) for body, table in scene.bodies.items()}
    meshes = {body: _MeshPlan.of(table, coarse[body]) for body, table in scene.bodies.items()}
    _check_size(meshes)
    _check_curves(scene)
    planes = tuple(SymmetryPlane("xyz".index(axis), place) for axis, place in sorted(scene.symmetry.items()))
    whole = tuple(_body(body, table, coarse[body], meshes[body], scene) for body, table in scene.bodies.items())
    for one in whole:
        check_units(one)  # before anything is squared
    bodies, cuts = upper_part(whole, planes)
    by_name = {body.name: body for body in bodies}
    problem = Problem(
        name=scene.name or name,
        bodies=bodies,
        contacts=(),
        supports=tuple(
            _support(support, table, by_name, _motions(scene, support), _factors(scene, support, table.stages), _held_in(scene, support))
            for support, table in scene.supports.items()
        ),
        stages=_stages(scene),
        settings=scene.solver,
        glue=tuple(_joint(faces, by_name, f"glue.{number}") for number, faces in enumerate(scene.glue)),
        symmetry=planes,
        loads=tuple(_load(load, table, by_name, _factors(scene, load)) for load, table in scene.loads.items()),
    )
    contacts = tuple(_contact(contact, table, problem, replace(problem, bodies=whole)) for contact, table in scene.contacts.items())
    return held_on_planes(replace(problem, contacts=contacts), cuts)


def coarse_patch(name: str, table: BodyTable, folder: Path) -> Patch:
    """Geometry of a body before its discretisation."""
    if table.geometry is not None:
        with located(f"bodies.{name}.geometry"):
            return table.geometry.patch()
    if table.file is not None:
        with located(f"bodies.{name}.file"):
            return read_geometry(folder / table.file)
    assert table.patch is not None  # BodyTable has exactly one of the three
    with located(f"bodies.{name}.patch"):
        return table.patch.patch()


class _MeshPlan:
    """Families, orders, numbers and grading of elements that a body is to have, with the defaults filled in."""

    def __init__(self, table: MeshTable, own: tuple[Direction, ...], lowest_order: int) -> None:
        self.asked_for = bool(table.model_fields_set - {"quadrature"}) or lowest_order > 1
        self.families = table.family if "family" in table.model_fields_set else tuple(d.family for d in own)
        self.orders = table.order or tuple(max(d.order, lowest_order) for d in own)
        self.elements = table.elements or tuple(d.elements for d in own)
        self.grading = table.grading

    @classmethod
    def of(cls, table: BodyTable, coarse: Patch) -> _MeshPlan:
        return cls(table.mesh, coarse.directions, 1 if table.geometry is None else 2)

    @property
    def control_points(self) -> int:
        """Their number, inner knots counted once: known before any array is made."""
        counts = [n + p if f == "N" else n * p + 1 for f, p, n in zip(self.families, self.orders, self.elements, strict=True)]
        return counts[0] * counts[1] * counts[2]


def _check_size(meshes: dict[str, _MeshPlan]) -> None:
    unknowns = {name: 3 * plan.control_points for name, plan in meshes.items()}
    if sum(unknowns.values()) > MAX_UNKNOWNS:
        largest = max(unknowns, key=lambda name: unknowns[name])
        raise InputError(
            f"the scene would have {sum(unknowns.values())} unknowns, {unknowns[largest]} of them here; allowed: {MAX_UNKNOWNS}",
            f"bodies.{largest}.mesh.elements",
        )


def _body(name: str, table: BodyTable, coarse: Patch, plan: _MeshPlan, scene: SceneTable) -> Body:
    patch, raised = coarse, None
    if plan.asked_for:
        with located(f"bodies.{name}.mesh"):
            patch = mesh(coarse, plan.families, plan.orders, plan.elements, plan.grading)
    below = patch.directions
    if table.mesh.contact_order:
        raised = Raised(_face_in_contact(scene, name), (below[0].order, below[1].order, below[2].order))
        with located(f"bodies.{name}.mesh.contact_order"):
            patch = raised_along(patch, raised.face, table.mesh.contact_order)
    u, v, w = (max(volume_points(low), high.order + 1) for low, high in zip(below, patch.directions, strict=True))
    quadrature = table.mesh.quadrature or (u, v, w)
    closed = table.closed or (table.geometry.closed if table.geometry else None)
    return Body(name, patch, _material(scene, name), quadrature, closed, table.rigid, raised)


def _face_in_contact(scene: SceneTable, body: str) -> str:
    """The face of a body that is in contact, the only one."""
    sides = [side for contact in scene.contacts.values() for side in (*contact.slave, *(contact.master or ()))]
    faces = sorted({side.rpartition(".")[2] for side in sides if side.rpartition(".")[0] == body})
    if len(faces) != 1:
        named = f"of {body!r} are {', '.join(faces)}" if faces else f"{body!r} has none"
        raise InputError(f"is for bodies with one face in contact, and {named}; remove it", f"bodies.{body}.mesh.contact_order")
    return faces[0]


def _material(scene: SceneTable, body: str) -> Material:
    names, wanted, field = list(scene.materials), scene.bodies[body].material, f"bodies.{body}.material"
    if scene.bodies[body].rigid:
        return Material()
    if wanted is None and len(names) > 1:
        raise InputError(f"is missing, but must be given where there are several; allowed: {', '.join(names)}", field)
    if wanted is not None and wanted not in names:
        raise InputError(f"there is no material {wanted!r}; allowed: {listed(wanted, names)}", field)
    return scene.materials[wanted or names[0]] if names else Material()


def _face(text: str, bodies: dict[str, Body], field: str) -> Face:
    body, point, face = text.rpartition(".")
    if not point:
        raise InputError(f"is {text!r}, which names no face; allowed: BODY.FACE with BODY one of {listed(text, bodies)}", field)
    if body not in bodies:
        raise InputError(f"is {text!r}, but there is no body {body!r}; allowed: BODY.FACE with BODY one of {listed(body, bodies)}", field)
    faces = bodies[body].outer
    if face not in faces:
        closed = f" ({body} is closed in {bodies[body].closed})" if face in FACES else ""
        raise InputError(f"is {text!r}, but {body} has no face {face!r}{closed}; allowed: {', '.join(faces)}", field)
    return Face(body, face)


def _place(table: SupportTable, bodies: dict[str, Body], field: str) -> Edge | Face:
    """Where a support is."""
    key, text = next((key, text) for key in PLACES if (text := getattr(table, key)) is not None)
    if key == "face":
        return _face(text, bodies, f"{field}.face")
    body, *names = text.split(".")
    faces = [_face(f"{body}.{name}", bodies, f"{field}.{key}") for name in names]
    if not len(faces) == len({name[0] for name in names}) == 1 + PLACES.index(key):
        form = ".".join(["BODY", *["FACE"] * (1 + PLACES.index(key))])
        raise InputError(f"is {text!r}; allowed: {form} with faces that meet, such as {body}.{_MEETING[key]}", f"{field}.{key}")
    return Edge(body, names[0], tuple(names[1:]))


def _joint(faces: tuple[str, str], bodies: dict[str, Body], field: str) -> tuple[Face, Face]:
    one, other = (_face(face, bodies, field) for face in faces)
    return one, other


def _contact(name: str, table: ContactTable, problem: Problem, whole: Problem) -> Contact:
    """A contact of a problem that has its bodies; what planes of symmetry cut has its kinks there in the whole."""
    path = f"contacts.{name}"
    slave, slave_sheet = _side(table.slave, problem, f"{path}.slave")
    master: Face | RigidPlane
    if table.plane:
        master, by_default = _plane(table.plane, f"{path}.plane"), False
    else:
        master, sheet = _side(table.master or (), whole, f"{path}.master")
        # The paper's slip sum needs closest points; at a pole there are no averaged normals.
        wanted = table.projection is None and problem.settings.slip_sum != "paper"
        by_default = wanted and has_kinks(sheet) and not has_pole(sheet)
    if master == slave:
        raise InputError(f"is the slave face {slave.words!r} itself; allowed: another face", f"{path}.master")
    first, second = slave_sheet.directions
    contact = Contact(
        name=name,
        slave=slave,
        master=master,
        friction=table.friction,
        quadrature=table.quadrature or (contact_points(first), contact_points(second)),
        reference_area=table.reference_area,
        cohesion=table.cohesion,
        traction_max=table.traction_max,
        projection="averaged" if by_default else table.projection or "closest",
        by_default=by_default,
        enforcement=table.enforcement,
        subcells=table.subcells or 0,
        elastic_slip=table.elastic_slip,
        smoothing=table.smoothing,
    )
    return integrated(contact, problem) if table.quadrature is None and table.subcells is None else contact


def _side(names: tuple[str, ...], problem: Problem, field: str) -> tuple[Face, Sheet]:
    """A side of a contact and its sheet."""
    first, *others = (_face(name, {body.name: body for body in problem.bodies}, field) for name in names)
    place = Faces(first.body, first.face, tuple(others)) if others else first
    with located(field):
        return place, Sheet.of(problem, place)


def _plane(table: PlaneTable, path: str) -> RigidPlane:
    normal = _unit(table.normal, f"{path}.normal")
    wanted = table.tangent or ((1.0, 0.0, 0.0) if abs(normal[0]) < 0.9 else (0.0, 1.0, 0.0))
    along = _unit(wanted, f"{path}.tangent")
    out = sum(a * n for a, n in zip(along, normal, strict=True))
    across = (along[0] - out * normal[0], along[1] - out * normal[1], along[2] - out * normal[2])
    if hypot(*across) < constants.NO_PART:
        raise InputError(f"is {list(wanted)}, parallel to the normal; allowed: any other direction", f"{path}.tangent")
    return RigidPlane(table.point, normal, _unit(across, f"{path}.tangent"))


def _unit(vector: tuple[float, float, float], path: str) -> tuple[float, float, float]:
    length = hypot(*vector)
    if length == 0.0:
        raise InputError("is a vector of length zero; allowed: any other", path)
    return vector[0] / length, vector[1] / length, vector[2] / length


def _support(
    name: str,
    table: SupportTable,
    bodies: dict[str, Body],
    motions: tuple[Motion, ...],
    factors: tuple[float, ...],
    stages: tuple[int, ...] | None,
) -> Support:
    place = _place(table, bodies, f"supports.{name}")
    force = (table.force.x, table.force.y, table.force.z)
    given = [axis for axis, size in zip("xyz", force, strict=True) if size is None] if table.components is None else table.components
    components = tuple(sorted("xyz".index(axis) for axis in given))
    axis = _unit(table.axis, f"supports.{name}.axis")
    factors = factors if table.by_force else ()
    return Support(name, place, motions, components, table.centre, axis, force, factors, table.moment, stages)


def _held_in(scene: SceneTable, support: str) -> tuple[int, ...] | None:
    """Numbers of the stages in which a support holds; None: all, now and in longer scenes."""
    wanted, names = scene.supports[support].stages, [stage.name for stage in scene.stages]
    if wanted is None:
        return None
    for name in wanted:
        if name not in names:
            raise InputError(f"there is no stage {name!r}; allowed: {listed(name, names)}", f"supports.{support}.stages")
    return tuple(number for number, name in enumerate(names) if name in wanted)


def _motions(scene: SceneTable, support: str) -> tuple[Motion, ...]:
    return tuple(stage.motions.get(support, Motion()) for stage in scene.stages)


def _load(name: str, table: LoadTable, bodies: dict[str, Body], factors: tuple[float, ...]) -> Load:
    if table.weight is not None:
        assert table.body is not None  # LoadTable has a body with a weight, else a face
        if table.body not in bodies:
            raise InputError(f"there is no body {table.body!r}; allowed: {listed(table.body, bodies)}", f"loads.{name}.body")
        return Load(name, "weight", table.body, None, table.weight, factors)
    assert table.face is not None
    place = _face(table.face, bodies, f"loads.{name}.face")
    if table.traction is not None:
        return Load(name, "traction", place.body, place.face, table.traction, factors)
    assert table.pressure is not None
    return Load(name, "pressure", place.body, place.face, (table.pressure,), factors)


def _factors(scene: SceneTable, load: str, stages: list[str] | None = None) -> tuple[float, ...]:
    """Factors of a load at the ends of the stages: what they name, else that of the stage before, of the first one 1.

    Of a support of some `stages` it is 0 in the others.
    """
    factor, factors = 1.0, []
    for stage in scene.stages:
        factor = stage.loads.get(load, factor)
        factors.append(factor if stages is None or stage.name in stages else 0.0)
    return tuple(factors)


def _stages(scene: SceneTable) -> tuple[Stage, ...]:
    pressed = [name for name, support in scene.supports.items() if support.by_force]
    for name in pressed:
        if name in scene.loads:
            raise InputError(
                "is the name of a load as well, and stages name both among loads; allowed: a name for each", f"supports.{name}"
            )
    loads = [*scene.loads, *pressed]
    for number, stage in enumerate(scene.stages):
        for name in stage.loads:
            if name not in loads:
                field = f"stages.{stage.name}.loads.{name}"
                raise InputError(f"there is no such load, nor a support with a force or a moment; allowed: {listed(name, loads)}", field)
            held = scene.supports[name].stages if name in pressed else None
            if held is not None and stage.name not in held:
                raise InputError(
                    f"support {name!r} does not hold in that stage (supports.{name}.stages); allowed: factors of those in which it does",
                    f"stages.{stage.name}.loads.{name}",
                )
        for name in stage.motions:
            if name not in scene.supports:
                field = f"stages.{stage.name}.motions.{name}"
                raise InputError(f"there is no such support; allowed: {listed(name, scene.supports)}", field)
        if stage.name in [other.name for other in scene.stages[:number]]:
            raise InputError(f"{stage.name!r} is the name of two stages; allowed: a name for each", f"stages.{number}.name")
    return tuple(Stage(stage.name, stage.steps) for stage in scene.stages)


def _check_curves(scene: SceneTable) -> None:
    curves = scene.record.curves or ()
    for number, curve in enumerate(curves):
        if curve.name in [other.name for other in curves[:number]]:
            raise InputError(f"{curve.name!r} is the name of two curves; allowed: a name for each", f"record.curves.{number}.name")
        if curve.support not in scene.supports:
            allowed = listed(curve.support, scene.supports)
            raise InputError(f"there is no support {curve.support!r}; allowed: {allowed}", f"record.curves.{curve.name}.support")
