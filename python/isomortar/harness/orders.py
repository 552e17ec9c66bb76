"""Observed orders of accuracy: estimate, confidence interval and a verdict that does not flatter."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray

OrderJudgement = Literal["confirmed", "pre-asymptotic", "at the floor", "diverging", "invalid"]

#: Meshes that the regression takes, the finest ones, and fewest meshes that make an order.
WINDOW = 4
#: Two meshes whose sizes differ by less tell noise, not order.
SMALLEST_RATIO = 1.2
#: Other sources of error must stay below this share of the error that is measured.
BUDGET = 0.1
#: No interval is taken to be narrower: sizes of curved meshes mean no more.
RESOLUTION = 0.05
#: A wider interval holds two whole numbers and confirms neither.
WIDEST = 0.5


@frozen
class Convergence:
    """Errors on a sequence of meshes, coarsest first; what a case returns when its claim is an order.

    Parameters
    ----------
    sizes : array_like, shape (n,)
        Element sizes h, strictly decreasing, at least four.
    errors : array_like, shape (n,)
        Errors, positive, in any norm.
    others : dict
        Error budget, not empty: for each other source (``"quadrature"``, ``"augmentation"``, ``"load step"``, ``"penalty"``,
        ``"reference"``, ...) its share of the error on each mesh, shape (n,), or one number for all: the change of the
        result when that source alone is tightened, not zero on all of them.
    """

    sizes: ArrayLike
    errors: ArrayLike
    others: dict[str, ArrayLike]


@frozen
class OrderEstimate:
    """Order of accuracy: estimate, 95 % interval, order between neighbouring meshes, verdict and its reason."""

    order: float
    low: float
    high: float
    steps: tuple[float, ...]
    judgement: OrderJudgement
    why: str


def estimate_order(convergence: Convergence, expected: float) -> OrderEstimate:
    """Order of accuracy by regression of log(error) on log(size) over the four finest meshes.

    The interval is Student's, 95 %, from the scatter about the line: a sequence that still bends has a wide one. ``confirmed`` needs the
    expected order inside an interval that does not reach the next whole number, and as near to it the order of the two finest meshes:
    orders of 2.9, 2.6, 2.3 make a line of 2.6 ± 0.4, and are on their way to no order 3.

    Parameters
    ----------
    convergence : Convergence
    expected : float
        From theory.
    """
    fault = _fault(convergence, expected)
    if fault:
        return OrderEstimate(np.nan, np.nan, np.nan, (), "invalid", fault)
    sizes, errors = np.asarray(convergence.sizes, float), np.asarray(convergence.errors, float)
    steps = np.diff(np.log(errors)) / np.diff(np.log(sizes))
    order, half = regression(np.log(sizes[-WINDOW:]), np.log(errors[-WINDOW:]))
    half = max(half, RESOLUTION)
    judgement, why = _judge(order, half, expected, steps[-WINDOW + 1 :], _over_budget(convergence, errors))
    return OrderEstimate(order, order - half, order + half, tuple(float(s) for s in steps), judgement, why)


def regression(x: FloatArray, y: FloatArray) -> tuple[float, float]:
    """Slope of the line through points by least squares, and half of its 95 % interval, Student's."""
    x, y = x - x.mean(), y - y.mean()
    slope, free = float(x @ y / (x @ x)), len(x) - 2
    left = y - slope * x
    return slope, float(stdtrit(free, 0.975) * np.sqrt(left @ left / free / (x @ x)))


def _fault(convergence: Convergence, expected: float) -> str:
    """What makes the sequence no measurement, or nothing."""
    try:
        sizes, errors = np.asarray(convergence.sizes, float), np.asarray(convergence.errors, float)
        others = {name: np.asarray(values, float) for name, values in convergence.others.items()}
    except (TypeError, ValueError):
        return "sizes, errors and other errors must be numbers"
    if not others:
        return "no other source of error was measured (quadrature, load step, penalty, ...)"
    if sizes.ndim != 1 or sizes.shape != errors.shape:
        return f"sizes and errors must be lists of one length; shapes are {sizes.shape} and {errors.shape}"
    if len(sizes) < WINDOW:
        return f"{len(sizes)} meshes; an order needs at least {WINDOW}"
    if not (np.isfinite(sizes).all() and np.isfinite(errors).all()):
        return "a size or an error is not finite"
    if not (sizes > 0).all() or not (sizes[:-1] >= SMALLEST_RATIO * sizes[1:]).all():
        return f"sizes must be positive and fall by a factor of at least {SMALLEST_RATIO} from mesh to mesh"
    if not (errors > 0).all():
        return "an error is zero or negative: not a measured error"
    for name, values in others.items():
        if values.shape not in ((), errors.shape) or not (np.isfinite(values) & (values >= 0)).all():
            return f"the {name} error must be one number, or one a mesh, finite and not negative"
        if not (values > 0).any():
            return f"the {name} error is zero: a result that does not change at all was not measured with less of it"
    if not (np.isfinite(expected) and expected > 0):
        return f"the expected order is {expected}; it must be positive"
    return ""


def _over_budget(convergence: Convergence, errors: FloatArray) -> str:
    """The other source of error that takes too large a share on the meshes of the regression, or nothing."""
    for name, values in convergence.others.items():
        share = float(np.max((np.asarray(values, float) / errors)[-WINDOW:]))
        if not share < BUDGET:
            return f"{name} makes {share:.0%} of the error"
    return ""


def _judge(order: float, half: float, expected: float, steps: FloatArray, over_budget: str) -> tuple[OrderJudgement, str]:
    found = f"order {order:.2f} ± {half:.2f}, expected {expected:g}"
    if order < RESOLUTION:
        return "diverging", f"{found}: the error does not fall"
    if over_budget:
        return "at the floor", f"{found}: {over_budget}"
    if steps[-1] < expected / 2 and steps.max() > 0.75 * expected:
        return "at the floor", f"{found}: the error had fallen with order {steps.max():.2f} and falls with {steps[-1]:.2f} at last"
    if steps[-1] < RESOLUTION:
        return "diverging", f"{found}: the error does not fall on the finest mesh"
    if half > WIDEST:
        return "pre-asymptotic", f"{found}: the interval holds more than one whole number"
    if not order - half <= expected <= order + half:
        return "pre-asymptotic", f"{found}: outside the interval"
    if not abs(steps[-1] - expected) < WIDEST:
        return "pre-asymptotic", f"{found}: the error falls with order {steps[-1]:.2f} at last"
    return "confirmed", found
