"""Comparison that fails closed: what is not plainly within its bounds does not pass."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.harness.cases import Bound, Cell, Claim, Curve, Matches, Order, Shown, Words
from isomortar.harness.measurement import Measurement, Stored, real_numbers, restored
from isomortar.harness.orders import Convergence, OrderEstimate, estimate_order
from isomortar.harness.wording import reworded

#: Lines of a text that are told where more are not as they were: the first ones show what it is, and a page of them nobody reads.
TOLD = 4
#: Best first. Only ``passed`` passes.
CheckState = Literal["passed", "missing reference", "not measured", "skipped", "failed", "crashed", "timed out"]
CHECK_STATES: tuple[CheckState, ...] = ("passed", "missing reference", "not measured", "skipped", "failed", "crashed", "timed out")


@frozen
class Agreement:
    """Largest error of a comparison, as a share of its tolerance, and whether it is within."""

    agrees: bool
    why: str
    share: float = np.nan


@frozen
class Check:
    """A claim on one number: its state, the value to show (worst entry), the limit in words, what was found and why it is the limit.

    `order`: of a convergence sequence. `reference`: the class of the reference that it was compared with.
    """

    name: str
    state: CheckState
    value: float
    limit: str
    found: str
    reason: str
    order: OrderEstimate | None = None
    reference: str = ""


@frozen
class Expected:
    """A dataset of a reference: values, uncertainty (one number or the values' shape), and the reference's class.

    `text`: of words, which have no values, and whose uncertainty is relative; None: the dataset holds numbers.
    """

    values: FloatArray
    uncertainty: FloatArray
    kind: str
    text: str | None = None


#: Finds the dataset of a reference for a cell and a number; None: there is none.
Lookup = Callable[[str, Cell, str], Expected | None]


def worst(states: Iterable[CheckState]) -> CheckState:
    """The worst of some states; of none: not measured."""
    return max(states, key=CHECK_STATES.index, default="not measured")


def agree(measured: ArrayLike, expected: ArrayLike, tolerance: ArrayLike) -> Agreement:
    """Compare entry by entry, absolutely: shapes equal, not empty, finite on both sides, error <= tolerance."""
    try:
        a, b, t = real_numbers(measured), real_numbers(expected), real_numbers(tolerance)
    except (TypeError, ValueError):
        return Agreement(False, "not numbers")
    if a.shape != b.shape:
        return Agreement(False, f"shapes differ: {a.shape} and {b.shape}")
    if t.shape not in ((), b.shape):
        return Agreement(False, f"tolerance has shape {t.shape}, the values {b.shape}")
    if a.size == 0:
        return Agreement(False, "nothing to compare")
    for side, values in (("measured", a), ("expected", b), ("tolerance", t)):
        if not np.isfinite(values).all():
            return Agreement(False, f"{side}: not finite")
    if not (t >= 0).all():
        return Agreement(False, "negative tolerance")
    with np.errstate(all="ignore"):
        error = np.abs(a - b)
        share = np.where(error == 0, 0.0, error / t)
    within = bool(np.all(error <= t))
    return Agreement(within, f"largest error {error.max():.3g}, {share.max():.3g} of the tolerance", float(share.max()))


def judge(cell: Cell, measurement: Measurement, lookup: Lookup) -> list[Check]:
    """A check for every bound of a cell, and for every number that has none."""
    claims = cell.case.bounds_of(cell.settings)
    ending = measurement.ending
    if ending != "measured":
        state: CheckState = "failed" if ending == "not converged" or ending == "refused" or ending == "trouble" else ending
        line = measurement.message.strip().splitlines()[-1] if measurement.message.strip() else ending
        return [Check(name, state, np.nan, _limit(claim), line, claim.reason) for name, claim in claims.items()]
    checks = []
    for name, claim in claims.items():
        value = measurement.numbers.get(name)
        if value is None:
            checks.append(Check(name, "not measured", np.nan, _limit(claim), "the case returned no such number", claim.reason))
        else:
            checks.append(_check(cell, name, claim, value, lookup))
    for name in sorted(measurement.numbers.keys() - claims.keys()):
        checks.append(Check(name, "failed", np.nan, "none", "a number without a bound: bound it, or declare it Shown", ""))
    return checks


def _check(cell: Cell, name: str, claim: Claim, value: Stored, lookup: Lookup) -> Check:
    if isinstance(claim, Order):
        return _check_order(name, claim, value)
    if (said := restored(value, Words)) is not None:
        if isinstance(claim, Matches):
            return _check_words(name, claim, said.text, lookup(claim.reference, cell, name))
        shown = isinstance(claim, Shown)
        found = said.text if shown else "words, not numbers"
        return Check(name, "passed" if shown else "failed", np.nan, _limit(claim), found, claim.reason)
    curve = restored(value, Curve)
    if curve is None and isinstance(value, dict):
        return Check(name, "failed", np.nan, _limit(claim), "a convergence sequence: its claim must be an Order", claim.reason)
    if curve and (fault := curve_fault(curve)):
        return Check(name, "failed", np.nan, _limit(claim), fault, claim.reason)
    entries = np.asarray(value if curve is None else curve.y, float)
    if isinstance(claim, Matches):
        if curve:
            words = "a curve, whose x a reference does not hold: return its values as an array"
            return Check(name, "failed", np.nan, _limit(claim), words, claim.reason)
        return _check_match(name, claim, entries, lookup(claim.reference, cell, name))
    low, high = (claim.low, claim.high) if isinstance(claim, Bound) else (-np.inf, np.inf)
    if entries.size == 0:
        return Check(name, "failed", np.nan, _limit(claim), "an empty array", claim.reason)
    if not np.isfinite(entries).all():
        return Check(name, "failed", np.nan, _limit(claim), "not finite", claim.reason)
    extreme = float(entries.min() if high == np.inf and low > -np.inf else entries.flat[np.argmax(np.abs(entries))])
    within = bool(np.all((entries >= low) & (entries <= high)))
    found = "" if entries.ndim == 0 else f"{entries.size} values, {entries.min():.4g} to {entries.max():.4g}"
    return Check(name, "passed" if within else "failed", extreme, _limit(claim), found, claim.reason)


def curve_fault(curve: Curve) -> str:
    """What makes a curve none, or nothing. Its values are for the claim to judge."""
    x, y = np.asarray(curve.x, float), np.asarray(curve.y, float)
    if x.ndim != 1 or x.shape != y.shape:
        return f"a curve whose x and y have shapes {x.shape} and {y.shape}: they must be lists of one length"
    return "" if np.isfinite(x).all() else "a curve whose x is not finite"


def _check_order(name: str, claim: Order, value: Stored) -> Check:
    if (convergence := restored(value, Convergence)) is None:
        return Check(name, "failed", np.nan, _limit(claim), "not a Convergence", claim.reason)
    estimate = estimate_order(convergence, claim.expected)
    state: CheckState = "passed" if estimate.judgement == "confirmed" else "failed"
    return Check(name, state, estimate.order, _limit(claim), f"{estimate.judgement}: {estimate.why}", claim.reason, estimate)


def _check_match(name: str, claim: Matches, entries: FloatArray, expected: Expected | None) -> Check:
    shown = float(entries) if entries.ndim == 0 else np.nan
    if expected is None:
        return Check(name, "missing reference", shown, _limit(claim), f"{claim.reference} has no such dataset", claim.reason)
    allowance = claim.allowance * float(np.max(np.abs(expected.values), initial=0.0))
    agreement = agree(entries, expected.values, 2 * expected.uncertainty + allowance)
    note = " (shows change, not correctness)" if expected.kind == "self" else ""
    state: CheckState = "passed" if agreement.agrees else "failed"
    found = f"reference of class {expected.kind}{note}: {agreement.why}"
    return Check(name, state, shown, _limit(claim), found, claim.reason, reference=expected.kind)


def _check_words(name: str, claim: Matches, text: str, expected: Expected | None) -> Check:
    if expected is None or not text.strip():
        missing = f"{claim.reference} has no such dataset" if expected is None else "nothing is said"
        return Check(name, "missing reference" if expected is None else "failed", np.nan, _limit(claim), missing, claim.reason)
    if expected.text is None:
        return Check(name, "failed", np.nan, _limit(claim), f"words, and {claim.reference} holds numbers", claim.reason)
    changed = reworded(expected.text, text, 2 * float(expected.uncertainty) + claim.allowance)
    note = " (shows change, not correctness)" if expected.kind == "self" else ""
    count = f"{len(changed)} of {len(expected.text.splitlines())} lines are others"
    found = f"reference of class {expected.kind}{note}: {count}" + "".join(f"\n    {line}" for line in changed[:TOLD])
    return Check(name, "failed" if changed else "passed", np.nan, _limit(claim), found, claim.reason, reference=expected.kind)


def _limit(claim: Claim) -> str:
    """The limit in words."""
    match claim:
        case Bound(at_most=None):
            return f"≥ {claim.low:.4g}"
        case Bound(at_least=None):
            return f"≤ {claim.high:.4g}"
        case Bound() if claim.low == claim.high:
            return f"= {claim.low:.6g}"
        case Bound():
            return f"{claim.low:.6g} to {claim.high:.6g}"
        case Order():
            return f"order {claim.expected:g}"
        case Matches():
            return f"as {claim.reference}" + (f" ± {claim.allowance:.3g}" if claim.allowance else "")
        case Shown():
            return "shown"
