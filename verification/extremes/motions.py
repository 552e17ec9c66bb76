"""Load histories at the edges of what they can be: friction, turns in one increment, grazing contact, overlap."""

from __future__ import annotations

from typing import Any

import numpy as np
from extreme_scenes import YOUNG, Data, changed, column, column_pressure, loaded, press_of, ran
from extremes.endings import digits, endings, judge
from extremes.trials import Trial

from isomortar.harness import case

_TIGHT = {"solver.newton_tolerance": 1e-12, "solver.complementarity_tolerance": 1e-11}
_FRICTIONS = (0.0, 1e-150, 1e-12, 1e-6, 1e-3, 0.1, 0.3, 1.0, 3.0, 10.0, 1e3, 1e6, 1e12, 1e50, 1e150, 1e156, 1e300)

#: Share of the press of which two digits are round-off.
DRAG_ROUND_OFF = 1e-11


def press_with(friction: float) -> Data:
    """``coarse-press`` with another coefficient of friction."""
    return changed(loaded("coarse-press"), {"contacts.floor.friction": friction, **_TIGHT})


@case(
    claim="The coefficient of friction may be anything from zero to sticking.",
    tier=lambda friction: "gate" if friction in (0.0, 1e150) else "nightly",
    grid={"friction": _FRICTIONS},
    bounds=lambda friction: endings(friction <= 1e12),
)
def friction(friction: float) -> dict[str, Any]:
    """Scaling law below 1e-3 (drag goes with friction), the other method up to 10, above that the limit in which all sticks."""
    run = ran(press_with(friction))
    if friction <= 1e-3:
        return judge(run, lambda done: _drag_per_friction(done, friction), needed=2.0, causes=["friction"])
    if friction <= 10.0:
        augmented = {"solver.method": "uzawa", "solver.augmentation_tolerance": 1e-9}
        right = ran(changed(press_with(friction), augmented)).force("top")
    else:
        right = ran(press_with(1e4)).force("top")
    return judge(run, lambda done: digits(done.force("top"), right), needed=6.0, causes=["friction"])


def _drag_per_friction(done: Trial, friction: float) -> float:
    """Digits of the press and of the drag over friction, against those at a friction of 1e-4.

    A drag that is less than the round-off of the press has none.
    """
    right, found = ran(press_with(1e-4)).force("top"), done.force("top")
    normal = digits(found[:, 2], right[:, 2])
    drag = friction * right[:, :2] / 1e-4
    size = max(float(np.abs(drag).max()), DRAG_ROUND_OFF * float(np.abs(found).max()))
    return float(np.minimum(normal, digits(found[:, :2], drag, size=size)))


def bar(base_turns: bool, degrees: float, steps: int) -> Data:
    """A bar whose top is turned about its axis; its base is held, or turned with it."""
    turn = {"rotate": degrees}
    support = {"centre": [0.5, 0.5, 0.0]}
    return {
        "format": 1,
        "bodies": {
            "b": {
                "geometry": {"kind": "box", "lower": [0, 0, 0], "upper": [1, 1, 4]},
                "mesh": {"order": [2, 2, 2], "elements": [1, 1, 6]},
            }
        },
        "supports": {"top": {"face": "b.w1", **support}, "base": {"face": "b.w0", **support}},
        "stages": [{"name": "turn", "steps": steps, "motions": {"top": turn, "base": turn} if base_turns else {"top": turn}}],
    }


_DEGREES = (1.0, 10.0, 45.0, 90.0, 135.0, 170.0, 180.0, 190.0, 270.0, 350.0, 360.0, 370.0, 720.0)


@case(
    claim="A body may be turned by any angle in one load step.",
    tier=lambda degrees: "gate" if degrees == 90.0 else "nightly",
    grid={"degrees": _DEGREES},
    bounds=lambda degrees: endings(degrees <= 90.0),
)
def rigid_turn(degrees: float) -> dict[str, Any]:
    """Objectivity: both ends turn alike, and no force remains of what a strain of one would give."""
    run = ran(bar(True, degrees, 1))
    return judge(run, lambda done: digits(done.force("top"), np.zeros((1, 3)), size=YOUNG), needed=8.0, causes=["turn", "rotat", "degrees"])


@case(
    claim="A bar may be twisted by any angle in one load step.",
    tier=lambda degrees: "gate" if degrees == 45.0 else "nightly",
    grid={"degrees": _DEGREES},
    bounds=lambda degrees: endings(degrees <= 45.0),
)
def twist(degrees: float) -> dict[str, Any]:
    """Invariant: moment and pull do not depend on the path; the other way is at most ten degrees a load step."""
    slow = ran(bar(False, degrees, int(np.ceil(degrees / 10.0))))
    right = np.concatenate([slow.moment("top")[-1], slow.force("top")[-1]])
    return judge(
        ran(bar(False, degrees, 1)),
        lambda done: digits(np.concatenate([done.moment("top")[-1], done.force("top")[-1]]), right),
        needed=6.0,
        causes=["turn", "rotat", "degrees"],
    )


@case(
    claim="Contact may begin with any approach, however small.",
    tier=lambda approach: "gate" if approach == 1e-9 else "nightly",
    grid={"approach": (0.0, 1e-300, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-6, 1e-3, 0.1)},
    bounds=lambda approach: endings(approach == 0.0 or approach >= 1e-12),
)
def grazing(approach: float) -> dict[str, Any]:
    """Closed form: a column shortened by this share; its coordinates hold the approach to 1e-16, which may cost a hundred times that."""
    run = ran(column(press=approach))
    force = column_pressure(1.0 - approach) if approach > 1e-4 else YOUNG * approach
    size = force if approach > 1e-14 else 1e-14 * YOUNG
    needed = float(np.clip(14.0 + np.log10(max(approach, 1e-16)), 1.0, 3.0))
    causes = ["round-off", "graz", "close"]
    return judge(run, lambda done: digits(press_of(done)[-1:], [force], size=size), needed, causes)


@case(
    claim="Bodies may overlap at the start as far as one of them can be pressed together, or the program says that they do.",
    tier=lambda overlap: "gate" if overlap == 0.1 else "nightly",
    grid={"overlap": (1e-12, 1e-6, 1e-3, 0.1, 0.2, 0.3, 0.5, 0.6, 0.8, 0.9, 0.99, 1.0, 1.5, 10.0)},
    bounds=endings(right=False),
)
def overlap(overlap: float) -> dict[str, Any]:
    """Closed form: a column on a plane that stands inside of it from the start."""
    data = changed(column(press=0.0), {"contacts.f.plane.point": [0, 0, overlap]})
    right = column_pressure(1.0 - overlap) if overlap < 1.0 else np.nan
    needed = float(np.clip(13.0 + np.log10(overlap), 1.0, 6.0))
    causes = ["overlap", "penetrat", "fold", "J = "]
    return judge(ran(data), lambda done: digits(press_of(done)[-1:], [right]), needed, causes)
