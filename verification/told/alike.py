"""What is said of a scene before a run, and of the same scene elsewhere, turned and in other units: the same sentences."""

from __future__ import annotations

import re
import tomllib
from collections import Counter

import numpy as np
from told.mistakes import MISTAKES
from transforms import moved, relabelled, scaled, turned

from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.model.entities import Problem
from isomortar.scene import Scene

#: x to y, y to z, z to x.
TURN = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
#: In metres over seconds squared, which other units do not have: what is said of it is for the number itself.
GRAVITY = "9.81"
PARTS = 3


def elsewhere(problem: Problem) -> Problem:
    """The scene turned, moved by some of its sizes, in other units; without rings bodies in reverse order, with others of u, v, w."""
    size = float(np.max([body.size for body in problem.bodies]))
    closed = any(body.closed for body in problem.bodies)
    renamed = problem if closed else relabelled(problem)
    return scaled(moved(turned(renamed, TURN), size * np.array([0.5, -1.0, 2.0])), 4.0, 32.0)


def words(sentence: str) -> tuple[str, ...]:
    """The words of a sentence, without numbers, axes and faces; of several bodies any may come first."""
    return tuple(sorted(re.findall(r"[a-z]{3,}", sentence)))


@case(
    claim="What is doubtful of a scene does not depend on where it stands, how it is turned, what its units are, and which body is first.",
    tier="gate",
    grid={"part": tuple(range(PARTS))},
    bounds={"others": Bound(0.0, 0.0, "definition: sentences on one of two scenes that are the same, and not on the other")},
    files=[MISTAKES],
)
def alike(part: int) -> dict[str, float]:
    """How many, over a part of each third mistake that a first look warns of."""
    found = [mistake for mistake in tomllib.loads(MISTAKES.read_text(encoding="utf-8")).values() if mistake["said"] == "check"]
    others = 0
    for mistake in [mistake for mistake in found if GRAVITY not in str(mistake["set"])][3 * part :: 3 * PARTS]:
        problem = Scene.load(mistake["scene"], mistake["set"]).problem()
        said, there = (Counter(words(sentence) for sentence in outlook(of).warnings) for of in (problem, elsewhere(problem)))
        others += sum(((said - there) + (there - said)).values())
    return {"others": float(others)}
