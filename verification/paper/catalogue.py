"""The sections by name."""

from __future__ import annotations

from collections.abc import Sequence

from paper.plans import FULL
from paper.quick import QUICK
from paper.sections import Section

from isomortar.errors import InputError


def chosen(names: Sequence[str], quick: bool) -> tuple[Section, ...]:
    """The sections of these names, all if there are none, in full or as their quick variants.

    Raises
    ------
    InputError
        There is no such section.
    """
    known = {section.scene: section for section in (QUICK if quick else FULL)}
    for name in names:
        if name not in known:
            raise InputError(f"is {name!r}; allowed: {', '.join(known)}", "study")
    return tuple(section for name, section in known.items() if name in names or not names)
