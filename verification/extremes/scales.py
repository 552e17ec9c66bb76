"""Units, distance from the origin, and the numbers of the solver: none of them may change a result."""

from __future__ import annotations

from typing import Any

import numpy as np
from extreme_scenes import Data, changed, loaded, press_of, ran
from extremes.endings import digits, endings, judge
from extremes.trials import Trial
from numpy.typing import ArrayLike

from isomortar.harness import case

#: Lengths that change with the unit, as paths of ``coarse-press``.
_LENGTHS = ("half_width", "bottom", "rise", "top")
_TIGHT = {"solver.newton_tolerance": 1e-12, "solver.complementarity_tolerance": 1e-11}


def _times(values: ArrayLike, factor: float) -> list[float]:
    """Coordinates times a factor, as a scene file takes them."""
    return (factor * np.asarray(values, float)).tolist()


def scaled_press(length: float, stress: float) -> Data:
    """``coarse-press`` in other units."""
    data = loaded("coarse-press")
    geometry = data["bodies"]["block"]["geometry"]
    geometry |= {name: length * geometry[name] for name in _LENGTHS}
    for stage in data["stages"]:
        motion = stage["motions"]["top"]
        motion["translate"] = _times(motion["translate"], length)
    return data | {"materials": {"m": {"young": 10.0 * stress, "poisson": 0.3}}}


def shifted_bowl(distance: float, size: float, friction: float = 0.3) -> Data:
    """``coarse-bowl`` of another size, moved by a distance in units of its own."""
    data = loaded("coarse-bowl")
    away = distance * np.array([1.0, 0.7, -0.3])
    bowl, box = (data["bodies"][name]["geometry"] for name in ("slave", "master"))
    bowl["centre"] = _times(bowl["centre"] + away[:2], size)
    bowl |= {"half_width": size * 0.375, "bottom": size * away[2], "rise": size * 0.06, "top": size * (0.5 + away[2])}
    box |= {name: _times(box[name] + away, size) for name in ("lower", "upper")}
    for stage in data["stages"]:
        motion = stage["motions"]["top"]
        motion["translate"] = _times(motion["translate"], size)
    data["supports"]["top"]["centre"] = _times(away, size)
    data["contacts"]["interface"]["friction"] = friction
    return data


@case(
    claim="The units of length and of force change no result.",
    tier=lambda length, stress: "gate" if (length, stress) in ((1e-75, 1.0), (1.0, 1e140)) else "nightly",
    grid={
        "length": (1e-150, 1e-75, 1e-9, 1.0, 1e9, 1e75, 1e150),
        "stress": (1e-200, 1e-140, 1.0, 1e140, 1e200),
    },
    bounds=lambda length, stress: endings(2 * abs(np.log10(length)) + abs(np.log10(stress)) <= 150.0),
)
def units(length: float, stress: float) -> dict[str, Any]:
    """Scaling law: forces of a press with friction go with stress times the square of length."""
    right = ran(scaled_press(1.0, 1.0)).force("top")
    return judge(
        ran(scaled_press(length, stress)),
        lambda done: digits(done.force("top") / stress / length / length, right),
        needed=8.0,
        causes=["[Yy]oung", "geometry", "is .* long", "its size"],
    )


@case(
    claim="Where in space a scene stands changes no result.",
    tier=lambda distance, size: "gate" if (distance, size) in ((1e2, 1e-6), (1e16, 1.0)) else "nightly",
    grid={"distance": (0.0, 1e2, 1e4, 1e5, 1e6, 1e8, 1e10, 1e12, 1e16), "size": (1e-6, 1.0)},
    bounds=lambda distance, **_: endings(distance <= 1e6),
)
def origin(distance: float, size: float) -> dict[str, Any]:
    """Symmetry: translation by a distance, in lengths of the body; its coordinates then hold that many digits less."""
    right = ran(shifted_bowl(0.0, 1.0)).force("top")
    needed = float(np.clip(12.0 - np.log10(max(distance, 1.0)), 3.0, 6.0))
    return judge(
        ran(shifted_bowl(distance, size)),
        lambda done: digits(done.force("top") / size**2, right),
        needed=needed,
        causes=["far from the origin", "from the origin and is"],
    )


