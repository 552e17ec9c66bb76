"""Rings close, or not, whatever the unit of length and of weights."""

from __future__ import annotations

from dataclasses import replace

import pytest

from isomortar.errors import InputError
from isomortar.geometry.primitives import ring
from isomortar.model.entities import Body, Material
from isomortar.model.numbering import check_closed


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_a_ring_closes_or_not_whatever_the_unit_of_length(unit: float) -> None:
    patch = ring((0.0, 0.0, 0.0), unit, 2.0 * unit, unit)
    ends = patch.face_points("u1")

    def moved(share: float) -> Body:
        points = patch.control_points.copy()
        points[ends, 1] += share * unit
        return Body("ring", replace(patch, control_points=points), Material(), (3, 2, 2), closed="u")

    check_closed(moved(0.0))
    check_closed(moved(1e-13))
    with pytest.raises(InputError, match="differ"):
        check_closed(moved(1e-6))


@pytest.mark.parametrize("unit", [1e-12, 1.0, 1e12])
def test_or_of_weights(unit: float) -> None:
    patch = ring((0.0, 0.0, 0.0), 1.0, 2.0, 1.0)

    def heavier(share: float) -> Body:
        weights = patch.weights * unit
        weights[patch.face_points("u1")] *= 1.0 + share
        return Body("ring", replace(patch, weights=weights), Material(), (3, 2, 2), closed="u")

    check_closed(heavier(1e-13))
    with pytest.raises(InputError, match="differ"):
        check_closed(heavier(1e-6))
