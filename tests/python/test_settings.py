"""Settings that are made in Python."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from told.wrong.contacts import PRESS

from isomortar.errors import InputError
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene


@pytest.mark.parametrize(
    ("setting", "value"), [("newton_tolerance", -1.0), ("max_cuts", -1), ("method", "guess"), ("newton_tolerance", np.nan)]
)
def test_settings_made_in_python_are_checked_as_those_of_a_file(setting: str, value: object) -> None:
    problem = Scene.from_toml(PRESS).problem()
    wrong = replace(problem, settings=replace(problem.settings, **{setting: value}))  # type: ignore[arg-type]
    with pytest.raises(InputError, match=rf"solver\.{setting}: "):
        Simulation(wrong)