@case(
    claim="The penalty, a parameter of complementarity, changes no result of the monolithic method.",
    tier=lambda penalty, friction: "gate" if (penalty, friction) in ((1e-1, 0.3), (1e11, 10.0)) else "nightly",
    grid={"penalty": (1e-1, 1e1, 1e3, 1e5, 1e8, 1e11), "friction": (0.0, 1e-6, 0.3, 10.0)},
    bounds=lambda penalty, **_: endings(10.0 <= penalty <= 1e3),
)
def penalty(penalty: float, friction: float) -> dict[str, Any]:
    """Limit: the solution with the default penalty, 100; from 1e-3 to 1e9 times that. The tangential one is a tenth of it."""
    data = changed(shifted_bowl(0.0, 1.0, friction), _TIGHT)
    right = ran(data).force("top")
    return judge(
        ran(changed(data, {"solver.penalty_normal": penalty, "solver.penalty_tangential": 0.1 * penalty})),
        lambda done: digits(done.force("top"), right),
        needed=6.0,
        causes=["penalt", "contact conditions"],
    )


@case(
    claim="Augmentations end at the same solution from any penalty, or say that they do not.",
    tier=lambda penalty: "gate" if penalty == 100.0 else "nightly",
    grid={"penalty": (1e-3, 0.1, 1.0, 10.0, 100.0, 1e3, 1e5, 1e9)},
    bounds=lambda penalty: endings(10.0 <= penalty <= 1e3),
)
def augmentation_penalty(penalty: float) -> dict[str, Any]:
    """Limit: the monolithic solution, to five times the tolerance of the augmentations, 0.01."""
    data = loaded("coarse-bowl")
    right = ran(data).force("top")
    uzawa = changed(data, {"solver.method": "uzawa", "solver.penalty_normal": penalty, "solver.penalty_tangential": 0.1 * penalty})
    return judge(ran(uzawa), lambda done: digits(done.force("top"), right), needed=1.3, causes=["penalt", "larger penalties"])


@case(
    claim="A result is as good as the tolerance that was asked for, until round-off is in the way.",
    tier=lambda tolerance: "gate" if tolerance == 1e-12 else "nightly",
    grid={"tolerance": (10.0, 1.0, 0.1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12, 1e-14, 1e-16, 1e-20)},
    bounds=lambda tolerance: endings(1e-12 <= tolerance <= 1e-4),
)
def newton_tolerance(tolerance: float) -> dict[str, Any]:
    """Finer run: the tolerance 1e-12; an error of a hundred times the tolerance is allowed, for the condition of the system."""
    data = loaded("coarse-press")
    right = ran(changed(data, _TIGHT)).force("top")
    run = ran(changed(data, {"solver.newton_tolerance": tolerance}))
    needed = float(np.clip(-np.log10(tolerance) - 2.0, 1.0, 8.0))
    return judge(run, lambda done: digits(done.force("top"), right), needed, causes=["newton_tolerance", "residual", "round-off"])


@case(
    claim="A load step that has no solution ends, however often it may be cut.",
    tier=lambda cuts: "gate" if cuts in (0, 54) else "nightly",
    grid={"cuts": (0, 8, 30, 54, 1000)},
    bounds=endings(right=False),
)
def cuts(cuts: int) -> dict[str, Any]:
    """No result is right: a box is pressed through itself."""
    data = changed(loaded("coarse-press"), {"stages.0.motions.top.translate": [0, 0, -1.0], "solver.max_cuts": cuts})
    return judge(ran(data), _none_is_right, needed=1.0, causes=["max_cuts", "folded", "pressed flat"])


def _none_is_right(_: Trial) -> float:
    return 0.0


@case(
    claim="The number of load steps changes no result without friction.",
    tier=lambda steps: "gate" if steps == 1 else "nightly",
    grid={"steps": (1, 2, 10, 100, 1000)},
    bounds=endings(right=True),
)
def load_steps(steps: int) -> dict[str, Any]:
    """Invariant: the end of the press does not depend on the path."""
    data = changed(loaded("coarse-press"), {"contacts.floor.friction": 0.0, **_TIGHT})
    data["stages"] = data["stages"][:1]
    right = press_of(ran(changed(data, {"stages.0.steps": 4})))[-1]
    run = ran(changed(data, {"stages.0.steps": steps}), seconds=300)
    return judge(run, lambda done: digits([press_of(done)[-1]], [right]), needed=8.0)
