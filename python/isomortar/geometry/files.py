"""Geometry files that splinepy reads."""

from __future__ import annotations

from pathlib import Path

import splinepy

from isomortar.errors import InputError
from isomortar.geometry.patch import Patch
from isomortar.geometry.refinement import from_splinepy

#: Formats in which splinepy reads volumes (its IGES reader knows curves and surfaces only).
SUFFIXES = {".json": "splinepy", ".xml": "G+Smo", ".itd": "IRIT", ".irit": "IRIT", ".mesh": "MFEM"}


def read_spline(path: Path) -> Patch:
    """The one volume spline of a geometry file, its format known by the suffix.

    Raises
    ------
    InputError
        Unknown suffix, unreadable file, or a file without exactly one volume in space.
    """
    if path.suffix not in SUFFIXES:
        raise InputError(f"suffix of {path.name} is {path.suffix!r}; splinepy reads volumes from " + ", ".join(SUFFIXES))
    if not path.is_file():
        raise InputError(f"there is no file {path}")
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
    return from_splinepy(volumes[0])
