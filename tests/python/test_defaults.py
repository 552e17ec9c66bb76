"""What a user gets who says nothing: every default of scene files, problems and quadrature tables, as documented."""

import inspect
from dataclasses import MISSING, fields, is_dataclass

import pytest
from pydantic import BaseModel

from isomortar.geometry.patch import Direction
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.model import entities
from isomortar.scene import schema
from isomortar.solve import simulation

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
    "measures": ("forgiving", "margin", "reversal", "halving", "keeping"),
    "path_tolerance": None,
}
#: By entity of a problem; those that are not named have none.
ENTITIES = {
    "Material": {"young": 10.0, "poisson": 0.3},
    "Body": {"closed": None},
    "Contact": {"reference_area": None},
    "Motion": {"translate": (0.0, 0.0, 0.0), "rotate": 0.0},
    "Support": {"components": (0, 1, 2), "centre": (0.0, 0.0, 0.0), "axis": (0.0, 0.0, 1.0)},
    "SolverSettings": SOLVER,
    "Problem": {"settings": SOLVER},
}
_MESH = {"family": ("N", "N", "N"), "order": None, "elements": None, "quadrature": None}
_RECORD = {"states": "every", "curves": None}
#: By table of a scene file.
TABLES = {
    "MaterialTable": {"young": 10.0, "poisson": 0.3},
    "BowlTable": {"centre": (0.0, 0.0)},
    "RingTable": {"centre": (0.0, 0.0, 0.0)},
    "PatchTable": {"family": ("N", "N", "N"), "weights": None},
    "MeshTable": _MESH,
    "BodyTable": {"material": None, "geometry": None, "file": None, "patch": None, "mesh": _MESH, "closed": None},
    "PlaneTable": {"point": (0.0, 0.0, 0.0), "normal": (0.0, 0.0, 1.0), "tangent": None},
    "ContactTable": {"master": None, "plane": None, "friction": 0.3, "quadrature": None, "reference_area": None},
    "SupportTable": {"components": ("x", "y", "z"), "centre": (0.0, 0.0, 0.0), "axis": (0.0, 0.0, 1.0)},
    "MotionTable": {"translate": (0.0, 0.0, 0.0), "rotate": 0.0},
    "StageTable": {"motions": {}},
    "SolverTable": SOLVER,
    "CurveTable": {"quantity": "force", "component": "norm"},
    "RecordTable": _RECORD,
    "SceneTable": {"name": None, "title": "", "materials": {}, "contacts": {}, "supports": {}, "solver": SOLVER, "record": _RECORD},
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
    for entity in filter(is_dataclass, own_classes(entities)):
        made = {f.name: f.default_factory() for f in fields(entity) if f.default_factory is not MISSING}
        given = {f.name: f.default for f in fields(entity) if f.default is not MISSING}
        found[entity.__name__] = {name: plain(value) for name, value in (given | made).items()}
    assert {name: defaults for name, defaults in found.items() if defaults} == ENTITIES


def test_defaults_of_a_scene_file():
    found = {}
    for table in own_classes(schema):
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


def test_when_increments_grow_back():
    assert (simulation.EASY_ITERATIONS, simulation.HARD_TANGENTS) == (12, 25)
