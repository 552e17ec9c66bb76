"""Twins of scenes: written or solved in another way, they must come out the same."""

from __future__ import annotations

import copy
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, get_args

import numpy as np
from fuzz.mutation import numbers

from isomortar.model.settings import Measure

#: Powers of a quarter by which the units of the twin differ: exact, also under a root.
LENGTH, MODULUS = 4.0**-7, 4.0**9
#: Powers of the unit of length in the keys that hold one.
LENGTHS = {
    "lower": 1, "upper": 1, "centre": 1, "half_width": 1, "bottom": 1, "rise": 1, "top": 1, "inner": 1, "outer": 1, "width": 1, "point": 1,
    "radius": 1, "translate": 1, "control_points": 1, "reference_area": 2, "elastic_slip": 1, "smoothing": 1, "x": 1, "y": 1, "z": 1,
}  # fmt: skip
#: Keys that hold numbers without a unit.
PURE = {
    "friction", "normal", "tangent", "axis", "angles", "latitudes", "rotate", "knots", "weights", "poisson", "penalty_normal",
    "penalty_tangential", "penalty_growth", "penalty_growth_max", "newton_tolerance", "augmentation_tolerance", "complementarity_tolerance",
    "path_tolerance", "compression", "loads",
}  # fmt: skip
#: Keys of contacts that hold stresses.
STRESSES = ("cohesion", "traction_max", "smoothing")
#: Keys of loads, and by which power of the length they go beside the modulus.
LOADS = {"pressure": 0, "traction": 0, "weight": -1}
#: Numbers within this range have twins, in the other units, that are as far from under- and overflow.
ORDINARY = 1e12
#: How augmentations come nearly as far as the monolithic method does, or give up soon.
AUGMENTED = {
    "method": "uzawa", "augmentation_tolerance": 1e-7, "max_augmentations": 200, "max_cuts": 3, "penalty_growth": 2.0,
    "penalty_growth_max": 1e3,
}  # fmt: skip


@dataclass(frozen=True)
class Twin:
    """A scene that must come out as another one does: how it differs, whether by iterations of its own, and the factors of its units."""

    data: Any
    differs: str
    own_iterations: bool = False
    length: float = 1.0
    modulus: float = 1.0


def twin_of(data: Any, number: int) -> Twin | None:
    """The twin of a scene; every fourth number has one of the same kind. None: nothing to learn."""
    if any(abs(table[key]) > ORDINARY or 0 < abs(table[key]) < 1 / ORDINARY for table, key in numbers(data)):
        return None
    match number % 4:
        case 0:
            return Twin(_in_other_units(data), "in other units", length=LENGTH, modulus=MODULUS)
        case 1:
            reverse = ("bodies", "contacts", "supports")
            reversed_ = {key: dict(reversed(value.items())) if key in reverse else value for key, value in data.items()}
            return Twin(reversed_, "in another order")
        case 2:
            return _never_keeping(data)
        case _:
            return _by_the_other_method(data)


def _never_keeping(data: Any) -> Twin | None:
    """The scene with a tangent and factors of its own for every iteration; None where it has these."""
    solver = data.get("solver", {})
    measures = solver.get("measures", get_args(Measure))
    if "keeping" not in measures:
        return None
    solver = {**solver, "measures": [measure for measure in measures if measure != "keeping"]}
    return Twin({**data, "solver": solver}, "with factors that are never kept", own_iterations=True)


def _by_the_other_method(data: Any) -> Twin | None:
    """The scene by augmentations in place of the monolithic method, or the other way; None where slips are summed, which jumps."""
    solver = data.get("solver", {})
    if solver.get("slip_sum") == "paper":
        return None
    other = AUGMENTED if solver.get("method", "monolithic") == "monolithic" else {"method": "monolithic"}
    return Twin({**data, "solver": {**solver, **other}}, "by the other method", own_iterations=True)


def _in_other_units(data: Any) -> Any:
    """A scene with another unit of length and of stress."""
    twin = copy.deepcopy(data)
    materials = twin.setdefault("materials", {})
    for material in materials.values() if materials else (materials.setdefault("only", {}),):
        material["young"] = material.get("young", 10.0) * MODULUS
    _scale(twin, 0)
    for contact in twin.get("contacts", {}).values():
        contact.update({key: contact[key] * MODULUS for key in STRESSES if key in contact})
        if "tangent" not in contact.get("plane", {"tangent": ()}):
            contact["plane"].setdefault("point", [0.0, 0.0, 0.0])
    for load in twin.get("loads", {}).values():
        for key, power in LOADS.items():
            if key in load:
                load[key] = np.multiply(load[key], MODULUS * LENGTH**power).tolist()
    for support in twin.get("supports", {}).values():  # of x, y and z lengths are scaled already
        support.update({"force": {axis: size * MODULUS * LENGTH for axis, size in support["force"].items()}} if "force" in support else {})
        support.update({"moment": support["moment"] * MODULUS * LENGTH**3} if "moment" in support else {})
    return twin


def _scale(data: Any, power: int) -> None:
    """Multiply every length below by the factor of length."""
    entries: Iterable[Any] = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        own = LENGTHS.get(key, 0) if isinstance(key, str) and not isinstance(value, dict) else power
        if isinstance(value, dict | list):
            _scale(value, own)
        elif own and isinstance(value, int | float):
            data[key] = value * LENGTH**own
