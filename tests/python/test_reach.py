"""What control points a pair's constraints reach: patterns that stand while they do, and elements that meet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from isomortar.geometry.patch import Direction
from isomortar.model.pattern import _meeting
from test_apart import Placed


def test_within_an_increment_patterns_keep_what_was_reached() -> None:
    placed = Placed()
    pair, reach = placed.pair, placed.pair.reach
    nothing = placed.equilibrium.initial_state().contacts[0]
    places = [pair.kinematics(placed.at(move, 0, -0.01), nothing).projections for move in (-0.6, 0.6)]
    state = np.ones(pair.pair.slave.test.count, dtype=np.int32)
    reach.begin()
    first = reach.update(places[0], state)
    second = reach.update(places[1], state)
    assert second is not first
    assert reach.update(places[0], state) is second
    assert reach.update(places[1], state) is second
    assert len(second.rows.column) > len(first.rows.column)
    reach.begin()
    again = reach.update(places[1], state)
    assert len(again.rows.column) == len(first.rows.column)  # the same by symmetry: what an earlier increment needed is forgotten


def test_a_contact_that_opens_and_closes_keeps_its_patterns() -> None:
    placed = Placed()
    pair, reach = placed.pair, placed.pair.reach
    projections = pair.kinematics(placed.at(0, 0, -0.01), placed.equilibrium.initial_state().contacts[0]).projections
    some = np.arange(pair.pair.slave.test.count, dtype=np.int32) % 2
    reach.begin()
    reach.update(projections, some)
    both = reach.update(projections, 1 - some)
    assert reach.update(projections, some) is both
    assert reach.update(replace(projections, found=np.zeros_like(projections.found)), some) is both


@pytest.mark.parametrize("family", ["N", "L"])
@pytest.mark.parametrize("order", [1, 2, 3, 4])
@pytest.mark.parametrize("closed", [False, True])
def test_elements_that_meet_at_a_node(family: str, order: int, closed: bool) -> None:
    knots = np.array([0.0, 0.3, 0.5, 1.2, 1.3, 2.0, 2.4])
    elements = len(knots) - 1
    if family == "N":
        knots = np.concatenate([np.full(order, knots[0]), knots, np.full(order, knots[-1])])
    direction = Direction(family, order, knots)
    lines = direction.boundaries
    expected = np.zeros((elements, elements), dtype=int)
    for e in range(elements):
        for j in range(e * (order if family == "L" else 1), e * (order if family == "L" else 1) + order + 1):
            if family == "L":
                place = lines[e] + (j - order * e) / order * (lines[e + 1] - lines[e])
            else:
                place = float(np.mean(knots[j + 1 : j + order + 1]))
            there = {f for f in range(elements) if lines[f] - 1e-9 <= place <= lines[f + 1] + 1e-9}
            if closed and j in (0, direction.count - 1):
                there |= {0, elements - 1}
            expected[e, sorted(there)] = 1
    assert np.array_equal(_meeting(direction, closed).toarray(), expected)
