"""Contacts that cannot be meant are refused before any work; unusual ones that can be are let through."""

from __future__ import annotations

import contextlib

import numpy as np
import pytest
from told.wrong.choices import NEEDED, PROJECTIONS
from told.wrong.contacts import BLOCK, LAGRANGE, PAIR, PRESS, RINGS, UNUSUAL, WRONG

from isomortar.errors import InputError, LostProjectionError
from isomortar.model.enforcement.subcells import Subcells
from isomortar.scene import Scene
from isomortar.scene.source import bundled_scenes


@pytest.mark.parametrize("case", WRONG)
def test_what_cannot_be_meant_is_refused(case: str) -> None:
    scene, old, new, field, words = WRONG[case]
    assert old in scene
    with pytest.raises(InputError) as refused:
        Scene.from_toml(scene.replace(old, new)).problem()
    assert (refused.value.field or "").startswith(field)
    assert words in str(refused.value)


@pytest.mark.parametrize("case", UNUSUAL)
def test_what_can_be_meant_is_let_through(case: str) -> None:
    scene, old, new = UNUSUAL[case]
    assert old in scene
    Scene.from_toml(scene.replace(old, new)).problem()


@pytest.mark.parametrize("name", bundled_scenes())
def test_bundled_scenes_are_let_through(name: str) -> None:
    Scene.load(name).problem()


@pytest.mark.parametrize(("change", "projection", "by_default"), PROJECTIONS)
def test_masters_with_lines_inside_have_averaged_normals(change: tuple[str, ...], projection: str, by_default: bool) -> None:
    (contact,) = Scene.from_toml(PAIR, overrides=change).problem().contacts
    assert (contact.projection, contact.by_default) == (projection, by_default)


@pytest.mark.parametrize(
    ("text", "overrides", "sentence"),
    [
        (PAIR, ["contacts.pair.enforcement=kts"], "with 144 conditions for the 16 control points"),
        (LAGRANGE, ["contacts.pair.enforcement=demko"], "Lagrange elements, which have no such abscissae"),
    ],
)
def test_points_that_cannot_bear_are_refused(text, overrides, sentence):
    with pytest.raises(InputError, match=sentence) as refused:
        Scene.from_toml(text, overrides=overrides).problem()
    assert refused.value.field == "contacts.pair.enforcement"


@pytest.mark.parametrize(
    ("overrides", "field", "sentence"),
    [
        (["contacts.pair.quadrature=[3,2]"], "contacts.pair.quadrature", r"at least \[3, 3\]"),
        (["solver.slip_sum=paper"], "contacts.pair.enforcement", "functions that are nowhere negative"),
    ],
)
def test_dual_functions_that_there_are_not_are_refused(overrides, field, sentence):
    with pytest.raises(InputError, match=sentence) as refused:
        Scene.from_toml(PAIR, overrides=["contacts.pair.enforcement=dual", *overrides]).problem()
    assert refused.value.field == field


def test_dual_functions_take_cells_and_the_slip_sum_of_no_slip():
    Scene.from_toml(PAIR, overrides=["contacts.pair.enforcement=dual", "contacts.pair.quadrature=3", "contacts.pair.subcells=1"]).problem()
    Scene.from_toml(PAIR, overrides=["contacts.pair.enforcement=dual", "solver.slip_sum=paper", "contacts.pair.friction=0"]).problem()


def test_quadrature_points_are_enforced_by_augmentations_or_where_they_are_few():
    Scene.from_toml(PAIR, overrides=["contacts.pair.enforcement=kts", "solver.method=uzawa"]).problem()
    Scene.from_toml(PAIR, overrides=["contacts.pair.enforcement=kts", "contacts.pair.quadrature=2"]).problem()


@pytest.mark.parametrize(("overrides", "subcells", "points"), NEEDED)
def test_who_says_nothing_of_quadrature_gets_what_the_masters_lines_need(overrides, subcells, points):
    (contact,) = Scene.from_toml(PAIR, overrides=overrides).problem().contacts
    assert (contact.subcells, contact.quadrature) == (subcells, points)


def test_elements_stay_whole_where_a_place_has_no_foot(monkeypatch):
    def lost(_: Subcells) -> int:
        raise LostProjectionError("degenerate", 0)

    monkeypatch.setattr(Subcells, "lines", lost)
    (contact,) = Scene.from_toml(PAIR, overrides=["bodies.lower.mesh.elements=[5,5,1]"]).problem().contacts
    assert (contact.subcells, contact.quadrature) == (0, (6, 6))


def test_rings_and_planes_whose_lines_cross_nothing_have_whole_elements():
    for text in (PRESS, RINGS):
        (contact,) = Scene.from_toml(text).problem().contacts
        assert (contact.subcells, contact.quadrature[0]) == (0, 6)


@pytest.mark.parametrize(
    ("text", "overrides", "sentence"),
    [
        (PRESS, ["contacts.floor.subcells=1"], "a rigid plane, which has no knot lines"),
        (PAIR, ["contacts.pair.subcells=1", "contacts.pair.enforcement=greville"], "whose constraints are at points"),
        (PAIR, ["contacts.pair.subcells=9"], "less than or equal to 5"),
        (PAIR, ["contacts.pair.subcells=-1"], "greater than or equal to 0"),
    ],
)
def test_cells_that_cannot_be_are_refused(text, overrides, sentence):
    with pytest.raises(InputError, match=sentence) as refused:
        Scene.from_toml(text, overrides=overrides).problem()
    assert refused.value.field.endswith(".subcells")


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize(("end", "refused"), [((1, 4e-16), True), ((4e-16, 4e-16), True), ((1, 1e-5), False), ((1e-7, 1e-7), False)])
def test_faces_that_are_a_line_or_a_point_but_for_round_off_are_refused(end: tuple[float, float], refused: bool, size: float) -> None:
    """In any unit of length; those that are only narrow, or small beside their body, are let through."""
    points = np.array([[u, v, w] for w in (0.0, 1.0) for v in (0.0, 1.0) for u in (0.0, 1.0)])
    tip = points[:, 1] == 0.0
    points[tip] = [0.1, 0.0, 0.4] + points[tip] * [end[0], 0.0, end[1]]
    control_points = (size * points).tolist()
    body = f"\n[bodies.upper.patch]\norder = [1, 1, 1]\nknots = {[[0, 0, 1, 1]] * 3}\ncontrol_points = {control_points}\n"
    text = PAIR.replace(BLOCK, body).replace('"upper.w0"', '"upper.v0"').replace('"upper.w1"', '"upper.v1"')
    text = text.replace(
        "lower = [-1, -1, -1], upper = [1, 1, 0]", f"lower = {[-9 * size] * 3}, upper = {[9 * size, -0.2 * size, 9 * size]}"
    )
    text = text.replace('"lower.w1"', '"lower.v1"').replace("[0, 0, -0.1]", f"[0, {-0.1 * size}, 0]")
    with pytest.raises(InputError, match="fall onto a line or a point") if refused else contextlib.nullcontext():
        Scene.from_toml(text).problem()
