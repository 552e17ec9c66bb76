"""B-splines and NURBS of any number of directions, by splinepy: evaluated, with more knots.

Of splinepy the compiled module does all of that. It is loaded alone: the package brings SciPy's solvers and what fits, reads and draws
splines, for which a small scene waited longer than for anything else.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.machinery import PathFinder
from importlib.util import find_spec, module_from_spec
from types import ModuleType
from typing import Any

import numpy as np

from isomortar.geometry.patch import Direction, FloatArray


def _compiled() -> ModuleType:
    """The module under its own name, so that the package finds it there when files are read: it must not be loaded twice."""
    name = "splinepy.splinepy_core"
    if name not in sys.modules:
        package = find_spec("splinepy")
        spec = PathFinder.find_spec(name, package.submodule_search_locations) if package else None
        if spec is None or spec.loader is None:
            raise ModuleNotFoundError("No module named 'splinepy'", name="splinepy")
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
        sys.modules[name] = module
    return sys.modules[name]


_core = _compiled()


class Spline:
    """A spline.

    Parameters
    ----------
    directions : sequence of Direction
        NURBS, the first fastest among the control points.
    control_points : ndarray, shape (n, m)
    weights : ndarray, shape (n,), optional
        None: a plain B-spline.
    """

    def __init__(self, directions: Sequence[Direction], control_points: FloatArray, weights: FloatArray | None = None) -> None:
        properties: dict[str, Any] = {
            "degrees": np.array([d.order for d in directions], dtype=np.int32),
            "knot_vectors": [np.ascontiguousarray(d.knots, dtype=np.float64) for d in directions],
            "control_points": np.ascontiguousarray(control_points, dtype=np.float64),
        }
        if weights is not None:
            properties["weights"] = np.ascontiguousarray(weights, dtype=np.float64).reshape(-1, 1)
        self._spline = _core.PySpline(**properties)

    def evaluate(self, parameters: FloatArray) -> FloatArray:
        """Points at parameters of shape (k, directions), shape (k, m)."""
        return np.asarray(self._spline.evaluate(np.ascontiguousarray(parameters, dtype=np.float64), 1))

    def insert(self, axis: int, knots: FloatArray) -> None:
        """Add knots to a direction."""
        _core.insert_knots(self._spline, axis, np.ascontiguousarray(knots, dtype=np.float64))

    @property
    def knots(self) -> list[FloatArray]:
        """Knots by direction."""
        return [np.array(knots) for knots in self._spline.current_core_properties()["knot_vectors"]]

    @property
    def control_points(self) -> FloatArray:
        """Control points, shape (n, m)."""
        return np.array(self._spline.current_core_properties()["control_points"])

    @property
    def weights(self) -> FloatArray:
        """Weights, shape (n,); those of a plain B-spline are exactly 1."""
        found = self._spline.current_core_properties()
        return np.array(found["weights"]).ravel() if "weights" in found else np.ones(len(found["control_points"]))
