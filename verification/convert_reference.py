"""Turn an explicit scene (JSON, nothing left to a builder) into a scene file with its geometry files.

    python verification/convert_reference.py iron_N2.json OUTPUT --slip-sum paper --augmentation-norm separate

The format: each body a patch with its knots, control points and weights; one contact pair; boundary conditions with
phases of their own, which become stages that all of them share.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import warnings
from collections.abc import Iterable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, Patch
from isomortar.scene.geometry_file import write_geometry
from isomortar.scene.toml_text import dump

#: Solver keys of the explicit scene and ours; `penalty_base` is a pair and handled apart.
SOLVER_KEYS = {
    "newton_tol": "newton_tolerance",
    "aug_tol": "augmentation_tolerance",
    "penalty_growth": "penalty_growth",
    "penalty_growth_max": "penalty_growth_max",
    "max_newton": "max_iterations",
    "max_aug": "max_augmentations",
}

#: What the explicit scene means where it says nothing.
SOLVER_DEFAULTS: dict[str, Any] = {"penalty_base": [100.0, 10.0], "aug_tol": 0.01, "penalty_growth": 1.0}


def convert(source: Path, folder: Path, slip_sum: str = "local", augmentation_norm: str = "separate") -> Path:
    """Write the scene file and one geometry file a body.

    Parameters
    ----------
    source : Path
        Explicit scene JSON.
    folder : Path
        Where the files go; made if needed.
    slip_sum, augmentation_norm : str
        Solver options that the explicit scene does not state.

    Returns
    -------
    Path
        The scene file.

    Raises
    ------
    InputError
        A key that has no counterpart (of the solver's: a warning): nothing is dropped silently.
    """
    data = json.loads(source.read_text(encoding="utf-8"))
    _only(data, "scene", "name", "bodies", "contact", "bcs", "solver")
    folder.mkdir(parents=True, exist_ok=True)
    bodies = _distinct(body.get("name", "body") for body in data["bodies"])
    supports = _distinct(f"{bodies[bc['body']]}-{bc['face']}" for bc in data["bcs"])
    scene: dict[str, Any] = {"format": 1, "name": _plain(data.get("name", source.stem))}
    scene["materials"] = {name: {"young": float(b["E"]), "poisson": float(b["nu"])} for name, b in zip(bodies, data["bodies"], strict=True)}
    scene["bodies"] = {name: _body(name, body, folder) for name, body in zip(bodies, data["bodies"], strict=True)}
    if data.get("contact"):
        scene["contacts"] = {"interface": _contact(data["contact"], bodies)}
    scene["supports"] = {name: _support(bc, bodies) for name, bc in zip(supports, data["bcs"], strict=True)}
    scene["stages"] = list(_stages(dict(zip(supports, (bc.get("phases") or [] for bc in data["bcs"]), strict=True))))
    scene["solver"] = {"slip_sum": slip_sum, "augmentation_norm": augmentation_norm, **_solver(data.get("solver") or {})}
    path = folder / f"{source.stem}.toml"
    path.write_text(dump(scene), encoding="utf-8")
    return path


def _body(name: str, body: dict[str, Any], folder: Path) -> dict[str, Any]:
    _only(body, f"body {name}", "name", "E", "nu", "patch", "quad", "closed")
    given = body["patch"]
    _only(given, f"patch of {name}", "kind", "degrees", "knots", "n", "control_points", "weights")
    u, v, w = (Direction(k, p, np.array(t, dtype=float)) for k, p, t in zip(given["kind"], given["degrees"], given["knots"], strict=True))
    points = np.array(given["control_points"], dtype=float).reshape(-1, 3)
    patch = Patch((u, v, w), points, np.array(given.get("weights") or np.ones(len(points)), dtype=float))
    if list(patch.shape) != list(given.get("n", patch.shape)):
        raise InputError(f"n of {name} is {given['n']}, its knots and degrees give {list(patch.shape)}")
    file = f"{name}.geometry.toml"
    write_geometry(folder / file, patch)
    table: dict[str, Any] = {"material": name, "file": file}
    if body.get("quad"):
        table["mesh"] = {"quadrature": body["quad"]}
    if body.get("closed"):
        table["closed"] = body["closed"]
    return table


def _contact(contact: dict[str, Any], bodies: list[str]) -> dict[str, Any]:
    _only(contact, "contact", "slave", "master", "plane", "mu", "quad")
    table: dict[str, Any] = {"slave": _face(contact["slave"], bodies)}
    if contact.get("master"):
        table["master"] = _face(contact["master"], bodies)
    else:
        plane = contact["plane"]
        _only(plane, "plane", "point", "normal", "t1")
        table["plane"] = {"tangent" if key == "t1" else key: vector for key, vector in plane.items()}
    table |= {"friction": float(contact.get("mu", 0.0)), "reference_area": 1.0, "subcells": 0}
    if contact.get("quad"):
        table["quadrature"] = contact["quad"]
    return table


def _support(bc: dict[str, Any], bodies: list[str]) -> dict[str, Any]:
    _only(bc, "bcs", "body", "face", "components", "centre", "axis", "phases")
    table: dict[str, Any] = {"face": _face(bc, bodies)}
    if bc.get("components") is not None:
        table["components"] = [c if isinstance(c, str) else "xyz"[c] for c in bc["components"]]
    return table | {key: bc[key] for key in ("centre", "axis") if bc.get(key) is not None}


def _stages(phases: dict[str, list[dict[str, Any]]]) -> Iterator[dict[str, Any]]:
    """Stages that end wherever a phase of any support ends; within a phase the motion is linear, so its share is exact."""
    for support, own in phases.items():
        for phase in own:
            _only(phase, f"phase of {support}", "steps", "translate", "rotate")
    ends = {support: np.cumsum([phase["steps"] for phase in own], dtype=int) for support, own in phases.items()}
    joints = sorted({0}.union(*(end.tolist() for end in ends.values())))
    if len(joints) == 1:
        joints.append(1)  # nothing ever moves: one load step
    for number, (start, stop) in enumerate(pairwise(joints), start=1):
        stage: dict[str, Any] = {"name": f"stage-{number}", "steps": stop - start, "motions": {}}
        for support, own in phases.items():
            current = int(np.searchsorted(ends[support], start, side="right"))
            if current < len(own):
                stage["motions"][support] = _share(own[current], stop - start)
        yield stage


def _share(phase: dict[str, Any], steps: int) -> dict[str, Any]:
    return {
        "translate": [float(c) * steps / phase["steps"] for c in phase.get("translate") or (0, 0, 0)],
        "rotate": float(phase.get("rotate") or 0) * steps / phase["steps"],
    }


def _solver(solver: dict[str, Any]) -> dict[str, Any]:
    unknown = sorted(set(solver) - {"penalty_base", *SOLVER_KEYS})
    if unknown:  # they steer the way to the solution, not the solution
        warnings.warn(f"solver keys without a counterpart are left out: {', '.join(unknown)}", stacklevel=2)
    solver = {**SOLVER_DEFAULTS, **solver}
    normal, tangential = solver["penalty_base"]
    table = {"penalty_normal": float(normal), "penalty_tangential": float(tangential)}
    return table | {ours: solver[theirs] for theirs, ours in SOLVER_KEYS.items() if theirs in solver}


def _face(place: dict[str, Any], bodies: list[str]) -> str:
    return f"{bodies[place['body']]}.{place['face']}"


def _plain(name: str) -> str:
    """The name in the characters that a scene file allows."""
    return re.sub(r"[^A-Za-z0-9_-]+", "-", str(name)) or "unnamed"


def _distinct(names: Iterable[str]) -> list[str]:
    plain: list[str] = []
    for name in map(_plain, names):
        plain.append(name if name not in plain else f"{name}-{len(plain) + 1}")
    return plain


def _only(table: dict[str, Any], place: str, *allowed: str) -> None:
    unknown = sorted(set(table) - set(allowed))
    if unknown:
        raise InputError(f"{place} has {', '.join(unknown)}; what can be converted: {', '.join(allowed)}")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", type=Path, help="explicit scene JSON")
    parser.add_argument("folder", type=Path, help="where the scene file and the geometry files go")
    parser.add_argument("--slip-sum", choices=["local", "paper"], default="local", help="default: %(default)s")
    parser.add_argument("--augmentation-norm", choices=["separate", "paper"], default="separate", help="default: %(default)s")
    options = parser.parse_args()
    try:
        print(convert(options.source, options.folder, options.slip_sum, options.augmentation_norm))
    except InputError as error:
        sys.exit(f"{options.source}: {error}")


if __name__ == "__main__":
    main()
