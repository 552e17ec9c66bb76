"""Kinks of a master's face: lines where its tangent plane jumps, not those where arcs meet smoothly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from isomortar.geometry.patch import Direction, Family, Patch
from isomortar.geometry.primitives import ring
from isomortar.geometry.refinement import mesh
from isomortar.model.entities import Body, Face, Material
from isomortar.model.kinks import has_kinks
from isomortar.model.sheet import Sheet
from isomortar.scene import Scene

LINE = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
FACES_OF_RIDGE = ("w0", "w1", "v0", "v1", "u0", "u1")


def body(patch: Patch, closed: str | None = None) -> Body:
    """A body of a patch, whatever the rest."""
    return Body("b", patch, Material(), (3, 3, 3), closed)  # type: ignore[arg-type]


def roof(slope: float, order: int = 2, family: Family = "N") -> Patch:
    """A plate of two halves along u, that rise and fall; at the ridge there is a C0 line."""
    u = Direction("N", 1, np.array([0.0, 0.0, 0.3, 1.0, 1.0]))
    x, y, z = (a.ravel(order="F") for a in np.meshgrid([0.0, 0.3, 1.0], [0.0, 1.0], [0.0, 0.5], indexing="ij"))
    points = np.column_stack([x, y, z + slope * np.where(x > 0.0, np.where(x < 1.0, 0.3, 0.0), 0.0)])
    return mesh(Patch((u, LINE, LINE), points, np.ones(12)), (family, "N", "N"), (order, order, 1), (2, 2, 1))


def tyre(order: int = 2, elements: int = 8) -> Patch:
    """A ring: full circles of four arcs."""
    return mesh(ring((0.0, 0.0, 0.0), 0.5, 1.0, 0.5), ("N", "N", "N"), (order, max(order, 2), order), (elements, 1, 2))


def dented(patch: Patch, row: int) -> Patch:
    """A control point of every circle a little out of its place."""
    points = patch.control_points.reshape(*patch.shape[::-1], 3).copy()
    points[:, :, row, :] *= [1.02, 1.0, 1.02]
    if row == 0:
        points[:, :, -1, :] = points[:, :, 0, :]
    return replace(patch, control_points=points.reshape(-1, 3))


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("slope", [0.2, -0.2, 0.002])
def test_a_line_where_two_slopes_meet_is_a_kink(slope: float, order: int) -> None:
    ridge = body(roof(slope, order))
    assert [has_kinks(Sheet.of_face(ridge, face)) for face in FACES_OF_RIDGE] == [True, True, False, False, False, False]


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("slope", [0.0, 1e-5])
def test_a_line_of_a_flat_face_is_none(slope: float, order: int) -> None:
    assert not any(has_kinks(Sheet.of_face(body(roof(slope, order)), face)) for face in FACES_OF_RIDGE)


@pytest.mark.parametrize(("family", "order"), [("N", 1), ("L", 1), ("L", 2), ("L", 3)])
def test_elements_of_order_one_and_lagranges_have_kinks_once_they_deform(family: Family, order: int) -> None:
    flat = body(roof(0.0, order, family))
    assert [has_kinks(Sheet.of_face(flat, face)) for face in FACES_OF_RIDGE] == [True] * 4 + [order == 1] * 2


@pytest.mark.parametrize(("below", "kinks"), [(1, True), (2, False)])
def test_a_row_of_a_higher_order_has_the_kinks_of_those_below(below: int, kinks: bool) -> None:
    text = f"""
        format = 1
        [bodies.upper]
        geometry = {{ kind = "bowl", centre = [0.5, 0.5], half_width = 0.3, bottom = 0.0, rise = 0.1, top = 0.5 }}
        mesh = {{ order = [2, 2, 1], elements = [2, 2, 1] }}
        [bodies.lower]
        geometry = {{ kind = "box", lower = [0, 0, -0.5], upper = [1, 1, 0] }}
        mesh = {{ order = [{below}, {below}, 1], elements = [3, 3, 1], contact_order = {below + 1} }}
        [contacts.between]
        slave = "upper.w0"
        master = "lower.w1"
        [supports]
        top.face = "upper.w1"
        floor.face = "lower.w0"
        [[stages]]
        name = "press"
        steps = 1
        motions.top.translate = [0, 0, -0.01]
    """
    problem = Scene.from_toml(text).problem()
    assert has_kinks(Sheet.of(problem, Face("lower", "w1"))) == kinks
    assert problem.contacts[0].projection == ("averaged" if kinks else "closest")


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("closed", ["u", None])
def test_arcs_that_meet_smoothly_have_none(order: int, closed: str | None) -> None:
    assert not any(has_kinks(Sheet.of_face(body(tyre(order), closed), face)) for face in ("v0", "v1", "w0", "w1"))


@pytest.mark.parametrize("row", [1, 3, 4])
def test_arcs_that_do_not_are_told_apart(row: int) -> None:
    patch = dented(tyre(2, 4), row)
    assert has_kinks(Sheet.of_face(body(patch), "v1"))
    assert not has_kinks(Sheet.of_face(body(patch), "u0"))


def test_the_seam_of_a_closed_body_is_a_line_too() -> None:
    patch = mesh(ring((0.0, 0.0, 0.0), 0.5, 1.0, 0.5), ("N", "N", "N"), (2, 1, 1), (4, 1, 1))
    teardrop = dented(patch, 0)
    assert has_kinks(Sheet.of_face(body(teardrop, "u"), "v1"))
    assert not has_kinks(Sheet.of_face(body(teardrop, None), "v1"))
