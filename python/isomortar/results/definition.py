"""Stores a `Problem` in a results file and rebuilds it, bit for bit.

Patches are datasets; all else is JSON (which keeps every bit of a float) in attributes (which HDF5 guards with checksums).
"""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

import h5py
import numpy as np
from pydantic import TypeAdapter

from isomortar.geometry.patch import Closed, Direction, Patch
from isomortar.model.entities import (
    Body,
    Contact,
    Face,
    Load,
    Material,
    Problem,
    Raised,
    Stage,
    Support,
    SymmetryPlane,
)
from isomortar.model.settings import SolverSettings
from isomortar.results.layout import CONTROL_POINTS, KNOTS, WEIGHTS, Quantity

_AXES = "uvw"
_PLAIN: dict[str, Any] = {
    "contacts": tuple[Contact, ...],
    "supports": tuple[Support, ...],
    "stages": tuple[Stage, ...],
    "settings": SolverSettings,
    "glue": tuple[tuple[Face, Face], ...],
    "symmetry": tuple[SymmetryPlane, ...],
    "loads": tuple[Load, ...],
}
#: What earlier files of the same format do not hold, and had not.
_LATER = ("glue", "symmetry", "loads", "rigid", "raised")
_BODY: dict[str, Any] = {
    "name": str,
    "material": Material,
    "quadrature": tuple[int, int, int],
    "closed": Closed | None,
    "rigid": bool,
    "raised": Raised | None,
}


def write_problem(group: h5py.Group, problem: Problem) -> None:
    """Store the problem in an empty group."""
    for name in ("name", *_PLAIN):
        group.attrs[name] = _json(getattr(problem, name))
    for number, body in enumerate(problem.bodies):
        _write_body(group.create_group(f"bodies/{number}"), body)


def write_stages(group: h5py.Group, problem: Problem) -> None:
    """Store the stages of a problem, and what supports and loads do in them, in the place of fewer."""
    for name in ("stages", "supports", "loads"):
        group.attrs[name] = _json(getattr(problem, name))


def read_problem(group: h5py.Group) -> Problem:
    """Rebuild the problem that `write_problem` stored.

    Raises
    ------
    ValueError
        Bodies are missing.
    """
    others = _read_plain(group, _PLAIN)
    bodies = tuple(_read_body(group[f"bodies/{number}"]) for number in range(len(group["bodies"])))
    problem = Problem(name=json.loads(group.attrs["name"]), bodies=bodies, **others)
    named = {support.place.body for support in problem.supports} | {contact.slave.body for contact in problem.contacts}
    named |= {load.body for load in problem.loads}
    if not bodies or not named <= {body.name for body in bodies}:
        raise ValueError("bodies of the scene are missing")
    return problem


def _write_body(group: h5py.Group, body: Body) -> None:
    for name in _BODY:
        group.attrs[name] = _json(getattr(body, name))
    for axis, direction in zip(_AXES, body.patch.directions, strict=True):
        knots = _dataset(group, f"knots_{axis}", KNOTS, direction.knots)
        knots.attrs["family"] = _json(direction.family)
        knots.attrs["order"] = direction.order
    _dataset(group, "control_points", CONTROL_POINTS, body.patch.control_points)
    _dataset(group, "weights", WEIGHTS, body.patch.weights)


def _read_body(group: h5py.Group) -> Body:
    knots = [group[f"knots_{axis}"] for axis in _AXES]
    u, v, w = (Direction(json.loads(k.attrs["family"]), int(k.attrs["order"]), k[()]) for k in knots)
    patch = Patch((u, v, w), group["control_points"][()], group["weights"][()])
    others = _read_plain(group, _BODY)
    return Body(patch=patch, **others)


def _read_plain(group: h5py.Group, kinds: dict[str, Any]) -> dict[str, Any]:
    there = {name: kind for name, kind in kinds.items() if name in group.attrs or name not in _LATER}
    return {name: _reader_of(kind).validate_json(bytes(group.attrs[name])) for name, kind in there.items()}


@cache
def _reader_of(kind: Any) -> TypeAdapter[Any]:
    """What reads values of a type: made once, which takes longer than all that it reads."""
    return TypeAdapter(kind)


def _dataset(group: h5py.Group, name: str, quantity: Quantity, data: Any) -> h5py.Dataset:
    dataset = group.create_dataset(name, data=np.asarray(data, dtype=quantity.dtype), chunks=True, fletcher32=True)
    dataset.attrs["unit"], dataset.attrs["description"] = quantity.unit, quantity.description
    return dataset


def _json(value: Any) -> np.bytes_:
    return np.bytes_(json.dumps(plain(value)))


def plain(value: Any) -> Any:
    """Dataclasses to dictionaries, arrays and tuples to lists, NumPy numbers to Python's."""
    if is_dataclass(value):
        return {f.name: plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value
