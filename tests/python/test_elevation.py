"""Orders are raised with the knots that they should have, at any scale of coordinates and of parameters."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from isomortar.geometry.patch import Direction, Patch
from isomortar.geometry.refinement import mesh
from isomortar.geometry.splines import Spline

LINE = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))


@st.composite
def curved(draw):
    """A patch that is curved along u, with knots of any multiplicity, and the scales of its coordinates and parameters."""
    order = draw(st.integers(1, 4))
    inner = draw(st.lists(st.tuples(st.floats(0.01, 0.99), st.integers(1, order)), max_size=5, unique_by=lambda knot: round(knot[0], 3)))
    span, size = draw(st.sampled_from([1e-3, 1.0, 50.0, 1e6])), draw(st.sampled_from([1e-6, 1.0, 40.0, 1e5]))
    knots = np.sort(np.concatenate([np.zeros(order + 1), *([x] * m for x, m in inner), np.ones(order + 1)])) * span
    u = Direction("N", order, knots)
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    x, y, z = rng.uniform(-0.2, 0.2, (3, 2, 2, u.count))
    points = np.stack([x + u.greville / span, y + np.array([0.0, 1.0])[:, None], z + np.array([0.0, 1.0])[:, None, None]], axis=-1)
    weights = rng.uniform(0.5, 2.0, points.shape[:-1]) if draw(st.booleans()) else np.ones(points.shape[:-1])
    return Patch((u, LINE, LINE), size * points.reshape(-1, 3), weights.ravel()), draw(st.integers(0, 6 - order)), draw(st.integers(1, 3))


@given(curved())
@settings(max_examples=150, deadline=None)
def test_refinement_keeps_shape_and_smoothness(drawn):
    patch, more, parts = drawn
    u = patch.directions[0]
    raised = mesh(patch, ("N", "N", "N"), (u.order + more, 1, 1), (parts * u.elements, 1, 1))
    distinct, counts = np.unique(u.knots, return_counts=True)
    cuts = np.setdiff1d(u.subdivided(parts), distinct)
    assert np.array_equal(raised.directions[0].knots, np.sort(np.concatenate([np.repeat(distinct, counts + more), cuts])))
    at = np.random.default_rng(0).uniform(0.0, 1.0, (40, 3)) * [u.knots[-1], 1.0, 1.0]
    before, after = (Spline(p.directions, p.control_points, p.weights).evaluate(at) for p in (patch, raised))
    assert np.abs(after - before).max() <= 1e-13 * np.abs(patch.control_points).max()


@pytest.mark.parametrize("scale", [1.0, 40.0])
def test_a_smooth_knot_stays_one_at_any_scale(scale):
    """A library removed knots by an absolute tolerance: in millimetres elements were joined less smoothly than in metres."""
    u = Direction("N", 2, scale * np.array([0, 0, 0, 0.25, 0.75, 1, 1, 1]))
    x, y, z = np.meshgrid(u.greville, [0.0, scale], [0.0, scale], indexing="ij")
    patch = Patch((u, LINE, LINE), np.stack([x, y + 0.1 * np.sin(x / scale), z], axis=-1).reshape(-1, 3, order="F"), np.ones(x.size))
    raised = mesh(patch, ("N", "N", "N"), (3, 1, 1), (3, 1, 1)).directions[0]
    assert raised.knots.tolist() == [scale * k for k in (0, 0, 0, 0, 0.25, 0.25, 0.75, 0.75, 1, 1, 1, 1)]
