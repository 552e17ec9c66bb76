"""What a user gets who says nothing: every default of scene files, problems and quadrature tables, as documented."""

import inspect
from dataclasses import MISSING, fields, is_dataclass

import pytest
from pydantic import BaseModel

from isomortar.geometry.patch import Direction
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.march.simulation import Simulation
from isomortar.model import constants, entities, settings
from isomortar.scene import Scene, primitives, schema
from isomortar.solve.record import StepResult

SOLVER = {
    "method": "monolithic",
    "slip_sum": "local",
    "penalty_normal": 100.0,
    "penalty_tangential": 10.0,
    "penalty_growth": 2.0,
    "penalty_growth_max": 200.0,
    "augmentation_tolerance": 0.01,
    "augmentation_norm": "separate",
    "newton_tolerance": 1e-9,
    "complementarity_tolerance": 1e-8,
    "max_augmentations": 100,
    "max_iterations": 30,
    "max_cuts": 8,
    "measures": ("forgiving", "margin", "reversal", "halving", "keeping", "extrapolation"),
    "path_tolerance": None,
    "engine": "own",
    "compression": 0.0,
}
_FRICTION = {"cohesion": 0.0, "traction_max": None, "elastic_slip": 0.0, "smoothing": 0.0}
#: By entity of a problem; those that are not named have none.
ENTITIES = {
    "Material": {"young": 10.0, "poisson": 0.3, "law": "neo-hookean"},
    "Body": {"closed": None, "rigid": False, "raised": None},
    "Contact": {"reference_area": None, **_FRICTION, "projection": "closest", "by_default": False, "enforcement": "mortar", "subcells": 0},
    "Motion": {"translate": (0.0, 0.0, 0.0), "rotate": 0.0},
    "Support": {
        "components": (0, 1, 2),
        "centre": (0.0, 0.0, 0.0),
        "axis": (0.0, 0.0, 1.0),
        "force": (None, None, None),
        "factors": (),
        "moment": None,
        "stages": None,
    },
    "Load": {"factors": ()},
    "SolverSettings": SOLVER,
    "Problem": {"settings": SOLVER, "glue": (), "symmetry": (), "loads": ()},
}
_MESH = {"family": ("N", "N", "N"), "order": None, "contact_order": None, "elements": None, "grading": (1.0, 1.0, 1.0), "quadrature": None}
_ROUND = {"centre": (0.0, 0.0, 0.0), "angles": (0.0, 360.0)}
_RECORD = {"states": "every", "curves": None}
_FORCE = {"x": None, "y": None, "z": None}
#: By table of a scene file that is none of these.
TABLES = {
    "BowlTable": {"centre": (0.0, 0.0)},
    "CapTable": {"centre": (0.0, 0.0)},
    "RingTable": {**_ROUND, "axis": "y"},
    "SphereTable": {**_ROUND, "inner": 0.0, "latitudes": (-90.0, 90.0), "axis": "z"},
    "TorusTable": {**_ROUND, "inner": 0.0, "latitudes": (-180.0, 180.0), "axis": "z"},
    "PatchTable": {"family": ("N", "N", "N"), "weights": None},
    "MeshTable": _MESH,
    "BodyTable": {"material": None, "geometry": None, "file": None, "patch": None, "mesh": _MESH, "closed": None, "rigid": False},
    "PlaneTable": {"point": (0.0, 0.0, 0.0), "normal": (0.0, 0.0, 1.0), "tangent": None},
    "ContactTable": {
        "master": None,
        "plane": None,
        "friction": 0.3,
        **_FRICTION,
        "projection": None,
        "enforcement": "mortar",
        "quadrature": None,
        "subcells": None,
        "reference_area": None,
    },
    "ForceTable": _FORCE,
    "SupportTable": {
        "face": None,
        "edge": None,
        "corner": None,
        "components": None,
        "force": _FORCE,
        "centre": (0.0, 0.0, 0.0),
        "axis": (0.0, 0.0, 1.0),
        "moment": None,
        "stages": None,
    },
    "LoadTable": {"face": None, "body": None, "pressure": None, "traction": None, "weight": None},
    "StageTable": {"motions": {}, "loads": {}},
    "CurveTable": {"quantity": "force", "component": "norm"},
    "RecordTable": _RECORD,
    "SceneTable": {
        "name": None,
        "title": "",
        "materials": {},
        "glue": [],
        "symmetry": {},
        "contacts": {},
        "supports": {},
        "loads": {},
        "solver": SOLVER,
        "record": _RECORD,
    },
}

ORDERS = {"N": range(1, 8), "L": range(1, 5)}


def plain(value: object) -> object:
    """A default as it would stand in a file."""
    if isinstance(value, BaseModel):
        return {name: plain(getattr(value, name)) for name in type(value).model_fields}
    return {f.name: plain(getattr(value, f.name)) for f in fields(value)} if is_dataclass(value) else value


def own_classes(module: object) -> list[type]:
    return [c for _, c in inspect.getmembers(module, inspect.isclass) if c.__module__ == module.__name__]


def test_defaults_of_a_problem():
    found = {}
    for entity in filter(is_dataclass, [*own_classes(entities), *own_classes(settings)]):
        made = {f.name: f.default_factory() for f in fields(entity) if f.default_factory is not MISSING}
        given = {f.name: f.default for f in fields(entity) if f.default is not MISSING}
        found[entity.__name__] = {name: plain(value) for name, value in (given | made).items()}
    assert {name: defaults for name, defaults in found.items() if defaults} == ENTITIES


