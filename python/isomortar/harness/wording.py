"""Texts beside each other, line by line: words as they are, and numbers as numbers."""

from __future__ import annotations

import re
from collections.abc import Iterator
from difflib import SequenceMatcher

#: A number as it is printed, which no letter or digit stands before: what has one is part of a word, as the 1 of v1 and of w1.
_NUMBER = re.compile(r"(?<![\w.])[-+]?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?(?![\w])")
#: What is round-off of numbers that are about one, where a line holds no other: sums of a thousand of them are known to about 1e-12.
_NOTHING = 1e-9


def reworded(old: str, new: str, allowance: float) -> list[str]:
    """What of a text is not as it was, a sentence a line that changed, was added, or is gone.

    Whole numbers are to be the same; others may be apart by `allowance` of the largest number of their line in the old text.
    """
    before, after = old.splitlines(), new.splitlines()
    one, other = ([_words(line) for line in lines] for lines in (before, after))
    blocks = [("equal", 0, len(one), 0, len(one))] if one == other else SequenceMatcher(None, one, other, False).get_opcodes()
    told = []
    for what, a, b, c, d in blocks:
        if what in ("equal", "replace"):
            pairs = list(zip(before[a:b], after[c:d], strict=False))
            told += [_beside(*pair) for pair in pairs if what == "replace" or not _same(*pair, allowance)]
            a, c = a + len(pairs), c + len(pairs)
        told += [f"gone: {line}" for line in before[a:b]]
        told += [f"new: {line}" for line in after[c:d]]
    return told


def _words(line: str) -> str:
    """A line without the values of its numbers."""
    return _NUMBER.sub("0", line)


def _same(old: str, new: str, allowance: float) -> bool:
    """Whether numbers of two lines of the same words are the same."""
    one, other = _NUMBER.findall(old), _NUMBER.findall(new)
    apart = allowance * max((abs(float(number)) for number in one), default=0.0) + _NOTHING
    return all(float(a) == float(b) or (not _whole(a, b) and abs(float(a) - float(b)) <= apart) for a, b in zip(one, other, strict=True))


def _whole(*numbers: str) -> bool:
    """Whether numbers are printed as whole ones, all of them."""
    return all(number.lstrip("+-").isdigit() for number in numbers)


def _beside(old: str, new: str) -> str:
    """Two lines: where they begin alike, and what then was, and is."""
    begin = next((place for place in _places(old, new)), min(len(old), len(new)))
    at = max(old.rfind(" ", 0, begin), old.rfind(":", 0, begin), begin - 40, 0)
    return f"{old[: min(at, 120)].strip()} ... was {old[at : at + 120].strip()!r}, is {new[at : at + 120].strip()!r}"


def _places(old: str, new: str) -> Iterator[int]:
    """Where two texts differ."""
    return (place for place, (one, other) in enumerate(zip(old, new, strict=False)) if one != other)
