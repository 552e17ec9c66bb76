"""Meshes at the edges of what they can be: orders, aspect ratios, knot spans, weights."""

from __future__ import annotations

from typing import Any

import numpy as np
from extreme_scenes import Data, changed, column, column_pressure, press_of, ran, worst
from extremes.endings import digits, endings, judge
from extremes.trials import Trial

from isomortar.harness import case

_TIGHT = {"solver.newton_tolerance": 1e-12, "solver.complementarity_tolerance": 1e-11}
#: Pressures of the column after each of its two load steps.
_PRESSURES = np.array([column_pressure(stretch) for stretch in (0.9, 0.8)])


def uniform(done: Trial) -> float:
    """Digits of a column's force, and of the pressure at every quadrature point."""
    pressure = done.held["curves/contacts/f/pressure_field"]
    return worst(uniform_force(done), digits(pressure, np.stack([_PRESSURES, _PRESSURES], axis=1)))


def uniform_force(done: Trial) -> float:
    """Digits of a column's force."""
    return digits(press_of(done), _PRESSURES)


def lost_in_span(span: float) -> float:
    """Digits of six that pressures at a knot span are allowed to lose, four at most."""
    return float(np.clip(-2.0 * np.log10(span) - 9.0, 0.0, 4.0))


def patched(knots: list[float], order: int, weights: Any = None) -> Data:
    """The column as an explicit patch with the same knots along every direction; `weights`: of the control points, first axis fastest."""
    data = column()
    points = np.array([np.mean(knots[i + 1 : i + 1 + order]) for i in range(len(knots) - order - 1)])
    grid = np.stack(np.meshgrid(points, points, points, indexing="ij"), axis=-1).reshape((-1, 3), order="F")
    patch: Data = {"order": [order] * 3, "knots": [list(knots)] * 3, "control_points": grid.tolist()}
    if weights is not None:
        patch["weights"] = np.asarray(weights, float).tolist()
    data["bodies"]["b"] = {"patch": patch}
    return changed(data, _TIGHT)


@case(
    claim="Thin and tall bodies of every order carry a uniform pressure.",
    tier=lambda order, aspect: "gate" if (order, aspect) in ((2, 1e6), (2, 1e-8)) else "nightly",
    grid={"order": (1, 2, 4, 7), "aspect": (1e-8, 1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6)},
    bounds=lambda order, aspect: endings(order <= 4 and 1e-4 <= aspect <= 1e4),
)
def aspect_ratio(order: int, aspect: float) -> dict[str, Any]:
    """Closed form: a column of `aspect` times its width in height; force, and pressure at every point.

    Its coordinates are known to 1e-16 of the longer side. That shears the shorter one by `aspect` times as much, over an area that is
    `aspect` times as large: the square of it is lost.
    """
    needed = float(np.clip(15.0 - 2.0 * abs(np.log10(aspect)), 3.0, 6.0))
    elements = 2 if order < 5 else 1
    data = changed(column((1.0, 1.0, aspect)), {"bodies.b.mesh": {"order": [order] * 3, "elements": [elements] * 3}, **_TIGHT})
    return judge(ran(data), uniform, needed, causes=["thin", "round-off"])


@case(
    claim="Orders go to ten.",
    tier="nightly",
    grid={"order": (1, 2, 3, 4, 5, 6, 7, 8, 9, 10)},
    bounds=endings(right=True),
)
def order(order: int) -> dict[str, Any]:
    """Closed form: a column of one element; force, and pressure at every point."""
    data = changed(column(), {"bodies.b.mesh": {"order": [order] * 3, "elements": [1, 1, 1]}, **_TIGHT})
    return judge(ran(data, seconds=60), uniform, needed=6.0)


