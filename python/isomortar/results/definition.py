"""Stores a `Problem` in a results file and rebuilds it, bit for bit; says where two problems differ.

Patches are datasets; all else is JSON (which keeps every bit of a float) in attributes (which HDF5 guards with checksums).
"""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass, replace
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
    Motion,
    Problem,
    Raised,
    SolverSettings,
    Stage,
    Support,
    SymmetryPlane,
)
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
    plain = _read_plain(group, _PLAIN)
    bodies = tuple(_read_body(group[f"bodies/{number}"]) for number in range(len(group["bodies"])))
    problem = Problem(name=json.loads(group.attrs["name"]), bodies=bodies, **plain)
    named = {support.place.body for support in problem.supports} | {contact.slave.body for contact in problem.contacts}
    named |= {load.body for load in problem.loads}
    if not bodies or not named <= {body.name for body in bodies}:
        raise ValueError("bodies of the scene are missing")
    return problem


def is_longer(stored: Problem, given: Problem) -> bool:
    """Whether a problem is another one with stages added at its end, or its last stage longer at the same rate, and nothing else."""
    count = len(stored.stages)
    if given.total_steps <= stored.total_steps or len(given.stages) < count:
        return False
    last, longer = stored.stages[-1], given.stages[count - 1]
    if last.steps != longer.steps and any(s.holds(count - 2) and not s.holds(count - 1) for s in given.supports if count > 1):
        return False  # what a support bore goes to zero by the end of the stage
    share = last.steps / longer.steps
    supports = tuple(_first_stages(s, count, share) for s in given.supports)
    loads = tuple(replace(load, factors=_factors(load.factors, count, share)) for load in given.loads)
    stages = (*given.stages[: count - 1], replace(longer, steps=min(last.steps, longer.steps)))
    return not differences(_rounded(stored), _rounded(replace(given, stages=stages, supports=supports, loads=loads)))


def _first_stages(support: Support, count: int, share: float) -> Support:
    """A support in the first stages, and in a share of the last of these."""
    *before, last = support.motions[:count]
    x, y, z = (share * way for way in last.translate)
    motions = (*before, Motion((x, y, z), share * last.rotate))
    held = support.stages and tuple(stage for stage in support.stages if stage < count)
    return replace(support, motions=motions, factors=_factors(support.factors, count, share), stages=held)


def _factors(factors: tuple[float, ...], count: int, share: float) -> tuple[float, ...]:
    """Factors at the ends of the first stages, and where a share of the last of these has passed."""
    if not factors:
        return ()
    *before, last = factors[:count]
    begun = before[-1] if before else 0.0
    return (*before, begun + share * (last - begun))


def _rounded(problem: Problem) -> Problem:
    """What a problem does in its last stage, without the last digits: rates are those of other numbers, to round-off."""
    supports = []
    for support in problem.supports:
        *before, last = support.motions
        x, y, z, angle = (float(f"{value:.12g}") for value in (*last.translate, last.rotate))
        rounded = tuple(float(f"{value:.12g}") for value in support.factors)
        supports.append(replace(support, motions=(*before, Motion((x, y, z), angle)), factors=rounded))
    loads = tuple(replace(load, factors=tuple(float(f"{value:.12g}") for value in load.factors)) for load in problem.loads)
    return replace(problem, supports=tuple(supports), loads=loads)


def differences(stored: Problem, given: Problem) -> list[str]:
    """Where two problems differ: one sentence a field, by its dotted path. Their own names, which may be those of files, are no part.

    One sentence tells an entry that one of them has alone, and one the mesh of a body that has another.
    """
    old, new = (
        _flat(replace(problem, name="")) | _order(problem) | _order_of_loads(problem) | _meshes(problem) for problem in (stored, given)
    )
    missing = object()
    unlike = [path for path in {**old, **new} if old.get(path, missing) != new.get(path, missing)]
    alone = {_entry(path) for path in old} ^ {_entry(path) for path in new}
    told = alone | {path.replace(".mesh", ".patch") for path in unlike if path.endswith(".mesh")}
    here = {_entry(path): "file" for path in old} | {_entry(path): "scene" for path in new}
    sentences = [f"{entry}: in the {here[entry]} alone" for entry in dict.fromkeys(map(_entry, unlike)) if entry in alone]
    paths = [path for path in unlike if not any(f"{path}.".startswith(f"{entry}.") for entry in told)]
    return sentences + [f"{path}: {_shown(old, path)} in the file, {_shown(new, path)} in the scene" for path in paths]


def _entry(path: str) -> str:
    """The body, contact, ... that a path begins with."""
    return ".".join(path.split(".")[:2])


def _meshes(problem: Problem) -> dict[str, str]:
    """Elements of each body in words."""
    return {f"bodies.{body.name}.mesh": _mesh(body) for body in problem.bodies}


def _mesh(body: Body) -> str:
    directions = body.patch.directions
    return f"{' x '.join(str(d.elements) for d in directions)} elements of {' x '.join(f'{d.family}{d.order}' for d in directions)}"


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
    plain = _read_plain(group, _BODY)
    return Body(patch=patch, **plain)


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
    return np.bytes_(json.dumps(_plain(value)))


def _plain(value: Any) -> Any:
    """Dataclasses to dictionaries, arrays and tuples to lists, NumPy numbers to Python's."""
    if is_dataclass(value):
        return {f.name: _plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def _flat(value: Any, path: str = "") -> dict[str, Any]:
    """Leaves of a problem by dotted path; entries of lists go by their name where they have one. Lists of numbers are leaves."""
    plain = _plain(value) if is_dataclass(value) else value
    if isinstance(plain, dict):
        entries = plain.items()
    elif isinstance(plain, list) and any(isinstance(entry, dict) for entry in plain):
        entries = {str(entry.get("name", number)): entry for number, entry in enumerate(plain)}.items()
    else:
        return {path: plain}
    return {p: v for key, entry in entries for p, v in _flat(entry, f"{path}.{key}".lstrip(".")).items()}


def _order(problem: Problem) -> dict[str, Any]:
    """Names in the order in which numbers of the results file stand."""
    return {kind: [entry.name for entry in getattr(problem, kind)] for kind in ("bodies", "contacts", "supports", "stages")}


def _order_of_loads(problem: Problem) -> dict[str, Any]:
    return {"loads": [load.name for load in problem.loads]}


def _shown(leaves: dict[str, Any], path: str) -> str:
    if path not in leaves:
        return "nothing"
    text = leaves[path] if path.endswith(".mesh") else repr(leaves[path])
    return text if len(text) <= 60 else f"other numbers ({text[:30]}...)"
