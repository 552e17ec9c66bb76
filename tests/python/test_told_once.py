"""What a watch has found is told of each body, support and kind, and of each once, whatever was told before."""

from __future__ import annotations

from itertools import permutations
from typing import Any

import pytest

from isomortar.told.during.inside_out import InsideOut, Least
from isomortar.told.during.snapping import Snapping

#: What is found of two bodies or supports, and of two kinds.
OF_BODIES = [("one", False), ("one", True), ("two", False), ("two", True)]


@pytest.mark.parametrize("order", [*permutations(range(4))][::5])
def test_each_fall_of_each_body_is_told_once(order: tuple[int, ...]) -> None:
    watch = InsideOut(None)  # type: ignore[arg-type]
    for step, number in enumerate(order, 1):
        name, inside_out = OF_BODIES[number]
        watch._found[name, inside_out] = Least(0.9, (0, 0, 0)), Least(-0.1 if inside_out else 0.1, (1, 2, 3))
        (said,) = watch.after_step(step)
        assert said.startswith(f"body {name!r}, load step {step}: ")
        assert ("turned inside out" in said) == inside_out
        assert not list(watch.after_step(step + 1))


def test_each_support_that_snaps_is_told_once() -> None:
    watch: Any = Snapping(None)  # type: ignore[arg-type]
    for step, name in enumerate(("one", "two", "three"), 1):
        watch._snapped[name] = 100.0 * step
        (said,) = watch.after_step(step)
        assert said.startswith(f"support {name!r}, load step {step}: its moment lets it turn by {100 * step} degrees")
        assert not list(watch.after_step(step + 1))