@case(
    claim="A thin cantilever bends as a beam, or the program says that it can not tell.",
    tier=lambda order, thickness: "gate" if (order, thickness) == (3, 1e-3) else "nightly",
    grid={"order": (3, 4), "thickness": (1e-2, 1e-3, 7e-4, 5e-4, 4e-4, 3e-4, 2.5e-4, 2e-4, 1e-4, 1e-5, 1e-6, 1e-8)},
    bounds=lambda thickness, **_: endings(thickness >= 1e-3),
)
def bending(order: int, thickness: float) -> dict[str, Any]:
    """Limit: Euler's beam, 3 E I w / L^3, deflected by a twentieth of its thickness, w; shear changes the force by the thickness' square.

    Poisson's ratio is zero; the deflection of a cubic beam is a cubic, which these orders hold. The support keeps the height of the whole
    tip, where the section is turned: points at its top and bottom would come down by the square of the turn. What that costs is of the
    order of w over the thickness, squared, times some; at w of the thickness itself it is a fifth.
    """
    deflection = 0.05 * thickness
    data: Data = {
        "format": 1,
        "materials": {"m": {"young": 10.0, "poisson": 0.0}},
        "bodies": {
            "b": {
                "geometry": {"kind": "box", "lower": [0, 0, 0], "upper": [1, 1, thickness]},
                "mesh": {"order": [order, 1, order], "elements": [4, 1, 1]},
            }
        },
        "supports": {"root": {"face": "b.u0"}, "tip": {"face": "b.u1", "components": ["z"]}},
        "stages": [{"name": "bend", "steps": 1, "motions": {"tip": {"translate": [0, 0, deflection]}}}],
    }
    right = 3.0 * 10.0 * thickness**3 / 12.0 * deflection
    return judge(ran(data), lambda done: digits([done.force("tip")[-1, 2]], [right]), needed=2.0, causes=["lost in round-off", "thin"])


@case(
    claim="Knot spans may differ by many decades in one body.",
    tier=lambda span: "gate" if span in (1e-5, 1e-8, 1e-14) else "nightly",
    grid={"span": (0.25, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 1e-12, 1e-14)},
    bounds=lambda span: endings(span >= 1e-6),
)
def knot_spans(span: float) -> dict[str, Any]:
    """Closed form: the column, of order 2, with a first knot span of this length along every direction.

    Coordinates are known to 1e-16, which strains the shortest elements by as much over the span, beside areas of the span: of the pressure
    there the square of it is lost. Two digits of it have to be there.
    """
    return judge(
        ran(patched([0, 0, 0, span, 0.5, 1, 1, 1], 2)),
        lambda done: worst(uniform_force(done), lost_in_span(span) + uniform(done)),
        needed=6.0,
        causes=["lost in round-off", "shortest knot spans"],
    )


@case(
    claim="Weights may differ, or the program says that its quadrature does not do for them.",
    tier=lambda contrast: "gate" if contrast in (5.0, 100.0) else "nightly",
    grid={"contrast": (1.0, 2.0, 5.0, 10.0, 30.0, 100.0, 1e3, 1e4, 1e6, 1e8, 1e12)},
    bounds=lambda contrast: endings(contrast <= 5.0),
)
def weights(contrast: float) -> dict[str, Any]:
    """Closed form: the column, of order 2, with a seeded mixture of weights between 1 and the contrast.

    Of the force a hundredth may be off, of the pressure at single points a tenth. Control points stand where those of a polynomial
    column do: the parametrisation is rational, the body is the same.
    """
    knots = [0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0]
    share = np.random.default_rng(13).random(64)
    share[:2] = 0.0, 1.0
    return judge(
        ran(patched(knots, 2, contrast**share)),
        lambda done: worst(uniform_force(done), 1.0 + uniform(done)),
        needed=2.0,
        causes=["(its|their) weights"],
    )


@case(
    claim="A factor of all weights changes no result.",
    tier=lambda factor: "gate" if factor == 1e-300 else "nightly",
    grid={"factor": (1e-300, 1e-100, 1e-9, 1.0, 1e9, 1e100, 1e300)},
    bounds=endings(right=True),
)
def common_weight(factor: float) -> dict[str, Any]:
    """Symmetry: functions do not change; closed form of the column."""
    run = ran(patched([0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0], 2, np.full(64, factor)))
    return judge(run, uniform, needed=8.0)


@case(
    claim="A factor of all knots changes no result.",
    tier=lambda factor: "gate" if factor == 1e300 else "nightly",
    grid={"factor": (1e-300, 1e-150, 1e-75, 1e-9, 1.0, 1e9, 1e75, 1e150, 1e300)},
    bounds=endings(right=True),
)
def common_knots(factor: float) -> dict[str, Any]:
    """Symmetry: functions do not change; closed form of the column."""
    data = patched([0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0], 2)
    data["bodies"]["b"]["patch"]["knots"] = [[factor * knot for knot in (0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0)]] * 3
    return judge(ran(data), uniform, needed=8.0)
