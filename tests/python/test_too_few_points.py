"""Bodies that too few Gauss points miss are refused with a number of them that does: none is warned of that has as many."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from solid.too_few_points import in_turn

from isomortar.errors import InputError
from isomortar.model.checks import QUADRATURE_LOST, _check_weights
from isomortar.model.rational import QUADRATURE_TOLD, quadrature_error


@pytest.mark.parametrize("contrast", [20.0, 50.0])
def test_the_points_that_are_named_are_enough(contrast: float) -> None:
    body = in_turn(contrast)
    assert quadrature_error(body) > QUADRATURE_LOST
    with pytest.raises(InputError) as refused:
        _check_weights(body)
    found = re.search(r"quadrature = \[(\d+), (\d+), (\d+)\]", str(refused.value))
    assert found
    better = replace(body, quadrature=(int(found[1]), int(found[2]), int(found[3])))
    _check_weights(better)
    assert quadrature_error(better) <= QUADRATURE_TOLD
