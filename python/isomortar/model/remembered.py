"""What is made of a problem again and again is made once, and forgotten with the problem."""

from __future__ import annotations

import functools
from collections.abc import Callable, Hashable
from typing import TypeVar
from weakref import WeakKeyDictionary

from isomortar.model.entities import Problem

_Part = TypeVar("_Part", bound=Hashable)
_Made = TypeVar("_Made")


def remembered(function: Callable[[Problem, _Part], _Made]) -> Callable[[Problem, _Part], _Made]:
    """Let a function of a problem and of a part of it be called once for each. Errors are raised anew."""
    known: WeakKeyDictionary[Problem, dict[_Part, _Made]] = WeakKeyDictionary()

    @functools.wraps(function)
    def called(problem: Problem, part: _Part) -> _Made:
        made = known.setdefault(problem, {})
        if part not in made:
            made[part] = function(problem, part)
        return made[part]

    return called
