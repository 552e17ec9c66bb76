"""Points whose area is not positive: the one that is named is the worst, by a quadrature of its own with SciPy's splines."""

from __future__ import annotations

import re

import numpy as np
from scipy.interpolate import BSpline

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Contact, Face, Material, Problem, RigidPlane
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: Inner knots of a direction that are graded enough for any order, and of the other one, which is not.
GRADED, OTHER = [0.01, 0.04], [0.45]
SIZE = np.array([2.0, 3.0])


def means(direction: Direction) -> FloatArray:
    """Means of the knots of each function: the points."""
    return np.asarray(np.convolve(direction.knots[1:-1], np.full(direction.order, 1.0 / direction.order), "valid"))


def areas(direction: Direction) -> FloatArray:
    """Weights of the points with which the direction's functions are integrated exactly."""
    functions = BSpline(direction.knots, np.eye(direction.count), direction.order)
    return np.asarray(np.linalg.solve(functions(means(direction)).T, functions.integrate(0.0, 1.0)))


@case(
    claim="Where constraints at points have areas that are not positive the worst of them is named, with its area.",
    tier="gate",
    grid={"order": (2, 3, 4), "graded": ("u", "v")},
    bounds={
        "place": Bound(at_most=5e-5, reason="definition: four digits of coordinates below one tenth"),
        "other": Bound(at_most=5e-4, reason="definition: four digits of coordinates below one"),
        "area": Bound(at_most=5e-3, reason="definition: three digits"),
    },
)
def of_no_area(order: int, graded: str) -> dict[str, float]:
    """What is told from what there is: the graded coordinate, the other one, and the area as a share of itself."""
    inner = (GRADED, OTHER) if graded == "u" else (OTHER, GRADED)
    one, two = (Direction("N", order, np.array([0.0] * (order + 1) + knots + [1.0] * (order + 1))) for knots in inner)
    line = Direction("N", 1, np.repeat([0.0, 1.0], 2))
    x, y, z = (a.ravel(order="F") for a in np.meshgrid(SIZE[0] * means(one), SIZE[1] * means(two), [0.0, 1.0], indexing="ij"))
    body = Body("block", Patch((one, two, line), np.column_stack([x, y, z]), np.ones(x.shape)), Material(), (order + 1, order + 1, 2))
    contact = Contact("pair", Face("block", "w0"), RigidPlane((0, 0, 0), (0, 0, 1), (1, 0, 0)), 0.0, (4, 4), enforcement="greville")
    try:
        Equilibrium(Problem("graded", (body,), (contact,), (), ()), Ledger())
        said = ""
    except InputError as error:
        said = str(error)
    found = re.search(r"its point at \((\S+), (\S+)\) of block.w0 has an area of (\S+):", said)
    told = np.array([float(number) for number in found.groups()]) if found else np.full(3, np.nan)
    all_areas = SIZE.prod() * np.outer(areas(one), areas(two))
    i, j = np.unravel_index(np.argmin(all_areas), all_areas.shape)
    apart = np.abs(told[:2] - [means(one)[i], means(two)[j]])
    place, other = apart if graded == "u" else apart[::-1]
    return {"place": float(place), "other": float(other), "area": float(abs(told[2] / all_areas[i, j] - 1.0))}
