"""Cells of slave elements: the same whichever way the coordinates of slave and master run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from isomortar.geometry.patch import FloatArray, Patch
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.enforcement.subcells import Subcells
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering
from isomortar.scene import Scene

SCENE = """
format = 1
bodies.slave.geometry = {{ kind = "box", lower = [{shift}, -0.3, 0], upper = [0.3, 0.31, 0.4] }}
bodies.slave.mesh = {{ order = [2, 2, 1], elements = [2, 3, 1] }}
bodies.master.geometry = {{ kind = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0] }}
bodies.master.mesh = {{ order = [2, 2, 1], elements = [10, 9, 1] }}
contacts.c = {{ slave = "slave.w0", master = "master.w1", subcells = 2 }}
supports.top.face = "slave.w1"
supports.base.face = "master.w0"
stages = [{{ name = "down", steps = 1, motions.top.translate = [0, 0, -0.01] }}]
"""


def turned(patch: Patch) -> Patch:
    """The patch with u and v running the other way."""
    u, v, w = patch.directions
    grid = patch.control_points.reshape(*patch.shape, 3, order="F")[::-1, ::-1]
    weights = patch.weights.reshape(patch.shape, order="F")[::-1, ::-1]
    return Patch((u.reversed(), v.reversed(), w), grid.reshape(-1, 3, order="F"), weights.ravel(order="F"))


def cells(problem: Problem) -> FloatArray:
    """Bounds of the cells, sorted, shape (cells, 4)."""
    made = Subcells(SlaveFace(problem.contacts[0], problem, Numbering(problem)))
    found = np.column_stack([made.low, made.high])
    return found[np.lexsort(np.round(found, 9).T)]


@pytest.mark.parametrize("shift", [-0.3, -0.31, -0.4, -0.1])
def test_cells_do_not_depend_on_the_way_in_which_coordinates_run(shift: float) -> None:
    problem = Scene.from_toml(SCENE.format(shift=shift)).problem()
    own = cells(problem)
    assert len(own) > 6
    master = replace(problem, bodies=tuple(replace(b, patch=turned(b.patch)) if b.name == "master" else b for b in problem.bodies))
    np.testing.assert_allclose(cells(master), own, rtol=0, atol=1e-13)
    both = replace(problem, bodies=tuple(replace(b, patch=turned(b.patch)) for b in problem.bodies))
    other = 1.0 - cells(both)[:, [2, 3, 0, 1]]
    np.testing.assert_allclose(other[np.lexsort(np.round(other, 9).T)], own, rtol=0, atol=1e-13)