def test_defaults_of_a_scene_file():
    found = {}
    for table in (*own_classes(primitives), *own_classes(schema)):
        if issubclass(table, BaseModel):
            given = {name: field for name, field in table.model_fields.items() if not field.is_required()}
            found[table.__name__] = {name: plain(field.get_default(call_default_factory=True)) for name, field in given.items()}
    assert {name: defaults for name, defaults in found.items() if defaults} == TABLES


@pytest.mark.parametrize(
    ("family", "rule", "points"),
    [
        ("N", volume_points, (2, 4, 6, 6, 7, 8, 9)),
        ("N", contact_points, (4, 6, 6, 6, 7, 8, 9)),
        ("L", volume_points, (2, 4, 4, 6)),
        ("L", contact_points, (4, 4, 9, 12)),
    ],
)
def test_gauss_points_by_order(family, rule, points):
    found = [rule(Direction(family, order, [0, 1] if family == "L" else [0] * (order + 1) + [1] * (order + 1))) for order in ORDERS[family]]
    assert tuple(found) == points


#: Contact with friction that opens, sticks and slips; no word on the solver, the material or quadrature.
SILENT = """
format = 1
[bodies.block]
geometry = { kind = "bowl", half_width = 0.5, bottom = 0.0, rise = 0.1, top = 0.6 }
mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
[contacts.floor]
slave = "block.w0"
plane = {}
[supports.top]
face = "block.w1"
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0, 0, -0.1]
[[stages]]
name = "drag"
steps = 1
motions.top = { translate = [0.1, 0.02, 0], rotate = 6 }
"""
#: The same as docs say that it is.
SPOKEN = (
    SILENT.replace("elements = [3, 3, 1] }", 'elements = [3, 3, 1], family = "N", quadrature = [4, 4, 2] }')
    .replace(
        "plane = {}",
        "friction = 0.3\nelastic_slip = 0\nquadrature = [6, 6]\nplane = { point = [0, 0, 0], normal = [0, 0, 1], tangent = [1, 0, 0] }",
    )
    .replace('face = "block.w1"', 'face = "block.w1"\ncomponents = ["x", "y", "z"]\ncentre = [0, 0, 0]\naxis = [0, 0, 1]')
    + """
[materials.m]
young = 10.0
poisson = 0.3
[solver]
method = "monolithic"
slip_sum = "local"
newton_tolerance = 1e-9
complementarity_tolerance = 1e-8
max_iterations = 30
max_cuts = 8
measures = ["forgiving", "margin", "reversal", "halving", "keeping", "extrapolation"]
"""
)


def ends(text: str, *overrides: str) -> StepResult:
    return list(Simulation(Scene.from_toml(text, overrides=overrides).problem()).run())[-1]


def test_who_says_nothing_gets_what_is_documented_to_the_last_bit():
    silent, spoken = ends(SILENT), ends(SPOKEN)
    assert {0, 2} <= set(silent.contacts[0].status.tolist())
    assert silent.state.positions.tobytes() == spoken.state.positions.tobytes()
    assert silent.contacts[0].force_slave.tobytes() == spoken.contacts[0].force_slave.tobytes()
    assert silent.augmentations == spoken.augmentations


@pytest.mark.parametrize(
    "other",
    [
        'solver.method="uzawa"', 'solver.slip_sum="paper"', "solver.newton_tolerance=1e-4", "contacts.floor.friction=0.31",
        "contacts.floor.quadrature=[5,6]", "contacts.floor.plane.normal=[0.01,0,1]", "contacts.floor.plane.point=[0,0,0.001]",
        "bodies.block.mesh.quadrature=[3,4,2]", "materials.m.young=10.1", "materials.m.poisson=0.31", "supports.top.centre=[0.1,0,0]",
        "supports.top.axis=[0,0.1,1]", "contacts.floor.elastic_slip=1e-3", 'solver.measures=["forgiving","margin","reversal","halving"]',
    ],
)  # fmt: skip
def test_each_of_them_counts(other):
    spoken, changed = ends(SPOKEN), ends(SPOKEN, other)
    assert changed.augmentations != spoken.augmentations or changed.state.positions.tobytes() != spoken.state.positions.tobytes()


def test_uzawa_has_the_penalties_and_tolerances_that_are_documented():
    said = ["solver.method=uzawa"]
    documented = {name: value for name, value in SOLVER.items() if "penalty" in name or "augmentation" in name}
    silent, spoken = ends(SILENT, *said), ends(SILENT, *said, *(f"solver.{name}={value}" for name, value in documented.items()))
    assert silent.augmentations == spoken.augmentations
    base = silent.augmentations[0].penalty_normal
    found = [(record.penalty_normal / base, record.penalty_tangential / base) for record in silent.augmentations]
    assert found == [(pytest.approx(2.0**k), pytest.approx(0.1 * 2.0**k)) for k in range(len(found))]
    assert max(silent.augmentations[-1].change_pressure, silent.augmentations[-1].change_traction) <= 0.01
    assert max(silent.augmentations[-2].change_pressure, silent.augmentations[-2].change_traction) > 0.01


def test_when_increments_grow_back():
    assert (constants.EASY_ITERATIONS, constants.HARD_TANGENTS) == (12, 25)
