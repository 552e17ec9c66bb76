"""Shares as people read them."""

from __future__ import annotations

import pytest

from isomortar.harness import report
from isomortar.model.shares import percent


@pytest.mark.parametrize(("share", "words"), [(0.0123, "1.2 %"), (0.0996, "10 %"), (0.996, "100 %"), (1.4509, "150 %"), (31.4, "3100 %")])
def test_two_digits_and_no_power_of_ten(share: float, words: str) -> None:
    assert percent(share) == words


@pytest.mark.parametrize(
    ("error", "words"), [(0.0, "0 %"), (8.4e-7, "8.4e-05 %"), (0.01234, "1.23 %"), (31.4159, "3140 %"), (float("nan"), "-")]
)
def test_errors_on_pages_are_per_cent_however_small_or_large(error: float, words: str) -> None:
    assert report.percent(error) == words
