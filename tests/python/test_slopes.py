"""The order of errors that scatter about a line, with its interval."""

from __future__ import annotations

import numpy as np
import pytest
from slopes import fall

COUNTS = np.array([4.0, 6.0, 8.0, 12.0])


def test_order_without_scatter() -> None:
    assert fall(COUNTS, 3.0 / COUNTS**2) == pytest.approx({"order": 2.0, "low": 2.0, "high": 2.0}, abs=1e-7)


def test_interval_is_students() -> None:
    # Residuals of (1, -1, -1, 1) / 10 about a line through four equidistant places: deviation 0.1 sqrt(2), spread of places sqrt(5) d.
    places = np.exp(np.arange(4.0))
    found = fall(places, np.exp(-np.arange(4.0) + 0.1 * np.array([1.0, -1.0, -1.0, 1.0])))
    assert found["order"] == pytest.approx(1.0)
    assert found["high"] - found["order"] == pytest.approx(4.302653 * 0.1 * np.sqrt(2.0) / np.sqrt(5.0), rel=1e-6)
    assert found["order"] - found["low"] == pytest.approx(found["high"] - found["order"])


def test_scatter_that_hides_the_fall_is_seen() -> None:
    assert fall(COUNTS, [1.0, 2.0, 0.3, 0.5])["low"] < 0.0 < fall(COUNTS, [1.0, 0.5, 0.3, 0.14])["low"]


def test_what_is_not_finite_stays_so() -> None:
    assert np.isnan(fall(COUNTS, [1.0, np.nan, 0.3, 0.1])["low"])
