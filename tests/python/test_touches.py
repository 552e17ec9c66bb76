"""What touches, as those see it who tell of bodies that slide and tip: which motions move, open or press it, by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from isomortar.told.after import overcome, tipping
from isomortar.told.after.limit_load import Touch, groups_of, pressed_bed

WAY = np.array([1.0])


def touch(closing: Any, slipping: Any, beside: Any = (), friction: bool = True, weight: float = 1.0, near: Any = None) -> Touch:
    """Constraints of equal shares by one motion; those beside have half of a share."""
    count, others = len(closing), len(beside)
    return Touch(
        pair=SimpleNamespace(friction=SimpleNamespace(acts=friction)),  # type: ignore[arg-type]
        near=np.ones(count, dtype=bool) if near is None else np.array(near),
        weight=np.full(count, weight),
        closing=weight * np.reshape(closing, (count, 1)).astype(float),
        slipping=weight * np.stack([np.array(slipping, dtype=float), np.zeros(count)], axis=1)[:, :, None],
        beside=np.reshape(beside, (others, 1)).astype(float),
        share=np.full(count, 1.0 / (count + 0.5 * others)),
    )


@pytest.mark.parametrize("weight", [1.0, 1e-3, 50.0])
@pytest.mark.parametrize(
    ("closing", "slipping", "beside", "friction", "opens"),
    [
        ([-1.0, -1.0], [0, 0], [], True, 1.0),
        ([-1.0, 1.0], [0, 0], [], True, 0.5),
        ([1.0, 1.0], [0, 0], [], True, 0.0),
        ([-0.05, 1.0], [0, 0], [], True, 0.0),  # next to nothing beside what closes
        ([-0.05, -0.05], [1.0, 0], [], True, 0.0),  # it slides, and opens next to nothing
        ([-0.05, -0.05], [0, 0], [], True, 1.0),
        ([-0.05, -0.05], [0, 0], [], False, 0.0),  # without friction: what it does beside the motion itself
        ([-0.2, -0.2], [0, 0], [], False, 1.0),
        ([0.0, 0.0], [0, 0], [-1.0], True, 0.2),  # what is open beside it opens more, and is a fifth
        ([0.0, 0.0], [0, 0], [1.0], True, 0.0),
        ([-1.0, 0.0], [0, 0], [1.0], True, 0.6),  # with what is open, whether that opens more or not
    ],
)
def test_what_opens_is_judged_beside_how_fast_it_goes(
    closing: list[float], slipping: list[float], beside: list[float], friction: bool, opens: float, weight: float
) -> None:
    """However dense constraints are."""
    assert tipping._opened(touch(closing, slipping, beside, friction, weight), WAY) == pytest.approx(opens)


@pytest.mark.parametrize(("closing", "slipping"), [(1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.0, 0.0)])
def test_a_motion_that_only_slides_it_moves_it_as_well(closing: float, slipping: float) -> None:
    """By the same, two bodies on one that neither presses are looked at together, and those that do not touch are not."""
    one = touch([0.0, closing], [0.0, slipping])
    assert one.is_moved(np.array([True])) == bool(closing or slipping)
    assert not one.is_moved(np.array([False]))
    between = Touch(one.pair, one.near, one.weight, *(np.repeat(a, 2, axis=-1) for a in (one.closing, one.slipping, one.beside)), one.share)
    groups = list(groups_of([between], np.array([3, 7])))
    assert [list(mine) for mine, _ in groups] == ([[True, True]] if closing or slipping else [[True, False], [False, True]])
    assert [len(near) for _, near in groups] == ([1] if closing or slipping else [0, 0])


def test_the_same_by_some_motions_alone() -> None:
    random = np.random.default_rng(2)
    many = Touch(
        pair=SimpleNamespace(radius=lambda pressure: 2.0 * pressure),  # type: ignore[arg-type]
        near=np.array([False, True, False, True, True]),
        weight=np.array([1.0, 2.0, 4.0]),
        closing=random.standard_normal((3, 4)),
        slipping=random.standard_normal((3, 2, 4)),
        beside=random.standard_normal((2, 4)),
        share=np.full(3, 0.25),
    )
    some = np.array([True, False, True, False])
    few, bed = many.by(some), np.array([0.3, 0.0, -0.4, 0.0])
    for name in ("closing", "slipping", "beside"):
        np.testing.assert_array_equal(getattr(few, name), getattr(many, name)[..., some])
    np.testing.assert_allclose(few.lengths(bed[some]), many.lengths(bed), rtol=1e-14)
    np.testing.assert_allclose(many.lengths(bed), np.hypot(*(many.slipping @ bed).T), rtol=1e-14)
    pressures = [max(float(row @ bed), 0.0) / weight for row, weight in zip(many.closing, many.weight, strict=True)]
    np.testing.assert_allclose(many.limits(bed), 2.0 * np.array(pressures), rtol=1e-14)
    assert many.is_face
    assert not touch([1.0], [0.0], near=[True, False, False]).is_face


class Named(SimpleNamespace):
    """A pair of a name, which stands in a dictionary."""

    def __init__(self, name: str) -> None:
        super().__init__(pair=SimpleNamespace(contact=SimpleNamespace(name=name)))

    def __hash__(self) -> int:
        return id(self)


def going(turns: bool) -> SimpleNamespace:
    """How a body goes."""
    rates = np.array([0.0, 0.0, 2.0])
    return SimpleNamespace(turns=turns, turn=rates, shift=rates, bodies="body 'a'", through=lambda _: "0, 0, 0")


@pytest.mark.parametrize("turns", [True, False])
@pytest.mark.parametrize("faces", [(True, True), (True, False), (False, False)])
def test_of_a_turn_that_an_edge_bears_as_well_no_friction_is_told(
    monkeypatch: pytest.MonkeyPatch, faces: tuple[bool, bool], turns: bool
) -> None:
    """It would roll there."""
    touches: Any = [SimpleNamespace(is_face=face, pair=Named("c")) for face in faces]
    equilibrium: Any = SimpleNamespace(numbering=None, problem=SimpleNamespace(images=1))
    monkeypatch.setattr(overcome, "going", lambda *_: going(turns))
    assert len(list(overcome._said(equilibrium, touches, [], WAY, 1.0, "more friction"))) == (all(faces) or not turns)


@pytest.mark.parametrize("turns", [True, False])
@pytest.mark.parametrize("bears", [(True, True), (True, False), (False, False)])
def test_a_finer_slave_is_advised_where_it_bears_more_of_a_turn(
    monkeypatch: pytest.MonkeyPatch, bears: tuple[bool, bool], turns: bool
) -> None:
    """On one side is enough; and what lifts off no slave holds."""
    pairs = [Named(name) for name in "ab"]
    touches = [SimpleNamespace(pair=pair) for pair in pairs]
    found = dict(zip(map(id, touches), bears, strict=True))
    monkeypatch.setattr(tipping, "going", lambda *_: going(turns))
    monkeypatch.setattr(tipping, "_opened", lambda *_: 1.0)
    monkeypatch.setattr(tipping, "_met", lambda *_: iter(()))
    monkeypatch.setattr(tipping, "_finer_bears", lambda one, *_: found[id(one)])
    equilibrium: Any = SimpleNamespace(numbering=None, origin=np.zeros(3), pairs=pairs)
    bodies: Any = SimpleNamespace(touches=touches, motions=[], works=WAY)
    said = tipping._said(equilibrium, SimpleNamespace(contacts=[None, None], positions=None), bodies, WAY)  # type: ignore[arg-type]
    assert (tipping.FINER in said) == (turns and any(bears))
    assert "contact 'a' and 'b'" in said


@pytest.mark.parametrize("unit", [1.0, 30.0, 3e-2, 1e-2])
@pytest.mark.parametrize("aside", [0.0, 0.1, -0.15])
def test_a_bed_of_springs_bears_a_load_beside_its_middle_as_beams_do(aside: float, unit: float) -> None:
    """Pressures F / A + F e x / I within the middle third, whatever a motion's turn is measured by; a narrow face is turned as well."""
    x, weight = np.linspace(-0.5, 0.5, 9), np.array([0.5, *[1.0] * 7, 0.5])
    closing = weight[:, None] * np.column_stack([np.ones(9), unit * x])
    bed = Touch(SimpleNamespace(), np.ones(9, dtype=bool), weight, closing, np.zeros((9, 2, 2)), np.zeros((0, 2)), weight / weight.sum())  # type: ignore[arg-type]
    way = pressed_bed([bed], 7.0 * np.array([1.0, unit * aside]), np.zeros((2, 0)))
    assert way is not None
    np.testing.assert_allclose(bed.pressures(way), 7.0 * (1.0 / weight.sum() + aside * x / (weight @ x**2)), rtol=1e-8)


