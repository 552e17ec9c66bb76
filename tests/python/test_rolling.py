"""Who is looked at where a round body may roll: the supports of all that is glued to it, round or not, and of nothing else."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from isomortar.model.entities import Face
from isomortar.told.before import turns

CLOSED = {"tyre": "u", "rim": "u", "hub": "", "road": "", "stone": None}
PIECES = (("tyre", "rim", "hub"), ("road", "stone"))


@pytest.mark.parametrize("body", CLOSED)
def test_supports_of_a_wheel_are_those_of_its_hub_as_well(monkeypatch: pytest.MonkeyPatch, body: str) -> None:
    pieces = [[SimpleNamespace(name=name, closed=CLOSED[name]) for name in names] for names in PIECES]
    (piece,) = [piece for piece in pieces if any(part.name == body for part in piece)]
    monkeypatch.setattr(turns, "piece_of", lambda *_: piece)
    supports = [SimpleNamespace(place=SimpleNamespace(body=name), moves=name == "hub", is_plate=name == "stone") for name in CLOSED]
    problem: Any = SimpleNamespace(supports=supports)
    found = [support.place.body for support in turns._round(problem, Face(body, "w0"))]
    assert found == (["tyre", "rim", "hub"] if body in PIECES[0] else [])
    assert turns._moves(problem, Face(body, "w0"))  # by the hub in one, by what is free to turn in the other


def test_a_plane_and_what_is_held_move_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    piece = [SimpleNamespace(name="road", closed="")]
    monkeypatch.setattr(turns, "piece_of", lambda *_: piece)
    supports = [SimpleNamespace(place=SimpleNamespace(body=name), moves=name == "hub", is_plate=False) for name in ("road", "hub")]
    problem: Any = SimpleNamespace(supports=supports)
    assert not turns._moves(problem, Face("road", "w0"))
    assert not turns._moves(problem, SimpleNamespace())
