"""Rigid planes anywhere: coordinates and gap of slave points against their definition."""

from __future__ import annotations

import numpy as np

from isomortar import _bindings
from isomortar._bindings import PlaneArrays, SlaveArrays
from isomortar.harness import Bound, case

_ROUND_OFF = Bound(at_most=1e-14, reason="round-off: sums of three products of numbers of size one")


@case(
    claim="On any rigid plane, coordinates are lengths along its tangents, and the gap is the penetration along its normal, however "
    "long these vectors are given, and the first tangent aslant.",
    tier="gate",
    bounds={
        "coordinates": _ROUND_OFF,
        "gap": _ROUND_OFF,
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: a plane has no edge"),
    },
)
def distance_and_coordinates() -> dict[str, float]:
    """Largest errors over ten planes and points on either side; share of points that are found."""
    random = np.random.default_rng(13)
    coordinates, gaps, found = [], [], []
    for _ in range(10):
        origin, points = random.uniform(-1, 1, 3), random.uniform(-1, 1, (30, 3))
        normal, tangent = np.linalg.qr(random.standard_normal((3, 2)))[0].T
        long, aslant = random.uniform(0.1, 3.0, 2), random.uniform(-2.0, 2.0)
        plane = PlaneArrays(origin, long[0] * normal, long[1] * tangent + aslant * normal)
        number = np.arange(len(points), dtype=np.int32)
        slave = SlaveArrays.of_points(number)
        projections = _bindings.project_points(slave, plane, points, np.zeros((len(points), 2)), np.zeros_like(number))
        control = _bindings.control_quantities(slave, plane, points, projections)
        expected = (points - origin) @ np.column_stack([tangent, np.cross(normal, tangent)])
        coordinates.append(np.abs(projections.xi - expected).max())
        gaps.append(np.abs(control.gap + (points - origin) @ normal).max())
        found.append(projections.found)
    return {"coordinates": float(np.max(coordinates)), "gap": float(np.max(gaps)), "found": float(np.mean(found))}