@pytest.mark.parametrize("goes", [0, 1])
@pytest.mark.parametrize(
    ("share", "speed", "meets"), [(0.5, 1.0, True), (2.0, 1.0, False), (0.3, 0.5, True), (0.9, 0.5, False), (0.001, 0.05, False)]
)
def test_what_a_motion_closes_is_met_on_the_way_of_the_size_of_what_goes(
    monkeypatch: pytest.MonkeyPatch, goes: int, share: float, speed: float, meets: bool
) -> None:
    """Other bodies, smaller or larger, that do not go have no part in it; nor have points without a foot, nor what touches."""
    sizes = np.array([1.0, 50.0])
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.5, 0.2]])
    pieces = [(SimpleNamespace(patch=SimpleNamespace(control_points=size * corners)),) for size in sizes]
    motions = [SimpleNamespace(piece=k, displacement=4.0 * np.outer(np.eye(2)[k], [0.0, 0.0, 1.0])) for k in range(2)]
    pair, rubs = Named("ahead"), Named("below")
    for one in (pair, rubs):
        one.pair.area = 1.0
        one.kinematics = lambda positions, _: SimpleNamespace(control=positions[goes, 2])
    gap = share * sizes[goes]
    monkeypatch.setattr(tipping, "heights", lambda _, z: np.array([-np.inf, speed * z - gap, speed * z - 1e3 * gap]))
    equilibrium = SimpleNamespace(pairs=[rubs, pair], numbering=SimpleNamespace(pieces=pieces))
    state: Any = SimpleNamespace(contacts=[None, None], positions=np.zeros((2, 3)))
    way = 0.3 * np.eye(2)[goes]
    met = tipping._met(equilibrium, state, [SimpleNamespace(pair=rubs)], motions, way)  # type: ignore[arg-type,list-item]
    assert list(met) == (["ahead"] if meets else [])
