"""Poles, edges of a face that are one point: found at any edge, and refused by what has no meaning there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from told.wrong.contacts import PAIR

from isomortar.errors import InputError
from isomortar.geometry.patch import FACES
from isomortar.model.contact_checks import check_contacts, has_pole
from isomortar.model.entities import Problem
from isomortar.model.sheet import Sheet
from isomortar.scene import Scene

#: Edges of a face's net of control points.
EDGES = (np.s_[0, :], np.s_[-1, :], np.s_[:, 0], np.s_[:, -1])


def drawn_together(problem: Problem, body: str, face: str, edge: tuple[int | slice, ...], left: float = 0.0) -> Problem:
    """A problem with an edge of a face drawn together, to so much of its length."""
    patch = problem.body(body).patch
    first, second = patch.face_directions(face)
    numbers = patch.face_points(face).reshape(second.count, first.count)[edge]
    points = patch.control_points.copy()
    points[numbers] = points[numbers].mean(axis=0) + left * (points[numbers] - points[numbers].mean(axis=0))
    changed = replace(problem.body(body), patch=replace(patch, control_points=points))
    return replace(problem, bodies=tuple(changed if b.name == body else b for b in problem.bodies))


@pytest.mark.parametrize("face", FACES)
@pytest.mark.parametrize("edge", EDGES)
def test_a_pole_is_found_at_any_edge(edge: tuple[int | slice, ...], face: str) -> None:
    problem = Scene.from_toml(PAIR).problem()
    for left, there in ((0.0, True), (1e-12, True), (1e-6, False), (1.0, False)):
        changed = drawn_together(problem, "upper", face, edge, left)
        assert has_pole(Sheet.of_face(changed.body("upper"), face)) == there


@pytest.mark.parametrize("edge", EDGES)
@pytest.mark.parametrize(
    ("body", "face", "change", "words"),
    [
        ("lower", "w1", {"projection": "averaged"}, r"projection: is \"averaged\", but the master lower\.w1 has a pole"),
        ("upper", "w0", {"enforcement": "greville"}, r"enforcement: is \"greville\", but the slave upper\.w0 has a pole"),
        ("upper", "w0", {"enforcement": "demko"}, r"enforcement: is \"demko\", but the slave upper\.w0 has a pole"),
        ("upper", "w0", {"enforcement": "knots"}, r"enforcement: is \"knots\", but the slave upper\.w0 has a pole"),
    ],
)
def test_what_has_no_meaning_at_a_pole_is_refused(
    body: str, face: str, change: dict[str, str], words: str, edge: tuple[int | slice, ...]
) -> None:
    problem = Scene.from_toml(PAIR).problem()
    asked = replace(problem, contacts=(replace(problem.contacts[0], **change),))  # type: ignore[arg-type]
    check_contacts(asked)
    with pytest.raises(InputError, match=words):
        check_contacts(drawn_together(asked, body, face, edge))
