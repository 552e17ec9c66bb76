"""How far multipliers are from others: against the formula, with what friction may bear drawn from none to more than presses."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from isomortar.model.constants import LEAST_TRACTION
from isomortar.solve.distances import apart

COUNT = 4
#: A metric of lengths one: norms of tractions are those of their components.
CONTROL = SimpleNamespace(metric=np.tile([1.0, 0.0, 1.0], (COUNT, 1)), square=np.ones(COUNT))


@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.3, 1.0, 3.0]), st.sampled_from([0.0, 1e-9, 1.0]), st.sampled_from([0.0, 1e-7, 1e3]))
def test_tractions_are_measured_by_no_less_than_a_hundredth_of_what_friction_bears_or_of_pressures(
    seed: int, friction: float, size: float, noise: float
) -> None:
    random = np.random.default_rng(seed)
    q, p = random.uniform(0.5, 1.0, (2, COUNT))
    t, s = size * random.standard_normal((2, COUNT, 2))
    pair = SimpleNamespace(radius=lambda pressure: friction * pressure)
    normal, tangential = apart(pair, CONTROL, (p, t), (q, s), (0.0, noise))  # type: ignore[arg-type]
    assert normal == pytest.approx(np.linalg.norm(p - q) / np.linalg.norm(q), rel=1e-12)
    change = max(np.linalg.norm(t - s) ** 2 - noise**2, 0.0)
    least = max(LEAST_TRACTION * min(friction, 1.0) * np.linalg.norm(q), noise, np.linalg.norm(s))
    assert tangential == pytest.approx(np.sqrt(change) / least if change else 0.0, rel=1e-10)


def test_round_off_of_pressures_is_none_of_their_change() -> None:
    one, other = np.full(COUNT, 2.0), np.array([2.0, 2.0, 2.0, 2.5])
    pair, still = SimpleNamespace(radius=lambda pressure: 0.3 * pressure), np.zeros((COUNT, 2))
    for noise, share in ((0.0, 0.125), (0.3, 0.1), (0.5, 0.0), (0.6, 0.0)):
        assert apart(pair, CONTROL, (other, still), (one, still), (noise, 0.0)) == pytest.approx((share, 0.0))  # type: ignore[arg-type]
