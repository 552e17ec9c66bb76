"""Feet that a contact cannot have are refused by every routine that takes them, before the kernel reads elements that are not there."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from fuzz.calls import sound

from isomortar.errors import InputError

#: Routines that are given feet, by the name of that argument.
ROUTINES = {"project_points": "near", "control_quantities": "projections", "contact_forces": "projections", "contact_blocks": "projections"}


@pytest.mark.parametrize("wrong", ["below", "along u", "along v", "fewer", "none"])
@pytest.mark.parametrize("name", ROUTINES)
def test_feet_beyond_the_master_or_of_another_slave_are_refused(name: str, wrong: str) -> None:
    routine, given = sound("closest")[name]
    feet, count = sound("closest")["contact_forces"][1]["projections"], given["master"].elements
    element = feet.element.copy()
    element[len(element) // 2] = {"below": (0, -1), "along u": (count[0], 0), "along v": (0, count[1])}.get(wrong, (0, 0))
    other: Any = replace(feet, element=element)
    if wrong == "fewer":
        other = type(feet)(*(getattr(feet, field.name)[:-1] for field in fields(feet)))
    assert np.all(feet.element >= 0)
    with pytest.raises(InputError) as refused:
        routine(**{**given, ROUTINES[name]: "x" if wrong == "none" else other})
    assert str(refused.value.field).startswith("projections")
