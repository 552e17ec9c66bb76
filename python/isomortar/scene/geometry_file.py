"""Geometry files of isomortar: the keys of a scene's ``patch`` table in a TOML file of their own."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from isomortar.errors import InputError
from isomortar.geometry.files import read_spline
from isomortar.geometry.patch import Patch
from isomortar.model.messages import input_error
from isomortar.scene.schema import PatchTable
from isomortar.scene.source import parse
from isomortar.scene.text import read_text


def read_geometry(path: Path) -> Patch:
    """The patch of a geometry file: ``.toml`` is ours, other suffixes are read by splinepy.

    Raises
    ------
    InputError
        No such file, a format that is not read, or wrong content.
    """
    if path.suffix != ".toml":
        return read_spline(path)
    if not path.is_file():
        raise InputError(f"there is no file {path}")
    data = parse(read_text(path), path.name)
    try:
        return PatchTable.model_validate(data).patch()
    except ValidationError as error:
        raise InputError(f"in {path.name}, {input_error(error, data)}") from error
    except InputError as error:
        raise InputError(f"in {path.name}, {error}") from error


def patch_table(patch: Patch) -> dict[str, Any]:
    """The patch as the content of a ``patch`` table; `PatchTable` of it gives the same patch, bit by bit."""
    return {
        "family": [d.family for d in patch.directions],
        "order": [d.order for d in patch.directions],
        "knots": [d.knots.tolist() for d in patch.directions],
        "control_points": patch.control_points.tolist(),
        "weights": patch.weights.tolist(),
    }


def write_geometry(path: Path, patch: Patch) -> None:
    """Write a geometry file, a line for each knot vector and control point."""
    table = patch_table(patch)
    lines = [f"{key} = {json.dumps(table[key])}" for key in ("family", "order")]
    for key in ("knots", "control_points"):
        lines += [f"{key} = [", *(f"  {json.dumps(entry)}," for entry in table[key]), "]"]
    lines.append(f"weights = {json.dumps(table['weights'])}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
