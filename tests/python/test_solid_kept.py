"""What a solid keeps of the last positions: the same answers as of one that keeps nothing, in whatever order it is asked."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from isomortar.model.numbering import Numbering
from isomortar.model.solid import Solid
from isomortar.scene import Scene

SCENE = """
format = 1
bodies.soft.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
bodies.hard.geometry = { kind = "box", lower = [2, 0, 0], upper = [3, 1, 2] }
supports = { one.face = "soft.w0", two.face = "hard.w0" }
stages = [{ name = "rest", steps = 1 }]
"""
PROBLEM = Scene.from_toml(SCENE).problem()
NUMBERING = Numbering(PROBLEM)
PLACES = [NUMBERING.reference + 0.05 * np.random.default_rng(seed).uniform(-1, 1, NUMBERING.reference.shape) for seed in range(3)]
ASKED = ("forces", "forces_and_tangent", "smallest_jacobians")


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(ASKED), st.integers(0, 2)), min_size=2, max_size=6))
def test_whatever_is_asked_before_changes_no_answer(asked: list[tuple[str, int]]) -> None:
    kept = solid()
    for name, place in asked:
        found, expected = (np.concatenate([np.ravel(a) for a in getattr(of, name)(PLACES[place])]) for of in (kept, solid()))
        assert np.array_equal(found, expected), (name, place)


def solid() -> Solid:
    """One that has seen the reference configuration alone."""
    return Solid(PROBLEM, NUMBERING)
