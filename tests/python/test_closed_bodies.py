"""Rings close, or not, whatever the unit of length."""

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
