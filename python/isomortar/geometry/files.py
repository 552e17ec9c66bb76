"""Geometry files that splinepy reads."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, Patch

if TYPE_CHECKING:
    import splinepy

#: Formats in which splinepy reads volumes (its IGES reader knows curves and surfaces only).
SUFFIXES = {".json": "splinepy", ".xml": "G+Smo", ".itd": "IRIT", ".irit": "IRIT", ".mesh": "MFEM"}


def read_spline(path: Path) -> Patch:
    """The one volume spline of a geometry file, its format known by the suffix.

    Raises
    ------
    InputError
        Unknown suffix, unreadable file, or a file without exactly one volume in space.
    """
    if path.is_dir():
        raise InputError(f"is the folder {path}; allowed: a file")
    if path.suffix not in SUFFIXES:
        raise InputError(f"suffix of {path.name} is {path.suffix!r}; splinepy reads volumes from " + ", ".join(SUFFIXES))
    if not path.is_file():
        raise InputError(f"there is no file {path}")
    import splinepy  # within: no other scene waits for all of it

    try:
        loaded = splinepy.io.load(str(path))
    except Exception as error:  # whatever its parsers meet in a damaged file
        raise InputError(f"splinepy cannot read {path.name} ({SUFFIXES[path.suffix]} format): {error}") from error
    if isinstance(loaded, tuple):  # G+Smo files come as (multipatch, options)
        loaded = loaded[0].patches
    splines = loaded if isinstance(loaded, list) else [loaded]
    volumes = [s for s in splines if (s.para_dim, s.dim) == (3, 3)]
    if len(splines) != 1 or not volumes:
        raise InputError(f"{path.name} holds {len(splines)} splines, {len(volumes)} of them volumes; allowed: one volume")
    return _patch_of(volumes[0])


def _patch_of(spline: splinepy.Spline) -> Patch:
    """The patch of a volume spline of any kind."""
    knots = spline.nurbs.knot_vectors
    u, v, w = (Direction("N", int(p), np.array(k)) for p, k in zip(spline.degrees, knots, strict=True))
    points = np.array(spline.control_points)
    return Patch((u, v, w), points, np.array(spline.weights).ravel() if spline.is_rational else np.ones(len(points)))
