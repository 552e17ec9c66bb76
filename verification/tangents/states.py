"""The tangent at states that Newton's method visits, part by part, against differences in extended precision."""

from __future__ import annotations

from small_scenes import at_few_points, bowl

from isomortar.harness import Bound, case
from isomortar.harness.tangents import BOUND, SYMMETRY_BOUND, TangentReport, check_tangent

#: Parts that vanish on a plane: its coordinates are linear in space.
CURVED = ("normal, geometric", "tangential, geometric", "tangential, metric")
FRICTIONLESS = ("solid", "normal, geometric", "normal, gap", "normal, pressure", "whole", "symmetry")
TANGENTIAL = (
    "tangential, geometric",
    "tangential, projection",
    "tangential, slip increment",
    "tangential, metric",
    "stick",
    "slip",
    "multipliers",
)
_REASON = "round-off: products of double precision against differences of a twin in extended precision"


def bounds(parts: tuple[str, ...], master: str, states: tuple[str, ...]) -> dict[str, Bound]:
    """A bound for each part that the scene has, and that all its states occur."""
    present = [part for part in parts if master == "block" or part not in CURVED]
    limits = {part: Bound(at_most=SYMMETRY_BOUND if part == "symmetry" else BOUND, reason=_REASON) for part in present}
    return limits | {state: Bound(at_least=1.0, reason="definition: a part is tested only where it acts") for state in states}


def frictional_bounds(master: str, **_: str) -> dict[str, Bound]:
    """Bounds of a scene with friction."""
    return bounds((*FRICTIONLESS, *TANGENTIAL), master, ("open", "sticking", "slipping"))


def frictionless_bounds(master: str, **_: int) -> dict[str, Bound]:
    """Bounds of a scene without friction."""
    return bounds(FRICTIONLESS, master, ("open", "closed"))


def errors(report: TangentReport) -> dict[str, float]:
    """Error of every part that the report has."""
    return {row.part: row.error for row in report.rows}


@case(
    claim="The tangent with friction is exact in every part where points are open, stick and slip.",
    tier=lambda master, slip_sum: "nightly" if (master, slip_sum) == ("plane", "local") else "gate",
    grid={"master": ("block", "plane"), "slip_sum": ("local", "paper")},
    bounds=frictional_bounds,
)
def with_friction(master: str, slip_sum: str) -> dict[str, float]:
    """Largest relative error of each part during pressing, where sticking and slipping points are mixed."""
    problem = at_few_points(bowl(master, slip_sum=slip_sum))
    points = problem.bodies[0].patch.shape[0] * problem.bodies[0].patch.shape[1]
    report = check_tangent(problem, 2, directions=1)
    counts = {"open": points - min(report.active), "sticking": max(report.stick), "slipping": max(report.slip)}
    return errors(report) | {name: float(count) for name, count in counts.items()}


@case(
    claim="The tangent without friction is exact in every part and symmetric.",
    tier="gate",
    grid={"master": ("block", "plane"), "order": (2, 3)},
    bounds=frictionless_bounds,
)
def without_friction(master: str, order: int) -> dict[str, float]:
    """Largest relative error of each part, and asymmetry."""
    problem = at_few_points(bowl(master, friction=0.0, order=order))
    points = problem.bodies[0].patch.shape[0] * problem.bodies[0].patch.shape[1]
    report = check_tangent(problem, 3, directions=1)
    return errors(report) | {"open": float(points - min(report.active)), "closed": float(max(report.active))}
