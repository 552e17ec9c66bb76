"""Shares as people read them."""

from __future__ import annotations

import pytest

from isomortar.model.shares import percent


@pytest.mark.parametrize(("share", "words"), [(0.0123, "1.2 %"), (0.0996, "10 %"), (0.996, "100 %"), (1.4509, "150 %"), (31.4, "3100 %")])
def test_two_digits_and_no_power_of_ten(share: float, words: str) -> None:
    assert percent(share) == words
