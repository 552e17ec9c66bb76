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


def beside(low: float, high: float, slaves: int, begin: float, end: float, masters: int, cuts: int) -> Problem:
    """A slave from `low` to `high` along x on a master from `begin` to `end`, with so many elements each, and one across."""
    text = SCENE.format(shift=low).replace("upper = [0.3, 0.31, 0.4]", f"upper = [{high}, 0.31, 0.4]")
    text = text.replace("lower = [-1, -1, -0.5], upper = [1, 1, 0]", f"lower = [{begin}, -1, -0.5], upper = [{end}, 1, 0]")
    text = text.replace("elements = [2, 3, 1]", f"elements = [{slaves}, 1, 1]").replace("[10, 9, 1]", f"[{masters}, 1, 1]")
    return Scene.from_toml(text.replace("subcells = 2", f"subcells = {cuts}")).problem()


def reverse(problem: Problem, *names: str) -> Problem:
    return replace(problem, bodies=tuple(replace(b, patch=turned(b.patch)) if b.name in names else b for b in problem.bodies))


def bounds(problem: Problem) -> FloatArray:
    """Where cells begin along x."""
    return np.unique(np.round(cells(problem)[:, 0], 12))


def test_of_lines_on_both_sides_of_the_middle_the_nearer_one_is_cut() -> None:
    problem = beside(0.0, 1.0, 1, -0.35, 2.05, 8, 2)  # lines at 0.25, 0.55, 0.85
    np.testing.assert_allclose(bounds(problem), [0.0, 0.25, 0.55, 0.85], atol=1e-6)
    np.testing.assert_allclose(bounds(reverse(problem, "slave")), [0.0, 0.15, 0.45, 0.75], atol=1e-6)


def lines(problem: Problem) -> int:
    return Subcells(SlaveFace(problem.contacts[0], problem, Numbering(problem))).lines()


def test_lines_are_counted_the_same_from_either_end() -> None:
    problem = beside(-0.5, 0.5, 1, 0.0, 2.0, 1, 0)  # over the master's edge
    assert [lines(reverse(problem, *names)) for names in ((), ("master",), ("slave",), ("master", "slave"))] == [1, 1, 1, 1]


@pytest.mark.parametrize("elements", [90, 150])
def test_lines_along_the_bounds_of_elements_cross_none(elements: int) -> None:
    assert lines(beside(0.0, 1.0, elements, 0.0, 1.0, elements, 0)) == 0


@pytest.mark.parametrize("elements", [1, 4, 16])
@pytest.mark.parametrize(("share", "more"), [(4e-6, 0), (4e-5, 1), (1.0 - 4e-5, 1), (1.0 - 4e-6, 0)])
def test_lines_are_left_alone_at_the_bounds_of_an_element_by_shares_of_its_own_length(elements: int, share: float, more: int) -> None:
    line = (elements // 2 + share) / elements
    assert len(bounds(beside(0.0, 1.0, elements, line - 1.0, line + 1.0, 2, 1))) == elements + more


@pytest.mark.parametrize("elements", [1, 100])
@pytest.mark.parametrize(("other", "cut"), [(0.7, [0.3, 0.7]), (0.7005, [0.3]), (0.6995, [0.6995])])
def test_lines_are_as_near_by_shares_of_the_element_that_they_cut(elements: int, other: float, cut: list[float]) -> None:
    """Not of its length along the other coordinate, along which it may be a hundred times as long."""
    first = elements // 2
    low, high = (first + 0.3) / elements, (first + other) / elements
    found = elements * bounds(beside(0.0, 1.0, elements, 2.0 * low - high, 2.0 * high - low, 3, 1)) - first
    np.testing.assert_allclose(found[(found > 0.1) & (found < 0.9)], cut, atol=1e-6)


def test_lines_are_counted_along_the_middle_of_cells() -> None:
    """Where the master is as narrow as that they cross it as well; at the sides of the cells there is none of it."""
    wide = beside(0.0, 1.0, 1, -0.35, 2.05, 8, 0)
    narrow = replace(wide, bodies=tuple(replace(b, patch=squeezed(b.patch)) if b.name == "master" else b for b in wide.bodies))
    assert [lines(problem) for problem in (wide, narrow, reverse(narrow, "slave"), reverse(narrow, "master"))] == [3, 3, 3, 3]


def squeezed(patch: Patch) -> Patch:
    """A tenth as wide along y."""
    return replace(patch, control_points=patch.control_points * [1.0, 0.1, 1.0])


#: A block on a plate of more elements.
ON_A_PLATE = """
format = 1
bodies.a.geometry = { kind = "box", lower = [0.1, 0.1, 0], upper = [0.9, 0.9, 1] }
bodies.a.mesh = { order = SLAVE, elements = [2, 2, 1] }
bodies.base = { geometry = { kind = "box", lower = [0, 0, -1], upper = [1, 1, 0] }, mesh = { order = MASTER, elements = [5, 5, 1] } }
contacts.c = { slave = "a.w0", master = "base.w1", projection = "closest" }
supports = { base.face = "base.w0", top.face = "a.w1" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.01] }]
"""


@pytest.mark.parametrize("slave", [(1, 1), (1, 3), (3, 1)])
@pytest.mark.parametrize("master", [(1, 1), (1, 5), (5, 1), (5, 5)])
def test_points_of_cells_follow_the_order_along_each_and_the_highest_of_the_master(slave: tuple[int, int], master: tuple[int, int]) -> None:
    """Half of both orders together, that of the master if it is higher, and two more (theory 10.10); a foot runs along both."""
    text = ON_A_PLATE.replace("SLAVE", f"[{slave[0]}, {slave[1]}, 1]").replace("MASTER", f"[{master[0]}, {master[1]}, 1]")
    contact = Scene.from_toml(text).problem().contacts[0]
    assert contact.subcells > 0
    assert contact.quadrature == tuple((order + max(order, *master)) // 2 + 2 for order in slave)
