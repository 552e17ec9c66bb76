"""Verification: cases, comparison, orders of accuracy, references, runner and report.

What a case needs is here: ``from isomortar.harness import Bound, Order, case``.
"""

from isomortar.harness.cases import LAGRANGE, NURBS, Bound, Curve, Matches, Order, Shown, Words, case, skip
from isomortar.harness.orders import Convergence

__all__ = ["LAGRANGE", "NURBS", "Bound", "Convergence", "Curve", "Matches", "Order", "Shown", "Words", "case", "skip"]
